#include "texture/uv_texture.h"

namespace etendue {

const Plugin uv_texture_plugin{
    "texture",
    "uvtexture",
    "The surface coordinates: red is u, green v, modulo 1, with a ripple; blue is 0.5.",
    {},
    {}};

UvTexture make_uv_texture(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, uv_texture_plugin, unread);
  return {};
}

}  // namespace etendue
