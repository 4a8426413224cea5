#include "bsdf/refractive_indices.h"

#include <cmath>
#include <fmt/format.h>

namespace etendue {

std::vector<Parameter> refractive_index_parameters() {
  return {{"intIOR", Parameter::Type::real, "1.5046", "", "Refractive index behind the surface (BK7 glass)"},
          {"extIOR", Parameter::Type::real, "1.000277", "", "Refractive index before the surface (air)"}};
}

RefractiveIndices read_refractive_indices(const Parameters& parameters) {
  const auto index = [&](const char* name) {
    const double value = parameters.real(name);
    constexpr double least = 1e-3, most = 1e3;
    if (!(value >= least && value <= most))
      throw InputError(
          parameters.location(name),
          fmt::format("'{}' is {}; a refractive index must be from {} to {}", name, value, least, most));
    return value;
  };
  const double inside = index("intIOR"), outside = index("extIOR");
  return {float(inside / outside), float(outside / inside)};
}

}  // namespace etendue
