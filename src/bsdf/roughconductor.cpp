#include "bsdf/roughconductor.h"

#include <algorithm>
#include <fmt/format.h>

namespace etendue {

const Plugin roughconductor_plugin{
    "bsdf",
    "roughconductor",
    "A rough metal: f = D F G / (4 cos_i cos_o), copper by default; black from behind.",
    [] {
      using Type = Parameter::Type;
      std::vector<Parameter> parameters = microfacet_parameters();
      parameters.push_back({"eta", Type::color, "0.200438, 0.924033, 1.102212", "",
                            "Real part of the refractive index over that of the outside (copper)"});
      parameters.push_back({"k", Type::color, "3.912949, 2.452848, 2.142188", "",
                            "Its imaginary part, the extinction (copper)"});
      parameters.push_back({"specularReflectance", Type::color, "1", "", "Multiplies what is reflected"});
      parameters.push_back(
          {"R0", Type::color, "", "",
           "Instead of eta and k: the reflectance along the normal, at most 1, for Schlick's "
           "Fresnel term with Nori's rational shadowing (Zaragoza)"});
      return parameters;
    }(),
    {}};

RoughConductor make_roughconductor(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, roughconductor_plugin, unread);
  RoughConductor model{read_microfacet_distribution(parameters, "'mirror'"),
                       nonnegative_color(parameters, "eta"), nonnegative_color(parameters, "k"),
                       nonnegative_color(parameters, "specularReflectance")};
  if (!parameters.is_stated("R0")) return model;
  for (const char* other : {"eta", "k", "specularReflectance", "distribution"})
    if (parameters.is_stated(other))
      throw InputError(parameters.location(other),
                       fmt::format("both 'R0' and '{}' are stated for this roughconductor", other),
                       "use one of: R0, alpha | eta, k, specularReflectance, distribution, alpha");
  model.fresnel_term = RoughConductor::Fresnel::schlick;
  model.r0 = nonnegative_color(parameters, "R0");
  if (const float largest = std::max({model.r0.r, model.r0.g, model.r0.b}); largest > 1)
    throw InputError(parameters.location("R0"),
                     fmt::format("'R0' has a channel of {}; it must be at most 1", largest));
  return model;
}

}  // namespace etendue
