#include "bsdf/bsdf.h"
#include "commands.h"
#include "film/filter.h"
#include "geometry/camera.h"
#include "integrator/integrator.h"
#include "medium/homogeneous.h"
#include "noritest/noritest.h"
#include "render/image_layers.h"
#include "render/isa.h"
#include "render/render.h"
#include "sampler/sampler.h"
#include "scene/load_light.h"
#include "scene/load_shape.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

namespace etendue::app {

namespace {

using Json = nlohmann::ordered_json;

std::string_view type_name(Parameter::Type type) {
  constexpr std::array names{"boolean", "integer", "float",     "string", "color",
                             "point",   "vector",  "transform", "point"};
  return names[std::size_t(type)];
}

Json plugin_json(const Plugin& plugin) {
  Json parameters = Json::array();
  for (const Parameter& parameter : plugin.parameters)
    parameters.push_back({{"name", parameter.name},
                          {"type", type_name(parameter.type)},
                          {"default", parameter.default_value},
                          {"is_required", parameter.is_required},
                          {"accepts_texture", parameter.accepts_texture},
                          {"unit", parameter.unit},
                          {"meaning", parameter.meaning}});
  return {{"name", plugin.name}, {"meaning", plugin.meaning}, {"parameters", parameters}};
}

Json plugins_json(const std::vector<Plugin>& plugins) {
  Json all = Json::array();
  for (const Plugin& plugin : plugins) all.push_back(plugin_json(plugin));
  return all;
}

/// With what each does that no option changes, on one line; of one that only a file can name, nothing.
Json describe_integrators() {
  Json all = plugins_json(integrator_plugins());
  for (Json& plugin : all) {
    const auto& parameters = plugin["parameters"];
    if (std::none_of(parameters.begin(), parameters.end(),
                     [](const Json& parameter) { return parameter["is_required"].get<bool>(); }))
      plugin["by_default"] = describe(integrator_from_name(plugin["name"].get<std::string>()));
  }
  return all;
}

/// From the names and releases that the build found, in turn.
Json dependency_versions() {
  Json versions = Json::object();
  std::istringstream list(ETENDUE_DEPENDENCIES);
  for (std::string name, version; list >> name >> version;) versions[name] = version;
  return versions;
}

Json describe_program() {
  Json isas = Json::array();
  for (const Isa isa : available_isas())
    isas.push_back({{"name", isa_name(isa)}, {"lanes", lane_count(isa)}});
  Json json;
  json["version"] = ETENDUE_VERSION;
  json["instruction_sets"] = isas;
  json["threads"] = available_threads();
  json["dependencies"] = dependency_versions();
  json["integrators"] = describe_integrators();
  json["light_samplers"] = plugins_json(light_sampler_plugins());
  json["samplers"] = plugins_json(sampler_plugins());
  json["cameras"] = plugins_json(camera_plugins());
  json["filters"] = plugins_json(filter_plugins());
  json["shapes"] = plugins_json(shape_plugins());
  json["bsdfs"] = plugins_json(bsdf_plugins());
  json["textures"] = plugins_json(texture_plugins());
  json["media"] = plugins_json(medium_plugins());
  json["phases"] = plugins_json(phase_plugins());
  json["lights"] = plugins_json(light_plugins());
  json["tests"] = plugins_json(test_plugins());
  for (const KnownLayer& layer : known_layers())
    json["layers"].push_back({{"name", layer.name}, {"meaning", layer.meaning}});
  return json;
}

void print(const Json& json) {
  fmt::print("Etendue {}\n\ninstruction sets:", json["version"].get<std::string>());
  for (const Json& isa : json["instruction_sets"])
    fmt::print(" {} ({} lanes)", isa["name"].get<std::string>(), isa["lanes"].get<int>());
  fmt::print("\nthreads: {}\nlibraries:", json["threads"].get<int>());
  for (const auto& [name, version] : json["dependencies"].items())
    fmt::print(" {} {}", name, version.get<std::string>());
  fmt::print("\n");
  for (const char* family : {"integrators", "light_samplers", "samplers", "cameras", "filters", "shapes",
                             "bsdfs", "textures", "media", "phases", "lights", "tests", "layers"}) {
    fmt::print("\n{}\n", family);
    for (const Json& plugin : json[family]) {
      fmt::print("  {}: {}\n", plugin["name"].get<std::string>(), plugin["meaning"].get<std::string>());
      if (plugin.contains("by_default"))
        fmt::print("    by default: {}\n", plugin["by_default"].get<std::string>());
      for (const Json& parameter : plugin.value("parameters", Json::array())) {
        const auto text = [&](const char* key) { return parameter[key].get<std::string>(); };
        const std::string unit = text("unit").empty() ? "" : " " + text("unit");
        const std::string value = parameter["is_required"].get<bool>() ? "required"
                                  : text("default").empty()            ? "none"
                                                                       : text("default") + unit;
        fmt::print("    {:<20} {:<9} [{}] {}\n", text("name"), text("type"), value, text("meaning"));
      }
    }
  }
}

}  // namespace

void add_info_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("info", "Version, instruction sets, and every plugin with its parameters");
  const auto is_json = std::make_shared<bool>(false);
  command->add_flag("--json", *is_json, "As JSON");
  command->callback([is_json, &exit_code] {
    const Json json = describe_program();
    if (*is_json)
      fmt::print("{}\n", json.dump(2));
    else
      print(json);
    exit_code = done;
  });
}

}  // namespace etendue::app
