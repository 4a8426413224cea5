#include "lint/lint.h"

#include "base/temporary_file.h"
#include "commands.h"
#include "messages.h"
#include "output_files.h"
#include "render_options.h"
#include "scenefile/nori_xml.h"
#include "scenefile/scene_files.h"

#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace etendue::app {

namespace {

using Json = nlohmann::ordered_json;

struct LintOptions {
  RenderOptions render;
  std::string json_file;
};

Json to_json(const Finding& finding) {
  const LineColumn at = line_and_column(finding.where);
  Json json;
  json["id"] = finding.id;
  json["severity"] = severity_name(finding.severity);
  json["file"] = finding.where.source ? finding.where.source->path : "";
  json["line"] = at.line;
  json["column"] = at.column;
  json["problem"] = finding.problem;
  json["remedy"] = finding.remedy;
  return json;
}

int run(const LintOptions& options) {
  const SceneDesc description = read_nori_xml(options.render.scene_file, options.render.run.dialect());
  if (!options.json_file.empty()) {
    check_destination(options.json_file);
    check_overwrites_nothing({options.json_file}, files_of(description, options.render.scene_file));
  }
  LoadedScene loaded = load_scene(description);
  const IntegratorSettings integrator =
      integrator_for(options.render.integrator, loaded, description.dialect, loaded.warnings);
  if (integrator.needs_lights()) check_has_light(description, loaded.scene);
  const int samples = options.render.samples_per_pixel.value_or(loaded.samples_per_pixel);
  const std::vector<Finding> findings = lint({loaded.scene, loaded.places, integrator, samples}, thorough);
  for (const std::string& warning : loaded.warnings) fmt::print("warning: {}\n", warning);
  Json all = Json::array();
  for (const Finding& finding : findings) {
    fmt::print("{} [{}] {}\n", severity_name(finding.severity), finding.id,
               format_message(finding.where, finding.problem, finding.remedy));
    all.push_back(to_json(finding));
  }
  const std::size_t count = findings.size() + loaded.warnings.size();
  fmt::print("{}: {}\n", options.render.scene_file,
             count == 0 ? "nothing odd" : fmt::format("{} finding{}", count, count == 1 ? "" : "s"));
  if (!options.json_file.empty()) {
    Json json;
    json["scene"] = options.render.scene_file;
    json["integrator"] = integrator.name;
    json["samples_per_pixel"] = samples;
    json["warnings"] = loaded.warnings;
    json["findings"] = all;
    write_text_file(options.json_file, json.dump(2) + "\n");
  }
  return count == 0 ? done : check_failed;
}

}  // namespace

void add_lint_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("lint", "Say what is odd about a scene as a whole, and what to do");
  const auto options = std::make_shared<LintOptions>();
  command->add_option("SCENE", options->render.scene_file, "Scene file (XML of the Nori family)")->required();
  command->add_option("--json", options->json_file, "JSON file with all findings")->allow_extra_args(false);
  add_integrator_options(*command, options->render.integrator);
  command->add_option("--spp", options->render.samples_per_pixel, "Samples a pixel, instead of the file's")
      ->check(whole_number(std::numeric_limits<int>::max()));
  command->add_option("--dialect", options->render.run.dialect_name,
                      "nori-2012, nori-eth or nori, instead of what the file tells");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace etendue::app
