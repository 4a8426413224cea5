#include "render/image_layers.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <set>
#include <utility>

namespace etendue {
namespace {

struct NamedLayers {
  std::string name, meaning;
  std::variant<RadianceLayers (*)(const LightGroups& groups), HitLayer, RenderLayer> what;
};

RadianceLayers by_light(const LightGroups& groups) {
  RadianceLayers layers{layers_of_lights(LayerSet{}, groups), {}};
  for (const std::string& name : groups.names) layers.names.push_back("light." + name);
  return layers;
}

RadianceLayers by_technique(const LightGroups&) {
  return {technique_layers(), {"emission", "technique.light", "technique.bsdf"}};
}

RadianceLayers by_depth(const LightGroups&) {
  LayerSet set;
  set.path_parts = 6;
  set.path_part.fill({0, 1, 2, 3, 4, 5});
  return {set, {"emission", "direct", "indirect.1", "indirect.2", "indirect.3", "indirect.beyond"}};
}

std::vector<float> sample_counts(const LayerSource& source) {
  std::vector<float> counts;
  const Film& film = source.result.film;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x)
      counts.push_back(float(film.at(x, y).count * source.settings.samples_per_replicate_of(x, y)));
  return counts;
}

std::vector<float> variance_share(const LayerSource& source) {
  double whole = 0;
  for (const PixelInterval& interval : source.intervals)
    whole += double(interval.luminance_error) * interval.luminance_error;
  std::vector<float> shares;
  for (const PixelInterval& interval : source.intervals)
    shares.push_back(float(double(interval.luminance_error) * interval.luminance_error / whole));
  return shares;
}

const std::vector<NamedLayers>& layer_table() {
  static const std::vector<NamedLayers> rows{
      {"light", "light.NAME.*: what each light brings; lights of one name are one layer", by_light},
      {"technique",
       "emission.*: light that the camera sees; technique.light.*, technique.bsdf.*: what light samples and "
       "BSDF samples bring, with their weights",
       by_technique},
      {"depth",
       "emission.*, direct.*, indirect.1.*, .2, .3, .beyond: light that was scattered 0, 1, 2, 3, 4 and more "
       "times",
       by_depth},
      {"position", "Of what is seen at the pixel's centre, m, in the world of the file; 0 where nothing is",
       HitLayer{{"X", [](const FirstHit& hit) { return float(hit.position.x); }},
                {"Y", [](const FirstHit& hit) { return float(hit.position.y); }},
                {"Z", [](const FirstHit& hit) { return float(hit.position.z); }}}},
      {"distance", "Of it from the camera, m; infinity where nothing is",
       HitLayer{{"Z", [](const FirstHit& hit) { return hit.distance; }}}},
      {"normal", "Its shading normal, in the world; 0 where nothing is",
       HitLayer{{"X", [](const FirstHit& hit) { return hit.normal.x; }},
                {"Y", [](const FirstHit& hit) { return hit.normal.y; }},
                {"Z", [](const FirstHit& hit) { return hit.normal.z; }}}},
      {"albedo", "The share of the light from all around that it scatters to the camera",
       HitLayer{{"R", [](const FirstHit& hit) { return hit.albedo.r; }},
                {"G", [](const FirstHit& hit) { return hit.albedo.g; }},
                {"B", [](const FirstHit& hit) { return hit.albedo.b; }}}},
      {"id", "id.shape, id.material, id.light: which it is, in the order of the file; -1: none",
       HitLayer{{"shape", [](const FirstHit& hit) { return float(hit.shape); }},
                {"material", [](const FirstHit& hit) { return float(hit.material); }},
                {"light", [](const FirstHit& hit) { return float(hit.light); }}}},
      {"samples", "How many the pixel has taken", RenderLayer{"count", sample_counts}},
      {"variance_share", "The squared standard error of its luminance, over the sum of all pixels'",
       RenderLayer{"Y", variance_share}}};
  return rows;
}

ImageLayer make_layer(const std::string& name, const LightGroups& groups) {
  const auto row = std::find_if(layer_table().begin(), layer_table().end(),
                                [&](const NamedLayers& candidate) { return candidate.name == name; });
  if (row == layer_table().end()) {
    std::vector<std::string> known;
    for (const NamedLayers& each : layer_table()) known.push_back(each.name);
    throw InputError(fmt::format("unknown layer '{}'\n{}", name, known_names(name, known)));
  }
  if (const auto* make = std::get_if<RadianceLayers (*)(const LightGroups&)>(&row->what))
    return {name, (*make)(groups)};
  if (const auto* hit = std::get_if<HitLayer>(&row->what)) return {name, *hit};
  return {name, std::get<RenderLayer>(row->what)};
}

/// Red, green and blue of a film, and their standard errors.
void add_radiance(const std::string& name, const Film& film, std::vector<Channel>& channels) {
  const std::size_t first = channels.size();
  for (const char* channel : {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"})
    channels.push_back({name + "." + channel, {}});
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const PixelStatistics& pixel = film.at(x, y);
      const Color<double> error = standard_error(pixel);
      const std::array values{pixel.mean.r, pixel.mean.g, pixel.mean.b, error.r, error.g, error.b};
      for (std::size_t c = 0; c < values.size(); ++c) channels[first + c].values.push_back(float(values[c]));
    }
}

}  // namespace

std::vector<KnownLayer> known_layers() {
  std::vector<KnownLayer> known;
  for (const NamedLayers& row : layer_table()) known.push_back({row.name, row.meaning});
  return known;
}

std::vector<ImageLayer> image_layers(const std::vector<std::string>& names, const LightGroups& groups) {
  std::vector<ImageLayer> layers;
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (!seen.insert(name).second) throw InputError(fmt::format("the layer '{}' is asked for twice", name));
    layers.push_back(make_layer(name, groups));
  }
  return layers;
}

