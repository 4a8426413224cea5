// One light of the file -> the scene's lights.
#pragma once

#include "light/light.h"
#include "scenefile/parameters.h"

#include <filesystem>
#include <string_view>
#include <vector>

namespace etendue {

bool is_light(const Object& object);  ///< <luminaire> or <emitter>

const std::vector<Plugin>& light_plugins();

/// The kind that is the shape it stands in.
inline constexpr std::string_view area_light_name = "area";

struct AreaLight {
  Colorf radiance;   ///< W/(m^2 sr)
  bool is_twosided;  ///< Whether the back side shines too.
};

/// Throws InputError for a negative radiance.
AreaLight make_area_light(const Object& description, std::vector<UnreadKey>& unread);

/// Adds a light that is no area light; where it stands in the file makes no difference. Throws InputError for
/// an unknown kind, a parameter out of range, an image that cannot be read or used.
void add_light(const Object& description, const std::filesystem::path& directory, Lights& lights,
               std::vector<UnreadKey>& unread);

}  // namespace etendue
