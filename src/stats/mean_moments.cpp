#include "stats/mean_moments.h"

#include "stats/boost_policy.h"
#include "stats/quantile.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace etendue {
namespace {

constexpr double unknown_moment = std::numeric_limits<double>::quiet_NaN();

/// Of what differs by less, floats do not tell.
constexpr double relative_rounding = 1e-5;

double degrees_of_freedom(const MeanMoments& a, const MeanMoments& b) {
  const double variance = a.variance + b.variance, error_sq = a.variance_error_sq + b.variance_error_sq;
  return error_sq > 0 ? std::max(2 * variance * variance / error_sq, 0.5) : 1;
}

}  // namespace

MeanMoments& MeanMoments::operator+=(const MeanMoments& other) {
  mean += other.mean;
  variance += other.variance;
  third += other.third;
  variance_error_sq += other.variance_error_sq;
  return *this;
}

MeanMoments MeanMoments::scaled(double factor) const {
  const double sq = factor * factor;
  return {mean * factor, variance * sq, third * sq * factor, variance_error_sq * sq * sq};
}

double MeanMoments::standard_error() const { return std::sqrt(variance); }

MeanMoments moments_of_mean(std::span<const float> values) {
  const double count = double(values.size());
  double mean = 0, m2 = 0, m3 = 0, m4 = 0;
  for (const float value : values) mean += value;
  mean /= count;
  if (values.size() < 3) return {mean, unknown_moment, unknown_moment, unknown_moment};
  for (const float value : values) {
    const double deviation = value - mean, sq = deviation * deviation;
    m2 += sq;
    m3 += sq * deviation;
    m4 += sq * sq;
  }
  const double variance = m2 / (count - 1);  // Of one value.
  const double error_sq = std::max(2 / (count - 1) * variance * variance,
                                   (m4 / count - variance * variance * (count - 3) / (count - 1)) / count);
  return {mean, variance / count, m3 / (count * (count - 1) * (count - 2)), error_sq / (count * count)};
}

double variance_if_same(const MeanMoments& a, const MeanMoments& b, double step_a, double step_b) {
  const bool is_a_low = a.mean < b.mean;
  const MeanMoments &low = is_a_low ? a : b, &high = is_a_low ? b : a;
  const double step = std::max({low.step(), -high.step(), is_a_low ? step_a : step_b, 0.0});
  return a.variance + b.variance + (high.mean - low.mean) * step;
}

MeanTest test_same_mean(const MeanMoments& a, const MeanMoments& b, double step_a, double step_b) {
  const double difference = a.mean - b.mean,
               rounding = relative_rounding * std::max(std::abs(a.mean), std::abs(b.mean));
  if (!std::isfinite(difference) || !std::isfinite(a.variance + b.variance))
    return {unknown_moment, 0, unknown_moment};
  const double sampled = variance_if_same(a, b, step_a, step_b);
  if (sampled == 0) return {difference, 0, std::abs(difference) <= rounding ? 1.0 : 0.0};
  const double statistic = difference / std::sqrt(sampled + rounding * rounding),
               freedom = degrees_of_freedom(a, b);
  const boost::math::students_t_distribution<double, BoostPolicy> student(freedom);
  return {statistic, freedom, std::min(1.0, 2 * cdf(complement(student, std::abs(statistic))))};
}

double smallest_difference(const MeanMoments& a, const MeanMoments& b, double step_a, double step_b,
                           double level) {
  const double variance = a.variance + b.variance;
  if (!std::isfinite(variance)) return std::numeric_limits<double>::infinity();
  if (variance == 0) return relative_rounding * std::max(std::abs(a.mean), std::abs(b.mean));
  const double step = std::max({a.step(), b.step(), step_a, step_b, 0.0});
  const double critical = student_t_quantile(1 - level / 2, degrees_of_freedom(a, b)),
               missed = normal_quantile(0.9) * std::sqrt(variance);
  // d - missed = critical sqrt(variance + d step)
  const double half = missed + critical * critical * step / 2;
  return half + std::sqrt(std::max(0.0, half * half - missed * missed + critical * critical * variance));
}

}  // namespace etendue
