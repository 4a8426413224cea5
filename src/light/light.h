// Lights: how ONE light emits and is sampled.
//
// Lanes of a packet may hold different lights, so a kind of light is a table with one column a field, and its
// functions take a lane-varying row. To add a kind: write light/NAME_light.h with `sample_position` and
// `pdf_area`, give it a member and a LightKind here, and add it to the chi-squared test's list in
// tests/statistical/light_test.cpp.
#pragma once

#include "base/color.h"
#include "base/lookup_table.h"
#include "light/light_point.h"
#include "light/mesh_light.h"
#include "light/rectangle_light.h"
#include "light/sphere_light.h"

#include <cstdint>
#include <string>
#include <vector>

namespace etendue {

enum class LightKind : std::int32_t { mesh, rectangle, sphere };

/// All lights of a scene; each emits its radiance from the front side of its surface.
class Lights {
 public:
  /// \param row what the table of its kind returned for this light, the latest of that table
  /// \return the new light's id
  std::int32_t add(const Colorf& radiance, std::string name, LightKind kind, std::int32_t row);

  std::int32_t count() const { return kind_.size(); }
  int infinite_count() const { return 0; }
  const std::string& name(std::int32_t light) const { return names_[std::size_t(light)]; }

  /// Whether shadow packets that aim at one piece of one light are best traced as one. The random choice of a
  /// light is uniform, so most lights are most rays.
  bool are_aimed_packets_coherent() const { return 2 * meshes.finely_built_count() <= count(); }

  MeshLights meshes;
  RectangleLights rectangles;
  SphereLights spheres;

  /// W/(m^2 sr); lanes outside of `m` may hold any light.
  template <class F>
  Color<F> radiance(const Int<F>& light, const Mask<F>& m) const {
    const Int<F> safe = select(m, light, Int<F>(0));
    return {red_.at(safe), green_.at(safe), blue_.at(safe)};
  }

  /// A point on the light for a receiver at `reference`; u are 32-bit fractions, so that choosing among many
  /// triangles leaves enough of them. Lanes outside of `m` get anything.
  template <class F>
  LightPoint<F> sample_position(const Geometry& geometry, const Int<F>& light, const Vec3<F>& reference,
                                const Vec2<UInt<F>>& u_light, const Mask<F>& m) const {
    // Most scenes have lights of one kind only: then no lane needs to be chosen from another table.
    if (meshes_only())
      return meshes.sample_position<F>(geometry, select(m, light, Int<F>(0)), reference, u_light, m);
    LightPoint<F> point = no_light_point<F>();
    for_each_kind<F>(light, m, [&](const auto& table, const Int<F>& row, const Mask<F>& lanes) {
      point =
          select(lanes, table.template sample_position<F>(geometry, row, reference, u_light, lanes), point);
    });
    return point;
  }

  /// The density per area (1/m^2) with which `sample_position` gives `position`, whose geometric normal is
  /// `ng`.
  template <class F>
  F pdf_area(const Int<F>& light, const Vec3<F>& reference, const Vec3<F>& position, const Vec3<F>& ng,
             const Mask<F>& m) const {
    F pdf(0);
    for_each_kind<F>(light, m, [&](const auto& table, const Int<F>& row, const Mask<F>& lanes) {
      pdf = select(lanes, table.template pdf_area<F>(row, reference, position, ng), pdf);
    });
    return pdf;
  }

 private:
  /// Then a light's id is its row.
  bool meshes_only() const { return meshes.count() == count(); }

  template <class F, class Function>
  void for_each_kind(const Int<F>& light, const Mask<F>& m, Function&& f) const {
    const Int<F> safe = select(m, light, Int<F>(0));
    const Int<F> kind = kind_.at(safe);
    const Int<F> row = row_.at(safe);
    for_each_unique<F>(kind, m, [&](std::int32_t which, const Mask<F>& lanes) {
      const Int<F> safe_row = select(lanes, row, Int<F>(0));
      switch (LightKind(which)) {
        case LightKind::mesh:
          return f(meshes, safe_row, lanes);
        case LightKind::rectangle:
          return f(rectangles, safe_row, lanes);
        case LightKind::sphere:
          return f(spheres, safe_row, lanes);
      }
    });
  }

  LookupTable<std::int32_t> kind_, row_;   ///< Which table, and the row in it.
  LookupTable<float> red_, green_, blue_;  ///< Radiance.
  std::vector<std::string> names_;
};

}  // namespace etendue
