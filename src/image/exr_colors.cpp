#include "base/error.h"
#include "image/color_space.h"
#include "image/decoders.h"
#include "image/exr_read.h"
#include "image/unreadable.h"

#include <ImfChannelList.h>
#include <ImfEnvmap.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <optional>
#include <utility>

namespace etendue {
namespace {

using About = ColorRequestError::About;

/// Channels that are one colour; `name` is what the scene calls them by.
struct Layer {
  enum class Kind { rgb, grey, luminance_and_chroma } kind;
  std::string name;
  std::size_t part;
  std::array<std::string, 3> channels{};  ///< R, G, B; or the grey one three times.
};

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return text;
}

/// "diffuse" and "R" of "diffuse.R".
std::pair<std::string, std::string> split_channel_name(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  if (dot == std::string::npos) return {"", channel};
  return {channel.substr(0, dot), channel.substr(dot + 1)};
}

/// The full name of the channel of `group` that one of these names stands for; empty where there is none.
std::string find_channel(const std::vector<std::string>& group,
                         std::initializer_list<std::string_view> names) {
  for (const std::string& channel : group)
    if (std::find(names.begin(), names.end(), lower_case(split_channel_name(channel).second)) != names.end())
      return channel;
  return "";
}

std::optional<Layer> layer_of(const std::vector<std::string>& group, std::size_t part) {
  Layer layer{Layer::Kind::rgb, split_channel_name(group.front()).first, part};
  layer.channels = {find_channel(group, {"r", "red"}), find_channel(group, {"g", "green"}),
                    find_channel(group, {"b", "blue"})};
  if (std::none_of(layer.channels.begin(), layer.channels.end(), [](const auto& c) { return c.empty(); }))
    return layer;
  const std::string grey = find_channel(group, {"y"});
  // Y beside X or Z is a coordinate.
  if (grey.empty() || !find_channel(group, {"x", "z"}).empty()) return std::nullopt;
  const bool has_chroma = !find_channel(group, {"ry"}).empty() && !find_channel(group, {"by"}).empty();
  layer.kind = has_chroma ? Layer::Kind::luminance_and_chroma : Layer::Kind::grey;
  layer.channels = {grey, grey, grey};
  return layer;
}

std::vector<std::string> channels_of(const ExrPart& part) {
  std::vector<std::string> names;
  for (auto c = part.header.channels().begin(); c != part.header.channels().end(); ++c)
    names.emplace_back(c.name());
  return names;
}

/// All that are colours, in the order of the file. Of a file of several parts their names begin with the
/// part's, unless they do so already.
std::vector<Layer> layers_of(const std::vector<ExrPart>& parts) {
  std::vector<Layer> layers;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].is_deep) continue;
    std::vector<std::string> channels = channels_of(parts[p]);
    if (channels.size() == 1 && parts.size() == 1) {
      const std::string& only = channels.front();  // Whatever its name is.
      return {{Layer::Kind::grey, split_channel_name(only).first, p, {only, only, only}}};
    }
    while (!channels.empty()) {
      const std::string prefix = split_channel_name(channels.front()).first;
      const auto rest = std::stable_partition(channels.begin(), channels.end(), [&](const auto& name) {
        return split_channel_name(name).first == prefix;
      });
      if (const auto layer = layer_of({channels.begin(), rest}, p)) layers.push_back(*layer);
      channels.erase(channels.begin(), rest);
    }
  }
  for (Layer& layer : layers)
    if (const std::string& part = parts[layer.part].name;
        !part.empty() && layer.name != part && !layer.name.starts_with(part + "."))
      layer.name = layer.name.empty() ? part : part + "." + layer.name;
  return layers;
}

