// Camera rays: a sample's place on the film, importance-sampled from the pixel filter, and the ray through
// it.
#pragma once

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

template <class F>
void camera_rays(const Scene& scene, SampleBlock& block) {
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    const Vec2<F> u_film = to_unit_floats<F>(sample_bits<F>(scene, block, i, dimension::film));
    const F x_px =
        to_float(load_lanes<Int<F>>(&block.pixel_x[i])) + F(0.5f) + scene.filter.sample_offset_px(u_film.x);
    const F y_px =
        to_float(load_lanes<Int<F>>(&block.pixel_y[i])) + F(0.5f) + scene.filter.sample_offset_px(u_film.y);
    const CameraRay<F> ray = scene.camera.ray(x_px, y_px);
    store_lanes(block.camera_ray.origin, i, ray.origin);
    store_lanes(block.camera_ray.direction, i, ray.direction);
    store_lanes(&block.camera_ray.t_near[i], ray.t_near);
    store_lanes(&block.camera_ray.t_far[i], ray.t_far);
    store_lanes(&block.camera_ray.is_active[i], Int<F>(-1));
  }
  block.camera_rays += block.count;
  block.clock.finish(Stage::camera_rays);
}

}  // namespace etendue
