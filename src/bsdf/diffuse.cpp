#include "bsdf/diffuse.h"

namespace etendue {

const Plugin diffuse_plugin{
    "bsdf",
    "diffuse",
    "Lambert's reflection: f = albedo / pi; black from behind.",
    {{"albedo", Parameter::Type::color, "0.5", "", "Fraction of the light that is reflected", false, true}},
    {}};

Diffuse make_diffuse(const Object& description, TextureFiles& files, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, diffuse_plugin, unread);
  return {read_color_texture(parameters, "albedo", files, unread)};
}

}  // namespace etendue
