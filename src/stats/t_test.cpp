#include "stats/t_test.h"

#include "stats/boost_policy.h"
#include "stats/quantile.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace etendue {
namespace {

constexpr double unknown_test = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The test of a difference whose standard error is known or estimated with so many degrees of freedom.
MeanTest test_difference(double difference, double standard_error, double degrees_of_freedom) {
  if (!std::isfinite(difference) || !std::isfinite(standard_error) || standard_error < 0)
    return {unknown_test, 0, unknown_test};
  if (standard_error == 0) {
    if (difference == 0) return {0, degrees_of_freedom, 1};
    return {std::copysign(infinity, difference), degrees_of_freedom, 0};
  }
  const double statistic = difference / standard_error;
  if (std::isinf(statistic)) return {statistic, degrees_of_freedom, 0};
  const double tail =
      std::isinf(degrees_of_freedom)
          ? cdf(complement(boost::math::normal_distribution<double, BoostPolicy>(0, 1), std::abs(statistic)))
          : cdf(complement(boost::math::students_t_distribution<double, BoostPolicy>(degrees_of_freedom),
                           std::abs(statistic)));
  return {statistic, degrees_of_freedom, std::min(1.0, 2 * tail)};
}

}  // namespace

MeanTest t_test(const RunningStatistics& sample, double reference, double variance_floor) {
  if (sample.count < 2 || !std::isfinite(sample.m2)) return {unknown_test, 0, unknown_test};
  const double variance = std::max(sample.variance(), variance_floor);
  return test_difference(sample.mean - reference, std::sqrt(variance / double(sample.count)),
                         double(sample.count - 1));
}

MeanTest welch_t_test(const RunningStatistics& a, const RunningStatistics& b) {
  if (a.count < 2 || b.count < 2) return {unknown_test, 0, unknown_test};
  const double error_a_sq = a.variance() / double(a.count);
  const double error_b_sq = b.variance() / double(b.count);
  const double error_sq = error_a_sq + error_b_sq;
  // The shares cannot overflow or underflow where the squares of the variances would.
  const double share_a = error_a_sq / error_sq, share_b = error_b_sq / error_sq;
  const double degrees_of_freedom =
      error_sq > 0 ? 1 / (share_a * share_a / double(a.count - 1) + share_b * share_b / double(b.count - 1))
                   : double(a.count + b.count - 2);
  return test_difference(a.mean - b.mean, std::sqrt(error_sq), degrees_of_freedom);
}

MeanTest z_test(double value, double reference, double standard_error) {
  return test_difference(value - reference, standard_error, infinity);
}

Interval student_t_interval(const RunningStatistics& sample, double confidence) {
  if (!(confidence > 0 && confidence < 1))
    throw std::domain_error("student_t_interval: the confidence must lie in (0, 1)");
  if (sample.count < 2) return {-infinity, infinity};
  const double half_width =
      student_t_quantile((1 + confidence) / 2, double(sample.count - 1)) * sample.standard_error();
  return {sample.mean - half_width, sample.mean + half_width};
}

}  // namespace etendue
