#include "texture/color_image.h"

#include "scenefile/existing_file.h"

#include <fmt/format.h>
#include <fstream>
#include <system_error>

namespace etendue {

namespace {

/// By its first bytes: names of images lie now and then. What is not a regular file, or cannot be
/// opened, is left to read_exr, which says so.
ImageFormat format_of(const std::filesystem::path& file, const Location& where, const std::string& name) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return ImageFormat::exr;
  std::array<char, 4> begin{};
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return ImageFormat::exr;
  stream.read(begin.data(), begin.size());
  if (begin == std::array<char, 4>{'v', '/', '1', '\x01'}) return ImageFormat::exr;
  if (begin == std::array<char, 4>{'\x89', 'P', 'N', 'G'}) return ImageFormat::png;
  throw InputError(where, fmt::format("'{}' is neither an EXR nor a PNG image", name),
                   "convert it to one of these");
}

}  // namespace

ColorImage read_color_image(const Parameters& parameters, std::string_view name,
                            const std::filesystem::path& directory, PngEncoding encoding) {
  const std::filesystem::path file = existing_file(parameters, name, directory, "an EXR or PNG image");
  const Location& where = parameters.location(name);
  const bool is_png = format_of(file, where, parameters.text(name)) == ImageFormat::png;
  ColorImage color{is_png ? read_png(file, encoding) : read_exr(file), {}};
  const std::vector<Channel>& channels = color.image.channels;
  const auto number = [&](const char* channel) {
    std::size_t i = 0;
    while (i < channels.size() && channels[i].name != channel) ++i;
    return i;
  };
  color.rgb = {number("R"), number("G"), number("B")};
  const auto is_missing = [&](std::size_t i) { return i == channels.size(); };
  if (is_missing(color.rgb[0]) || is_missing(color.rgb[1]) || is_missing(color.rgb[2])) {
    const std::size_t grey = channels.size() == 1 ? 0 : number("Y");
    color.rgb = {grey, grey, grey};
  }
  if (is_missing(color.rgb[0])) {
    std::string names;
    for (const Channel& channel : channels) names += (names.empty() ? "" : ", ") + channel.name;
    throw InputError(
        where, fmt::format("{}: an image of colours needs the channels R, G and B, or Y", file.string()),
        "it has: " + names);
  }
  return color;
}

}  // namespace etendue
