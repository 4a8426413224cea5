#include "bsdf/roughdielectric.h"

#include <cmath>
#include <fmt/format.h>

namespace etendue {

const Plugin roughdielectric_plugin{
    "bsdf",
    "roughdielectric",
    "A rough boundary of two dielectrics: reflection and refraction by microfacets, seen from both sides.",
    [] {
      std::vector<Parameter> parameters = microfacet_parameters();
      for (const Parameter& parameter : refractive_index_parameters()) parameters.push_back(parameter);
      return parameters;
    }(),
    {}};

RoughDielectric make_roughdielectric(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, roughdielectric_plugin, unread);
  const RoughDielectric model{read_microfacet_distribution(parameters, "'dielectric'"),
                              read_refractive_indices(parameters)};
  constexpr float least_contrast = 1e-3f;  // Below, the normal of a refraction is lost to rounding.
  if (!(std::abs(model.indices.inside_over_outside - 1) >= least_contrast))
    throw InputError(parameters.location(parameters.is_stated("intIOR") ? "intIOR" : "extIOR"),
                     fmt::format("'intIOR' / 'extIOR' is {}, too close to 1 for a rough boundary",
                                 model.indices.inside_over_outside),
                     "such a boundary hardly changes light, however rough it is: use 'dielectric'");
  return model;
}

}  // namespace etendue
