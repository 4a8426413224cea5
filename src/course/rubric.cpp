#include "course/rubric.h"

#include "base/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

namespace etendue {

Rubric default_rubric() {
  const auto written = [](const char* title, double points) { return RubricPart{title, points, {}, true}; };
  return {{"3.2.1 sampleLights",
           20,
           {{"unshadowed", 7},
            {"light shares", 4},
            {"shadows", 4},
            {"back faces", 3},
            {"use of the sampler", 2},
            {"repeatable", 2},
            {"thread safety", 1}}},
          {"3.2.2 Li",
           15,
           {{"mean", 6},
            {"horizon", 2},
            {"emission", 3},
            {"valid samples", 2},
            {"scene area_sampling", 1},
            {"scene phong_plates", 1}}},
          written("3.3.1", 2),
          written("3.3.2", 3),
          written("3.3.3", 5),
          written("3.3.4", 5)};
}

Rubric read_rubric(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(fmt::format("cannot read the rubric {}", file.string()));
  try {
    Rubric rubric;
    for (const nlohmann::json& one : nlohmann::json::parse(in)) {
      RubricPart part{one.at("title").get<std::string>(), one.at("points").get<double>(), {}, false};
      part.is_written = one.value("written", false);
      const nlohmann::json losses = one.value("lose", nlohmann::json::object());
      for (const auto& [property, points] : losses.items())
        part.losses.push_back({property, points.get<double>()});
      rubric.push_back(std::move(part));
    }
    return rubric;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format(
        "{}: {}\n  a rubric is a list of {{\"title\": ..., \"points\": 20, \"lose\": {{\"mean\": 5}}}}",
        file.string(), error.what()));
  }
}

double points_of(const RubricPart& part, const nlohmann::json& result) {
  if (part.is_written || !result.contains("properties")) return 0;
  double points = part.points;
  for (const nlohmann::json& property : result["properties"])
    for (const RubricPart::Loss& loss : part.losses)
      if (property["name"] == loss.property) {
        if (property["verdict"] == "wrong") points -= loss.points;
        if (property["verdict"] == "cannot tell") points -= loss.points / 2;
      }
  return std::max(points, 0.0);
}

}  // namespace etendue
