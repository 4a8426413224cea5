// Which light: one of n, all alike.
#pragma once

#include "light/light.h"
#include "lightsampler/light_choice.h"

namespace etendue {

class UniformLights {
 public:
  explicit UniformLights(const Lights& lights)
      : count_(std::uint32_t(lights.count())), pmf_(1.0f / float(lights.count())) {}

  static constexpr bool chooses_facets = false;
  std::int32_t passes() const { return 1; }
  std::int32_t ranks() const { return std::int32_t(count_); }

  template <class F>
  LightChoice<F> choose(const Receiver<F>& /*receiver*/, const UInt<F>& u, std::int32_t /*pass*/) const {
    const UInt<F> n(count_);
    const Int<F> light = as_int(mul_hi(u, n));
    return {light, Int<F>(whole_light), u * n, F(pmf_), light};
  }

  template <class F>
  F pmf(const Receiver<F>& /*receiver*/, const Int<F>& /*light*/, const Int<F>& /*facet*/) const {
    return F(pmf_);
  }

 private:
  std::uint32_t count_;
  float pmf_;
};

}  // namespace etendue
