// Places that were floats, far from the origin, before a mesh file was written: what the file cannot tell.
#pragma once

#include "base/vec.h"

#include <string>
#include <vector>

namespace etendue {

/// What to say where the rounding of `positions` (in the file) to floats may be more than a hundredth of the
/// size of what they span: whether they were rounded shows, as they lie on the floats' grid. Else empty.
std::string float_rounding_in_file(const std::vector<Vec3<double>>& positions);

}  // namespace etendue
