// One light of the file -> the scene's lights.
#pragma once

#include "light/light.h"
#include "scenefile/parameters.h"
#include "texture/texture.h"

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace etendue {

bool is_light(const Object& object);  ///< <luminaire> or <emitter>

const std::vector<Plugin>& light_plugins();

/// The kind that is the shape it stands in.
inline constexpr std::string_view area_light_name = "area";

struct AreaLight {
  struct Texture {
    ColorTexture radiance;
    Location where;  ///< In the file.
  };
  Colorf strength;  ///< W/(m^2 sr): the radiance, or the factor of the texture.
  std::optional<Texture> texture;
  bool is_twosided = false;  ///< Whether the back side shines too.
};

/// Throws InputError for a negative radiance or scale, and for a texture that cannot be read.
AreaLight make_area_light(const Object& description, TextureFiles& textures, std::vector<UnreadKey>& unread);

/// Adds a light that is no area light; where it stands in the file makes no difference. Throws InputError for
/// an unknown kind, a parameter out of range, an image that cannot be read or used.
void add_light(const Object& description, const std::filesystem::path& directory, Lights& lights,
               std::vector<UnreadKey>& unread);

}  // namespace etendue
