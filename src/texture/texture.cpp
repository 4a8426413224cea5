#include "texture/texture.h"

namespace etendue {

namespace {

const Plugin constant_texture_plugin{"texture",
                                     "constant_color",
                                     "One colour everywhere, as without a texture.",
                                     {{"value", Parameter::Type::color, "", "", "The colour", true}},
                                     {}};

/// What several forks call it.
constexpr std::string_view image_alias_name = "image_texture";

Plugin image_plugin_alias() {
  Plugin alias = image_texture_plugin;
  alias.name = image_alias_name;
  alias.meaning = "Another name of imagetexture.";
  return alias;
}

}  // namespace

const std::vector<Plugin>& texture_plugins() {
  static const std::vector<Plugin> plugins{checkerboard_plugin, uv_texture_plugin, constant_texture_plugin,
                                           image_texture_plugin, image_plugin_alias()};
  return plugins;
}

ColorTexture read_color_texture(const Parameters& parameters, std::string_view name, TextureFiles& files,
                                std::vector<UnreadKey>& unread) {
  const Object* description = parameters.texture(name);
  if (!description) return nonnegative_color(parameters, name);
  if (description->type == checkerboard_plugin.name) return make_checkerboard(*description, unread);
  if (description->type == uv_texture_plugin.name) return make_uv_texture(*description, unread);
  if (description->type == constant_texture_plugin.name)
    return nonnegative_color(Parameters(*description, constant_texture_plugin, unread), "value");
  if (description->type == image_texture_plugin.name || description->type == image_alias_name)
    return make_image_texture(*description, files, unread);
  throw unknown_plugin(*description, texture_plugins());
}

}  // namespace etendue
