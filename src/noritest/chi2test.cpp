// Pearson's chi-squared test of "samples of a BSDF or phase function follow its own density", over cells of
// the whole sphere.
//
// The rules are those of Nori's chi2test (W. Jakob): the cells, the number of samples and of directions, the
// pooling, the allowance of a cell that should be empty, and the level of the whole file with its Sidak
// correction. Samples of weight 0 are not counted, so the density may integrate to less than 1. The expected
// counts are integrated more exactly than there, by Gauss and Kronrod's rule instead of Simpson's: narrow
// lobes need it.
#include "base/frame.h"
#include "base/hash.h"
#include "bsdf/bsdf.h"
#include "medium/homogeneous.h"
#include "noritest/case_runner.h"
#include "noritest/random_squares.h"
#include "stats/chi_squared.h"
#include "stats/significance.h"

#include <algorithm>
#include <atomic>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <numeric>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

namespace etendue {

using Type = Parameter::Type;

const Plugin chi2test_plugin{
    "test",
    "chi2test",
    "Chi-squared tests of BSDFs and phase functions: do their samples follow their density?",
    {{"resolution", Type::integer, "10", "",
      "Rows of cells over the sphere; there are twice as many columns"},
     {"sampleCount", Type::integer, "-1", "", "Samples a direction; negative: 5000 a cell"},
     {"testCount", Type::integer, "5", "", "Random directions to the viewer for each"},
     {"minExpFrequency", Type::integer, "5", "", "Cells with fewer expected samples are pooled"},
     {"significanceLevel", Type::real, "0.01", "", "Of all cases of the file together"}},
    {"bsdf", "brdf", "phase"}};

namespace {

constexpr double pi_d = std::numbers::pi;
constexpr int quadrature_points = 15;              ///< Along each side of a cell, at first.
constexpr double allowance_of_empty_cells = 1e-5;  ///< Of the number of samples.
constexpr std::int64_t most_samples_of_case = std::int64_t{1} << 32;  ///< Sample numbers are 32-bit.

struct Chi2Rules {
  int rows, directions;
  std::int64_t sample_count, tests;
  double pooling_threshold, level;
  bool is_first_generation;  ///< Rows even in theta, directions cosine-weighted; else both even in cos theta.

