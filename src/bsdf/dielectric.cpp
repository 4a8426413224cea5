#include "bsdf/dielectric.h"

namespace etendue {

const Plugin dielectric_plugin{
    "bsdf",
    "dielectric",
    "A smooth boundary of two dielectrics: Fresnel reflection and refraction, seen from both sides.",
    refractive_index_parameters(),
    {}};

Dielectric make_dielectric(const Object& description, std::vector<UnreadKey>& unread) {
  return {read_refractive_indices(Parameters(description, dielectric_plugin, unread))};
}

}  // namespace etendue
