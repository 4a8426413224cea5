#include "light/light_properties.h"

namespace etendue {

std::int32_t LightProperties::note(const Colorf& strength, std::string name, std::int32_t kind,
                                   LightPlace place, std::int32_t row) {
  if (place == LightPlace::surface) ++surface_count_;
  if (place == LightPlace::infinity) infinite_.push_back(count());
  kind_.push_back(kind);
  row_.push_back(row);
  emissions_.push_back(strength);
  names_.push_back(std::move(name));
  return count() - 1;
}

double LightProperties::power(std::int32_t light) const {
  double of_unit = 0;
  with_table(kind_[light], [&](const auto& table) { of_unit = table.power(row_[light], scene_bounds_); });
  if (emissions_.is_twosided(light)) of_unit *= 2;
  return of_unit * luminance(emissions_.strength(light));
}

std::optional<LightBounds> LightProperties::bounds(std::int32_t light) const {
  std::optional<LightBounds> bounds;
  with_table(kind_[light], [&](const auto& table) { bounds = table.bounds(row_[light]); });
  return seen_from_its_sides(light, bounds);
}

Colorf LightProperties::largest_radiance(std::int32_t light) const {
  const Colorf strength = emissions_.strength(light);
  if (!is_textured(light)) return strength;
  return strength * float(table<TexturedLights>().largest_luminance(row_[light]));
}

std::int32_t LightProperties::facet_count(std::int32_t light) const {
  std::int32_t count = 1;
  with_table(kind_[light], [&](const auto& table) {
    if constexpr (FacetLightTable<std::remove_cvref_t<decltype(table)>>)
      count = table.facet_count(row_[light]);
  });
  return count;
}

double LightProperties::facet_power(std::int32_t light, std::int32_t facet) const {
  double share = 1;
  with_table(kind_[light], [&](const auto& table) {
    if constexpr (FacetLightTable<std::remove_cvref_t<decltype(table)>>)
      share = table.facet_power_share(row_[light], facet);
  });
  return power(light) * share;
}

std::optional<LightBounds> LightProperties::facet_bounds(std::int32_t light, std::int32_t facet) const {
  std::optional<LightBounds> bounds;
  with_table(kind_[light], [&](const auto& table) {
    if constexpr (FacetLightTable<std::remove_cvref_t<decltype(table)>>)
      bounds = table.facet_bounds(row_[light], facet);
    else
      bounds = table.bounds(row_[light]);
  });
  return seen_from_its_sides(light, bounds);
}

std::optional<LightBounds> LightProperties::seen_from_its_sides(std::int32_t light,
                                                                std::optional<LightBounds> bounds) const {
  // From the back of a normal it shines as from its front: the cone of both is the whole sphere.
  if (bounds && emissions_.is_twosided(light)) bounds->cos_normals = -1;
  return bounds;
}

}  // namespace etendue
