#include "bsdf/phong.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string>

namespace etendue {

namespace {

using Type = Parameter::Type;

/// Who calls the parameters what, and what each does with kd + ks > 1.
struct Convention {
  std::string kd, ks, exponent;
  double largest_sum;  ///< kd and ks are rescaled so that no channel of kd + ks exceeds this; 0: never.
};

const std::array<Convention, 3> conventions{{
    {"kd", "ks", "n", 0},
    {"diffuseReflectance", "specularReflectance", "shininess", 0.99},
    {"diffuseReflectance", "specularReflectance", "exponent", 1},
}};

/// The convention all of whose rivals' own names are absent; names that two conventions share decide nothing.
const Convention& convention_of(const Parameters& parameters) {
  const bool has_short =
      parameters.is_stated("kd") || parameters.is_stated("ks") || parameters.is_stated("n");
  const bool has_long =
      parameters.is_stated("diffuseReflectance") || parameters.is_stated("specularReflectance");
  const bool has_shininess = parameters.is_stated("shininess"),
             has_exponent = parameters.is_stated("exponent");
  if (has_short + has_shininess + has_exponent > 1 || (has_short && has_long))
    throw InputError(parameters.object().location, "this phong mixes the names of different conventions",
                     "use one of: kd, ks, n | diffuseReflectance, specularReflectance, shininess | "
                     "diffuseReflectance, specularReflectance, exponent");
  return has_shininess ? conventions[1] : has_exponent || has_long ? conventions[2] : conventions[0];
}

}  // namespace

const Plugin phong_plugin{
    "bsdf",
    "phong",
    "Modified Phong: f = kd / pi + ks (n + 2) / (2 pi) cos^n; black from behind. Three conventions, by "
    "names.",
    {{"kd", Type::color, "0.5", "", "Diffuse reflectance (EPFL); not rescaled"},
     {"ks", Type::color, "0.5", "", "Specular reflectance (EPFL); not rescaled"},
     {"n", Type::real, "20", "", "Exponent of the lobe (EPFL)"},
     {"diffuseReflectance", Type::color, "0.5", "", "Diffuse reflectance (McGill, Mitsuba 0.x)"},
     {"specularReflectance", Type::color, "0.2", "", "Specular reflectance (McGill, Mitsuba 0.x)"},
     {"shininess", Type::real, "30", "",
      "Exponent (McGill: both are scaled by 0.99 / max(kd + ks) where that exceeds 1)"},
     {"exponent", Type::real, "30", "",
      "Exponent (Mitsuba 0.x: both are scaled by 1 / max(kd + ks) where that exceeds 1)"}},
    {}};

Phong make_phong(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, phong_plugin, unread);
  const Convention& names = convention_of(parameters);
  Phong phong;
  phong.kd = nonnegative_color(parameters, names.kd);
  phong.ks = nonnegative_color(parameters, names.ks);
  const double exponent = parameters.real(names.exponent);
  constexpr double largest_exponent = 1e6;
  if (!(exponent >= 0 && exponent <= largest_exponent))
    throw InputError(
        parameters.location(names.exponent),
        fmt::format("'{}' is {}; it must be from 0 to {}", names.exponent, exponent, largest_exponent));
  phong.exponent = float(exponent);
  const Colorf sum = phong.kd + phong.ks;
  const float largest = std::max({sum.r, sum.g, sum.b});
  if (names.largest_sum > 0 && largest > 1) {
    phong.kd = phong.kd * (float(names.largest_sum) / largest);
    phong.ks = phong.ks * (float(names.largest_sum) / largest);
  }
  const float diffuse = luminance(phong.kd), specular = luminance(phong.ks);
  phong.specular_probability = diffuse + specular > 0 ? specular / (diffuse + specular) : 0;
  return phong;
}

}  // namespace etendue
