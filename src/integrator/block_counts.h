// What a thread counts while it renders: rays, how full its packets are, and where the time goes.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

namespace etendue {

struct BlockCounts {
  std::int64_t camera_rays = 0, outline_rays = 0, shadow_rays = 0, bsdf_rays = 0;
  std::int64_t candidates = 0;  ///< Of light samples; where there is no choice, these themselves.
  std::int64_t paths = 0;       ///< Living paths, summed over the vertices that they arrive at.
  std::int64_t lanes = 0;       ///< Lanes of the packets that they took.

  BlockCounts& operator+=(const BlockCounts& more) {
    camera_rays += more.camera_rays;
    outline_rays += more.outline_rays;
    shadow_rays += more.shadow_rays;
    bsdf_rays += more.bsdf_rays;
    candidates += more.candidates;
    paths += more.paths;
    lanes += more.lanes;
    return *this;
  }
};

/// For benchmarks: a stage ends where the next begins.
enum class Stage {
  pilots,
  camera_rays,
  outlines,
  closest_hits,
  medium,
  emission,
  light_samples,
  aiming,
  shadow_rays,
  bsdf_samples,
  following,
  sums
};
inline constexpr std::array stage_names{"pilots",      "camera_rays",  "outlines",      "closest_hits",
                                        "medium",      "emission",     "light_samples", "aiming",
                                        "shadow_rays", "bsdf_samples", "following",     "sums"};

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

}  // namespace etendue
