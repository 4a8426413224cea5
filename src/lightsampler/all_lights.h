// Which light: each of them, one after the other; a light sample is the sum of one of each.
#pragma once

#include "light/light.h"
#include "lightsampler/light_choice.h"

namespace etendue {

class AllLights {
 public:
  explicit AllLights(const Lights& lights) : count_(lights.count()) {}

  static constexpr bool chooses_facets = false;
  std::int32_t passes() const { return count_; }
  std::int32_t ranks() const { return count_; }

  template <class F>
  LightChoice<F> choose(const Receiver<F>& /*receiver*/, const UInt<F>& u, std::int32_t pass) const {
    return {Int<F>(pass), Int<F>(whole_light), u, F(1), Int<F>(pass)};
  }

  template <class F>
  F pmf(const Receiver<F>& /*receiver*/, const Int<F>& /*light*/, const Int<F>& /*facet*/) const {
    return F(1);
  }

 private:
  std::int32_t count_;
};

}  // namespace etendue
