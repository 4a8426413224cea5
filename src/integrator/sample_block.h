// A block of samples as structure-of-arrays buffers that stay in the cache; integrators' stages pass over it.
#pragma once

#include "base/lane_vec.h"
#include "integrator/block_counts.h"

#include <array>
#include <cstdint>
#include <functional>

namespace etendue {

inline constexpr int block_capacity = 1024;

template <class T>
struct alignas(64) Column : std::array<T, block_capacity> {};

struct Vec3Column {
  Column<float> x, y, z;
};
struct ColorColumn {
  Column<float> r, g, b;
};

template <class F>
Vec3<F> load_lanes(const Vec3Column& column, int i) {
  return {load_lanes<F>(&column.x[i]), load_lanes<F>(&column.y[i]), load_lanes<F>(&column.z[i])};
}
template <class F>
void store_lanes(Vec3Column& column, int i, const Vec3<F>& v) {
  store_lanes(&column.x[i], v.x);
  store_lanes(&column.y[i], v.y);
  store_lanes(&column.z[i], v.z);
}
template <class F>
Color<F> load_lanes(const ColorColumn& column, int i) {
  return {load_lanes<F>(&column.r[i]), load_lanes<F>(&column.g[i]), load_lanes<F>(&column.b[i])};
}
template <class F>
void store_lanes(ColorColumn& column, int i, const Color<F>& c) {
  store_lanes(&column.r[i], c.r);
  store_lanes(&column.g[i], c.g);
  store_lanes(&column.b[i], c.b);
}

/// Rays as they are cast.
struct RayColumns {
  Vec3Column origin, direction;  ///< The direction is unit.
  Column<float> t_near, t_far;
  Column<std::int32_t> is_active;  ///< -1: cast it; 0: not.
};

/// What they hit; geometry -1: nothing.
struct HitColumns {
  Column<float> t, u, v;
  Vec3Column ng;  ///< Not normalised.
  Column<std::int32_t> geometry, primitive;
};

/// The paths that are still alive, one a row, as they arrive at a vertex.
struct PathColumns {
  int count = 0;         ///< Paths.
  int padded_count = 0;  ///< Up to whole packets of the widest kind.

  Column<std::int32_t> sample;  ///< The row of the sample that the path belongs to.
  Column<std::uint32_t> stream_lo, stream_hi, index;

  RayColumns ray;  ///< The ray that arrives, and what it hits.
  HitColumns hit;
  ColorColumn throughput;  ///< Product of f cos / pdf, roulette included.
  Column<float> pdf;       ///< Of the ray's direction, 1/sr; infinity: the camera's, or a Dirac delta's.
  Column<float> eta;       ///< Refractive index here over that at the camera.
  Vec3Column from;         ///< The vertex where the ray was sampled, m.
};

struct SampleBlock {
  // The samples of a block, and what becomes of them; the surplus of the padding repeats the last sample.
  int count = 0;
  int padded_count = 0;
  bool is_one_pixel = false;
  Column<std::int32_t> pixel_x, pixel_y;
  Column<float> filter_weight;  ///< Set and read only where the pixel filter has negative lobes.
  ColorColumn radiance;

  PathColumns path;
  bool is_in_sample_order = true;  ///< Row i of `path` is sample i: no path has been left out yet.

  // A light sample: its shadow segment (t from 0 to 1), and what it adds where nothing hides it.
  Vec3Column shadow_origin, shadow_direction;
  ColorColumn unshadowed;
  Column<std::int32_t> shadow_is_needed, shadow_is_free;
  Column<std::int32_t> aim;    ///< light * light_pieces + piece; after aiming, the bin.
  Column<std::int32_t> order;  ///< Rows of `path`: of shadow rays as they are traced, then -1; of paths kept.
  int shadow_count = 0;        ///< 0 where no light has been sampled since the last vertex.

  RayColumns next_ray;  ///< Along the direction that the BSDF was sampled for.

  BlockCounts counts;
  StageClock clock;
  /// Called where set, once the samples of a vertex have been taken, with the numbers of the vertex and of
  /// the BSDF sample (of several, each goes on to a vertex of its own): benchmarks and replays look on.
  const std::function<void(const SampleBlock&, int vertex, int bsdf_sample)>* on_vertex = nullptr;
};

/// Adds to the radiance of the samples that the paths i, i + 1 ... belong to.
template <class F>
void add_radiance(SampleBlock& block, int i, const Mask<F>& m, const Color<F>& added) {
  if (block.is_in_sample_order) {
    store_lanes(block.radiance, i, load_lanes<F>(block.radiance, i) + select(m, added, black<F>()));
    return;
  }
  const Int<F> sample = load_lanes<Int<F>>(&block.path.sample[i]);
  const auto add = [&](float* channel, const F& value) {
    scatter<F>(channel, sample, m, gather(channel, sample) + value);
  };
  add(block.radiance.r.data(), added.r);
  add(block.radiance.g.data(), added.g);
  add(block.radiance.b.data(), added.b);
}

}  // namespace etendue
