// Cells of the sphere of directions that fit themselves to a distribution, however narrow its lobes.
#pragma once

#include "base/vec.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace etendue {

/// A grid in 1 - z and phi whose lines lie at quantiles of samples, with one at the horizon.
class QuantileCells {
 public:
  explicit QuantileCells(const std::vector<Vec3<double>>& samples) {
    std::vector<double> depths, turns;
    for (const Vec3<double>& w : samples) {
      depths.push_back(depth_of(w));
      turns.push_back(std::atan2(w.y, w.x));
      pilot_.push_back({depths.back(), turns.back()});
    }
    rows_ = lines(depths, {0, 1, 2});
    columns_ = lines(turns, {-std::numbers::pi, std::numbers::pi});
  }

  std::size_t size() const { return (rows_.size() - 1) * (columns_.size() - 1); }

  std::size_t cell_of(const Vec3<double>& w) const { return cell_at(depth_of(w), std::atan2(w.y, w.x)); }

  /// The integral of `pdf` (1/sr) over each cell by Gauss's rule of 2 x 2 points on parts, which are split
  /// once, then until the result stays and does not miss where samples are, `most_splits` times at most.
  template <class Pdf>
  std::vector<double> integrals(const Pdf& pdf, int most_splits) const {
    const auto density = [&](double depth, double turn) {
      const double radius = std::sqrt(depth * (2 - depth));
      return pdf(Vec3<double>{radius * std::cos(turn), radius * std::sin(turn), 1 - depth});
    };
    const std::vector<double> rows = graded(rows_), columns = graded(columns_);
    const std::size_t stride = columns.size() - 1;
    std::vector<std::vector<Vec2<double>>> pilot((rows.size() - 1) * stride);
    for (const Vec2<double>& point : pilot_)
      pilot[interval_of(rows, point.x) * stride + interval_of(columns, point.y)].push_back(point);
    std::vector<double> result(size());
    for (std::size_t row = 0; row + 1 < rows.size(); ++row)
      for (std::size_t column = 0; column < stride; ++column) {
        const Part part{rows[row], columns[column], rows[row + 1] - rows[row],
                        columns[column + 1] - columns[column]};
        result[cell_at(part.depth + part.depth_size / 2, part.turn + part.turn_size / 2)] +=
            refined(density, part, gauss(density, part), pilot[row * stride + column], most_splits);
      }
    return result;
  }

 private:
  /// A rectangle from its corner.
  struct Part {
    double depth, turn, depth_size, turn_size;
  };

  /// 1 - z without cancellation at the upper pole.
  static double depth_of(const Vec3<double>& w) {
    const double from_pole = (w.x * w.x + w.y * w.y) / (length(w) * (length(w) + std::abs(w.z)));
    return w.z > 0 ? from_pole : 2 - from_pole;
  }

  static std::vector<double> lines(std::vector<double> values, std::vector<double> result) {
    std::sort(values.begin(), values.end());
    for (const double q : {0.0, 0.0005, 0.02, 0.1, 0.25, 0.4, 0.6, 0.75, 0.9, 0.98, 0.9995, 1.0})
      result.push_back(values[std::size_t(q * double(values.size() - 1))]);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  /// More lines, so that no interval is much longer than its neighbours: long ones may hide a lobe at an end.
  static std::vector<double> graded(std::vector<double> lines) {
    constexpr double most_growth = 4;
    for (std::size_t i = 0; i + 2 < lines.size(); ++i)
      if (const double limit = most_growth * (lines[i + 1] - lines[i]); lines[i + 2] - lines[i + 1] > limit)
        lines.insert(lines.begin() + std::ptrdiff_t(i) + 2, lines[i + 1] + limit * 0.75);
    for (std::size_t i = lines.size() - 1; i >= 2; --i)
      while (lines[i - 1] - lines[i - 2] > most_growth * (lines[i] - lines[i - 1]))
        lines.insert(lines.begin() + std::ptrdiff_t(i) - 1,
                     lines[i - 1] - most_growth * 0.75 * (lines[i] - lines[i - 1]));
    return lines;
  }

  std::size_t cell_at(double depth, double turn) const {
    return interval_of(rows_, depth) * (columns_.size() - 1) + interval_of(columns_, turn);
  }

  static std::size_t interval_of(const std::vector<double>& lines, double value) {
    const auto above = std::upper_bound(lines.begin() + 1, lines.end() - 1, value);
    return std::size_t(above - lines.begin()) - 1;
  }

  template <class Density>
  static double gauss(const Density& density, const Part& part) {
    constexpr double points[]{0.21132486540518712, 0.78867513459481288};
    double sum = 0;
    for (const double i : points)
      for (const double k : points)
        sum += density(part.depth + i * part.depth_size, part.turn + k * part.turn_size);
    return 0.25 * sum * part.depth_size * part.turn_size;
  }

  template <class Density>
  double refined(const Density& density, const Part& part, double whole, std::span<Vec2<double>> pilot,
                 int splits_left, int forced_splits = 2) const {
    double quarters[4], sum = 0;
    Part parts[4];
    for (int i = 0; i < 4; ++i) {
      parts[i] = {part.depth + (i / 2) * part.depth_size / 2, part.turn + (i % 2) * part.turn_size / 2,
                  part.depth_size / 2, part.turn_size / 2};
      sum += quarters[i] = gauss(density, parts[i]);
    }
    const bool misses_samples = double(pilot.size()) > 2 * sum * double(pilot_.size()) + 0.5;
    const bool stays = std::abs(sum - whole) < 1e-8 + 1e-4 * std::abs(sum);
    if (splits_left == 0 || (forced_splits <= 0 && stays && !misses_samples)) return sum;
    sum = 0;
    for (int i = 0; i < 4; ++i) {
      const auto rest = std::partition(pilot.begin(), pilot.end(), [&](const Vec2<double>& point) {
        return i == 3 ||
               ((point.x >= parts[3].depth) == (i / 2 == 1) && (point.y >= parts[3].turn) == (i % 2 == 1));
      });
      const auto inside = std::size_t(rest - pilot.begin());
      sum += refined(density, parts[i], quarters[i], pilot.first(inside), splits_left - 1, forced_splits - 1);
      pilot = pilot.subspan(inside);
    }
    return sum;
  }

  std::vector<double> rows_, columns_;
  std::vector<Vec2<double>> pilot_;  ///< Depths and turns.
};

}  // namespace etendue
