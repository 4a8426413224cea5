#include "bsdf/microfacet_distribution.h"

#include <fmt/format.h>

namespace etendue {

Parameter alpha_parameter() {
  return {"alpha", Parameter::Type::real, "0.1", "", "Roughness, from 1e-4 to 1e3"};
}

std::vector<Parameter> microfacet_parameters() {
  return {
      {"distribution", Parameter::Type::text, "beckmann", "", "Of the microfacets' normals: beckmann or ggx"},
      alpha_parameter()};
}

float read_alpha(const Parameters& parameters, const std::string& smooth_models) {
  constexpr double least = 1e-4, most = 1e3;
  const double alpha = parameters.real("alpha");
  if (alpha >= least && alpha <= most) return float(alpha);
  throw InputError(
      parameters.location("alpha"),
      fmt::format("'alpha' is {}; it must be from {} to {}", alpha, least, most),
      alpha < least && alpha >= 0 ? fmt::format("for a smooth surface use {}", smooth_models) : "");
}

MicrofacetDistribution read_microfacet_distribution(const Parameters& parameters,
                                                    const std::string& smooth_models) {
  const std::string name = parameters.text("distribution");
  if (name != "beckmann" && name != "ggx")
    throw InputError(parameters.location("distribution"), fmt::format("unknown distribution '{}'", name),
                     known_names(name, {"beckmann", "ggx"}));
  return {name == "ggx" ? MicrofacetDistribution::Kind::ggx : MicrofacetDistribution::Kind::beckmann,
          read_alpha(parameters, smooth_models)};
}

}  // namespace etendue
