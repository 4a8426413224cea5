// From which sides of a surface light is scattered towards the viewer.
#pragma once

#include <cstdint>

namespace etendue {

/// Bits, relative to the shading normal.
namespace lit_side {
inline constexpr std::int32_t none = 0;    ///< By a Dirac delta alone, or seen from behind.
inline constexpr std::int32_t front = 1;   ///< The side that the normal points to.
inline constexpr std::int32_t back = 2;    ///< The other one.
inline constexpr std::int32_t medium = 4;  ///< All directions: there is no surface.
}  // namespace lit_side

}  // namespace etendue
