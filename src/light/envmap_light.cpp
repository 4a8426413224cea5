#include "light/envmap_light.h"

#include "light/light_parameters.h"
#include "texture/color_image.h"

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
    {{"filename", Type::text, "", "", "An image (EXR, PNG, JPEG, HDR), relative to the scene file", true},
     {"layer", Type::text, "", "", "Of an EXR: a part or a group of channels by its name"},
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
Envmap read_envmap(const Parameters& parameters, const std::filesystem::path& directory) {
  ColorImage image = read_color_image(parameters, "filename", directory, false);
  const auto fail = [&](const std::string& problem, const std::string& hint) {
    return InputError(parameters.location("filename"),
                      fmt::format("{}: {}", (directory / parameters.text("filename")).string(), problem),
                      hint);
  };
  const auto width = std::size_t(image.width), height = std::size_t(image.height);
  if (3 * width * height > std::size_t(std::numeric_limits<std::int32_t>::max()))
    throw fail(fmt::format("{} x {} texels are more than an environment map can have", width, height),
               "scale it down to at most 715 million texels");
  if (image.is_cube_map)
    throw fail("this image says that it is a cube map (its attribute 'envmap')",
               "convert it to latitude and longitude: exrenvmap -l CUBE.exr MAP.exr");
  // Sums of a few texels, weighted, must stay finite.
  constexpr float largest = 1e30f;
  bool is_black = true;
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const float value = image.rgb[i];
    const float* const texel = &image.rgb[i - i % 3];
    if (!(value >= 0 && value <= largest))
      throw fail(fmt::format("texel ({}, {}) is {} {} {}", i / 3 % width, i / 3 / width, texel[0], texel[1],
                             texel[2]),
                 fmt::format("radiance must be a number from 0 to {:g}; mend the image", largest));
    is_black = is_black && value == 0;
  }
  if (is_black) throw fail("all texels are 0: this environment map gives no light", "leave it out");
  return {image.width, image.height, std::move(image.rgb)};
}

}  // namespace

EnvmapLight make_envmap_light(const Object& description, const std::filesystem::path& directory,
                              std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, envmap_plugin, unread);
  const double scale = parameters.real("scale");
  if (!(scale > 0 && scale <= 1e6))
    throw InputError(parameters.location("scale"),
                     fmt::format("'scale' is {}; it must be above 0 and at most 1e6", scale));
  return {read_envmap(parameters, directory), rotation_from_light(parameters), float(scale)};
}

}  // namespace etendue
