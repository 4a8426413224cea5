#include "bsdf/roughconductor.h"

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
      return parameters;
    }(),
    {}};

RoughConductor make_roughconductor(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, roughconductor_plugin, unread);
  return {read_microfacet_distribution(parameters, "'mirror'"), nonnegative_color(parameters, "eta"),
          nonnegative_color(parameters, "k"), nonnegative_color(parameters, "specularReflectance")};
}

}  // namespace etendue
