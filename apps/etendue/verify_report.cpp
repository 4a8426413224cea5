#include "verify_report.h"

#include "image/image_file.h"
#include "messages.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue::app {

namespace {

using Json = nlohmann::ordered_json;

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::agree:
      return "agree";
    case Verdict::differ:
      return "differ";
    case Verdict::cannot_tell:
      break;
  }
  return "cannot tell";
}

std::string power_of_ten(double p) { return p < 1e-300 ? "< 1e-300" : fmt::format("{:.1g}", p); }

/// The pair that differs most; of those that agree, the one with the least p.
const VerifiedPair* most_telling(const VerifyResult& result) {
  const auto found = std::min_element(
      result.pairs.begin(), result.pairs.end(),
      [](const auto& a, const auto& b) { return a.comparison.p_value < b.comparison.p_value; });
  return found == result.pairs.end() ? nullptr : &*found;
}

/// "mesh 'floor' and 2 more".
std::string shapes_of_material(const Scene& scene, const ScenePlaces& places, std::int32_t material) {
  std::string first;
  int more = -1;
  for (std::size_t g = 0; g < scene.geometry.material.size(); ++g)
    if (scene.geometry.material[g] == material && more++ < 0) first = places.shapes[g].name;
  return more > 0 ? fmt::format("{} and {} more of its material", first, more) : first;
}

std::string region_text(const Region& region, const Scene& scene, const ScenePlaces& places) {
  const std::string_view weighted = region.is_weighted ? ", by where it is known best" : "";
  switch (region.kind) {
    case Region::Kind::whole:
      return fmt::format("over the whole image{}", weighted);
    case Region::Kind::material:
      return fmt::format("on {}{}", shapes_of_material(scene, places, region.material), weighted);
    case Region::Kind::block:
      return fmt::format("in the block of pixels from {}, {}", region.x, region.y);
    case Region::Kind::pixel:
      break;
  }
  return fmt::format("in the pixel {}, {}", region.x, region.y);
}

std::string estimator_verdict(const VerifiedEstimator& estimator, const VerifyResult& result, std::size_t k) {
  int differs = 0, others = 0;
  for (const VerifiedPair& pair : result.pairs)
    if (pair.a == k || pair.b == k) ++others, differs += pair.verdict == Verdict::differ;
  if (estimator.is_odd || (differs > 0 && others == 1))
    return fmt::format("DIFFERS from {} of {}", differs, others);
  if (!estimator.can_tell) return "cannot tell: too noisy";
  return "agrees";
}

std::string pair_text(const VerifyResult& result, const VerifiedPair& pair, const Scene& scene,
                      const ScenePlaces& places) {
  const Comparison& c = pair.comparison;
  const bool is_b_odd = result.estimators[pair.b].is_odd && !result.estimators[pair.a].is_odd;
  const std::string &odd = result.estimators[is_b_odd ? pair.b : pair.a].estimator.name,
                    &other = result.estimators[is_b_odd ? pair.a : pair.b].estimator.name;
  const double ratio = is_b_odd ? 1 / c.ratio : c.ratio, low = is_b_odd ? 1 / c.ratio_high : c.ratio_low,
               high = is_b_odd ? 1 / c.ratio_low : c.ratio_high;
  std::string text = fmt::format(
      "{} differs from {}:\n  {:.4g} times its mean (95 %: {:.4g} to {:.4g})\n"
      "  most surely {}: {:.4g} times (p {})\n",
      odd, other, ratio, low, high, region_text(c.strongest.region, scene, places),
      is_b_odd ? 1 / c.strongest.ratio : c.strongest.ratio, power_of_ten(pair.p_value));
  text += fmt::format("  worst block of {} x {} pixels: from {}, {}, {:+.1f} standard errors\n", block_side,
                      block_side, c.worst_block.region.x, c.worst_block.region.y,
                      (is_b_odd ? -1 : 1) * c.worst_block.test.statistic);
  for (const LightDifference& light : pair.lights)
    text += fmt::format("  by the light of {}: {:.4g} times\n", scene.lights.name(light.light),
                        is_b_odd ? 1 / light.ratio : light.ratio);
  return text;
}

}  // namespace

