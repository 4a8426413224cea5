#include "texture/image_texture.h"

#include "film/image_file.h"

#include <array>
#include <cmath>
#include <fmt/format.h>

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

Image read_image(const Parameters& parameters, const std::filesystem::path& directory, PngEncoding encoding) {
  const std::string name = parameters.text("filename");
  const std::filesystem::path file = directory / name;
  const Location& where = parameters.location("filename");
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw InputError(where, fmt::format("'{}' is not there", name),
                     fmt::format("looked for {}", file.string()));
  const std::string ending = file.extension().string();
  if (ending == ".exr") return read_exr(file);
  if (ending == ".png") return read_png(file, encoding);
  throw InputError(where, fmt::format("cannot tell the format of the image '{}'", name),
                   "expected: a name that ends in .exr or .png");
}

/// The channels of colour: R, G, B, or a grey image's only one three times.
std::array<const Channel*, 3> colors_of(const Image& image, const Parameters& parameters) {
  const std::array<const Channel*, 3> rgb{image.find("R"), image.find("G"), image.find("B")};
  if (rgb[0] && rgb[1] && rgb[2]) return rgb;
  const Channel* grey = image.find("Y");
  if (!grey && image.channels.size() == 1) grey = &image.channels.front();
  if (!grey)
    throw InputError(parameters.location("filename"),
                     fmt::format("'{}' has no channels R, G and B, nor Y", parameters.text("filename")));
  return {grey, grey, grey};
}

}  // namespace

const Plugin image_texture_plugin{
    "texture",
    "imagetexture",
    "An image file (EXR, PNG) over the unit square of uv: u to the right, v up.",
    {{"filename", Type::text, "", "", "The file, relative to the scene file", true},
     {"raw", Type::boolean, "false", "", "A PNG's values are plain numbers, not sRGB"},
     {"interpolation", Type::text, "bilinear", "", "Between pixels: bilinear or nearest"},
     {"wrap", Type::text, "repeat", "", "Outside of the unit square: repeat, mirror or clamp"}},
    {}};

ImageTexture make_image_texture(const Object& description, const std::filesystem::path& directory,
                                std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, image_texture_plugin, unread);
  using Wrap = ImageTexture::Wrap;
  using Interpolation = ImageTexture::Interpolation;
  ImageTexture texture;
  texture.interpolation = choice<Interpolation, 2>(
      parameters, "interpolation",
      {{{"bilinear", Interpolation::bilinear}, {"nearest", Interpolation::nearest}}});
  texture.wrap = choice<Wrap, 3>(
      parameters, "wrap", {{{"repeat", Wrap::repeat}, {"mirror", Wrap::mirror}, {"clamp", Wrap::clamp}}});
  const Image image =
      read_image(parameters, directory, parameters.boolean("raw") ? PngEncoding::linear : PngEncoding::srgb);
  const std::array<const Channel*, 3> channels = colors_of(image, parameters);
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
        const float value = channels[c]->values[(height - 1 - y) * width + x];
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

}  // namespace etendue
