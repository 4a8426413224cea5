#include "light/light.h"

namespace etendue {

std::int32_t Lights::note(const Colorf& strength, std::string name, std::int32_t kind, LightPlace place,
                          std::int32_t row) {
  if (place == LightPlace::surface) ++surface_count_;
  if (place == LightPlace::infinity) infinite_.push_back(count());
  kind_.push_back(kind);
  row_.push_back(row);
  emissions_.push_back(strength);
  names_.push_back(std::move(name));
  return count() - 1;
}

double Lights::power(std::int32_t light) const {
  double of_unit = 0;
  with_table(kind_[light], [&](const auto& table) { of_unit = table.power(row_[light], scene_bounds_); });
  if (emissions_.is_twosided(light)) of_unit *= 2;
  return of_unit * luminance(emissions_.strength(light));
}

std::optional<LightBounds> Lights::bounds(std::int32_t light) const {
  std::optional<LightBounds> bounds;
  with_table(kind_[light], [&](const auto& table) { bounds = table.bounds(row_[light]); });
  // From the back of a normal it shines as from its front: the cone of both is the whole sphere.
  if (bounds && emissions_.is_twosided(light)) bounds->cos_normals = -1;
  return bounds;
}

}  // namespace etendue