Layer choose_layer(const std::vector<ExrPart>& parts, const std::string& wanted) {
  const std::vector<Layer> layers = layers_of(parts);
  std::vector<std::string> names;
  for (const Layer& layer : layers) {
    if (layer.name == wanted) return layer;
    if (!layer.name.empty()) names.push_back(layer.name);
  }
  if (!wanted.empty()) {
    for (std::size_t p = 0; p < parts.size(); ++p)
      for (const std::string& channel : channels_of(parts[p]))
        if (channel == wanted && !parts[p].is_deep)
          return {Layer::Kind::grey, wanted, p, {channel, channel, channel}};
    throw ColorRequestError(
        About::layer, fmt::format("has no layer '{}'", wanted),
        names.empty() ? "it has none with a name: leave 'layer' out" : known_names(wanted, names));
  }
  if (layers.size() == 1) return layers.front();
  if (layers.empty()) {
    std::string all;
    for (const ExrPart& part : parts) {
      if (part.is_deep && parts.size() == 1)
        throw Unreadable("deep images are not supported; flatten it first");
      for (const std::string& channel : channels_of(part)) all += (all.empty() ? "" : ", ") + channel;
    }
    throw ColorRequestError(About::file, "has no colours: these are the channels R, G and B, or Y",
                            "it has: " + all);
  }
  throw ColorRequestError(About::file, "has several layers of colours",
                          fmt::format("name one by <string name=\"layer\" value=\"{}\"/>\n{}", names.front(),
                                      known_names("", names)));
}

/// Of the data window. OpenEXR brings the chroma, of which there is a quarter as much, to the pixels.
std::vector<float> read_luminance_and_chroma(Bytes file, const Imath::Box2i& window, const Layer& layer) {
  ExrBytes stream(file);
  Imf::RgbaInputFile input(stream, split_channel_name(layer.channels[0]).first);
  std::vector<Imf::Rgba> pixels(width_of(window) * height_of(window));
  input.setFrameBuffer(pixels.data() - window.min.x - std::ptrdiff_t(width_of(window)) * window.min.y, 1,
                       width_of(window));
  input.readPixels(window.min.y, window.max.y);
  std::vector<float> rgb;
  rgb.reserve(3 * pixels.size());
  for (const Imf::Rgba& pixel : pixels) rgb.insert(rgb.end(), {pixel.r, pixel.g, pixel.b});
  return rgb;
}

/// Of the data window.
std::vector<float> read_layer(Bytes file, const std::vector<ExrPart>& parts, const Layer& layer) {
  const Imath::Box2i& window = parts[layer.part].header.dataWindow();
  std::vector<float> rgb(3 * width_of(window) * height_of(window));
  const bool is_grey = layer.kind == Layer::Kind::grey;
  std::vector<ExrTarget> targets;
  for (std::size_t k = 0; k < (is_grey ? 1 : 3); ++k) targets.push_back({layer.channels[k], &rgb[k], 3});
  read_exr_channels(file, parts, layer.part, targets);
  if (is_grey)
    for (std::size_t i = 0; i < rgb.size(); i += 3) rgb[i + 1] = rgb[i + 2] = rgb[i];
  return rgb;
}

ColorImage decode_exr(Bytes file, const ColorRequest& request) {
  const std::vector<ExrPart> parts = read_exr_headers(file);
  const Layer layer = choose_layer(parts, request.layer);
  const Imf::Header& header = parts[layer.part].header;
  check_exr_pixels(parts[layer.part], file.size());
  const bool has_chroma = layer.kind == Layer::Kind::luminance_and_chroma;
  if (has_chroma && parts.size() > 1)
    throw Unreadable("luminance and chroma in a file of several parts are not supported; convert it to RGB");
  ColorImage image{int(width_of(header.displayWindow())), int(height_of(header.displayWindow())),
                   in_display_window(header,
                                     has_chroma ? read_luminance_and_chroma(file, header.dataWindow(), layer)
                                                : read_layer(file, parts, layer),
                                     3)};
  image.is_cube_map = Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE;
  if (Imf::hasChromaticities(header) && layer.kind != Layer::Kind::grey && !request.is_raw) {
    const Imf::Chromaticities& c = Imf::chromaticities(header);
    const auto xy = [](const Imath::V2f& p) { return Vec2<double>{p.x, p.y}; };
    if (const auto matrix = rec709_from({{{xy(c.red), xy(c.green), xy(c.blue)}}, xy(c.white)}))
      convert_colors(*matrix, image.rgb);
  }
  return image;
}

}  // namespace

const Decoder exr_decoder{"EXR", [](Bytes begin) { return begins_with(begin, "v/1\x01"); }, decode_exr};

}  // namespace etendue
