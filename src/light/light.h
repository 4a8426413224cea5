// Lights: how ONE light emits and is sampled.
//
// Lanes of a packet may hold different lights, so a kind of light is a table with one column a field, and its
// functions take a lane-varying row.
// To add a kind: write light/NAME_light.h with the functions that light/light_table.h asks for, add it to
// LightKinds in light/light_tables.h and to the makers in scene/load_light.cpp (a shape that shines:
// load_shape.cpp). The compiler names what is missing, and so does tests/statistical/light_test.cpp.
#pragma once

#include "light/light_properties.h"
#include "light/light_sample.h"

#include <cstdint>
#include <string>
#include <type_traits>

namespace etendue {

/// All lights of a scene.
class Lights : public LightProperties {
 public:
  /// \param strength radiance (W/(m^2 sr)) of area lights and disks, intensity (W/sr) of point and spot
  /// lights, irradiance (W/m^2) of directional ones, a factor of environment maps
  /// \param light what the table of its kind takes \return the new light's id
  template <class Table, class... Light>
  std::int32_t add(const Colorf& strength, std::string name, Light&&... light) {
    return note(strength, std::move(name), kind_of<Table>(), Table::place,
                std::get<Table>(tables_).add(std::forward<Light>(light)...));
  }

  /// From now on light samples of environment maps leave their darker parts to BSDF samples
  /// (Envmap::compensate), which must find all that they leave: after all lights have been added.
  void compensate_environments() { std::get<EnvmapLights>(tables_).compensate(); }

  /// The light that a chosen light, or a facet of it, sends to a receiver. \param pmf with which it was
  /// chosen \param u 32-bit fractions
  template <class F>
  LightSample<F> sample(const Int<F>& light, const F& pmf, const Receiver<F>& receiver,
                        const Vec2<UInt<F>>& u, const Mask<F>& m, const Int<F>& facet = Int<F>(whole_light),
                        LightTechnique technique = LightTechnique::area) const {
    // Most scenes have lights of one kind only: then no lane needs to be chosen from another table, and a
    // light's id is its row.
    if (table<MeshLights>().count() == count()) {
      const Int<F> safe = select(m, light, Int<F>(0));
      return table<MeshLights>().sample<F>(request<F>(light, safe, facet, pmf, receiver, u, m, technique));
    }
    LightSample<F> result = no_light_sample<F>();
    if (surface_count_ < count()) {
      sample_every_kind<F>(light, facet, pmf, receiver, u, m, technique, result);
      return result;
    }
    for_each_kind<F>(light, m, [&](const auto& table, const Int<F>& row, const Mask<F>& lanes) {
      if constexpr (SurfaceLightTable<std::remove_cvref_t<decltype(table)>>)
        result = select(
            lanes,
            table.template sample<F>(request<F>(light, row, facet, pmf, receiver, u, lanes, technique)),
            result);
    });
    return result;
  }

  /// The density (1/sr) with which `sample`, asked with this pmf, gives the direction of a hit on a light's
  /// surface; 0 for lights without one.
  template <class F>
  F pdf_solid_angle(const Int<F>& light, const F& pmf, const Receiver<F>& receiver, const LightHit<F>& hit,
                    const Mask<F>& m) const {
    F pdf(0);
    for_each_kind<F>(light, m, [&](const auto& table, const Int<F>& row, const Mask<F>& lanes) {
      if constexpr (SurfaceLightTable<std::remove_cvref_t<decltype(table)>>)
        pdf = select(lanes, table.template pdf_solid_angle<F>(row, pmf, receiver, hit.of(lanes)), pdf);
    });
    return pdf;
  }

  /// What a ray that leaves the scene in `direction` (unit, world) meets of the infinite light k, W/(m^2 sr).
  template <class F>
  Color<F> infinite_radiance(std::int32_t k, const Vec3<F>& direction, const Mask<F>& m) const {
    const std::int32_t light = infinite_light(k);
    Color<F> radiance = black<F>();
    with_infinite_table(light, [&](const auto& table, std::int32_t row) {
      const Colorf factor = emissions_.strength(light);
      radiance =
          table.template radiance<F>(row, direction, m) * Color<F>{F(factor.r), F(factor.g), F(factor.b)};
    });
    return radiance;
  }

  /// The density (1/sr) with which `sample`, asked with pmf 1, gives `direction` for the infinite light k.
  template <class F>
  F infinite_pdf_solid_angle(std::int32_t k, const Receiver<F>& receiver, const Vec3<F>& direction,
                             const Mask<F>& m, LightTechnique technique = LightTechnique::area) const {
    F pdf(0);
    with_infinite_table(infinite_light(k), [&](const auto& table, std::int32_t row) {
      pdf = table.template pdf_solid_angle<F>(row, receiver, direction, technique, m);
    });
    return pdf;
  }

 private:
  template <class F>
  LightRequest<F> request(const Int<F>& light, const Int<F>& row, const Int<F>& facet, const F& pmf,
                          const Receiver<F>& receiver, const Vec2<UInt<F>>& u, const Mask<F>& lanes,
                          LightTechnique technique) const {
    return {scene_bounds_,
            receiver,
            u,
            light,
            row,
            facet,
            emissions_.strength<F>(light, lanes),
            emissions_.is_twosided<F>(light, lanes),
            pmf,
            lanes,
            technique};
  }

  /// Apart, so that the code of all kinds does not weigh on scenes with lights on surfaces only.
  template <class F>
  [[gnu::noinline]] void sample_every_kind(const Int<F>& light, const Int<F>& facet, const F& pmf,
                                           const Receiver<F>& receiver, const Vec2<UInt<F>>& u,
                                           const Mask<F>& m, LightTechnique technique,
                                           LightSample<F>& result) const {
    for_each_kind<F>(light, m, [&](const auto& table, const Int<F>& row, const Mask<F>& lanes) {
      result = select(
          lanes, table.template sample<F>(request<F>(light, row, facet, pmf, receiver, u, lanes, technique)),
          result);
    });
  }
};

}  // namespace etendue
