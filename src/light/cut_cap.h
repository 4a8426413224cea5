// A spherical cap that the horizon cuts: directions in what is above, with density nearly in proportion to
// the cosine at the receiver.
#pragma once

#include "base/angles.h"
#include "light/cap_over_horizon.h"
#include "light/piecewise_linear.h"

#include <array>

namespace etendue {

/// Slices across the horizon, each an arc of directions in a plane with the zenith, are cut where they meet
/// it. Of their widths in the projection along the zenith, the measure of the cosine, straight lines over
/// sixteenths of half a turn stand for the right ones, for samples and densities alike: so the density is
/// exact, and leaves 3.5 % of the cosine (standard deviation) at most.
template <class F>
class CutCap {
 public:
  explicit CutCap(const CapOverHorizon<F>& cap) : cap_(cap) {
    const F up_to_rim = cap.sin_radius * cap.sin_radius,
            up_to_horizon =
                (up_to_rim - cap.sin_height * cap.sin_height) / max(cap.cos_height * cap.cos_height, F(tiny));
    most_across_ =
        sqrt(select(cap.sin_height > F(0), up_to_rim, max(min(up_to_horizon, up_to_rim), F(tiny))));
    std::array<F, parts + 1> heights;
    for (std::size_t k = 0; k < parts; ++k) heights[k] = slice_at(F(sines[k])).width * F(sines[parts - k]);
    heights[parts] = F(0);
    lines_ = PiecewiseLinear<F, parts>(heights);
  }

  /// What is above the horizon (sr, of the cosine), by the straight lines.
  F measure() const { return F(2 * part_angle) * most_across_ * lines_.integral(); }

  /// \param density_over_cosine of the direction, times measure()
  CapDirection<F> sample(const Vec2<F>& u, F& density_over_cosine) const {
    const F turn = F(2) * u.y - F(1);
    const auto drawn = lines_.sample(abs(turn));
    F sine, cosine;
    sincos_half_turn(drawn.place * F(part_angle), sine, cosine);
    const Slice at = slice_at(min(sine, F(1)));
    density_over_cosine = drawn.height / max(at.width * cosine, F(tiny));

    const F x = F(2) * u.x - F(1);
    const CapDirection<F> whole = direction_above(cap_, at.sin_half, at.cos_half, x, F(1) - x * x);
    const F depth = u.x * at.one_minus_cos_top, level = F(1) - depth,
            high = sqrt(max(depth * (F(2) - depth), F(0)));
    const auto choose = [&](const F& cut, const F& uncut) {
      return at.radius * select(at.is_cut, cut, uncut);
    };
    const F across = sine * most_across_;
    return {choose(high * cap_.cos_height - level * cap_.sin_height, whole.up),
            select(turn < F(0), -across, across),
            choose(level * cap_.cos_height + high * cap_.sin_height, whole.axis),
            choose(high, whole.cos_theta)};
  }

  /// As of samples. \param across of a direction in the cap
  F density_over_cosine(const F& across) const {
    const F sine = min(abs(across) / most_across_, F(1)), cosine = sqrt(F(1) - sine * sine);
    const F place = half_turn_angle(sine, cosine) * F(1 / part_angle);
    return lines_.height(place) / max(slice_at(sine).width * cosine, F(tiny));
  }

 private:
  static constexpr float tiny = 1e-30f;
  static constexpr std::size_t parts = 8;
  static constexpr float part_angle = 1.57079632679489661923f / parts;
  static constexpr std::array sines{0.0f,         0.195090322f, 0.382683432f, 0.555570233f, 0.707106781f,
                                    0.831469612f, 0.923879533f, 0.98078528f,  1.0f};

  struct Slice {
    F radius;              ///< Of the hemisphere there.
    F sin_half, cos_half;  ///< Of half the arc, as if nothing were cut.
    Mask<F> is_cut;
    F one_minus_cos_top;  ///< Of the height at which the arc ends.
    F width;              ///< In the projection.
  };
  /// \param sine of the slice's place between the middle, 0, and the end, 1
  Slice slice_at(const F& sine) const {
    const F across = sine * most_across_, across_sq = across * across;
    Slice at;
    at.radius = sqrt(F(1) - across_sq);
    const F inv_radius = F(1) / at.radius;
    at.sin_half = sqrt(max(cap_.sin_radius * cap_.sin_radius - across_sq, F(0))) * inv_radius;
    at.cos_half = cap_.cos_radius * inv_radius;
    const F middle = cap_.sin_height * at.cos_half, half = cap_.cos_height * at.sin_half;
    at.is_cut = middle < half;
    const F sin_top = max(middle + half, F(0)),
            cos_top = cap_.cos_height * at.cos_half - cap_.sin_height * at.sin_half;
    at.one_minus_cos_top = select(cos_top > F(0), sin_top * sin_top / (F(1) + abs(cos_top)), F(1) - cos_top);
    at.width = at.radius * select(at.is_cut, at.one_minus_cos_top, F(2) * cap_.sin_height * at.sin_half);
    return at;
  }

  CapOverHorizon<F> cap_;
  F most_across_;                    ///< Of the last slice.
  PiecewiseLinear<F, parts> lines_;  ///< Widths, over the angle whose sine says where the slice is.
};

}  // namespace etendue
