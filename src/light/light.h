// Lights: how ONE light emits and is sampled.
//
// Lanes of a packet may hold different lights, so a kind of light is a table with one column a field, and its
// functions take a lane-varying row. Two sorts: area lights (mesh, rectangle, sphere, disk) have
// `sample_position` and `pdf_area`; the others have `sample`, and those at infinity that a ray can meet also
// `radiance` and `pdf_solid_angle`. To add a kind: write light/NAME_light.h, give it a LightKind, a member
// and a case in light_tables.h, a line in scene/load_light.cpp, and add it to the chi-squared tests in
// tests/statistical/light_test.cpp.
#pragma once

#include "base/color.h"
#include "light/light_sample.h"
#include "light/light_tables.h"

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace etendue {

/// All lights of a scene.
class Lights : public LightTables {
 public:
  /// \param strength radiance (W/(m^2 sr)) of area lights and disks, intensity (W/sr) of point and spot
  /// lights, irradiance (W/m^2) of directional ones, a factor of environment maps
  /// \param row what the table of its kind returned for it, the latest \return the new light's id
  std::int32_t add(const Colorf& strength, std::string name, LightKind kind, std::int32_t row);

  /// The sphere around all shapes and media, which lights at infinity lie outside of.
  void set_scene_bounds(const Sphere& bounds) { scene_bounds_ = bounds; }

  std::int32_t count() const { return kind_.size(); }
  const std::string& name(std::int32_t light) const { return names_[std::size_t(light)]; }

  /// Whether shadow packets that aim at one piece of one light are best traced as one. The random choice of a
  /// light is uniform, so most lights are most rays.
  bool are_aimed_packets_coherent() const { return 2 * meshes.finely_built_count() <= count(); }

  /// What `add` was given; lanes outside of `m` may hold any light.
  template <class F>
  Color<F> strength(const Int<F>& light, const Mask<F>& m) const {
    const Int<F> safe = select(m, light, Int<F>(0));
    return {red_.at(safe), green_.at(safe), blue_.at(safe)};
  }
  /// W/(m^2 sr), of area lights, on their front side.
  template <class F>
  Color<F> radiance(const Int<F>& light, const Mask<F>& m) const {
    return strength<F>(light, m);
  }

  /// The light that `light` sends to a receiver at `reference`. \param u 32-bit fractions, so that choosing
  /// among many triangles leaves enough of them \param pmf with which the light was chosen
  template <class F>
  LightSample<F> sample(const Int<F>& light, const F& pmf, const Vec3<F>& reference, const Vec2<UInt<F>>& u,
                        const Mask<F>& m) const {
    if (area_count_ == count())
      return light_sample_at<F>(sample_position<F>(light, reference, u, m), light, radiance<F>(light, m), pmf,
                                reference, m);
    return sample_any_kind<F>(light, pmf, reference, u, m);
  }

  /// A point on an area light for a receiver at `reference`. Lanes outside of `m`, or with another light, get
  /// anything.
  template <class F>
  LightPoint<F> sample_position(const Int<F>& light, const Vec3<F>& reference, const Vec2<UInt<F>>& u_light,
                                const Mask<F>& m) const {
    // Most scenes have lights of one kind only: then no lane needs to be chosen from another table.
    if (meshes_only()) return meshes.sample_position<F>(select(m, light, Int<F>(0)), reference, u_light);
    LightPoint<F> point = no_light_point<F>();
    for_each_kind<F>(light, m, [&](const auto& table, const Int<F>& row, const Mask<F>& lanes) {
      if constexpr (AreaLightTable<std::remove_cvref_t<decltype(table)>>)
        point = select(lanes, table.template sample_position<F>(row, reference, u_light), point);
    });
    return point;
  }

  /// The density per area (1/m^2) with which `sample_position` gives `position`, whose geometric normal is
  /// `ng`; 0 for lights without area.
  template <class F>
  F pdf_area(const Int<F>& light, const Vec3<F>& reference, const Vec3<F>& position, const Vec3<F>& ng,
             const Mask<F>& m) const {
    F pdf(0);
    for_each_kind<F>(light, m, [&](const auto& table, const Int<F>& row, const Mask<F>& lanes) {
      if constexpr (AreaLightTable<std::remove_cvref_t<decltype(table)>>)
        pdf = select(lanes, table.template pdf_area<F>(row, reference, position, ng), pdf);
    });
    return pdf;
  }

  /// Lights at infinity that rays meet: distant disks and environment maps, k = 0 .. infinite_count() - 1.
  std::int32_t infinite_count() const { return std::int32_t(infinite_.size()); }
  std::int32_t infinite_light(std::int32_t k) const { return infinite_[std::size_t(k)]; }  ///< Its id.
  /// Points, spots and directions, which no ray can meet.
  std::int32_t dirac_count() const { return count() - area_count_ - infinite_count(); }

  /// What a ray that leaves the scene in `direction` (unit, world) meets of the infinite light k, W/(m^2 sr).
  template <class F>
  Color<F> infinite_radiance(std::int32_t k, const Vec3<F>& direction, const Mask<F>& m) const {
    const std::int32_t light = infinite_light(k);
    const Color<F> scale{F(red_[light]), F(green_[light]), F(blue_[light])};
    return LightKind(kind_[light]) == LightKind::envmap
               ? envmaps.radiance<F>(row_[light], direction, m) * scale
               : distant_disks.radiance<F>(row_[light], direction) * scale;
  }

  /// The density (1/sr) with which `sample` gives `direction` for the infinite light k, its choice left out.
  template <class F>
  F infinite_pdf_solid_angle(std::int32_t k, const Vec3<F>& direction, const Mask<F>& m) const {
    const std::int32_t light = infinite_light(k);
    return LightKind(kind_[light]) == LightKind::envmap
               ? envmaps.pdf_solid_angle<F>(row_[light], direction, m)
               : distant_disks.pdf_solid_angle<F>(row_[light], direction);
  }

 private:
  /// Apart, so that the code of all kinds does not weigh on scenes with area lights only.
  template <class F>
  [[gnu::noinline]] LightSample<F> sample_any_kind(const Int<F>& light, const F& pmf,
                                                   const Vec3<F>& reference, const Vec2<UInt<F>>& u,
                                                   const Mask<F>& m) const {
    LightSample<F> result = no_light_sample<F>();
    const Color<F> scale = strength<F>(light, m);
    for_each_kind<F>(light, m, [&](const auto& table, const Int<F>& row, const Mask<F>& lanes) {
      LightSample<F> sample = no_light_sample<F>();
      if constexpr (AreaLightTable<std::remove_cvref_t<decltype(table)>>) {
        sample = light_sample_at<F>(table.template sample_position<F>(row, reference, u), light, scale, pmf,
                                    reference, lanes);
      } else {
        sample = table.template sample<F>(scene_bounds_, row, reference, u, lanes);
        sample.radiance_over_pdf = sample.radiance_over_pdf * scale * (F(1) / pmf);
        sample.pdf = sample.pdf * pmf;
        sample.light = light;
      }
      result = select(lanes, sample, result);
    });
    return result;
  }

  /// Then a light's id is its row.
  bool meshes_only() const { return meshes.count() == count(); }

  LookupTable<float> red_, green_, blue_;  ///< Strength.
  std::vector<std::string> names_;
  std::vector<std::int32_t> infinite_;  ///< Ids of the lights that rays meet at infinity.
  std::int32_t area_count_ = 0;
  Sphere scene_bounds_{{0, 0, 0}, 0};
};

}  // namespace etendue
