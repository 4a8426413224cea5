#include "course/probe_evidence.h"

#include "course/calls.h"
#include "course/probe_receiver.h"
#include "course/stream_sampler.h"
#include "course/student_integrator.h"
#include "course/student_words.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <exception>
#include <fmt/format.h>
#include <thread>

namespace etendue {

namespace {

bool is_finite_color(const Colorf& c) {
  return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

bool is_same(const Colorf& a, const Colorf& b) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  return bits(a.r) == bits(b.r) && bits(a.g) == bits(b.g) && bits(a.b) == bits(b.b);
}

/// A ray and all that is known of it.
struct Line {
  const ProbeRay& ray;
  ProbeReceiver receiver;
  std::uint64_t stream;
};

class Gathering {
 public:
  Gathering(const StudentModule& module, const std::string& integrator, const std::vector<Probe>& probes,
            const ProbeSettings& settings)
      : settings_(settings) {
    for (const Probe& probe : probes) {
      settings_.at(probe.name);
      const LoadedProbe& loaded = probes_.emplace_back(probe, settings.folder);
      integrators_.emplace_back(module, integrator, loaded.loaded.scene, loaded.loaded.places, Object{});
      add_rays(loaded);
    }
  }

  ProbeEvidence gather() {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      settings_.at(probes_[evidence_.rays[i].probe].probe.name);
      record_samples(i);
      take_samples(i);
    }
    settings_.at("the same once more");
    for (std::size_t i = 0; i < lines_.size(); ++i) evidence_.not_repeated += differing(i, 0);
    settings_.at("several threads");
    compare_threads();
    return std::move(evidence_);
  }

 private:
  void add_rays(const LoadedProbe& loaded) {
    const std::size_t probe = probes_.size() - 1;
    evidence_.names.push_back(loaded.probe.name);
    std::vector<double>& powers = evidence_.powers.emplace_back();
    for (std::size_t light = 0; light < loaded.light_areas.size(); ++light) {
      const Colorf radiance = from_student(loaded.scene.getLuminaires()[light]->getColor());
      powers.push_back(double(luminance(radiance)) * loaded.light_areas[light]);
    }
    evidence_.areas.push_back(loaded.light_areas);
    evidence_.points.emplace_back(loaded.light_areas.size());
    for (const ProbeRay& ray : loaded.probe.rays) {
      const std::uint64_t stream = sample_stream(settings_.seed, int(lines_.size()), 0, 0);
      const Line& line = lines_.emplace_back(Line{ray, ProbeReceiver(loaded, ray), stream});
      const ExpectedRadiance expected = line.receiver.expected();
      evidence_.rays.push_back({probe,
                                loaded.probe.of,
                                line.receiver.is_light(),
                                expected.mean,
                                line.receiver.emitted(),
                                expected.evenness,
                                {},
                                {}});
    }
  }

  StreamSampler sampler(const Line& line, int index) const {
    return {SamplerKind::independent,
            {std::uint32_t(line.stream), std::uint32_t(line.stream >> 32), std::uint32_t(index)}};
  }
  Colorf sample(std::size_t i, int index) const {
    const Line& line = lines_[i];
    StreamSampler numbers = sampler(line, index);
    return integrators_[evidence_.rays[i].probe].radiance({line.ray.origin, line.ray.direction}, 0,
                                                          std::numeric_limits<float>::infinity(), numbers);
  }

  void record_samples(std::size_t i) {
    std::vector<Call> calls;
    for (int index = 0; index < settings_.recorded_per_ray; ++index) {
      calls.clear();
      Colorf value;
      {
        const CallRecording recording(calls);
        value = sample(i, index);
      }
      first_values_.push_back(value);
      note_sample(i, value, calls);
    }
  }

  void note_sample(std::size_t i, const Colorf& value, const std::vector<Call>& calls) {
    const Line& line = lines_[i];
    const std::size_t probe = evidence_.rays[i].probe;
    const LoadedProbe& loaded = probes_[probe];
    SampleEvidence noted{probe, i, value, {}};
    std::vector<Vec2f> placed_with, bsdf_numbers;
    bool has_numbers = false, is_shared = false, is_ray_due = false;
    for (const Call& call : calls) {
      if (std::holds_alternative<NumbersDrawn>(call)) has_numbers = true;
      if (const auto* point = std::get_if<PointSampled>(&call)) {
        const std::int32_t light = loaded.light_of_mesh[std::size_t(point->mesh)];
        if (light < 0 || !line.receiver.is_surface()) continue;
        noted.points.push_back(line.receiver.facts(point->mesh, point->position, point->ng));
        placed_with.push_back(point->u);
        PointsOfLight& points = evidence_.points[probe][std::size_t(light)];
        const auto cell = [](float u) {
          return std::clamp(int(u * PointsOfLight::cells), 0, PointsOfLight::cells - 1);
        };
        ++points.counts[std::size_t(cell(point->u.y) * PointsOfLight::cells + cell(point->u.x))];
        ++points.drawn;
        is_ray_due = true;
      }
      if (const auto* ray = std::get_if<RayCast>(&call); ray && is_ray_due) {
        note_shadow_ray(*ray, loaded, line, noted.points.back());
        is_ray_due = false;
      }
      if (const auto* asked = std::get_if<BsdfAsked>(&call); asked && asked->what == BsdfAsked::What::sample)
        bsdf_numbers.push_back(asked->u);
    }
    for (const Vec2f& u : placed_with)
      for (const Vec2f& other : bsdf_numbers) is_shared |= u.x == other.x || u.y == other.y;
    ++evidence_.samples_recorded;
    evidence_.bsdf_samples += !bsdf_numbers.empty();
    evidence_.numbers_shared_with_bsdf += is_shared;
    evidence_.without_numbers += !has_numbers && !noted.points.empty();
    for (LightPointFacts& point : noted.points) {
      point.choice_probability = 1 / double(loaded.light_areas.size());
      point.points_per_sample = double(noted.points.size());
    }
    evidence_.samples.push_back(std::move(noted));
  }

