// The kinds of light, a table each, and which light is in which row of which table.
#pragma once

#include "base/lookup_table.h"
#include "light/directional_light.h"
#include "light/distant_disk_light.h"
#include "light/envmap_light.h"
#include "light/mesh_light.h"
#include "light/point_light.h"
#include "light/rectangle_light.h"
#include "light/sphere_light.h"
#include "light/spot_light.h"

#include <cstdint>

namespace etendue {

enum class LightKind : std::int32_t {
  mesh,
  rectangle,
  sphere,
  point,
  spot,
  directional,
  distant_disk,
  envmap
};

constexpr bool is_area_light(LightKind kind) { return kind <= LightKind::sphere; }
/// Met by rays that leave the scene.
constexpr bool is_infinite_light(LightKind kind) { return kind >= LightKind::distant_disk; }

/// Lights on surfaces have `sample_position` and `pdf_area`; the others have `sample`.
template <class Table>
concept AreaLightTable =
    requires(const Table& table, const Vec3<float>& v) { table.template pdf_area<float>(0, v, v, v); };

class LightTables {
 public:
  MeshLights meshes;
  RectangleLights rectangles;
  SphereLights spheres;
  PointLights points;
  SpotLights spots;
  DirectionalLights directionals;
  DistantDiskLights distant_disks;
  EnvmapLights envmaps;

 protected:
  /// f(table, row, lanes) for each kind among the lights in the lanes of `m`; rows are valid in all lanes.
  template <class F, class Function>
  void for_each_kind(const Int<F>& light, const Mask<F>& m, Function&& f) const {
    const Int<F> safe = select(m, light, Int<F>(0));
    const Int<F> kinds = kind_.at(safe), rows = row_.at(safe);
    for_each_unique<F>(kinds, m, [&](std::int32_t which, const Mask<F>& lanes) {
      const Int<F> safe_row = select(lanes, rows, Int<F>(0));
      switch (LightKind(which)) {
        case LightKind::mesh:
          return f(meshes, safe_row, lanes);
        case LightKind::rectangle:
          return f(rectangles, safe_row, lanes);
        case LightKind::sphere:
          return f(spheres, safe_row, lanes);
        case LightKind::point:
          return f(points, safe_row, lanes);
        case LightKind::spot:
          return f(spots, safe_row, lanes);
        case LightKind::directional:
          return f(directionals, safe_row, lanes);
        case LightKind::distant_disk:
          return f(distant_disks, safe_row, lanes);
        case LightKind::envmap:
          return f(envmaps, safe_row, lanes);
      }
    });
  }

  LookupTable<std::int32_t> kind_, row_;  ///< Of each light, by its id: which table, and the row in it.
};

}  // namespace etendue
