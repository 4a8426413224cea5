#include "texture/image_texture.h"

#include "texture/color_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace etendue {
namespace {

using Type = Parameter::Type;

/// The alternative of this name.
template <class T, std::size_t n>
T choice(const Parameters& parameters, const char* key,
         const std::array<std::pair<const char*, T>, n>& choices) {
  const std::string name = parameters.text(key);
  std::vector<std::string> known;
  for (const auto& [known_name, value] : choices) {
    if (name == known_name) return value;
    known.emplace_back(known_name);
  }
  throw InputError(parameters.location(key), fmt::format("unknown {} '{}'", key, name),
                   known_names(name, known));
}

/// The first of the texels over which [low, high] (in texels) lies, and how many of them differ.
std::pair<double, int> texels_around(double low, double high, int size) {
  const double first = std::floor(low - 1), count = std::floor(high + 1) - first + 1;
  return {first, int(std::min(count, 2.0 * size))};
}

}  // namespace

double ImageTexture::largest_luminance(const Vec2<double>& low, const Vec2<double>& high) const {
  // Beyond the edges a clamped image is what it is there.
  const auto inside = [&](double x, int size) {
    return wrap == Wrap::clamp ? std::clamp(x * size, -1.0, size + 1.0) : x * size;
  };
  const auto [left, columns] = texels_around(inside(low.x, width), inside(high.x, width), width);
  const auto [bottom, rows] = texels_around(inside(low.y, height), inside(high.y, height), height);
  double largest = 0;
  for (int j = 0; j < rows; ++j) {
    const float y = wrapped(float(bottom + j), height);
    for (int i = 0; i < columns; ++i)
      largest = std::max(largest, double(luminance(texel(wrapped(float(left + i), width), y))));
  }
  return largest;
}

const Plugin image_texture_plugin{
    "texture",
    "imagetexture",
    "An image file (EXR, PNG, JPEG, HDR) over the unit square of uv: u to the right, v up.",
    {{"filename", Type::text, "", "", "The file, relative to the scene file", true},
     {"layer", Type::text, "", "", "Of an EXR: a part or a group of channels by its name"},
     {"raw", Type::boolean, "false", "", "The values are plain numbers, not colours"},
     {"interpolation", Type::text, "bilinear", "", "Between pixels: bilinear or nearest"},
     {"wrap", Type::text, "repeat", "", "Outside of the unit square: repeat, mirror or clamp"}},
    {}};

namespace {

/// Its pixels and size only.
ImageTexture read_texture_pixels(const Parameters& parameters, const std::filesystem::path& directory) {
  ImageTexture texture;
  const ColorImage image = read_color_image(parameters, "filename", directory, parameters.boolean("raw"));
  texture.width = image.width;
  texture.height = image.height;
  const std::size_t width = std::size_t(image.width), height = std::size_t(image.height);
  if (width * height > (std::size_t(1) << 29) || width > (1u << 24) || height > (1u << 24))
    throw InputError(parameters.location("filename"),
                     fmt::format("this image has {} x {} pixels, too many for a texture", width, height));
  std::vector<float> pixels(4 * width * height);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const float value = image.rgb[3 * ((height - 1 - y) * width + x) + c];
        if (!(value >= 0 && std::isfinite(value)))
          throw InputError(
              parameters.location("filename"),
              fmt::format("'{}' has {} in pixel {}, {}; a texture must be finite and not negative",
                          parameters.text("filename"), value, x, height - 1 - y));
        pixels[4 * (y * width + x) + c] = value;
      }
  texture.pixels = std::make_shared<const std::vector<float>>(std::move(pixels));
  return texture;
}

}  // namespace

ImageTexture make_image_texture(const Object& description, TextureFiles& files,
                                std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, image_texture_plugin, unread);
  using Wrap = ImageTexture::Wrap;
  using Interpolation = ImageTexture::Interpolation;
  const auto interpolation = choice<Interpolation, 2>(
      parameters, "interpolation",
      {{{"bilinear", Interpolation::bilinear}, {"nearest", Interpolation::nearest}}});
  const auto wrap = choice<Wrap, 3>(
      parameters, "wrap", {{{"repeat", Wrap::repeat}, {"mirror", Wrap::mirror}, {"clamp", Wrap::clamp}}});
  const std::tuple key((files.directory / parameters.text("filename")).lexically_normal(),
                       parameters.boolean("raw"), parameters.has("layer") ? parameters.text("layer") : "");
  auto known = files.known.find(key);
  if (known == files.known.end())
    known = files.known.emplace(key, read_texture_pixels(parameters, files.directory)).first;
  ImageTexture texture = known->second;
  texture.interpolation = interpolation;
  texture.wrap = wrap;
  return texture;
}

}  // namespace etendue
