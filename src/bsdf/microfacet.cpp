#include "bsdf/microfacet.h"

#include <algorithm>
#include <fmt/format.h>

namespace etendue {

const Plugin microfacet_plugin{
    "bsdf",
    "microfacet",
    "Nori's blend of a diffuse base and a rough coat: f = kd / pi + ks D F G / (4 cos_i cos_o), Beckmann's "
    "D, "
    "ks = 1 - max(kd); black from behind.",
    [] {
      std::vector<Parameter> parameters = refractive_index_parameters();
      parameters.insert(parameters.begin(), alpha_parameter());
      parameters.push_back(
          {"kd", Parameter::Type::color, "0.5", "",
           "Albedo of the diffuse base, at most 1; what its largest channel leaves is the coat's share"});
      return parameters;
    }(),
    {}};

Microfacet make_microfacet(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, microfacet_plugin, unread);
  Microfacet model;
  model.kd = nonnegative_color(parameters, "kd");
  const float largest = std::max({model.kd.r, model.kd.g, model.kd.b});
  if (largest > 1)
    throw InputError(
        parameters.location("kd"),
        fmt::format("'kd' has a channel of {}; it must be at most 1, as the coat gets 1 - kd", largest));
  model.ks = 1 - largest;
  model.distribution = {MicrofacetDistribution::Kind::beckmann,
                        read_alpha(parameters, "'mirror' or 'dielectric'")};
  model.indices = read_refractive_indices(parameters);
  return model;
}

}  // namespace etendue
