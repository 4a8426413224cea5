// Lamps that the camera sees, in pixels where the image of one may end: by several camera rays of their own
// for each sample, which look for nothing else. It is the adaptive supersampling of Whitted 1980, "An
// improved illumination model for shaded display", but for where: what is known of the lamps decides, not the
// samples.
#pragma once

#include "base/warp.h"
#include "integrator/camera_stage.h"
#include "integrator/contribution.h"
#include "integrator/hit_on_light.h"

#include <array>

namespace etendue {

/// Camera rays of the packet of samples from i on, the k-th of `count` of each; those of a pixel are one
/// sequence.
template <class F>
CameraRay<F> outline_ray(const Scene& scene, const SampleBlock& block, int i, int k, int count) {
  const SampleNumber which{k, count};
  const Vec2<F> u_film =
      to_unit_floats<F>(sample_bits<F>(scene, block.path, i, dimension::outline_film, which));
  const F x_px =
      to_float(load_lanes<Int<F>>(&block.pixel_x[i])) + F(0.5f) + scene.filter.sample_offset_px(u_film.x);
  const F y_px =
      to_float(load_lanes<Int<F>>(&block.pixel_y[i])) + F(0.5f) + scene.filter.sample_offset_px(u_film.y);
  if (!scene.camera.has_lens) return scene.camera.ray(x_px, y_px);
  const Vec2<F> u_lens =
      to_unit_floats<F>(sample_bits<F>(scene, block.path, i, dimension::outline_lens, which));
  return scene.camera.ray(x_px, y_px, square_to_uniform_disk(u_lens));
}

/// Adds what one of `count` rays of each sample of the packet has met of lamps. \param row of the ray
template <class F>
void add_lamp_at_outline(const Scene& scene, SampleBlock& block, int i, int row, int count) {
  const Ray<F> ray = load_ray<F>(block.next_ray, row);
  const Hit<F> hit = load_hit<F>(block.path.hit, row);
  const HitOnLight<F> met(scene, ray, hit);
  if (!any(met.is_there)) return;
  Color<F> radiance = met.radiance(scene, hit) * F(1 / float(count));
  if (scene.medium) {
    const F t_near = load_lanes<F>(&block.next_ray.t_near[row]);
    radiance = radiance * scene.medium->transmittance<F>(ray.origin + ray.direction * t_near,
                                                         ray.direction * max(hit.t - t_near, F(0)));
  }
  add_contribution<F>(block, i, met.is_there, radiance, {met.light, Technique::bsdf, 0});
}

/// For the samples in pixels where a lamp's image may end, adds the mean of the lamps' light along `count`
/// rays; what their own rays meet of it counts no more (add_emission). Comes after camera_rays.
template <class F>
[[gnu::noinline]] void add_lamps_at_outlines(const Scene& scene, SampleBlock& block, int count) {
  block.has_outlines = false;
  if (count == 0 || scene.lamp_outlines.is_empty()) return;
  std::array<int, block_capacity> first_rows;
  int packets = 0;
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    bool has_any = false;
    for (int s = i; s < i + lane_count_v<F>; ++s) {
      const bool is_marked = scene.lamp_outlines.contains(block.pixel_x[s], block.pixel_y[s]);
      block.is_at_outline[s] = is_marked ? -1 : 0;
      has_any = has_any || is_marked;
      if (is_marked && s < block.count) block.counts.outline_rays += count;
    }
    if (has_any) first_rows[std::size_t(packets++)] = i;
  }
  if (packets == 0) return;
  block.has_outlines = true;
  for (int k = 0; k < count; ++k) {
    for (int p = 0; p < packets; ++p) {
      const int i = first_rows[std::size_t(p)], row = p * lane_count_v<F>;
      store_camera_ray<F>(block.next_ray, row, outline_ray<F>(scene, block, i, k, count));
      store_lanes(&block.next_ray.is_active[row], load_lanes<Int<F>>(&block.is_at_outline[i]));
    }
    scene.rays.closest_hits(span_of(block.next_ray, packets * lane_count_v<F>), span_of(block.path.hit),
                            lane_count_v<F>, Coherence::coherent);
    for (int p = 0; p < packets; ++p)
      add_lamp_at_outline<F>(scene, block, first_rows[std::size_t(p)], p * lane_count_v<F>, count);
  }
  block.clock.finish(Stage::outlines);
}

}  // namespace etendue
