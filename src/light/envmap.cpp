#include "light/envmap.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace etendue {

Envmap::Envmap(std::int32_t width, std::int32_t height, std::vector<float> rgb)
    : width_(width), height_(height), rgb_(std::move(rgb)) {
  constexpr double pi_d = std::numbers::pi;
  for (std::int32_t j = 0; j < height; ++j) sin_theta_.push_back(float(std::sin((j + 0.5) / height * pi_d)));
  const double half_rim = 0.25 * pi_d / height;
  const double cap_one_minus_cos = 2 * std::sin(half_rim) * std::sin(half_rim);
  cap_one_minus_cos_ = float(cap_one_minus_cos);

  const auto texels = [&](std::int32_t column, std::int32_t row) {  // The sum of two neighbours.
    const auto one = [&](std::int32_t i) {
      const float* texel = &rgb_[3 * (std::size_t(row) * std::size_t(width) + std::size_t(i))];
      return double(luminance(Colorf{texel[0], texel[1], texel[2]}));
    };
    return one(column) + one(column + 1 < width ? column + 1 : 0);
  };
  std::vector<double> cells(static_cast<std::size_t>(width)), rows;
  column_shares_.reserve(std::size_t(height + 1) * std::size_t(width + 1));
  for (std::int32_t row = 0; row <= height; ++row) {
    double sum = 0;
    for (std::int32_t column = 0; column < width; ++column) {
      // Mean weight x solid angle, both without the 2 pi / width that all cells share.
      double weight;
      if (row == 0 || row == height)
        weight = texels(column, row == 0 ? 0 : height - 1) / 2 * cap_one_minus_cos;
      else
        weight = (texels(column, row - 1) * double(sin_theta_[std::size_t(row - 1)]) +
                  texels(column, row) * double(sin_theta_[std::size_t(row)])) /
                 4 * (pi_d / height);
      cells[std::size_t(column)] = weight;
      sum += weight;
    }
    append_cumulative_shares(cells, column_shares_);
    rows.push_back(sum);
    mean_luminance_ += sum / (2 * width);
  }
  append_cumulative_shares(rows, row_shares_);
}

}  // namespace etendue