  int columns() const { return 2 * rows; }
  std::size_t cells() const { return std::size_t(rows) * std::size_t(columns()); }
  /// cos theta at the lower end of a row.
  double row_begin(int row) const {
    return is_first_generation ? -std::cos(pi_d * row / rows) : -1 + 2.0 * row / rows;
  }
  std::size_t cell_of(const Vec3f& w) const {
    const double z = std::clamp(double(w.z), -1.0, 1.0);
    const double height = is_first_generation ? 1 - std::acos(z) / pi_d : 0.5 * z + 0.5;
    const double turn = std::atan2(double(w.y), double(w.x)) / (2 * pi_d);
    const int row = std::clamp(int(std::floor(height * rows)), 0, rows - 1);
    const int column =
        std::clamp(int(std::floor((turn < 0 ? turn + 1 : turn) * columns())), 0, columns() - 1);
    return std::size_t(row) * std::size_t(columns()) + std::size_t(column);
  }
};

int positive_integer(const Parameters& parameters, std::string_view name, int most) {
  const int value = parameters.integer(name);
  if (value < 1 || value > most)
    throw InputError(parameters.location(name),
                     fmt::format("'{}' is {}; it must be from 1 to {}", name, value, most));
  return value;
}

Chi2Rules rules_of(const TestRun& run, const Parameters& parameters) {
  Chi2Rules rules{};
  rules.rows = positive_integer(parameters, "resolution", 1000);
  rules.directions = positive_integer(parameters, "testCount", 1000000);
  rules.sample_count = parameters.integer("sampleCount");
  if (rules.sample_count < 0) rules.sample_count = 5000 * std::int64_t(rules.cells());
  if (rules.sample_count == 0)
    throw InputError(parameters.location("sampleCount"), "'sampleCount' is 0; nothing would be tested");
  if (rules.sample_count > most_samples_of_case)
    throw InputError(parameters.location("resolution"),
                     fmt::format("5000 samples for each of {} cells are more than the {} that can be drawn",
                                 rules.cells(), most_samples_of_case),
                     "state a 'sampleCount', or a lower 'resolution'");
  rules.pooling_threshold = parameters.integer("minExpFrequency");
  rules.level = parameters.real("significanceLevel");
  if (!(rules.level > 0 && rules.level < 1))
    throw InputError(parameters.location("significanceLevel"),
                     fmt::format("'significanceLevel' is {}; it must lie between 0 and 1", rules.level));
  rules.is_first_generation = run.test.dialect == Dialect::nori_2012;
  rules.tests = std::int64_t(run.test.root.children.size()) * rules.directions;
  return rules;
}

/// Above the surface; in a medium anywhere.
Vec3f random_viewer(const Chi2Rules& rules, const Vec2f& u, bool is_in_medium) {
  if (is_in_medium) return square_to_uniform_sphere(u);
  if (rules.is_first_generation) return square_to_cosine_hemisphere(u);
  const float sin_theta = std::sqrt(std::max(1 - u.x * u.x, 0.0f));
  return {sin_theta * std::cos(2 * pi * u.y), sin_theta * std::sin(2 * pi * u.y), u.x};
}

bool is_finite_direction(const Vec3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// A phase function for a viewer anywhere, though it samples in the frame of its ray.
struct FreePhase {
  HenyeyGreenstein phase;

  BsdfSample<float> sample(const Vec3f& wo, const Vec2f& u) const {
    BsdfSample<float> sample = phase.sample(Vec3f{0, 0, 1}, u);
    sample.wi_local = Frame<float>(wo).world_from_local(sample.wi_local);
    return sample;
  }
  float pdf_solid_angle(const Vec3f& wo, const Vec3f& wi) const { return phase.pdf_solid_angle(wo, wi); }
};

struct Observed {
  std::vector<double> counts;
  std::int64_t invalid_samples = 0;  ///< With a weight, direction or density that is not a number.
  double density_sum = 0;            ///< Over all samples, 1/sr.
};

template <class Model>
Observed observe(const Model& model, const Vec3f& wo, const Chi2Rules& rules, const TestSettings& settings,
                 std::uint64_t seed) {
  constexpr std::int64_t samples_a_task = 16384;
  const RandomSquares u_bsdf(settings.sampler, seed);
  std::atomic<bool> has_dirac{false};
  tbb::combinable<Observed> parts([&] { return Observed{std::vector<double>(rules.cells())}; });
  const auto run_task = [&](std::int64_t task) {
    throw_if_stopped(settings);
    Observed& part = parts.local();
    const std::int64_t end = std::min((task + 1) * samples_a_task, rules.sample_count);
    for (std::int64_t i = task * samples_a_task; i < end; ++i) {
      const BsdfSample<float> sample = model.sample(wo, u_bsdf[std::uint32_t(i)]);
      if (sample.weight == Colorf{0, 0, 0}) continue;
      if (std::isinf(sample.pdf_solid_angle)) has_dirac = true;
      const float sum = sample.weight.r + sample.weight.g + sample.weight.b + sample.pdf_solid_angle;
      if (std::isfinite(sum) && is_finite_direction(sample.wi_local)) {
        ++part.counts[rules.cell_of(sample.wi_local)];
        part.density_sum += sample.pdf_solid_angle;
      } else {
        ++part.invalid_samples;
      }
    }
  };
  tbb::parallel_for(std::int64_t{0}, (rules.sample_count + samples_a_task - 1) / samples_a_task, run_task);
  if (has_dirac)
    throw InputError(
        "it has a Dirac lobe (mirror reflection or refraction), whose density is infinite: a chi2test cannot "
        "test it\ntest its mean with a ttest instead");
  Observed all{std::vector<double>(rules.cells())};
  parts.combine_each([&](const Observed& part) {
    for (std::size_t c = 0; c < all.counts.size(); ++c) all.counts[c] += part.counts[c];
    all.invalid_samples += part.invalid_samples;
    all.density_sum += part.density_sum;
  });
  return all;
}

template <class Model>
std::vector<double> expect(const Model& model, const Vec3f& wo, const Chi2Rules& rules,
                           const TestSettings& settings) {
  // No end of an interval is evaluated, where a horizon would count as above and below.
  using Rule = boost::math::quadrature::gauss_kronrod<double, quadrature_points>;
  constexpr unsigned most_halvings = 6;
  constexpr double tolerance = 1e-5;
  std::vector<double> counts(rules.cells());
  tbb::parallel_for(std::size_t{0}, counts.size(), [&](std::size_t cell) {
    throw_if_stopped(settings);
    const int row = int(cell) / rules.columns(), column = int(cell) % rules.columns();
    const double width = 2 * pi_d / rules.columns();
    const auto over_row = [&](double z) {
      const double sin_theta = std::sqrt(std::max(1 - z * z, 0.0));
      const auto density = [&](double phi) {
        const Vec3f wi{float(sin_theta * std::cos(phi)), float(sin_theta * std::sin(phi)), float(z)};
        return double(model.pdf_solid_angle(wo, wi));
      };
      return Rule::integrate(density, column * width, (column + 1) * width, most_halvings, tolerance);
    };
    counts[cell] =
        double(rules.sample_count) *
        Rule::integrate(over_row, rules.row_begin(row), rules.row_begin(row + 1), most_halvings, tolerance);
  });
  return counts;
}

/// Throws where samples lie so close together that they are in a single cell, or that the quadrature's points
/// may have missed their lobe and the density's integral lacks them: that says nothing about the density.
void require_resolved(const CaseResult& result, const Observed& observed, const std::vector<double>& expected,
                      const Chi2Rules& rules) {
  const double count = std::accumulate(observed.counts.begin(), observed.counts.end(), 0.0);
  const double integral = std::accumulate(expected.begin(), expected.end(), 0.0);
  const bool is_unresolved = std::isnan(result.p_value) || integral < count - 5 * std::sqrt(count);
  const double lobe_sr = count / observed.density_sum;
  const double resolved_sr = 4 * pi_d / double(rules.cells()) / (quadrature_points * quadrature_points);
  if (is_unresolved && lobe_sr < resolved_sr)
    throw InputError(
        fmt::format("its lobe of about {:.2g} sr is too narrow for a chi2test with {} rows of cells, which "
                    "may miss what is "
                    "narrower than {:.2g} sr\n"
                    "raise 'resolution', or test its mean with a ttest",
                    lobe_sr, rules.rows, resolved_sr));
}

void judge_counts(CaseResult& result, const Observed& observed, const std::vector<double>& expected,
                  const Chi2Rules& rules) {
  const ChiSquaredTest test =
      chi_squared_test(observed.counts, expected,
                       {.pooling_threshold = rules.pooling_threshold,
                        .most_in_empty_cell = allowance_of_empty_cells * double(rules.sample_count)});
  result.statistic = test.statistic;
  result.p_value = test.p_value;
  if (observed.invalid_samples > 0)
    result.problem =
        fmt::format("{} of {} samples are not finite", observed.invalid_samples, rules.sample_count);
  else if (test.wrong_empty_cell >= 0)
    result.problem = fmt::format("{} samples in a cell where the density is 0",
                                 observed.counts[std::size_t(test.wrong_empty_cell)]);
  else if (std::isnan(test.p_value))
    result.problem = "the density is not finite, negative, or in fewer than two cells";
  result.is_passed = result.problem.empty() && !is_rejected(result.p_value, rules.level, rules.tests);
  if (!result.is_passed && observed.invalid_samples == 0) require_resolved(result, observed, expected, rules);
}

}  // namespace

void run_chi2test(TestRun& run) {
  std::vector<UnreadKey> unread;
  const Parameters parameters(run.test.root, chi2test_plugin, unread);
  run.warn(unread);
  const Chi2Rules rules = rules_of(run, parameters);
  if (run.test.root.children.empty())
    throw InputError(run.test.root.location, "this test has nothing to test",
                     "put <bsdf> or <phase> elements into a chi2test");
  std::uint64_t number = 0;
  for (const Object& subject : run.test.root.children) {
    const bool is_phase = subject.family == "phase";
    for (int direction = 0; direction < rules.directions; ++direction) {
      const std::uint64_t seed = hash64(hash64(run.settings.seed) + number++);
      CaseResult result{.kind = "chi2test",
                        .subject = is_phase ? "phase" : "bsdf",
                        .type = subject.type,
                        .detail = fmt::format("direction {}", direction + 1)};
      run.run_case(result, [&](CaseResult& measured) {
        std::vector<UnreadKey> unread_of_subject;
        const Vec3f wo =
            random_viewer(rules, RandomSquares(SamplerKind::independent, hash64(seed))[0], is_phase);
        const auto test = [&](const auto& model) {
          if (direction == 0) run.warn(unread_of_subject);
          judge_counts(measured, observe(model, wo, rules, run.settings, seed),
                       expect(model, wo, rules, run.settings), rules);
        };
        if (is_phase) return test(FreePhase{make_phase(subject, unread_of_subject)});
        TextureFiles textures{run.test.directory};
        const Material material = make_material(subject, textures, unread_of_subject);
        std::visit([&](const auto& model) { test(model.at(Vec2f{0, 0}, true)); }, material);
      });
    }
  }
}

}  // namespace etendue
