// What a student's integrator did on the probes: means with their errors, and single samples call by call.
#pragma once

#include "course/light_terms.h"
#include "course/probe.h"
#include "stats/running.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace etendue {

class StudentModule;

/// The mean of many samples of one ray.
struct RayEvidence {
  std::size_t probe;
  ProbeOf of;
  bool is_light;           ///< The ray meets one.
  Color<double> expected;  ///< W/(m^2 sr)
  Colorf emitted;          ///< Of that, by the surface itself.
  Color<double> evenness;  ///< Of its samples; see ExpectedRadiance.
  std::array<RunningStatistics, 3> channels;
  /// Of a channel minus its expected share of the sum: of mean zero where shares are right.
  std::array<RunningStatistics, 3> shares;

  double sum_of_means() const { return channels[0].mean + channels[1].mean + channels[2].mean; }
};

/// One sample, and the points on lights that it looked at.
struct SampleEvidence {
  std::size_t probe, ray;
  Colorf value;
  std::vector<LightPointFacts> points;
};

/// How the points of one light of a probe lie in the unit square that they were asked for with.
struct PointsOfLight {
  static constexpr int cells = 4;  ///< Along each edge of the square.
  std::array<double, cells * cells> counts{};
  double drawn = 0;
};

struct ProbeEvidence {
  std::vector<std::string> names;  ///< Of the probes.
  std::vector<RayEvidence> rays;
  std::vector<SampleEvidence> samples;
  std::vector<std::vector<PointsOfLight>> points;  ///< By probe and light.
  std::vector<std::vector<double>> powers, areas;  ///< By probe and light; of some unit.

  std::int64_t samples_in_all = 0, samples_recorded = 0;
  std::int64_t invalid = 0, negative = 0;  ///< Of all.
  std::string first_invalid;               ///< Where, and what came.
  std::int64_t not_repeated = 0;           ///< Samples that a second run gave otherwise.
  std::int64_t not_alike_in_threads = 0;   ///< Samples that many threads at once gave otherwise.
  std::int64_t repeated = 0;
  std::int64_t without_numbers = 0;  ///< Recorded samples with a point, but no number of the sampler.
  std::int64_t numbers_shared_with_bsdf = 0, bsdf_samples = 0;  ///< Of those recorded.
  /// Of the rays cast for points that are visible: what kept them from being so.
  std::int64_t rays_to_visible = 0, rays_to_hidden = 0, ended_on_light = 0, ended_on_receiver = 0,
               ended_elsewhere = 0;
};

struct ProbeSettings {
  std::uint64_t probe_seed = 1;  ///< Of the scenes.
  std::uint64_t seed = 1;        ///< Of the samples.
  int samples_per_ray = 8192;
  int recorded_per_ray = 96;
  std::filesystem::path folder;                  ///< For the probes' files; exists.
  std::function<void(const std::string&)> at{};  ///< Told what comes next.
};

/// Throws InputError with what the student's code throws.
ProbeEvidence gather_evidence(const StudentModule& module, const std::string& integrator,
                              const std::vector<Probe>& probes, const ProbeSettings& settings);

}  // namespace etendue
