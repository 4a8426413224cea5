// The shadow rays of a block's paths: of several light samples at once, so that more of them aim alike.
#pragma once

#include "integrator/columns.h"

#include <cstdint>

namespace etendue {

/// Which of the samples of a vertex: of several of the lights, and of the light sampler's passes.
struct LightSampleNumber {
  int vertex = 0, number = 0;
  std::int32_t pass = 0;
};

/// Light samples of each path, one after the other: what belongs to the k-th of path i is in row(k, i).
struct ShadowRays {
  static constexpr int most_samples = 4;  ///< Of a path at once.
  static constexpr int most_rows = most_samples * block_capacity;

  int samples = 0;  ///< Of each path.
  int stride = 0;   ///< Paths, padded to whole packets.
  int rows() const { return samples * stride; }
  int row(int sample, int path) const { return sample * stride + path; }

  Vec3ColumnOf<most_rows> origin, along;  ///< Where the segment starts, and from there to the light (m).
  ColorColumnOf<most_rows> unshadowed;    ///< What the light sample adds where nothing hides it.
  Column<std::int32_t, most_rows> is_needed, is_free;
  Column<std::int32_t, most_rows> light;  ///< Which it samples.
  Column<std::int32_t, most_rows> aim;    ///< DirectLightSample::aim.

  Column<std::int32_t, most_rows> bin;    ///< In the order of casting.
  Column<std::int32_t, most_rows> order;  ///< Rows as their rays are cast, then -1.
  int count = 0;                          ///< Rays that are cast.
};

}  // namespace etendue
