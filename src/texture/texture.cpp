#include "texture/texture.h"

namespace etendue {

const std::vector<Plugin>& texture_plugins() {
  static const std::vector<Plugin> plugins{checkerboard_plugin, uv_texture_plugin, image_texture_plugin};
  return plugins;
}

ColorTexture read_color_texture(const Parameters& parameters, std::string_view name,
                                const std::filesystem::path& directory, std::vector<UnreadKey>& unread) {
  const Object* description = parameters.texture(name);
  if (!description) return nonnegative_color(parameters, name);
  if (description->type == checkerboard_plugin.name) return make_checkerboard(*description, unread);
  if (description->type == uv_texture_plugin.name) return make_uv_texture(*description, unread);
  if (description->type == image_texture_plugin.name)
    return make_image_texture(*description, directory, unread);
  throw unknown_plugin(*description, texture_plugins());
}

}  // namespace etendue
