// Camera rays: a sample's place on the film, importance-sampled from the pixel filter, and the ray through
// it, by way of a point of the lens where the camera has one.
#pragma once

#include "base/warp.h"
#include "integrator/sample_block.h"
#include "sampler/sampler.h"
#include "scene/scene.h"

#include <limits>

namespace etendue {

/// Of the 2-D samples that one consumer takes at once: `number` of `count` that follow one another in one
/// sequence, and which of its sequences.
struct SampleNumber {
  int number = 0, count = 1;
  std::int32_t sequence = 0;
};

/// The 2-D random numbers of the paths i, i + 1 ... for one consumer. \param index in their sequences
template <class F>
Vec2<UInt<F>> sample_bits_at(const Scene& scene, const PathColumns& path, int i, std::uint32_t pair,
                             const UInt<F>& index, std::int32_t sequence) {
  using U = UInt<F>;
  U stream_lo = load_lanes<U>(&path.stream_lo[i]), stream_hi = load_lanes<U>(&path.stream_hi[i]);
  if (sequence > 0) {
    const std::uint64_t other = hash64(std::uint64_t(sequence));
    stream_lo = stream_lo ^ U(std::uint32_t(other));
    stream_hi = stream_hi ^ U(std::uint32_t(other >> 32));
  }
  return sample_2d<F>(scene.sampler, stream_lo, stream_hi, index, pair);
}
template <class F>
Vec2<UInt<F>> sample_bits(const Scene& scene, const PathColumns& path, int i, std::uint32_t pair,
                          const SampleNumber& which = {}) {
  using U = UInt<F>;
  U index = load_lanes<U>(&path.index[i]);
  if (which.count > 1) index = index * U(std::uint32_t(which.count)) + U(std::uint32_t(which.number));
  return sample_bits_at<F>(scene, path, i, pair, index, which.sequence);
}

template <class F>
void store_camera_ray(RayColumns& rays, int i, const CameraRay<F>& ray) {
  store_lanes(rays.origin, i, ray.origin);
  store_lanes(rays.direction, i, ray.direction);
  store_lanes(&rays.t_near[i], ray.t_near);
  store_lanes(&rays.t_far[i], ray.t_far);
  store_lanes(&rays.is_active[i], Int<F>(-1));
}

/// Starts the block's samples, each a path.
template <class F>
[[gnu::noinline]] void camera_rays(const Scene& scene, SampleBlock& block) {
  PathColumns& path = block.path;
  path.count = block.count;
  path.padded_count = block.padded_count;
  block.is_in_sample_order = true;
  const auto for_each_packet = [&](const auto& ray_at) {
    for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
      const Vec2<F> u_film = to_unit_floats<F>(sample_bits<F>(scene, path, i, dimension::film));
      const F x_px =
          to_float(load_lanes<Int<F>>(&block.pixel_x[i])) + F(0.5f) + scene.filter.sample_offset_px(u_film.x);
      const F y_px =
          to_float(load_lanes<Int<F>>(&block.pixel_y[i])) + F(0.5f) + scene.filter.sample_offset_px(u_film.y);
      if (scene.filter.is_signed())
        store_lanes(&block.filter_weight[i], scene.filter.sample_weight(u_film.x, u_film.y));
      store_camera_ray<F>(path.ray, i, ray_at(i, x_px, y_px));
      store_lanes(path.throughput, i, Color<F>{F(1), F(1), F(1)});
      store_lanes(&path.pdf[i], F(std::numeric_limits<float>::infinity()));
      store_lanes(&path.eta[i], F(1));
      store_lanes(block.radiance, i, black<F>());
      for (ColorColumn& layer : block.layers) store_lanes(layer, i, black<F>());
    }
  };
  const Camera& camera = scene.camera;
  if (camera.has_lens)
    for_each_packet([&](int i, const F& x_px, const F& y_px) {
      const Vec2<F> u_lens = to_unit_floats<F>(sample_bits<F>(scene, path, i, dimension::lens));
      return camera.ray(x_px, y_px, square_to_uniform_disk(u_lens));
    });
  else
    for_each_packet([&](int, const F& x_px, const F& y_px) { return camera.ray(x_px, y_px); });
  for (int i = 0; i < block.padded_count; ++i) path.sample[i] = i;
  block.counts.camera_rays += block.count;
  block.clock.finish(Stage::camera_rays);
}

/// Multiplies each sample's radiance, and its parts in layers, by the weight that belongs to its place under
/// the pixel filter: after the last look at what radiances are valid. Nothing to do for filters without
/// negative lobes.
template <class F>
void weigh_by_filter(const Scene& scene, SampleBlock& block) {
  if (!scene.filter.is_signed()) return;
  const auto weigh = [&](ColorColumn& sums) {
    for (int i = 0; i < block.padded_count; i += lane_count_v<F>)
      store_lanes(sums, i, load_lanes<F>(sums, i) * load_lanes<F>(&block.filter_weight[i]));
  };
  weigh(block.radiance);
  for (ColorColumn& layer : block.layers) weigh(layer);
}

}  // namespace etendue
