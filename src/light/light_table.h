// What every kind of light can do, and how far the kinds differ.
#pragma once

#include "base/warp.h"
#include "light/light_bounds.h"
#include "light/light_sample.h"

#include <concepts>
#include <cstdint>
#include <optional>

namespace etendue {

/// Where rays meet a light.
///   surface: on its shape. infinity: where they leave the scene. nowhere: a Dirac delta, which only its own
///   samples find.
enum class LightPlace { surface, infinity, nowhere };

/// Of a beam that reaches all of the scene (m^2).
inline double cross_section(const Sphere& scene_bounds) {
  return double(pi) * scene_bounds.radius * scene_bounds.radius;
}

/// One kind of light: a table with one column a field, whose functions take a row. Each kind states
///   place, a LightPlace;
///   sample(request): a direction to the light, as light_sample_at or light_sample_towards make it;
///   power(row, scene_bounds): W per unit of strength and channel; of lights at infinity, what they send
///     through the sphere's cross-section;
///   bounds(row): none of lights at infinity, directional ones among them, which shine everywhere.
template <class Table>
concept AnyLightTable = requires(const Table& table, const LightRequest<float>& request, std::int32_t row) {
  { Table::place } -> std::convertible_to<LightPlace>;
  { table.template sample<float>(request) } -> std::same_as<LightSample<float>>;
  { table.power(row, request.scene_bounds) } -> std::same_as<double>;
  { table.bounds(row) } -> std::same_as<std::optional<LightBounds>>;
};

/// pdf_solid_angle(row, pmf, receiver, hit): the density (1/sr) with which `sample`, asked with this pmf,
/// gives the direction of the hit.
template <class Table>
concept SurfaceLightTable = AnyLightTable<Table> && Table::place == LightPlace::surface &&
                            requires(const Table& table, const Receiver<float>& receiver,
                                     const LightHit<float>& hit, std::int32_t row) {
                              {
                                table.template pdf_solid_angle<float>(row, 1.0f, receiver, hit)
                              } -> std::same_as<float>;
                            };

/// facet_count(row), facet_power_share(row, facet) of the whole, facet_bounds(row, facet), and facet_at(row,
/// primitive, position): the facet that a ray has hit.
template <class Table>
concept FacetLightTable = SurfaceLightTable<Table> && requires(const Table& table, const Vec3f& position,
                                                               std::int32_t row, std::int32_t facet) {
  { table.facet_count(row) } -> std::same_as<std::int32_t>;
  { table.facet_power_share(row, facet) } -> std::same_as<double>;
  { table.facet_bounds(row, facet) } -> std::same_as<LightBounds>;
  { table.template facet_at<float>(row, facet, position) } -> std::same_as<std::int32_t>;
};

/// radiance(row, direction, lanes): what a ray that leaves the scene meets, per unit of strength.
/// pdf_solid_angle(row, receiver, direction, technique, lanes): the density (1/sr) with which `sample`, asked
/// with pmf 1, gives this direction.
template <class Table>
concept InfiniteLightTable =
    AnyLightTable<Table> && Table::place == LightPlace::infinity &&
    requires(const Table& table, const Receiver<float>& receiver, const Vec3<float>& direction,
             std::int32_t row) {
      { table.template radiance<float>(row, direction, true) } -> std::same_as<Color<float>>;
      {
        table.template pdf_solid_angle<float>(row, receiver, direction, LightTechnique::area, true)
      } -> std::same_as<float>;
    };

template <class Table>
concept LightTable = SurfaceLightTable<Table> || InfiniteLightTable<Table> ||
                     (AnyLightTable<Table> && Table::place == LightPlace::nowhere);

}  // namespace etendue
