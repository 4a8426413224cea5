// Pilot rays: what the camera sees of each small tile, for which a cut of the light tree is made.
#pragma once

#include "integrator/columns.h"
#include "integrator/sample_block.h"
#include "integrator/vertex.h"
#include "lightsampler/light_sampler.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace etendue {

/// The receivers that the pilot rays of a tile meet, in a grid over it and through the middle of the lens. They
/// decide how lights are chosen, never what a sample is worth.
template <class F>
void make_cut(const Scene& scene, const LightTree& tree, LightCuts& cuts, int slot, int tiles_across) {
  constexpr int side = 4, step_px = LightCuts::tile_px / side;
  static_assert(side * side == LightCuts::pilots && LightCuts::pilots % lane_count_v<F> == 0);
  const int x_px = cuts.tile(slot) % tiles_across * LightCuts::tile_px,
            y_px = cuts.tile(slot) / tiles_across * LightCuts::tile_px;
  alignas(64) std::array<float, LightCuts::pilots> x, y;
  for (int k = 0; k < LightCuts::pilots; ++k) {
    x[std::size_t(k)] = float(x_px + k % side * step_px) + 0.5f * step_px;
    y[std::size_t(k)] = float(y_px + k / side * step_px) + 0.5f * step_px;
  }
  struct Pilots {
    RayColumns ray;
    HitColumns hit;
  };
  static thread_local Pilots pilots;
  constexpr int packets = LightCuts::pilots / lane_count_v<F>;
  for (int p = 0; p < packets; ++p) {
    const int i = p * lane_count_v<F>;
    const F x_lanes = load_lanes<F>(&x[std::size_t(i)]), y_lanes = load_lanes<F>(&y[std::size_t(i)]);
    const CameraRay<F> ray = scene.camera.has_lens
                                 ? scene.camera.ray(x_lanes, y_lanes, Vec2<F>{F(0), F(0)})
                                 : scene.camera.ray(x_lanes, y_lanes);
    store_lanes(pilots.ray.origin, i, ray.origin);
    store_lanes(pilots.ray.direction, i, ray.direction);
    store_lanes(&pilots.ray.t_near[i], ray.t_near);
    store_lanes(&pilots.ray.t_far[i], ray.t_far);
    store_lanes(&pilots.ray.is_active[i], Int<F>(-1));
  }
  const RayColumns& rays = pilots.ray;
  HitColumns& hits = pilots.hit;
  scene.rays.closest_hits(
      {rays.origin.x.data(), rays.origin.y.data(), rays.origin.z.data(), rays.direction.x.data(),
       rays.direction.y.data(), rays.direction.z.data(), rays.t_near.data(), rays.t_far.data(),
       rays.is_active.data(), LightCuts::pilots},
      {hits.t.data(), hits.ng.x.data(), hits.ng.y.data(), hits.ng.z.data(), hits.u.data(), hits.v.data(),
       hits.geometry.data(), hits.primitive.data()},
      lane_count_v<F>, Coherence::coherent);
  std::array<Receiver<F>, packets> receivers;
  std::array<Mask<F>, packets> is_lit;
  for (int p = 0; p < packets; ++p) {
    const int i = p * lane_count_v<F>;
    const Vertex<F> vertex(scene, load_ray<F>(rays, i), load_hit<F>(hits, i));
    receivers[std::size_t(p)] = vertex.receiver(scene);
    is_lit[std::size_t(p)] = mask_and(
        vertex.is_surface, mask_not(equal(receivers[std::size_t(p)].lit_sides, Int<F>(lit_side::none))));
  }
  cuts.make<F>(slot, tree, receivers.data(), is_lit.data());
}

/// Cuts for the tiles of the block's samples, where lights are chosen by a tree. In a medium light scatters
/// before what pilot rays see: none.
template <class F>
void make_cuts(const Scene& scene, const LightSampler& light_sampler, SampleBlock& block) {
  const LightTree* tree = light_sampler.tree();
  block.has_cuts = tree && !tree->is_empty() && !scene.medium;
  if (!block.has_cuts) return;
  const int tiles_across = (scene.camera.width_px + LightCuts::tile_px - 1) / LightCuts::tile_px;
  std::vector<std::int32_t> tiles;
  int slot = 0;
  for (int i = 0; i < block.padded_count; ++i) {
    const std::int32_t tile =
        block.pixel_y[i] / LightCuts::tile_px * tiles_across + block.pixel_x[i] / LightCuts::tile_px;
    if (tiles.empty() || tiles[std::size_t(slot)] != tile) {
      slot = int(std::find(tiles.begin(), tiles.end(), tile) - tiles.begin());
      if (slot == int(tiles.size())) tiles.push_back(tile);
    }
    block.cut[i] = slot;
  }
  for (const int fresh : block.cuts.take_tiles(tiles)) make_cut<F>(scene, *tree, block.cuts, fresh, tiles_across);
  block.clock.finish(Stage::pilots);
}

}  // namespace etendue
