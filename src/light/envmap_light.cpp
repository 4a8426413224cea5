#include "light/envmap_light.h"

#include "film/image_file.h"
#include "light/light_parameters.h"
#include "scenefile/existing_file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace etendue {

using Type = Parameter::Type;

const Plugin envmap_plugin{
    "light",
    "envmap",
    "Light from all around, by an image in latitude and longitude; y of the light is up.",
    {{"filename", Type::text, "", "", "An EXR image with R, G, B or Y, relative to the scene file", true},
     {"scale", Type::real, "1", "", "Factor of the image's radiance"},
     {"toWorld", Type::transform, "", "", "World from light, a rotation; identity unless given"}},
    {}};

std::int32_t EnvmapLights::add(Envmap map, const Transform& world_from_map) {
  std::array<Vec3f, 3> axes;
  for (std::size_t k = 0; k < 3; ++k)
    axes[k] = {float(world_from_map.m[0][k]), float(world_from_map.m[1][k]), float(world_from_map.m[2][k])};
  maps_.push_back({std::move(map), axes});
  return std::int32_t(maps_.size()) - 1;
}

namespace {

/// The image's colour, three numbers a texel.
Envmap read_envmap(const std::filesystem::path& file, const Location& where) {
  const Image image = read_exr(file);
  const auto fail = [&](const std::string& problem, const std::string& hint) {
    return InputError(where, fmt::format("{}: {}", file.string(), problem), hint);
  };
  const Channel* grey = image.find("Y");
  const std::array<const Channel*, 3> channels{image.find("R") ? image.find("R") : grey,
                                               image.find("G") ? image.find("G") : grey,
                                               image.find("B") ? image.find("B") : grey};
  if (!channels[0] || !channels[1] || !channels[2]) {
    std::string names;
    for (const Channel& channel : image.channels) names += (names.empty() ? "" : ", ") + channel.name;
    throw fail("an environment map needs the channels R, G and B, or Y", "it has: " + names);
  }
  const auto width = std::size_t(image.width), height = std::size_t(image.height);
  if (3 * width * height > std::size_t(std::numeric_limits<std::int32_t>::max()))
    throw fail(fmt::format("{} x {} texels are more than an environment map can have", width, height),
               "scale it down to at most 715 million texels");
  // Sums of a few texels, weighted, must stay finite.
  constexpr float largest = 1e30f;
  std::vector<float> rgb(3 * width * height);
  bool is_black = true;
  for (std::size_t i = 0; i < width * height; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const float value = channels[k]->values[i];
      if (!(value >= 0 && value <= largest))
        throw fail(fmt::format("texel ({}, {}) is {} {} {}", i % width, i / width, channels[0]->values[i],
                               channels[1]->values[i], channels[2]->values[i]),
                   fmt::format("radiance must be a number from 0 to {:g}; mend the image", largest));
      is_black = is_black && value == 0;
      rgb[3 * i + k] = value;
    }
  if (is_black) throw fail("all texels are 0: this environment map gives no light", "leave it out");
  return {image.width, image.height, std::move(rgb)};
}

}  // namespace

EnvmapLight make_envmap_light(const Object& description, const std::filesystem::path& directory,
                              std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, envmap_plugin, unread);
  const double scale = parameters.real("scale");
  if (!(scale > 0 && scale <= 1e6))
    throw InputError(parameters.location("scale"),
                     fmt::format("'scale' is {}; it must be above 0 and at most 1e6", scale));
  const std::filesystem::path file = existing_file(parameters, "filename", directory, "an EXR image");
  return {read_envmap(file, parameters.location("filename")), rotation_from_light(parameters), float(scale)};
}

}  // namespace etendue
