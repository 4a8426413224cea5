// Light sampling by solid angle and projected solid angle, in floats, against extended precision: how far the
// measures of convex polygons are off, and the densities of disks and spheres, over many random ones and
// receivers of all troublesome sorts. Exit 1 where a bound of docs/light_sampling.md does not hold.

#include "disk_cases.h"
#include "light/light.h"
#include "light/polygon_table.h"
#include "light/projected_cap.h"
#include "light/projected_polygon.h"
#include "light/spherical_ellipse.h"
#include "light/spherical_polygon.h"
#include "polygon_cases.h"

#include <CLI/CLI.hpp>
#include <array>
#include <fmt/format.h>
#include <random>
#include <thread>
#include <vector>

namespace {

using namespace etendue;

// Of the relative errors, for places rounded to 2^-24: times PolygonCase::condition().
constexpr double solid_angle_bound = 2e-6, projected_bound = 3e-4;
// Means over 64 points, and of the densities themselves.
constexpr double disk_mean_bound = 3e-3, disk_deviation_bound = 0.03, sphere_bound = 2e-4,
                 cut_sphere_bound = 0.03;

/// Relative errors, by their size: a tenth of a decade apart.
class Spread {
 public:
  void add(double error) {
    most_ = std::max(most_, error);
    const double place = 10 * (std::log10(std::max(error, 1e-12)) + 12);
    ++counts_[std::size_t(std::clamp(place, 0.0, double(counts_.size() - 1)))];
  }
  void add(const Spread& other) {
    most_ = std::max(most_, other.most_);
    for (std::size_t k = 0; k < counts_.size(); ++k) counts_[k] += other.counts_[k];
  }
  double most() const { return most_; }
  /// Which all but one in a thousand are below.
  double common() const {
    long all = 0, above = 0;
    for (const long count : counts_) all += count;
    std::size_t k = counts_.size();
    while (k > 0 && (above + counts_[k - 1]) * 1000 <= all) above += counts_[--k];
    return std::min(most_, std::pow(10, double(k) / 10 - 12));
  }

 private:
  double most_ = 0;
  std::array<long, 140> counts_{};
};

/// The errors of one kind of polygons and receivers.
struct Errors {
  long seen = 0;       ///< Whose polygon has an area, and faces the receiver.
  Spread solid_angle;  ///< Relative errors.
  double most_by_condition = 0;
  double most_of_well_conditioned = 0;  ///< With a condition below 1000.
  Spread projected;
  long above_horizon = 0, accurate = 0;
  double most_projected_by_condition = 0, most_projected_of_well_conditioned = 0;

  void add(const PolygonCase& c) {
    const Outline outline = c.outline();
    long double area = 0;
    for (std::size_t k = 2; k < outline.size(); ++k)
      area += length(cross(outline[k - 1] - outline[0], outline[k] - outline[0]));
    if (!(area > 1e-10L)) return;
    PolygonTable table;
    const PolygonFan<float> fan = table.seen_from<float>(c.position, table.add(c.corners), true);
    const auto exact = double(etendue::solid_angle(outline));
    if (!(fan.height > 0) || !(exact > 0)) return;
    ++seen;
    const double condition = c.condition();
    const bool is_well_conditioned = condition < 1000;
    const double error = std::abs(SphericalPolygon<float>(fan).solid_angle() / exact - 1);
    solid_angle.add(error);
    most_by_condition = std::max(most_by_condition, error / condition);
    if (is_well_conditioned) most_of_well_conditioned = std::max(most_of_well_conditioned, error);

    const auto exact_projected = double(projected_solid_angle(outline, extended(c.ns)));
    if (!(exact_projected > 1e-14)) return;
    ++above_horizon;
    const ProjectedPolygon<float> polygon(fan, Frame<float>(c.ns));
    if (!polygon.is_accurate()) return;
    ++accurate;
    const double projected_error = std::abs(polygon.projected_solid_angle() / exact_projected - 1);
    projected.add(projected_error);
    most_projected_by_condition = std::max(most_projected_by_condition, projected_error / condition);
    if (is_well_conditioned)
      most_projected_of_well_conditioned = std::max(most_projected_of_well_conditioned, projected_error);
  }

