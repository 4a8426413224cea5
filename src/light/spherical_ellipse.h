// The directions in which a receiver sees a disk or an ellipse: all but uniform ones, and their density.
#pragma once

#include "base/angles.h"
#include "light/elliptic_cone.h"
#include "light/piecewise_linear.h"

#include <array>

namespace etendue {

/// After Guillen et al. 2017, "Area-preserving parameterizations for spherical ellipses", without its
/// integral: see docs/light_sampling.md. With half angles a >= b of the cone in its planes of symmetry, and
/// an angle psi about its axis, a wedge holds the solid angle dw = sin a sin b / (1 + q) dpsi, where q^2 =
/// cos^2 a cos^2 psi + cos^2 b sin^2 psi; q is also the cosine of the cone's half angle in the wedge. What 1
/// / (1 + q) is, between 1/2 and 1, straight lines over eighths of a half turn follow, for samples and
/// densities alike: so the density is exact, and differs from that of a uniform direction by 1 % (standard
/// deviation) at most; of a circular cone not at all.
template <class F>
class SphericalEllipse {
 public:
  explicit SphericalEllipse(const SeenDisk<F>& disk) : cone_(disk) {
    const F s = cone_.s, long_sq = cone_.long_sq, short_sq = cone_.short_sq;
    const F inv_long = F(1) / (s + long_sq), inv_short = F(1) / (s + short_sq);
    sin_long_sq_ = long_sq * inv_long;
    sin_short_sq_ = short_sq * inv_short;
    cos_long_ = sqrt(s * inv_long);
    cos_short_ = sqrt(s * inv_short);
    std::array<F, parts + 1> heights;
    for (std::size_t k = 0; k <= parts; ++k)
      heights[k] = F(1) / (F(1) + sqrt(s * inv_long * F(cos_sq[k]) + s * inv_short * F(1 - cos_sq[k])));
    lines_ = PiecewiseLinear<F, parts>(heights);
    inv_measure_ = F(1) / (F(4 * width) * lines_.integral() * sqrt(sin_long_sq_ * sin_short_sq_));
  }

  struct Sample {
    Vec2<F> on_disk;  ///< Of the unit disk.
    F pdf;            ///< Of the direction there (1/sr).
  };
  /// Neighbours in u are neighbours on the disk.
  Sample sample(const Vec2<F>& u) const {
    // Squares around the middle become rings, as in square_to_uniform_disk.
    const F x = F(2) * u.x - F(1), y = F(2) * u.y - F(1);
    const Mask<F> is_wide = abs(x) > abs(y);
    const F ring = select(is_wide, x, y), ring_sq = ring * ring;
    const F eighth = F(0.5f) * abs(select(is_wide, y, x)) / max(abs(ring), F(tiny));
    // Of the quadrant, from psi = 0 on.
    const auto drawn = lines_.sample(select(is_wide, eighth, F(1) - eighth));
    F sine, cosine;
    sincos_half_turn(drawn.place * F(width), sine, cosine);
    const F cos_part = cos_long_ * cosine, sin_part = cos_short_ * sine,
            q = sqrt(cos_part * cos_part + sin_part * sin_part);

    // Of the wedge's solid angle a share ring^2 lies nearer to the axis; as a share of the tangent.
    const F sin_sq = cosine * cosine * sin_long_sq_ + sine * sine * sin_short_sq_;
    const F depth = ring_sq * sin_sq / (F(1) + q);  // 1 - cos
    const F radius =
        abs(ring) * sqrt((F(2) - depth) / (F(1) + q)) / ((F(1) - ring_sq) + ring_sq * q);  // over q
    const F p_x = cos_part * radius, p_y = sin_part * radius;
    return {cone_.from_axis({select(x < F(0), -p_x, p_x), select(y < F(0), -p_y, p_y)}),
            drawn.height * (F(1) + q) * inv_measure_};
  }

  /// The density (1/sr) of the direction to a point of the unit disk.
  F pdf(const Vec2<F>& on_disk) const {
    const Vec2<F> p = cone_.to_axis(on_disk);
    const F long_part = abs(p.x) * cos_short_, short_part = abs(p.y) * cos_long_;
    const F psi = half_turn_angle(short_part, long_part);
    const F size = sqrt(long_part * long_part + short_part * short_part),
            inv_size = F(1) / max(size, F(tiny));
    // The axis itself belongs to every wedge.
    const F cosine = select(size > F(0), long_part * inv_size, F(1)), sine = short_part * inv_size;
    const F cos_part = cos_long_ * cosine, sin_part = cos_short_ * sine,
            q = sqrt(cos_part * cos_part + sin_part * sin_part);
    return lines_.height(psi * F(1 / width)) * (F(1) + q) * inv_measure_;
  }

 private:
  static constexpr float tiny = 1e-30f;
  static constexpr std::size_t parts = 4;  ///< Of a quadrant of psi.
  static constexpr float width = 1.57079632679489661923f / parts;
  static constexpr std::array cos_sq{1.0f, 0.853553391f, 0.5f, 0.146446609f, 0.0f};

  EllipticCone<F> cone_;
  F sin_long_sq_, sin_short_sq_, cos_long_, cos_short_;  ///< Of the half angles a and b.
  PiecewiseLinear<F, parts> lines_;                      ///< 1 / (1 + q)
  F inv_measure_;
};

}  // namespace etendue
