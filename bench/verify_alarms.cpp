// How often `etendue verify` says that the estimators of a correct scene differ, over many seeds.
// docs/verify.md has the figures.

#include "generated_scenes.h"
#include "scenefile/nori_xml.h"
#include "verify/verify.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <vector>

namespace {

using namespace etendue;

std::string_view kind_name(Region::Kind kind) {
  constexpr std::string_view names[]{"whole image", "material", "block", "pixel"};
  return names[std::size_t(kind)];
}

struct Options {
  std::vector<std::string> scenes, integrators;
  int width = 64, samples = 32, seeds = 1000, first_seed = 0;
};

void count_alarms(const std::string& file, const Options& options) {
  LoadedScene loaded = load_scene(read_nori_xml(file));
  Scene& scene = loaded.scene;
  bench::shrink(scene.camera, options.width);
  std::vector<UnreadKey> unread;
  const Estimators estimators =
      options.integrators.empty()
          ? estimators_of(scene, make_integrator(loaded.integrator, Dialect::nori_2012, unread))
          : estimators_named(scene, options.integrators);
  VerifySettings settings{.samples_per_pixel = options.samples, .isa = available_isas().back()};
  int alarms = 0, cannot_tell = 0;
  std::vector<double> p_values;
  for (int k = 0; k < options.seeds; ++k) {
    settings.seed = std::uint64_t(options.first_seed + k);
    const VerifyResult result = verify(scene, estimators, settings);
    double least = 1;
    for (const VerifiedPair& pair : result.pairs) {
      cannot_tell += pair.verdict == Verdict::cannot_tell;
      least = std::min(least, pair.p_value);
      if (pair.verdict != Verdict::differ) continue;
      const Difference& strongest = pair.comparison.strongest;
      fmt::print(
          "  seed {}: {} | {}: p {:.2g}, {} {} {}, {:.1f} standard errors, {:.0f} degrees of freedom\n",
          settings.seed, result.estimators[pair.a].estimator.name, result.estimators[pair.b].estimator.name,
          pair.p_value, kind_name(strongest.region.kind), strongest.region.x, strongest.region.y,
          strongest.test.statistic, strongest.test.degrees_of_freedom);
    }
    p_values.push_back(least);
    alarms += result.verdict == Verdict::differ;
    std::fflush(stdout);
  }
  const auto below = [&](double level) {
    return std::count_if(p_values.begin(), p_values.end(), [&](double p) { return p < level; });
  };
  const double pairs = double(estimators.all.size() * (estimators.all.size() - 1) / 2);
  fmt::print(
      "{}, {} x {}, {} estimators, {} samples: {} alarms in {} seeds; least p below 0.5: {}, 0.1: {}, 0.01: "
      "{}; "
      "{:.1f} % of pairs cannot tell\n",
      file, scene.camera.width_px, scene.camera.height_px, estimators.all.size(), options.samples, alarms,
      options.seeds, below(0.5), below(0.1), below(0.01), 100 * cannot_tell / pairs / options.seeds);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"How often `etendue verify` raises an alarm on scenes that are right"};
  Options options;
  app.add_option("SCENE", options.scenes, "Scene files")->required();
  app.add_option("--integrators", options.integrators, "Instead of all that apply")->delimiter(',');
  app.add_option("--width", options.width, "Pixels")->capture_default_str();
  app.add_option("--spp", options.samples, "Samples a pixel")->capture_default_str();
  app.add_option("--seeds", options.seeds, "How many")->capture_default_str();
  app.add_option("--first-seed", options.first_seed)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  for (const std::string& scene : options.scenes) count_alarms(scene, options);
  return 0;
}
