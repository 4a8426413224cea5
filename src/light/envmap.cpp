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
  const double whole = sum_below(std::numeric_limits<double>::infinity());
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
  const double cap_one_minus_cos = 2 * std::sin(half_rim) * std::sin(half_rim);
  cap_one_minus_cos_ = float(cap_one_minus_cos);

  const auto texel = [&](std::int32_t column, std::int32_t row) {
    const float* rgb_of = &rgb_[3 * (std::size_t(row) * std::size_t(width) + std::size_t(column))];
    return double(luminance(Colorf{rgb_of[0], rgb_of[1], rgb_of[2]}));
  };
  // Mean luminance of a cell x its solid angle, without the 2 pi / width that all cells share.
  const auto weight_of_cell = [&](std::int32_t column, std::int32_t row, double cap) {
    const std::int32_t right = column + 1 < width ? column + 1 : 0;
    const auto both = [&](std::int32_t of) {
      return std::min(texel(column, of), cap) + std::min(texel(right, of), cap);
    };
    if (row == 0 || row == height) return both(row == 0 ? 0 : height - 1) / 2 * cap_one_minus_cos;
    return (both(row - 1) * double(sin_theta_[std::size_t(row - 1)]) +
            both(row) * double(sin_theta_[std::size_t(row)])) /
           4 * (pi_d / height);
  };
  const LowContrast low = low_contrast(width, sin_theta_, texel);
  std::vector<double> cells(static_cast<std::size_t>(width)), rows;
  column_shares_.reserve(std::size_t(height + 1) * std::size_t(width + 1));
  for (std::int32_t row = 0; row <= height; ++row) {
    double sum = 0;
    for (std::int32_t column = 0; column < width; ++column) {
      const double weight = weight_of_cell(column, row, std::numeric_limits<double>::infinity());
      mean_luminance_ += weight / (2 * width);
      sum += cells[std::size_t(column)] = std::max(weight, low.gain * weight_of_cell(column, row, low.cap));
    }
    append_cumulative_shares(cells, column_shares_);
    rows.push_back(sum);
  }
  append_cumulative_shares(rows, row_shares_);
}

}  // namespace etendue