  void add(const Errors& other) {
    seen += other.seen;
    solid_angle.add(other.solid_angle);
    most_by_condition = std::max(most_by_condition, other.most_by_condition);
    most_of_well_conditioned = std::max(most_of_well_conditioned, other.most_of_well_conditioned);
    above_horizon += other.above_horizon;
    accurate += other.accurate;
    projected.add(other.projected);
    most_projected_by_condition = std::max(most_projected_by_condition, other.most_projected_by_condition);
    most_projected_of_well_conditioned =
        std::max(most_projected_of_well_conditioned, other.most_projected_of_well_conditioned);
  }
};

Errors errors_of(std::size_t kind, long count, int threads) {
  std::vector<Errors> parts(static_cast<std::size_t>(threads));
  std::vector<std::thread> workers;
  for (int t = 0; t < threads; ++t)
    workers.emplace_back([&, t] {
      PolygonCases cases(unsigned(1000 * kind) + unsigned(t));
      for (long i = t; i < count; i += threads) parts[std::size_t(t)].add(cases.next(kind));
    });
  for (std::thread& worker : workers) worker.join();
  Errors all;
  for (const Errors& part : parts) all.add(part);
  return all;
}

/// A point of the middle of each cell of an 8 x 8 grid over the unit square.
std::array<Vec2f, 64> grid() {
  std::array<Vec2f, 64> points;
  for (std::size_t k = 0; k < points.size(); ++k)
    points[k] = {(float(k % 8) + 0.5f) / 8, (float(k / 8) + 0.5f) / 8};
  return points;
}

/// Of disks and ellipses: the inverse of the density over the solid angle of an outline, which is 1 on
/// average, at 64 points.
bool check_disks(std::size_t kind, long count) {
  DiskCases cases(41);
  Spread mean_error, deviation;
  for (long i = 0; i < count; ++i) {
    const DiskCase c = cases.next(kind);
    Lights lights;
    lights.add<DiskLights>({1, 1, 1}, "disk", c.disk);
    const Receiver<float> receiver{c.position, c.ns, c.ns, lit_side::front};
    const auto exact = double(etendue::solid_angle(c.outline()));
    double sum = 0, most = 0;
    bool is_seen = exact > 0 && c.condition() < 1e5;
    for (const Vec2f& u : grid()) {
      const LightSample<float> sample =
          lights.sample<float>(0, 1, receiver, {std::uint32_t(u.x * 0x1p32f), std::uint32_t(u.y * 0x1p32f)},
                               true, whole_light, LightTechnique::solid_angle);
      is_seen = is_seen && sample.is_there;
      const double over_uniform = 1 / (sample.pdf_solid_angle * exact);
      sum += over_uniform;
      most = std::max(most, std::abs(over_uniform - 1));
    }
    if (!is_seen) continue;
    mean_error.add(std::abs(sum / 64 - 1));
    deviation.add(most);
  }
  fmt::print("{:<12} {:8} | {:.1e} {:.1e} | {:.1e} {:.1e}\n", disk_case_kinds[kind], count, mean_error.most(),
             mean_error.common(), deviation.most(), deviation.common());
  return mean_error.most() < disk_mean_bound && deviation.most() < disk_deviation_bound;
}

/// Of spheres by the cosine: the cosine over the density, on average over 64 points, against what the sphere
/// sends to an element (Howell's catalogue). \param is_cut by the horizon
bool check_spheres(bool is_cut, long count) {
  std::mt19937_64 random(43);
  const auto unit = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  Spread error, deviation;
  for (long i = 0; i < count; ++i) {
    const double radius = std::asin(std::pow(10, -(is_cut ? 2.5 : 5) * unit()));
    const double height =
        is_cut ? radius * (1.9 * unit() - 0.9) : radius + (std::numbers::pi / 2 - radius) * unit();
    const double turn = 2 * std::numbers::pi * unit();
    const Vec3f axis{float(std::cos(height) * std::cos(turn)), float(std::cos(height) * std::sin(turn)),
                     float(std::sin(height))};
    const CapOverHorizon<float> over_horizon(axis, float(std::pow(std::sin(radius), 2)), {0, 0, 1});
    const ProjectedCap<float> cap(over_horizon);
    if (!cap.is_accurate()) continue;
    const double h = 1 / std::sin(radius), b = std::numbers::pi / 2 - height;
    double exact = std::numbers::pi * std::cos(b) / (h * h);
    if (is_cut) {
      const double x = std::sqrt(h * h - 1), y = std::clamp(-x / std::tan(b), -1.0, 1.0),
                   root = std::sqrt(1 - y * y);
      exact =
          (std::cos(b) * std::acos(y) - x * std::sin(b) * root) / (h * h) + std::atan2(std::sin(b) * root, x);
    }
    double sum = 0, most = 0;
    for (const Vec2f& u : grid()) {
      float pdf;
      const CapDirection<float> direction = cap.sample(u, pdf);
      sum += direction.cos_theta / pdf;
      most = std::max(most, std::abs(direction.cos_theta / (pdf * exact) - 1));
    }
    error.add(std::abs(sum / 64 / exact - 1));
    deviation.add(most);
  }
  fmt::print("{:<12} {:8} | {:.1e} {:.1e} | {:.1e} {:.1e}\n", is_cut ? "cut" : "whole", count, error.most(),
             error.common(), deviation.most(), deviation.common());
  return error.most() < (is_cut ? cut_sphere_bound : sphere_bound);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Float measures and densities of light sampling against extended precision.");
  long count = 12'000'000;
  long few = 100'000;
  int threads = int(std::thread::hardware_concurrency());
  app.add_option("--count", count, "Polygons of each kind")->capture_default_str();
  app.add_option("--few", few, "Disks of each kind, and spheres")->capture_default_str();
  app.add_option("--threads", threads, "How many")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  bool holds = true;
  fmt::print(
      "polygons        seen | solid angle: most, 99.9 %, by condition, condition < 1000 | projected: "
      "accurate, "
      "most, 99.9 %, by condition, condition < 1000\n");
  for (std::size_t kind = 0; kind < polygon_case_kinds.size(); ++kind) {
    const Errors e = errors_of(kind, count, threads);
    fmt::print("{:<10} {:9} | {:.1e} {:.1e} {:.1e} {:.1e} | {:.3f} {:.1e} {:.1e} {:.1e} {:.1e}\n",
               polygon_case_kinds[kind], e.seen, e.solid_angle.most(), e.solid_angle.common(),
               e.most_by_condition, e.most_of_well_conditioned, double(e.accurate) / double(e.above_horizon),
               e.projected.most(), e.projected.common(), e.most_projected_by_condition,
               e.most_projected_of_well_conditioned);
    std::fflush(stdout);
    holds =
        holds && e.most_by_condition < solid_angle_bound && e.most_projected_by_condition < projected_bound;
  }
  fmt::print("disks                 | mean of 64: most, 99.9 % | density from uniform: most, 99.9 %\n");
  for (std::size_t kind = 0; kind < disk_case_kinds.size(); ++kind) holds = check_disks(kind, few) && holds;
  fmt::print("spheres               | mean of 64: most, 99.9 % | density from the cosine: most, 99.9 %\n");
  for (const bool is_cut : {false, true}) holds = check_spheres(is_cut, few) && holds;
  return holds ? 0 : 1;
}
