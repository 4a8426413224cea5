// Camera rays: a sample's place on the film, importance-sampled from the pixel filter, and the ray through
// it.
#pragma once

#include "base/warp.h"
#include "integrator/sample_block.h"
#include "sampler/sampler.h"
#include "scene/scene.h"

namespace etendue {

/// The 2-D random numbers of the samples i, i + 1 ... for one consumer.
template <class F>
Vec2<UInt<F>> sample_bits(const Scene& scene, const SampleBlock& block, int i, std::uint32_t pair) {
  return sample_2d<F>(scene.sampler, load_lanes<UInt<F>>(&block.stream_lo[i]),
                      load_lanes<UInt<F>>(&block.stream_hi[i]), load_lanes<UInt<F>>(&block.index[i]), pair);
}

/// The random numbers that place the samples i, i + 1 ... on the film.
template <class F>
Vec2<F> film_numbers(const Scene& scene, const SampleBlock& block, int i) {
  return to_unit_floats<F>(sample_bits<F>(scene, block, i, dimension::film));
}

template <class F>
void camera_rays(const Scene& scene, SampleBlock& block) {
  const auto for_each_packet = [&](const auto& ray_at) {
    for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
      const Vec2<F> u_film = film_numbers<F>(scene, block, i);
      const F x_px =
          to_float(load_lanes<Int<F>>(&block.pixel_x[i])) + F(0.5f) + scene.filter.sample_offset_px(u_film.x);
      const F y_px =
          to_float(load_lanes<Int<F>>(&block.pixel_y[i])) + F(0.5f) + scene.filter.sample_offset_px(u_film.y);
      const CameraRay<F> ray = ray_at(i, x_px, y_px);
      store_lanes(block.camera_ray.origin, i, ray.origin);
      store_lanes(block.camera_ray.direction, i, ray.direction);
      store_lanes(&block.camera_ray.t_near[i], ray.t_near);
      store_lanes(&block.camera_ray.t_far[i], ray.t_far);
      store_lanes(&block.camera_ray.is_active[i], Int<F>(-1));
    }
  };
  const Camera& camera = scene.camera;
  if (camera.has_lens)
    for_each_packet([&](int i, const F& x_px, const F& y_px) {
      const Vec2<F> u_lens = to_unit_floats<F>(sample_bits<F>(scene, block, i, dimension::lens));
      return camera.ray(x_px, y_px, square_to_uniform_disk(u_lens));
    });
  else
    for_each_packet([&](int, const F& x_px, const F& y_px) { return camera.ray(x_px, y_px); });
  block.camera_rays += block.count;
  block.clock.finish(Stage::camera_rays);
}

/// Multiplies each sample's radiance by its weight under the pixel filter, which may be negative: after the
/// last look at what radiances are valid. Nothing to do for filters without negative lobes.
template <class F>
void weigh_by_filter(const Scene& scene, SampleBlock& block) {
  if (!scene.filter.is_signed()) return;
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    const Vec2<F> u_film = film_numbers<F>(scene, block, i);
    store_lanes(block.radiance, i,
                load_lanes<F>(block.radiance, i) * scene.filter.sample_weight(u_film.x, u_film.y));
  }
}

}  // namespace etendue
