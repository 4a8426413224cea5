#include "light/envmap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace etendue {
namespace {

/// The share of samples that goes to the map as it would be with lower contrast, where it has less by itself.
constexpr double defensive_share = 0.05;
/// Lower contrast: no luminance above so many times the mean.
constexpr double defensive_contrast = 8;

constexpr double infinite = std::numeric_limits<double>::infinity();

struct LowContrast {
  double cap;   ///< Of luminances.
  double gain;  ///< For all of the capped map to weigh defensive_share of the whole one.
};

/// \param weights of the rows of texels: their solid angles, but for a factor
/// \param texel_luminance of (column, row)
template <class Luminance>
LowContrast low_contrast(std::int32_t width, const std::vector<float>& weights,
                         const Luminance& texel_luminance) {
  double largest = 0;
  const auto sum_below = [&](double cap) {
    double sum = 0;
    for (std::size_t row = 0; row < weights.size(); ++row) {
      double of_row = 0;
      for (std::int32_t column = 0; column < width; ++column) {
        const double luminance = std::min(texel_luminance(column, std::int32_t(row)), cap);
        of_row += luminance;
        largest = std::max(largest, luminance);
      }
      sum += of_row * double(weights[row]);
    }
    return sum;
  };
  const double whole = sum_below(infinite);
  // Against the mean of what is not black: else the cap of a map that is mostly black would fall for ever.
  double lit = 0;
  for (std::int32_t row = 0; row < std::int32_t(weights.size()); ++row)
    for (std::int32_t column = 0; column < width; ++column)
      if (texel_luminance(column, row) > 0) lit += double(weights[std::size_t(row)]);
  const double contrast = defensive_contrast / lit;
  // contrast x sum falls with the cap, towards the cap that is contrast x sum itself. Within a factor of two
  // of it is near enough.
  double cap = largest, sum = whole;
  for (double next; (next = contrast * sum) < cap / 2;) {
    cap = next;
    sum = sum_below(cap);
  }
  return {cap, defensive_share * whole / sum};
}

}  // namespace

Envmap::Envmap(std::int32_t width, std::int32_t height, std::vector<float> rgb)
    : width_(width), height_(height), rgb_(std::move(rgb)) {
  constexpr double pi_d = std::numbers::pi;
  for (std::int32_t j = 0; j < height; ++j) sin_theta_.push_back(float(std::sin((j + 0.5) / height * pi_d)));
  const double half_rim = 0.25 * pi_d / height;
  cap_one_minus_cos_ = 2 * std::sin(half_rim) * std::sin(half_rim);

  for (std::int32_t row = 0; row <= height; ++row)
    for (std::int32_t column = 0; column < width; ++column)
      mean_luminance_ += weight_of_cell(column, row, 0, infinite) / (2 * width);
  make_shares();
}

void Envmap::compensate() {
  const auto mean = float(mean_luminance_);
  for (std::int32_t row = 0; row < height_; ++row)
    for (std::int32_t column = 0; column < width_; ++column)
      if (luminance_over(column, row, mean) > 0) {
        floor_luminance_ = mean;
        return make_shares();
      }
}

double Envmap::luminance_over(std::int32_t column, std::int32_t row, double floor) const {
  const float* rgb = &rgb_[3 * (std::size_t(row) * std::size_t(width_) + std::size_t(column))];
  return std::max(double(luminance(Colorf{rgb[0], rgb[1], rgb[2]})) - floor, 0.0);
}

double Envmap::weight_of_cell(std::int32_t column, std::int32_t row, double floor, double cap) const {
  const std::int32_t right = column + 1 < width_ ? column + 1 : 0;
  const auto both = [&](std::int32_t of) {
    return std::min(luminance_over(column, of, floor), cap) + std::min(luminance_over(right, of, floor), cap);
  };
  if (row == 0 || row == height_) return both(row == 0 ? 0 : height_ - 1) / 2 * cap_one_minus_cos_;
  return (both(row - 1) * double(sin_theta_[std::size_t(row - 1)]) +
          both(row) * double(sin_theta_[std::size_t(row)])) /
         4 * (std::numbers::pi / height_);
}

void Envmap::make_shares() {
  row_shares_.clear();
  column_shares_.clear();
  const double floor = double(floor_luminance_);
  const LowContrast low = low_contrast(width_, sin_theta_, [&](std::int32_t column, std::int32_t row) {
    return luminance_over(column, row, floor);
  });
  std::vector<double> cells(static_cast<std::size_t>(width_)), rows;
  column_shares_.reserve(std::size_t(height_ + 1) * std::size_t(width_ + 1));
  for (std::int32_t row = 0; row <= height_; ++row) {
    double sum = 0;
    for (std::int32_t column = 0; column < width_; ++column)
      sum += cells[std::size_t(column)] = std::max(weight_of_cell(column, row, floor, infinite),
                                                   low.gain * weight_of_cell(column, row, floor, low.cap));
    append_cumulative_shares(cells, column_shares_);
    rows.push_back(sum);
  }
  append_cumulative_shares(rows, row_shares_);
}

}  // namespace etendue
