// Camera rays: a sample's place on the film, importance-sampled from the pixel filter, and the ray through
// it.
#pragma once

#include "integrator/sample_block.h"
#include "sampler/sampler.h"
#include "scene/scene.h"

#include <algorithm>
#include <limits>

namespace etendue {

/// The 2-D random numbers of the paths i, i + 1 ... for one consumer; the `number`-th of `count`, where it
/// takes several.
template <class F>
Vec2<UInt<F>> sample_bits(const Scene& scene, const PathColumns& path, int i, std::uint32_t pair,
                          int number = 0, int count = 1) {
  UInt<F> index = load_lanes<UInt<F>>(&path.index[i]);
  if (count > 1) index = index * UInt<F>(std::uint32_t(count)) + UInt<F>(std::uint32_t(number));
  return sample_2d<F>(scene.sampler, load_lanes<UInt<F>>(&path.stream_lo[i]),
                      load_lanes<UInt<F>>(&path.stream_hi[i]), index, pair);
}

/// Starts the block's samples, each a path.
template <class F>
[[gnu::noinline]] void camera_rays(const Scene& scene, SampleBlock& block) {
  PathColumns& path = block.path;
  path.count = block.count;
  path.padded_count = block.padded_count;
  block.is_in_sample_order = true;
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    const Vec2<F> u_film = to_unit_floats<F>(sample_bits<F>(scene, path, i, dimension::film));
    const F x_px =
        to_float(load_lanes<Int<F>>(&block.pixel_x[i])) + F(0.5f) + scene.filter.sample_offset_px(u_film.x);
    const F y_px =
        to_float(load_lanes<Int<F>>(&block.pixel_y[i])) + F(0.5f) + scene.filter.sample_offset_px(u_film.y);
    const CameraRay<F> ray = scene.camera.ray(x_px, y_px);
    store_lanes(path.ray.origin, i, ray.origin);
    store_lanes(path.ray.direction, i, ray.direction);
    store_lanes(&path.ray.t_near[i], ray.t_near);
    store_lanes(&path.ray.t_far[i], ray.t_far);
    store_lanes(&path.ray.is_active[i], Int<F>(-1));
    store_lanes(path.throughput, i, Color<F>{F(1), F(1), F(1)});
    store_lanes(&path.pdf[i], F(std::numeric_limits<float>::infinity()));
    store_lanes(&path.eta[i], F(1));
    store_lanes(block.radiance, i, black<F>());
  }
  for (int i = 0; i < block.padded_count; ++i) path.sample[i] = i;
  block.counts.camera_rays += block.count;
  block.clock.finish(Stage::camera_rays);
}

}  // namespace etendue
