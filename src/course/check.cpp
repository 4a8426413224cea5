#include "course/check.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using nlohmann::json;

/// The first samples of each ray, as a plot wants them: what came over what is right.
json points_of(const IntegratorCheck& check) {
  constexpr int most_of_a_probe = 120;
  const auto sum = [](const Colorf& c) { return double(c.r) + c.g + c.b; };
  std::vector<int> rays(check.probes.size()), counts(check.evidence.rays.size());
  for (const RayEvidence& ray : check.evidence.rays) ++rays[ray.probe];
  json points = json::array();
  for (const SampleEvidence& sample : check.evidence.samples) {
    const double right = sum(predicted(sample, {})), found = sum(sample.value);
    const double explained = sum(predicted(sample, check.diagnosis.fit));
    if (sample.points.empty() || check.evidence.rays[sample.ray].is_light || !std::isfinite(found) ||
        (right == 0 && found == 0) || counts[sample.ray] >= most_of_a_probe / rays[sample.probe])
      continue;
    ++counts[sample.ray];
    points.push_back({{"probe", sample.probe},
                      {"light", sample.points[0].light},
                      {"found", found},
                      {"right", right},
                      {"explained", explained}});
  }
  return points;
}

json rays_of(const IntegratorCheck& check) {
  json rays = json::array();
  for (const RayEvidence& ray : check.evidence.rays) {
    json means = json::array(), errors = json::array();
    for (const RunningStatistics& channel : ray.channels) {
      means.push_back(channel.mean);
      errors.push_back(channel.standard_error());
    }
    rays.push_back({{"probe", check.probes[ray.probe].name},
                    {"mean", means},
                    {"error", errors},
                    {"expected", {ray.expected.r, ray.expected.g, ray.expected.b}}});
  }
  return rays;
}

}  // namespace

bool IntegratorCheck::is_right() const {
  return std::ranges::none_of(
      properties, [](const CheckedProperty& one) { return one.verdict == PropertyVerdict::wrong; });
}

IntegratorCheck check_module(const std::filesystem::path& module_file, const CheckSettings& settings) {
  const StudentModule module(module_file);
  IntegratorCheck check;
  check.probes = make_probes(settings.probe_seed);
  check.evidence = gather_evidence(module, settings.integrator, check.probes,
                                   {.seed = settings.seed, .folder = settings.folder, .at = settings.at});
  check.properties = properties_of(check.evidence);
  for (const std::filesystem::path& scene : settings.scenes) {
    settings.at("scene " + scene.stem().string());
    check.scenes.push_back(
        check_scene(module, settings.integrator, scene, settings.seed, int(settings.scenes.size())));
    check.properties.push_back(check.scenes.back().property);
  }
  settings.at("diagnosis");
  check.diagnosis = diagnose(check.evidence, !check.is_right());
  return check;
}

json to_json(const IntegratorCheck& check) {
  json properties = json::array();
  for (const CheckedProperty& one : check.properties)
    properties.push_back({{"name", one.name},
                          {"verdict", verdict_name(one.verdict)},
                          {"what", one.what},
                          {"tests", one.tests},
                          {"p_value", one.p_value}});
  const Diagnosis& diagnosis = check.diagnosis;
  json findings = json::array();
  for (const FoundMistake& one : diagnosis.findings) {
    const MistakeText& text = text_of(one.mistake);
    findings.push_back({{"class", int(one.mistake)},
                        {"name", text.name},
                        {"what", text.what},
                        {"how", one.how},
                        {"evidence", one.evidence},
                        {"read", text.read}});
  }
  json probes = json::array();
  const std::vector<bool> wrong = wrong_probes(check.evidence);
  for (std::size_t i = 0; i < wrong.size(); ++i)
    probes.push_back(
        {{"name", check.probes[i].name}, {"what", check.probes[i].what}, {"is_right", !wrong[i]}});
  return {{"is_right", check.is_right()},
          {"level", level_of_probes + level_of_scenes},
          {"properties", properties},
          {"diagnosis",
           {{"findings", findings},
            {"is_unknown", diagnosis.is_unknown},
            {"samples_compared", diagnosis.samples_compared},
            {"samples_wrong", diagnosis.samples_wrong},
            {"share_explained", diagnosis.share_explained},
            {"runner_up", diagnosis.runner_up},
            {"share_runner_up", diagnosis.share_runner_up}}},
          {"probes", probes},
          {"rays", rays_of(check)},
          {"points", points_of(check)}};
}

}  // namespace etendue
