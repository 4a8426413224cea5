// An environment map: radiance by direction from an image in latitude and longitude, interpolated between its
// texels, and directions sampled in proportion to it.
#pragma once

#include "base/color.h"
#include "base/lane_vec.h"
#include "base/warp.h"
#include "light/inversion_table.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Orientation as in Mitsuba 0.x: y is up; the image's (u, v) is the direction (sin phi sin theta, cos theta,
/// -cos phi sin theta) with phi = 2 pi u, theta = pi v. Texel (i, j) stands at u = (i + 1/2) / width,
/// v = (j + 1/2) / height; between texels the radiance is bilinear in (u, v), over the seam u = 0 too; from
/// the first and last row to the poles it is that of the row.
///
/// The sphere is cut along the rows and columns of texels into (height + 1) x width cells, of which the first
/// and last row are the caps about the poles. Sampling takes a row of cells, a cell in it, and a place in the
/// cell by the bilinear interpolation of luminance x sin(theta) of the four texels around it (of the
/// luminance alone, and uniform in cos(theta), in the caps). So radiance over density is nearly constant: the
/// two differ only by how much sin(theta) differs from its own interpolation. But no cell is chosen less
/// often than in 1 of 20 samples by the map with its luminance capped at about 8 times the mean of what is
/// left: a sun behind the horizon must not take all samples, and where it has less than 19 of 20 parts of the
/// light, that changes hardly anything. The density integrates to 1 and is 0 only where the radiance is, or
/// where a cell has less than 2^-30 of its row's share or its row of all; compensated, in the darker part.
class Envmap {
 public:
  /// \param rgb three numbers a texel, rows from the top (v = 0), finite and not negative, not all 0
  Envmap(std::int32_t width, std::int32_t height, std::vector<float> rgb);

  template <class F>
  struct Value {
    Color<F> radiance;
    F pdf_solid_angle;  ///< 1/sr
  };
  /// In direction `d` (unit, of the map).
  template <class F>
  Value<F> at(const Vec3<F>& d, const Mask<F>& m) const;

  template <class F>
  struct Sample {
    Vec3<F> direction;  ///< Unit, of the map.
    Value<F> value;
    Int<F> piece;  ///< 0 .. 15
  };
  template <class F>
  Sample<F> sample(const Vec2<UInt<F>>& u) const;

  /// From now on samples directions in proportion to how far the luminance exceeds its mean: for where BSDF
  /// samples find the light too, which are as many everywhere on the average of all receivers. Unless it does
  /// nowhere. (Karlík et al. 2019, "MIS compensation: optimizing sampling techniques in multiple importance
  /// sampling".)
  void compensate();

  double mean_luminance() const { return mean_luminance_; }  ///< Over all directions.

  std::int32_t width() const { return width_; }
  std::int32_t height() const { return height_; }

 private:
  /// A place in a cell; s and t from 0 to 1 along u and v.
  template <class F>
  struct Place {
    Int<F> column, row;
    F s, t;
  };
  /// The texels around a cell, the upper ones first, and how much each weighs in sampling.
  template <class F>
  struct Corners {
    Color<F> color[4];
    F weight[4];
  };
  template <class F, bool is_compensated>
  Corners<F> corners(const Int<F>& column, const Int<F>& row) const;
  template <class F>
  Value<F> value(const Corners<F>& corners, const Place<F>& place, const F& sin_theta) const;
  // Two of each, so that images without compensation keep their bits.
  template <class F, bool is_compensated>
  Value<F> value_at(const Vec3<F>& d, const Mask<F>& m) const;
  template <class F, bool is_compensated>
  Sample<F> sample_by(const Vec2<UInt<F>>& u) const;
  template <class F>
  Mask<F> is_cap(const Int<F>& row) const {
    return mask_or(equal(row, Int<F>(0)), equal(row, Int<F>(height_)));
  }

  /// What sampling goes by, from the luminance above floor_luminance_ of each texel.
  void make_shares();
  /// Mean luminance of a cell x its solid angle, without the 2 pi / width that all cells share; luminances
  /// have `floor` taken off, and are capped.
  double weight_of_cell(std::int32_t column, std::int32_t row, double floor, double cap) const;
  double luminance_over(std::int32_t column, std::int32_t row, double floor) const;

  std::int32_t width_, height_;
  std::vector<float> rgb_;
  std::vector<float> sin_theta_;  ///< Of each row of texels.
  double cap_one_minus_cos_;      ///< At the rim of a cap.
  double mean_luminance_ = 0;
  float floor_luminance_ = 0;  ///< What is below is not sampled.
  std::vector<std::int32_t> row_shares_, column_shares_;
};

}  // namespace etendue

#include "light/envmap_sampling.h"
