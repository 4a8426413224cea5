// What is known of lights beside how they are sampled: names, strengths, powers, bounds, facets.
#pragma once

#include "light/emission.h"
#include "light/light_tables.h"

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace etendue {

/// Of each light by its id.
class LightProperties : public LightTables {
 public:
  /// Makes a light that is a surface shine from its back side as from its front.
  void set_twosided(std::int32_t light) { emissions_.set_twosided(light); }

  /// The sphere around all shapes and media, which lights at infinity lie outside of.
  void set_scene_bounds(const Sphere& bounds) { scene_bounds_ = bounds; }

  const std::string& name(std::int32_t light) const { return names_[std::size_t(light)]; }

  double power(std::int32_t light) const;                       ///< W, luminance of the channels.
  std::optional<LightBounds> bounds(std::int32_t light) const;  ///< None: it shines everywhere.

  // The facets of a light are parts of its surface that can be chosen one by one: of a mesh the flat convex
  // pieces that its triangles make (geometry/convex_pieces.h); any other light is one facet.
  std::int32_t facet_count(std::int32_t light) const;
  double facet_power(std::int32_t light, std::int32_t facet) const;  ///< W, luminance.
  /// None: it shines everywhere.
  std::optional<LightBounds> facet_bounds(std::int32_t light, std::int32_t facet) const;

  /// The facet that a ray has hit. \param primitive the triangle within a mesh; 0 of other shapes
  /// \param position where (world, m)
  template <class F>
  Int<F> facet_at(const Int<F>& light, const Int<F>& primitive, const Vec3<F>& position,
                  const Mask<F>& m) const {
    Int<F> facet(0);
    for_each_kind<F>(light, m, [&](const auto& table, const Int<F>& row, const Mask<F>& lanes) {
      if constexpr (FacetLightTable<std::remove_cvref_t<decltype(table)>>)
        facet = select(lanes, table.template facet_at<F>(row, select(lanes, primitive, Int<F>(0)), position),
                       facet);
    });
    return facet;
  }

  /// Lanes outside of `m` may hold any light.
  template <class F>
  Mask<F> is_twosided(const Int<F>& light, const Mask<F>& m) const {
    return emissions_.is_twosided<F>(light, m);
  }

  /// W/(m^2 sr), of a light's surface, on the sides that shine. \param uv_at of lanes, the surface
  /// coordinates there; asked where a light is textured
  template <class F, class Function>
  Color<F> radiance(const Int<F>& light, const Mask<F>& m, Function&& uv_at) const {
    const Color<F> strength = emissions_.strength<F>(light, m);
    if (!has_textured()) return strength;
    const Int<F> safe = select(m, light, Int<F>(0));
    const Mask<F> is_textured = mask_and(m, equal(kind_.at(safe), Int<F>(kind_of<TexturedLights>())));
    if (!any(is_textured)) return strength;
    const Vec2<F> uv = uv_at(is_textured);
    return select(is_textured,
                  strength * table<TexturedLights>().template radiance<F>(row_.at(safe), uv, is_textured),
                  strength);
  }
  bool has_textured() const { return table<TexturedLights>().count() > 0; }
  bool is_textured(std::int32_t light) const { return kind_[light] == kind_of<TexturedLights>(); }
  /// Where a light's surface shines most, or somewhat above; of textured lights the luminance as grey.
  Colorf largest_radiance(std::int32_t light) const;

 protected:
  std::int32_t note(const Colorf& strength, std::string name, std::int32_t kind, LightPlace place,
                    std::int32_t row);

  std::optional<LightBounds> seen_from_its_sides(std::int32_t light, std::optional<LightBounds> bounds) const;

  Emissions emissions_;
  std::vector<std::string> names_;
  Sphere scene_bounds_{{0, 0, 0}, 0};
};

}  // namespace etendue
