// Pilot rays: what the camera sees of each small tile, for which a cut of the light tree is made.
#pragma once

#include "base/frame.h"
#include "integrator/camera_stage.h"
#include "integrator/columns.h"
#include "integrator/pilot_shadow_rays.h"
#include "integrator/sample_block.h"
#include "integrator/vertex.h"
#include "lightsampler/light_sampler.h"
#include "lightsampler/make_light_cut.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace etendue {

/// The lobes of what a packet of pilot rays has met.
template <class F>
struct PilotLobes {
  Vertex<F> vertex;
  Frame<F> frame;
  Vec3<F> wo_local, mirrored;

  explicit PilotLobes(const Vertex<F>& met)
      : vertex(met),
        frame(met.ns),
        wo_local(frame.local_from_world(met.wo)),
        mirrored(met.ns * (F(2) * dot(met.ns, met.wo)) - met.wo) {}

  /// The BSDF's density of the direction of a cluster that is nearest to the mirror's, and a little from all
  /// others: other places of the tile have their lobes elsewhere.
  F density_at_most(const Scene& scene, const Importance<F>& of) const {
    const F cos_angle = dot(of.wi, mirrored), cos_spread = sqrt(F(1) - of.spread_sq);
    const Vec3<F> aside = mirrored - of.wi * cos_angle;
    const F inv_aside = F(1) / sqrt(max(length_sq(aside), F(1e-12f)));
    const Vec3<F> edge = of.wi * cos_spread + aside * (sqrt(of.spread_sq) * inv_aside);
    const Vec3<F> wi_local = frame.local_from_world(select(cos_angle >= cos_spread, mirrored, edge));
    F density(0);
    for_each_scatterer<F>(scene, vertex, vertex.is_surface, [&](const auto& bsdf, const Mask<F>& lanes) {
      density = select(lanes, bsdf.pdf_solid_angle(wo_local, wi_local), density);
    });
    constexpr float from_everywhere = 0.02f;
    return density + F(from_everywhere);
  }
};

/// The receivers that the pilot rays of a tile meet, in a grid over it and through the middle of the lens.
/// They decide how lights are chosen, never what a sample is worth.
template <class F>
LightCut make_cut(const Scene& scene, const LightTree& tree, std::int32_t tile, int tiles_across) {
  constexpr int side = 4;
  static_assert(side * side == light_cut_pilots && light_cut_pilots % lane_count_v<F> == 0);
  const int x_px = tile % tiles_across * LightCut::tile_px, y_px = tile / tiles_across * LightCut::tile_px;
  const float width_px = float(std::min(LightCut::tile_px, scene.camera.width_px - x_px)),
              height_px = float(std::min(LightCut::tile_px, scene.camera.height_px - y_px));
  alignas(64) std::array<float, light_cut_pilots> x, y;
  for (int k = 0; k < light_cut_pilots; ++k) {
    x[std::size_t(k)] = float(x_px) + width_px * (float(k % side) + 0.5f) / side;
    y[std::size_t(k)] = float(y_px) + height_px * (float(k / side) + 0.5f) / side;
  }
  struct Pilots {
    RayColumns ray;
    HitColumns hit;
  };
  static thread_local Pilots pilots;
  constexpr int packets = light_cut_pilots / lane_count_v<F>;
  for (int p = 0; p < packets; ++p) {
    const int i = p * lane_count_v<F>;
    const F x_lanes = load_lanes<F>(&x[std::size_t(i)]), y_lanes = load_lanes<F>(&y[std::size_t(i)]);
    const CameraRay<F> ray = scene.camera.has_lens ? scene.camera.ray(x_lanes, y_lanes, Vec2<F>{F(0), F(0)})
                                                   : scene.camera.ray(x_lanes, y_lanes);
    store_camera_ray<F>(pilots.ray, i, ray);
  }
  const RayColumns& rays = pilots.ray;
  scene.rays.closest_hits(span_of(rays, light_cut_pilots), span_of(pilots.hit), lane_count_v<F>,
                          Coherence::coherent);
  std::array<Receiver<F>, packets> receivers;
  std::array<Mask<F>, packets> is_lit;
  std::vector<PilotLobes<F>> lobes;
  bool is_all_diffuse = true;
  for (int p = 0; p < packets; ++p) {
    const int i = p * lane_count_v<F>;
    const Vertex<F> vertex(scene, load_ray<F>(rays, i), load_hit<F>(pilots.hit, i));
    receivers[std::size_t(p)] = vertex.receiver(scene);
    lobes.emplace_back(vertex);
    is_lit[std::size_t(p)] = mask_and(
        vertex.is_surface, mask_not(equal(receivers[std::size_t(p)].lit_sides, Int<F>(lit_side::none))));
    is_all_diffuse =
        is_all_diffuse &&
        !any(mask_and(is_lit[std::size_t(p)], mask_not(scene.materials.is_diffuse<F>(vertex.material))));
  }
  const auto see = [&](int p, const LightChoice<F>& choice, const UInt<F>& u_place) {
    const auto at = std::size_t(p);
    return see_lights<F>(scene, lobes[at].vertex, receivers[at], is_lit[at], choice, u_place);
  };
  if (is_all_diffuse) {
    return make_light_cut<F>(
        tree, receivers.data(), is_lit.data(), [](int, const Importance<F>&) { return F(1); }, see);
  }
  return make_light_cut<F>(
      tree, receivers.data(), is_lit.data(),
      [&](int p, const Importance<F>& of) { return lobes[std::size_t(p)].density_at_most(scene, of); }, see);
}

/// Cuts for the tiles of the block's samples, where lights are chosen by a tree. In a medium light scatters
/// before what pilot rays see: none.
template <class F>
void make_cuts(const Scene& scene, const LightSampler& light_sampler, SampleBlock& block) {
  const LightTree* tree = light_sampler.tree();
  block.has_cuts = tree && !tree->is_empty() && !scene.medium;
  if (!block.has_cuts) return;
  const int tiles_across = LightCuts::tiles_across(scene.camera.width_px);
  std::vector<std::int32_t> tiles;
  int slot = 0;
  for (int i = 0; i < block.padded_count; ++i) {
    const std::int32_t tile =
        block.pixel_y[i] / LightCut::tile_px * tiles_across + block.pixel_x[i] / LightCut::tile_px;
    if (tiles.empty() || tiles[std::size_t(slot)] != tile) {
      slot = int(std::find(tiles.begin(), tiles.end(), tile) - tiles.begin());
      if (slot == int(tiles.size())) tiles.push_back(tile);
    }
    block.cut[i] = slot;
  }
  block.cuts.take_tiles(tiles, block.cut_store,
                        [&](std::int32_t tile) { return make_cut<F>(scene, *tree, tile, tiles_across); });
  block.clock.finish(Stage::pilots);
}

}  // namespace etendue
