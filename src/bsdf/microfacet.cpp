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

const Plugin roughsubstrate_plugin{
    "bsdf",
    "roughsubstrate",
    "A diffuse base under a rough coat that lets in what it does not reflect: Ashikhmin and Shirley's base "
    "and D F G / (4 cos_i cos_o), Beckmann's D; black from behind.",
    [] {
      std::vector<Parameter> parameters = refractive_index_parameters();
      parameters.insert(parameters.begin(), alpha_parameter());
      parameters.push_back(
          {"kd", Parameter::Type::color, "0.5", "", "Albedo of the diffuse base, at most 1"});
      return parameters;
    }(),
    {}};

namespace {

/// What both models have. `why` completes "at most 1".
Microfacet read_coated(const Parameters& parameters, std::string_view why) {
  Microfacet model;
  model.kd = nonnegative_color(parameters, "kd");
  const float largest = std::max({model.kd.r, model.kd.g, model.kd.b});
  if (largest > 1)
    throw InputError(parameters.location("kd"),
                     fmt::format("'kd' has a channel of {}; it must be at most 1{}", largest, why));
  model.distribution = {MicrofacetDistribution::Kind::beckmann,
                        read_alpha(parameters, "'mirror' or 'dielectric'")};
  model.indices = read_refractive_indices(parameters);
  return model;
}

}  // namespace

Microfacet make_microfacet(const Object& description, std::vector<UnreadKey>& unread) {
  Microfacet model =
      read_coated(Parameters(description, microfacet_plugin, unread), ", as the coat gets 1 - kd");
  model.ks = model.coat_probability = 1 - std::max({model.kd.r, model.kd.g, model.kd.b});
  return model;
}

Microfacet make_roughsubstrate(const Object& description, std::vector<UnreadKey>& unread) {
  Microfacet model = read_coated(Parameters(description, roughsubstrate_plugin, unread), "");
  model.ks = 1;
  model.base = Microfacet::Base::under_coat;
  model.reflectance_along_normal = refract(1.0f, model.indices.inside_over_outside).reflectance;
  // As for a viewer at 60 degrees; at least 1/4, since at grazing angles the coat reflects most.
  const float coat = refract(0.5f, model.indices.inside_over_outside).reflectance;
  model.coat_probability = std::max(coat / (coat + std::max(luminance(model.kd), 1e-6f)), 0.25f);
  return model;
}

}  // namespace etendue
