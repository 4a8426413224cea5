// Area lights whose radiance is a texture, on meshes: sampled by their texels, or as polygons.
#pragma once

#include "base/lane_vec.h"
#include "base/lookup_table.h"
#include "base/simd_math.h"
#include "geometry/geometry.h"
#include "light/light_table.h"
#include "light/texel_mixture.h"

#include <cstdint>
#include <vector>

namespace etendue {

class TexturedLights {
 public:
  /// Makes the mesh `geometry_id`, which has texture coordinates, a light; returns its row. Its total area
  /// must be positive.
  std::int32_t add(const Geometry& geometry, std::int32_t geometry_id, const ColorTexture& radiance);

  std::int32_t count() const { return first_facet_.size(); }
  static constexpr LightPlace place = LightPlace::surface;

  /// By the techniques `automatic` and `transformed_cosine` a facet is sampled by its texels; where it is not
  /// small for its distance, a share of the time by solid angle (TexelMixture), as a near point counts for
  /// more than texels tell.
  template <class F>
  LightSample<F> sample(LightRequest<F> request) const {
    const Int<F> first = select(request.lanes, first_facet_.at(request.row), Int<F>(0));
    request.facet = select(request.lanes, request.facet, Int<F>(0));
    if (any(less(request.facet, Int<F>(0)))) {
      if (request.technique == LightTechnique::area) return sample_by_area<F>(request);
      choose_facet<F>(request);
    }
    const Int<F> facet = first + request.facet;
    const F longest_edge = longest_edge_.at(request.row);
    const Int<F> piece = gather(pieces_.data(), facet);
    LightSample<F> sample;
    if (is_by_texels(request.technique))
      sample =
          TexelMixture<F>(texels_, polygons_, facet, request.receiver, request.is_twosided, request.lanes)
              .sample(request, longest_edge, piece);
    else
      sample = PolygonLight<F>(polygons_, facet, request.receiver, request.is_twosided, request.technique,
                               request.lanes)
                   .sample(request, longest_edge, piece);
    return shining<F>(request, texels_.patch_of<F>(facet), sample);
  }

  template <class F>
  F pdf_solid_angle(const Int<F>& row, const F& pmf, const Receiver<F>& receiver,
                    const LightHit<F>& hit) const {
    if (hit.technique == LightTechnique::area && !hit.is_facet_chosen)
      return pdf_solid_angle_at(hit, receiver, pmf * pdf_area_.at(row));
    const Int<F> facet = first_facet_.at(row) + hit.facet;
    const Mask<F> every_lane = F(0) < F(1);
    F pdf;
    if (is_by_texels(hit.technique))
      pdf = TexelMixture<F>(texels_, polygons_, facet, receiver, every_lane, every_lane).pdf_solid_angle(hit);
    else
      pdf = PolygonLight<F>(polygons_, facet, receiver, every_lane, hit.technique, every_lane)
                .pdf_solid_angle(hit);
    if (hit.is_facet_chosen) return pdf * pmf;
    return pdf * pmf * inversion_pmf<F>(weight_shares_.data(), first_share<F>(row), hit.facet);
  }

  // Facets are those of TexelTable.
  std::int32_t facet_count(std::int32_t row) const { return facet_count_[row]; }
  double facet_power_share(std::int32_t row, std::int32_t facet) const;
  LightBounds facet_bounds(std::int32_t row, std::int32_t facet) const;
  template <class F>
  Int<F> facet_at(const Int<F>& row, const Int<F>& primitive, const Vec3<F>& position) const {
    const Int<F> patch = gather(patch_of_triangle_.data(), first_triangle_.at(row) + primitive);
    return texels_.facet_at<F>(patch, position) - first_facet_.at(row);
  }

  /// Luminance per unit of strength.
  double power(std::int32_t row, const Sphere& /*scene_bounds*/) const { return power_[std::size_t(row)]; }
  std::optional<LightBounds> bounds(std::int32_t row) const { return bounds_[std::size_t(row)]; }

  /// Per unit of strength, at surface coordinates in the lanes of `m`.
  template <class F>
  Color<F> radiance(const Int<F>& row, const Vec2<F>& uv, const Mask<F>& m) const {
    Color<F> color = black<F>();
    for_each_unique<F>(row, m, [&](std::int32_t one, const Mask<F>& lanes) {
      color = select(lanes, color_at<F>(textures_[std::size_t(one)], uv, lanes), color);
    });
    return color;
  }
  /// Its luminance where it is greatest, or somewhat more; of unit strength.
  double largest_luminance(std::int32_t row) const { return brightest_[std::size_t(row)]; }

 private:
  static bool is_by_texels(LightTechnique technique) {
    return technique == LightTechnique::automatic || technique == LightTechnique::transformed_cosine;
  }

  template <class F>
  Int<F> first_share(const Int<F>& row) const {
    return first_facet_.at(row) + row;  // Each light before has one more share than facets.
  }

  /// What `sample` brings of unit radiance becomes what it brings. Its end is off the surface along the
  /// normal, which changes no surface coordinates.
  template <class F>
  LightSample<F> shining(const LightRequest<F>& request, const Int<F>& patch, LightSample<F> sample) const;
  /// Of the whole light, where no facets are chosen: patches are larger, and their points better distributed.
  template <class F>
  LightSample<F> sample_by_area(const LightRequest<F>& request) const;
  /// In proportion to their power, in lanes that ask for the whole light.
  template <class F>
  void choose_facet(LightRequest<F>& request) const;

  // Per light.
  LookupTable<std::int32_t> first_triangle_, first_patch_, patch_count_, first_facet_, facet_count_;
  LookupTable<float> pdf_area_;      ///< 1 / total area.
  LookupTable<float> longest_edge_;  ///< m
  std::vector<double> power_, weight_, brightest_;
  std::vector<LightBounds> bounds_;
  std::vector<ColorTexture> textures_;
  // Of all lights.
  std::vector<std::int32_t> patch_of_triangle_;
  TexelTable texels_;
  PolygonTable polygons_;  ///< Of each facet.
  std::vector<std::int32_t> pieces_;
  std::vector<std::int32_t> area_shares_;    ///< Cumulative, of the patches of each light.
  std::vector<std::int32_t> weight_shares_;  ///< Of its facets.
  std::int32_t most_patches_ = 1, most_facets_ = 1;
};

}  // namespace etendue
