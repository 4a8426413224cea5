// The refractive indices of the two sides of a surface, and their parameters.
#pragma once

#include "base/mask.h"
#include "scenefile/parameters.h"

namespace etendue {

/// `inside` is the side that the shading normal points away from.
struct RefractiveIndices {
  float inside_over_outside = 1, outside_over_inside = 1;

  /// For a viewer outside (or inside): the index of the other side over that of the viewer's.
  template <class F>
  F across(const Mask<F>& from_outside) const {
    return select(from_outside, F(inside_over_outside), F(outside_over_inside));
  }
};

/// The parameters `intIOR` and `extIOR`, with the defaults of the Nori family: BK7 glass in air.
std::vector<Parameter> refractive_index_parameters();
/// Throws InputError unless both are finite and positive.
RefractiveIndices read_refractive_indices(const Parameters& parameters);

}  // namespace etendue
