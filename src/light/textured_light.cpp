#include "light/textured_light.h"

#include "light/inversion_table.h"
#include "light/light_pieces.h"
#include "texture/texels.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace etendue {

namespace {

/// So that a receiver can choose what is near among the facets of a lamp, and a cut of the light tree still
/// has room for all of them.
constexpr double facets_wanted = 64;
/// Of a light, in all its patches.
constexpr double most_cells = 1 << 24, most_cells_of_patch = 1 << 22;

TexelTable::Limits limits_for(double patches) {
  return {int(std::max(1.0, std::sqrt(facets_wanted / patches))),
          int(std::clamp(most_cells / patches, 16.0, most_cells_of_patch))};
}

}  // namespace

std::int32_t TexturedLights::add(const Geometry& geometry, std::int32_t geometry_id,
                                 const ColorTexture& radiance) {
  const TexturedPatches cut = textured_patches(geometry, geometry_id);
  const std::int32_t first = texels_.facet_count();
  first_triangle_.push_back(std::int32_t(patch_of_triangle_.size()));
  for (const std::int32_t patch : cut.of_triangle)
    patch_of_triangle_.push_back(texels_.patch_count() + patch);
  const double brightest = etendue::largest_luminance(radiance);
  for (const TexturedPatch& patch : cut.patches)
    texels_.add(patch, radiance, brightest, limits_for(double(cut.patches.size())));

  std::vector<double> areas, weights;
  std::vector<Vec3<double>> across;
  std::vector<Vec3f> centers;
  Box box;
  double integral = 0;
  for (std::int32_t facet = first; facet < texels_.facet_count(); ++facet) {
    const std::int32_t polygon = polygons_.add(texels_.corners(facet));
    areas.push_back(polygons_.area(polygon));
    weights.push_back(texels_.weight(facet));
    integral += texels_.integral(facet);
    across.push_back(widen(polygons_.ng(polygon)) * areas.back());
    const Box around = polygons_.box(polygon);
    box.include(around.low);
    box.include(around.high);
    centers.push_back((around.low + around.high) * 0.5f);
  }
  const double weight = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<double> patch_areas;
  first_patch_.push_back(texels_.patch_count() - std::int32_t(cut.patches.size()));
  patch_count_.push_back(std::int32_t(cut.patches.size()));
  most_patches_ = std::max(most_patches_, patch_count_[patch_count_.size() - 1]);
  for (std::int32_t patch = first_patch_[first_patch_.size() - 1]; patch < texels_.patch_count(); ++patch)
    patch_areas.push_back(texels_.area(patch));
  first_facet_.push_back(first);
  facet_count_.push_back(std::int32_t(areas.size()));
  most_facets_ = std::max(most_facets_, facet_count_[count() - 1]);
  pdf_area_.push_back(float(1 / std::accumulate(areas.begin(), areas.end(), 0.0)));
  longest_edge_.push_back(geometry.longest_edge[std::size_t(geometry_id)]);
  power_.push_back(std::numbers::pi * (integral > 0 ? integral : weight));
  weight_.push_back(weight);
  brightest_.push_back(brightest);
  bounds_.push_back(bounds_of(box, across));
  textures_.push_back(radiance);
  for (const std::int32_t piece : pieces_of(centers)) pieces_.push_back(piece & 0xff);
  append_positive_shares(std::move(patch_areas), area_shares_);
  append_positive_shares(std::move(weights), weight_shares_);
  return count() - 1;
}

double TexturedLights::facet_power_share(std::int32_t row, std::int32_t facet) const {
  const double all = weight_[std::size_t(row)];
  return all > 0 ? texels_.weight(first_facet_[row] + facet) / all : 0;
}

LightBounds TexturedLights::facet_bounds(std::int32_t row, std::int32_t facet) const {
  const std::int32_t polygon = first_facet_[row] + facet;
  return {polygons_.box(polygon), polygons_.ng(polygon), 1 - 1e-6f, 0};
}

}  // namespace etendue
