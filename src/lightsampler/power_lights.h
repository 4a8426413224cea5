// Which light: in proportion to its power, wherever the receiver is.
#pragma once

#include "light/inversion_table.h"
#include "light/light.h"
#include "lightsampler/light_choice.h"

#include <vector>

namespace etendue {

class PowerLights {
 public:
  /// A light of little power is chosen with a hundredth of what all alike would have (2^-28 at the least),
  /// one of none never; where no light has any, all alike.
  explicit PowerLights(const Lights& lights);

  static constexpr bool chooses_facets = false;
  std::int32_t passes() const { return 1; }
  std::int32_t ranks() const { return count(); }

  /// By inversion, which keeps the order of the random numbers and so their stratification. u_left has
  /// 2^32 values times the light's share, 2^24 at most (a float's), and 16 at the least share: the
  /// samples of such a light reach few of its points.
  template <class F>
  LightChoice<F> choose(const Receiver<F>& /*receiver*/, const UInt<F>& u, std::int32_t /*pass*/) const {
    const Int<F> first(0);
    const InversionSample<F> sample = sample_by_inversion<F>(shares_.data(), first, count(), u);
    const UInt<F> u_left = as_uint(to_int(sample.u_left * F(0x1p24f))) << 8;
    return {sample.index, Int<F>(whole_light), u_left, inversion_pmf<F>(shares_.data(), first, sample.index),
            sample.index};
  }

  template <class F>
  F pmf(const Receiver<F>& /*receiver*/, const Int<F>& light, const Int<F>& /*facet*/) const {
    return inversion_pmf<F>(shares_.data(), Int<F>(0), light);
  }

 private:
  std::int32_t count() const { return std::int32_t(shares_.size()) - 1; }
  std::vector<std::int32_t> shares_;  ///< Cumulative, see light/inversion_table.h.
};

}  // namespace etendue
