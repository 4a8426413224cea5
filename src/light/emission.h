// How strongly lights shine, and from which of their sides.
#pragma once

#include "base/color.h"
#include "base/lane_vec.h"
#include "base/lookup_table.h"

namespace etendue {

/// A row a light.
class Emissions {
 public:
  void push_back(const Colorf& strength) {
    red_.push_back(strength.r);
    green_.push_back(strength.g);
    blue_.push_back(strength.b);
    is_twosided_.push_back(0);
  }
  void set_twosided(std::int32_t light) {
    is_twosided_.set(light, 1);
    has_twosided_ = true;
  }

  Colorf strength(std::int32_t light) const { return {red_[light], green_[light], blue_[light]}; }
  bool is_twosided(std::int32_t light) const { return is_twosided_[light] != 0; }

  /// Of lights in the lanes of `m`; others may hold any light, and say nothing.
  template <class F>
  Color<F> strength(const Int<F>& light, const Mask<F>& m) const {
    const Int<F> safe = select(m, light, Int<F>(0));
    return {red_.at(safe), green_.at(safe), blue_.at(safe)};
  }
  template <class F>
  Mask<F> is_twosided(const Int<F>& light, const Mask<F>& m) const {
    if (!has_twosided_) return F(1) < F(0);
    return less(Int<F>(0), is_twosided_.at(select(m, light, Int<F>(0))));
  }

 private:
  LookupTable<float> red_, green_, blue_;
  LookupTable<std::int32_t> is_twosided_;
  bool has_twosided_ = false;
};

}  // namespace etendue
