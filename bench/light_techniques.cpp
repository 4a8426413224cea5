// Convex polygons by solid angle and projected solid angle, in floats, against extended precision: how far
// the measures are off over many random polygons and receivers of all troublesome sorts. Exit 1 where a bound
// of docs/light_sampling.md does not hold.

#include "light/polygon_table.h"
#include "light/projected_polygon.h"
#include "light/spherical_polygon.h"
#include "polygon_cases.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <thread>
#include <vector>

namespace {

using namespace etendue;

// Of the relative errors, for places rounded to 2^-24: times PolygonCase::condition().
constexpr double solid_angle_bound = 2e-6, projected_bound = 3e-4;

/// The errors of one kind of polygons and receivers.
struct Errors {
  long seen = 0;                           ///< Whose polygon has an area, and faces the receiver.
  double most = 0, most_by_condition = 0;  ///< Of the solid angle, relative.
  double most_of_well_conditioned = 0;     ///< With a condition below 1000.
  long above_horizon = 0, accurate = 0;    ///< Of the projected one.
  long projected_above_1e_4 = 0;
  double most_projected_by_condition = 0, most_projected_of_well_conditioned = 0;

  void add(const PolygonCase& c) {
    const Outline outline = c.outline();
    long double area = 0;
    for (std::size_t k = 2; k < outline.size(); ++k)
      area += length(cross(outline[k - 1] - outline[0], outline[k] - outline[0]));
    if (!(area > 1e-10L)) return;
    PolygonTable table;
    const PolygonFan<float> fan = table.seen_from<float>(c.position, table.add(c.corners), true);
    const auto exact = double(solid_angle(outline));
    if (!(fan.height > 0) || !(exact > 0)) return;
    ++seen;
    const double condition = c.condition();
    const bool is_well_conditioned = condition < 1000;
    const double error = std::abs(SphericalPolygon<float>(fan).solid_angle() / exact - 1);
    most = std::max(most, error);
    most_by_condition = std::max(most_by_condition, error / condition);
    if (is_well_conditioned) most_of_well_conditioned = std::max(most_of_well_conditioned, error);

    const auto exact_projected = double(projected_solid_angle(outline, extended(c.ns)));
    if (!(exact_projected > 1e-14)) return;
    ++above_horizon;
    const ProjectedPolygon<float> projected(fan, Frame<float>(c.ns));
    if (!projected.is_accurate()) return;
    ++accurate;
    const double projected_error = std::abs(projected.projected_solid_angle() / exact_projected - 1);
    projected_above_1e_4 += projected_error > 1e-4;
    most_projected_by_condition = std::max(most_projected_by_condition, projected_error / condition);
    if (is_well_conditioned)
      most_projected_of_well_conditioned = std::max(most_projected_of_well_conditioned, projected_error);
  }

  void add(const Errors& other) {
    seen += other.seen;
    most = std::max(most, other.most);
    most_by_condition = std::max(most_by_condition, other.most_by_condition);
    most_of_well_conditioned = std::max(most_of_well_conditioned, other.most_of_well_conditioned);
    above_horizon += other.above_horizon;
    accurate += other.accurate;
    projected_above_1e_4 += other.projected_above_1e_4;
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

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Float measures of polygons against extended precision.");
  long count = 12'000'000;
  int threads = int(std::thread::hardware_concurrency());
  app.add_option("--count", count, "Polygons of each kind")->capture_default_str();
  app.add_option("--threads", threads, "How many")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  bool holds = true;
  fmt::print(
      "kind        seen     | solid angle: most, by condition, condition < 1000 | projected: accurate, off "
      "by "
      "> 1e-4, by condition, condition < 1000\n");
  for (std::size_t kind = 0; kind < polygon_case_kinds.size(); ++kind) {
    const Errors e = errors_of(kind, count, threads);
    fmt::print("{:<10} {:9} | {:.1e} {:.1e} {:.1e} | {:.3f} {:.1e} {:.1e} {:.1e}\n", polygon_case_kinds[kind],
               e.seen, e.most, e.most_by_condition, e.most_of_well_conditioned,
               double(e.accurate) / double(e.above_horizon),
               double(e.projected_above_1e_4) / double(e.accurate), e.most_projected_by_condition,
               e.most_projected_of_well_conditioned);
    std::fflush(stdout);
    holds =
        holds && e.most_by_condition < solid_angle_bound && e.most_projected_by_condition < projected_bound;
  }
  return holds ? 0 : 1;
}
