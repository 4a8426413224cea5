// The directions in which a receiver sees a sphere, weighed by the cosine at the receiver: ones with density
// in proportion to the cosine, nearly so where the horizon cuts the sphere.
#pragma once

#include "base/warp.h"
#include "light/cut_cap.h"

#include <optional>

namespace etendue {

/// Peters and Dachsbacher 2019, "Sampling projected spherical caps in real time": what a cap above the
/// horizon covers on the hemisphere has an ellipse for its orthogonal projection to the horizon's plane, and
/// points are uniform in it. Of a cut cap see cut_cap.h.
template <class F>
class ProjectedCap {
 public:
  explicit ProjectedCap(const CapOverHorizon<F>& cap)
      : cap_(cap),
        is_accurate_(cap.sin_height + cap.sin_radius > F(1e-3f)),
        is_cut_(mask_and(is_accurate_, cap.sin_height < cap.sin_radius)),
        measure_(F(pi) * cap.sin_radius * cap.sin_radius * cap.sin_height) {
    if (!any(is_cut_)) return;
    cut_.emplace(cap);
    measure_ = select(is_cut_, cut_->measure(), measure_);
  }

  /// Elsewhere the cap is below the horizon, or so low that rounding would be seen in the cosines.
  const Mask<F>& is_accurate() const { return is_accurate_; }

  /// \param pdf of the direction (1/sr)
  CapDirection<F> sample(const Vec2<F>& u, F& pdf) const {
    const Vec2<F> on_disk = square_to_uniform_disk(u);
    CapDirection<F> made = direction_above(cap_, cap_.sin_radius, cap_.cos_radius, on_disk.x,
                                           F(1) - on_disk.x * on_disk.x - on_disk.y * on_disk.y);
    made.across = cap_.sin_radius * on_disk.y;
    F over_cosine(1);
    if (any(is_cut_)) {
      const CapDirection<F> cut = cut_->sample(u, over_cosine);
      over_cosine = select(is_cut_, over_cosine, F(1));
      made = {select(is_cut_, cut.up, made.up), select(is_cut_, cut.across, made.across),
              select(is_cut_, cut.axis, made.axis), select(is_cut_, cut.cos_theta, made.cos_theta)};
    }
    pdf = density(made.cos_theta, over_cosine);
    return made;
  }

  /// The density (1/sr) of a direction to the sphere.
  F pdf(const Vec3<F>& wi) const {
    F over_cosine(1);
    if (any(is_cut_)) over_cosine = select(is_cut_, cut_->density_over_cosine(dot(wi, cap_.across)), F(1));
    return density(dot(wi, cap_.zenith), over_cosine);
  }

 private:
  F density(const F& cos_theta, const F& over_cosine) const {
    // Rounding must not make it 0 for a direction along the horizon that was sampled.
    return max(cos_theta, F(1e-7f)) * over_cosine / measure_;
  }

  CapOverHorizon<F> cap_;
  Mask<F> is_accurate_, is_cut_;
  F measure_;  ///< sr, of the cosine; of the cut, as CutCap has it.
  std::optional<CutCap<F>> cut_;
};

}  // namespace etendue
