// A block of samples as structure-of-arrays buffers that stay in the cache; integrators' stages pass over it.
#pragma once

#include "base/color.h"
#include "base/mask.h"
#include "base/vec.h"

#include <array>
#include <chrono>
#include <cstdint>

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

/// Where the time goes, for benchmarks: a stage ends where the next begins.
enum class Stage {
  camera_rays,
  closest_hits,
  emission,
  light_samples,
  aiming,
  shadow_rays,
  bsdf_samples,
  bsdf_rays,
  sums
};
inline constexpr std::array stage_names{"camera_rays", "closest_hits", "emission",  "light_samples", "aiming",
                                        "shadow_rays", "bsdf_samples", "bsdf_rays", "sums"};

class StageClock {
 public:
  void start() { last_ = std::chrono::steady_clock::now(); }
  void finish(Stage stage) {
    const auto now = std::chrono::steady_clock::now();
    seconds_[std::size_t(stage)] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  const std::array<double, stage_names.size()>& seconds() const { return seconds_; }

 private:
  std::chrono::steady_clock::time_point last_{};
  std::array<double, stage_names.size()> seconds_{};
};

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

struct SampleBlock {
  int count = 0;         ///< Samples.
  int padded_count = 0;  ///< Up to whole packets of the widest kind; the surplus repeats the last sample.
  bool is_one_pixel = false;

  // Who the sample is.
  Column<std::int32_t> pixel_x, pixel_y;
  Column<std::uint32_t> stream_lo, stream_hi, index;

  // What the camera sees: the surface that light and BSDF samples start from.
  RayColumns camera_ray;
  HitColumns camera_hit;

  // A light sample: its shadow segment (t from 0 to 1), and what it adds where nothing hides it.
  Vec3Column shadow_origin, shadow_direction;
  ColorColumn unshadowed;
  Column<std::int32_t> shadow_is_needed, shadow_is_free;
  Column<std::int32_t> aim;    ///< light * light_pieces + piece; after aiming, the bin.
  Column<std::int32_t> order;  ///< Of tracing: sample numbers, then -1.
  int shadow_count = 0;

  // A BSDF sample: what its ray brings is weighted by `throughput`.
  RayColumns bsdf_ray;
  HitColumns bsdf_hit;
  ColorColumn throughput;
  Column<float> pdf_bsdf;  ///< 1/sr

  ColorColumn radiance;

  std::int64_t camera_rays = 0, shadow_rays = 0, bsdf_rays = 0;
  StageClock clock;
};

}  // namespace etendue