std::string report_text(const VerifyResult& result, const Scene& scene, const ScenePlaces& places) {
  std::size_t width = 9;
  for (const VerifiedEstimator& e : result.estimators) width = std::max(width, e.estimator.name.size());
  std::string text = fmt::format("{:<{}}  {:>7}  {:>21}  {:>7}  verdict\n", "estimator", width, "samples",
                                 "mean radiance", "found");
  for (std::size_t k = 0; k < result.estimators.size(); ++k) {
    const VerifiedEstimator& e = result.estimators[k];
    text += fmt::format("{:<{}}  {:>7}  {:>10.5g} +- {:>7.2g}  {:>7}  {}\n", e.estimator.name, width,
                        e.samples_per_pixel, e.mean, e.standard_error, percent_text(e.smallest_difference),
                        estimator_verdict(e, result, k));
    if (e.invalid_samples > 0)
      text += fmt::format("{:<{}}  {} samples were not a number, infinite or negative\n", "", width,
                          e.invalid_samples);
  }
  for (const LeftOutEstimator& left_out : result.left_out)
    text += fmt::format("{:<{}}  left out: {}\n", left_out.name, width, left_out.reason);
  text += "found: the smallest difference of its mean that would have been, 9 times in 10\n\n";
  // Each odd one against the estimator that tells most.
  for (std::size_t k = 0; k < result.estimators.size(); ++k) {
    const VerifiedPair* strongest = nullptr;
    for (const VerifiedPair& pair : result.pairs)
      if (result.estimators[k].is_odd && pair.verdict == Verdict::differ && (pair.a == k || pair.b == k) &&
          (!strongest || pair.comparison.p_value < strongest->comparison.p_value))
        strongest = &pair;
    if (strongest) text += pair_text(result, *strongest, scene, places);
  }
  const bool has_odd = std::any_of(result.estimators.begin(), result.estimators.end(),
                                   [](const VerifiedEstimator& e) { return e.is_odd; });
  if (result.verdict == Verdict::differ && !has_odd)
    text += pair_text(result, *most_telling(result), scene, places) +
            "  which of the two is wrong, one pair cannot tell\n";
  if (!result.foreign_noise.empty())
    text +=
        fmt::format("the noise of {} is {}\n", result.estimators.back().estimator.name, result.foreign_noise);
  if (!result.foreign_hint.empty()) text += fmt::format("  {}\n", result.foreign_hint);
  if (result.foreign_pixels_left_out > 0)
    text +=
        fmt::format("  {} of its pixels are left out: not numbers, or as white as a file of 8 bits can be\n",
                    result.foreign_pixels_left_out);
  if (result.mishap) text += fmt::format("most of it would be explained if {}\n", *result.mishap);
  switch (result.verdict) {
    case Verdict::agree:
      text += fmt::format(
          "AGREE: between the two that tell most a difference of {} of the mean would have been found\n",
          percent_text(result.smallest_difference));
      break;
    case Verdict::differ:
      text += fmt::format("DIFFER, at a level of {:g} for the whole run\n", result.level);
      break;
    case Verdict::cannot_tell:
      text += "CANNOT TELL: too much noise, or too few estimators; give it more time or samples\n";
      break;
  }
  return text;
}

nlohmann::ordered_json report_json(const VerifyResult& result, const Scene& scene,
                                   const std::string& scene_file) {
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  Json json;
  json["scene"] = scene_file;
  json["agree"] = result.verdict == Verdict::cannot_tell ? Json() : Json(result.verdict == Verdict::agree);
  json["level"] = result.level;
  json["estimators"] = Json::array();
  for (const VerifiedEstimator& e : result.estimators)
    json["estimators"].push_back({{"name", e.estimator.name},
                                  {"samples_per_pixel", e.samples_per_pixel},
                                  {"mean", e.mean},
                                  {"stderr", e.standard_error},
                                  {"seconds", e.seconds},
                                  {"invalid_samples", e.invalid_samples},
                                  {"smallest_difference", number(e.smallest_difference)},
                                  {"is_odd", e.is_odd},
                                  {"can_tell", e.can_tell}});
  json["left_out"] = Json::array();
  for (const LeftOutEstimator& left_out : result.left_out)
    json["left_out"].push_back({{"name", left_out.name}, {"reason", left_out.reason}});
  json["pairs"] = Json::array();
  for (const VerifiedPair& pair : result.pairs) {
    const Comparison& c = pair.comparison;
    json["pairs"].push_back(
        {{"a", result.estimators[pair.a].estimator.name},
         {"b", result.estimators[pair.b].estimator.name},
         {"verdict", verdict_name(pair.verdict)},
         {"p_value", number(pair.p_value)},
         {"ratio", number(c.ratio)},
         {"ratio_low", number(c.ratio_low)},
         {"ratio_high", number(c.ratio_high)},
         {"worst_block", {c.worst_block.region.x, c.worst_block.region.y}},
         {"worst_block_statistic", number(c.worst_block.test.statistic)},
         {"light", pair.lights.empty() ? Json() : Json(scene.lights.name(pair.lights.front().light))},
         {"smallest_difference", number(c.smallest_difference)}});
  }
  json["smallest_difference_found"] = number(result.smallest_difference);
  if (!result.foreign_noise.empty()) json["against_noise"] = result.foreign_noise;
  json["mishap"] = result.mishap ? Json(*result.mishap) : Json();
  json["is_interrupted"] = result.is_interrupted;
  return json;
}

void write_map(const std::filesystem::path& file, const VerifyResult& result) {
  const VerifiedPair* pair = most_telling(result);
  if (!pair) return;
  const ComparedImage &a = result.estimators[pair->a].image, &b = result.estimators[pair->b].image;
  const std::vector<double> pixels = pixel_differences(a, b), blocks = block_differences(a, b);
  Image map{a.image.width, a.image.height, {{"Y", {}}, {"a.Y", {}}, {"b.Y", {}}, {"block.Y", {}}}, {}};
  const int columns = blocks_along(map.width);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      map.channels[0].values.push_back(float(pixels[std::size_t(y * map.width + x)]));
      map.channels[1].values.push_back(float(a.image.at(x, y).mean));
      map.channels[2].values.push_back(float(b.image.at(x, y).mean));
      map.channels[3].values.push_back(float(blocks[std::size_t(y / block_side * columns + x / block_side)]));
    }
  map.metadata = {{"a", result.estimators[pair->a].estimator.name},
                  {"b", result.estimators[pair->b].estimator.name},
                  {"content", "luminance of a minus that of b, in standard errors"}};
  write_exr(file, map);
}

}  // namespace etendue::app
