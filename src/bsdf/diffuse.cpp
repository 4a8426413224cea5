#include "bsdf/diffuse.h"

namespace etendue {

const Plugin diffuse_plugin{
    "bsdf",
    "diffuse",
    "Lambert's reflection: f = albedo / pi; black from behind.",
    {{"albedo", Parameter::Type::color, "0.5", "", "Fraction of the light that is reflected"}},
    {}};

Diffuse make_diffuse(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, diffuse_plugin, unread);
  return {nonnegative_color(parameters, "albedo")};
}

}  // namespace etendue
