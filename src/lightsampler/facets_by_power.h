// A facet among neighbours in the light tree, in proportion to its power.
#pragma once

#include "lightsampler/light_choice.h"
#include "lightsampler/light_tree.h"

namespace etendue {

/// A facet of those at the places [begin, end), in proportion to their power.
template <class F>
LightChoice<F> choose_by_power(const LightTree& tree, const Int<F>& begin, const Int<F>& end,
                               const UInt<F>& u, const F& pmf) {
  using I = Int<F>;
  const std::int32_t* shares = tree.shares();
  const I low = gather(shares, begin), size = gather(shares, end) - low;
  const UInt<F> scaled = mul_hi(u, as_uint(size));
  const I wanted = low + as_int(scaled);
  // Between what the guide says, which is mostly one facet or two.
  const I guide_at = wanted >> tree.guide_shift();
  I first = max(begin, gather(tree.guide(), guide_at)),
    last = min(end - I(1), gather(tree.guide() + 1, guide_at));
  while (true) {
    const Mask<F> is_open = less(first, last);
    if (!any(is_open)) break;
    const I middle = (first + last + I(1)) >> 1;
    const Mask<F> is_above = less(wanted, gather(shares, middle));
    first = select(mask_and(is_open, mask_not(is_above)), middle, first);
    last = select(mask_and(is_open, is_above), middle - I(1), last);
  }
  const I from = gather(shares, first), part = gather(shares, first + I(1)) - from;
  // What is left of the number, below the whole shares too.
  const F below = to_unit_float(u * as_uint(size));
  const F u_left = min((to_float(wanted - from) + below) / max(to_float(part), F(1)), F(0x1.fffffep-1f));
  const I at = first * I(2);
  return {gather(&tree.facets()->light, at), gather(&tree.facets()->facet, at),
          as_uint(to_int(u_left * F(0x1p24f))) << 8, pmf * to_float(part) / max(to_float(size), F(1)),
          tree.rank_of<F>(first)};
}
template <class F>
F pmf_by_power(const LightTree& tree, const Int<F>& begin, const Int<F>& end, const Int<F>& place) {
  const std::int32_t* shares = tree.shares();
  const F part = to_float(gather(shares, place + Int<F>(1)) - gather(shares, place));
  return part / max(to_float(gather(shares, end) - gather(shares, begin)), F(1));
}

}  // namespace etendue