LayerSet technique_layers() {
  LayerSet set;
  set.path_parts = std::int32_t(technique_layer_names.size());
  set.path_part[std::size_t(Technique::light)] = {1};
  set.path_part[std::size_t(Technique::bsdf)] = {0, 2};
  return set;
}

LayerSet scattered_light() {
  LayerSet set;
  set.path_part.fill({LayerSet::none, 0});
  return set;
}

LayerSet layers_of_lights(const LayerSet& of_paths, const LightGroups& groups) {
  LayerSet set = of_paths;
  set.light_parts = std::int32_t(groups.names.size());
  for (const std::int32_t group : groups.of_light) set.light_part.push_back(group);
  return set;
}

std::vector<Channel> layer_channels(const std::vector<ImageLayer>& layers, const Scene& scene,
                                    const LayerSource& source) {
  std::vector<Channel> channels;
  std::vector<FirstHit> hits;
  std::set<std::string> seen;
  std::size_t next_film = 0;
  for (const ImageLayer& layer : layers) {
    if (const auto* radiance = std::get_if<RadianceLayers>(&layer.what)) {
      for (const std::string& name : radiance->names) {
        const Film& film = source.result.layers[next_film++];
        if (seen.insert(name).second) add_radiance(name, film, channels);
      }
    } else if (const auto* of_hits = std::get_if<HitLayer>(&layer.what)) {
      if (hits.empty()) hits = first_hits(scene);
      for (const HitChannel& channel : *of_hits) {
        std::vector<float> values;
        for (const FirstHit& hit : hits) values.push_back(channel.value(hit));
        channels.push_back({fmt::format("{}.{}", layer.name, channel.name), std::move(values)});
      }
    } else {
      const RenderLayer& of_render = std::get<RenderLayer>(layer.what);
      channels.push_back({fmt::format("{}.{}", layer.name, of_render.channel), of_render.values(source)});
    }
  }
  return channels;
}

}  // namespace etendue
