// What the descriptions of several kinds of light share.
#pragma once

#include "base/color.h"
#include "base/transform.h"
#include "scenefile/parameters.h"

#include <string_view>

namespace etendue {

/// toWorld as a rotation, perhaps mirrored: directions keep their angles. A common scale and a translation
/// are left out; throws InputError where there is more than these.
Transform rotation_from_light(const Parameters& parameters);

/// `name` as a point in the world after toWorld; throws InputError where it is not finite as floats.
Vec3f world_point(const Parameters& parameters, std::string_view name);

/// `name` as a unit direction in the world after toWorld; throws InputError where it has no length.
Vec3f world_direction(const Parameters& parameters, std::string_view name);

/// Which of two names for one strength the file states; where none, the first, with its default. Throws
/// InputError where it states both.
std::string_view stated_one_of(const Parameters& parameters, std::string_view name, std::string_view other);

}  // namespace etendue