  void note_shadow_ray(const RayCast& ray, const LoadedProbe& loaded, const Line& line,
                       LightPointFacts& point) {
    const std::int32_t target = loaded.mesh_of_light[std::size_t(point.light)];
    const bool is_free = ray.mesh < 0 || (!ray.is_any_hit && ray.mesh == target);
    point.is_visible_to_student = is_free;
    if (point.cos_light <= 0 || point.cos_receiver <= 0) return;
    if (!point.is_visible) {
      evidence_.rays_to_hidden += is_free;
      return;
    }
    ++evidence_.rays_to_visible;
    if (is_free) return;
    const bool is_own = loaded.scene.getMeshes()[std::size_t(ray.mesh)] == line.receiver.mesh();
    ++(ray.mesh == target ? evidence_.ended_on_light
       : is_own           ? evidence_.ended_on_receiver
                          : evidence_.ended_elsewhere);
  }

  void take_samples(std::size_t i) {
    RayEvidence& ray = evidence_.rays[i];
    const double all = ray.expected.r + ray.expected.g + ray.expected.b;
    const double expected[3]{ray.expected.r, ray.expected.g, ray.expected.b};
    const std::size_t begin = i * std::size_t(settings_.recorded_per_ray);
    for (int index = 0; index < settings_.samples_per_ray; ++index) {
      const Colorf value =
          index < settings_.recorded_per_ray ? first_values_[begin + std::size_t(index)] : sample(i, index);
      ++evidence_.samples_in_all;
      if (!is_finite_color(value) || value.r < 0 || value.g < 0 || value.b < 0) {
        ++(is_finite_color(value) ? evidence_.negative : evidence_.invalid);
        if (evidence_.first_invalid.empty())
          evidence_.first_invalid = fmt::format("{}, ray {}: {:.4g}, {:.4g}, {:.4g}",
                                                probes_[ray.probe].probe.name, i, value.r, value.g, value.b);
        if (!is_finite_color(value)) continue;
      }
      const double channels[3]{value.r, value.g, value.b}, sum = channels[0] + channels[1] + channels[2];
      for (std::size_t c = 0; c < 3; ++c) {
        ray.channels[c].add(channels[c]);
        if (all > 0) ray.shares[c].add(channels[c] - expected[c] / all * sum);
      }
    }
  }

  /// Of the recorded samples of a ray, how many come out otherwise now. \param first where to begin
  std::int64_t differing(std::size_t i, int first) const {
    std::int64_t count = 0;
    const int samples = settings_.recorded_per_ray;
    for (int k = 0; k < samples; ++k) {
      const int index = (first + k) % samples;
      count += !is_same(sample(i, index), first_values_[i * std::size_t(samples) + std::size_t(index)]);
    }
    return count;
  }

  void compare_threads() {
    constexpr int threads = 4, rounds = 4;
    std::array<std::int64_t, threads> counts{};
    std::array<std::exception_ptr, threads> errors{};
    std::vector<std::thread> running;
    for (int thread = 0; thread < threads; ++thread)
      running.emplace_back([&, thread] {
        try {
          for (int round = 0; round < rounds; ++round)
            for (std::size_t i = 0; i < lines_.size(); ++i)
              counts[std::size_t(thread)] += differing(i, 17 * thread + 5 * round);
        } catch (...) {
          errors[std::size_t(thread)] = std::current_exception();
        }
      });
    for (std::thread& one : running) one.join();
    for (const std::exception_ptr& error : errors)
      if (error) std::rethrow_exception(error);
    for (const std::int64_t count : counts) evidence_.not_alike_in_threads += count;
    evidence_.repeated = std::int64_t(first_values_.size());
  }

  const ProbeSettings& settings_;
  std::deque<LoadedProbe> probes_;
  std::deque<StudentIntegrator> integrators_;
  std::deque<Line> lines_;
  std::vector<Colorf> first_values_;
  ProbeEvidence evidence_;
};

}  // namespace

ProbeEvidence gather_evidence(const StudentModule& module, const std::string& integrator,
                              const std::vector<Probe>& probes, const ProbeSettings& settings) {
  return Gathering(module, integrator, probes, settings).gather();
}

}  // namespace etendue
