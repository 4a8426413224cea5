// Which parts of a light lie near each other: orders shadow rays only.
#pragma once

#include "base/vec.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Of each part of a light, by the places of their centres (m): the first of its pieces in the low byte,
/// their number above.
std::vector<std::int32_t> pieces_of(const std::vector<Vec3f>& centers);

}  // namespace etendue
