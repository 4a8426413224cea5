#include "image/image_file.h"

#include "base/error.h"
#include "base/temporary_file.h"

#include <algorithm>
#include <fmt/format.h>

namespace etendue {

const Channel* Image::find(const std::string& name) const {
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const Channel& channel) { return channel.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

std::optional<ImageFormat> image_format(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  if (ending == ".exr") return ImageFormat::exr;
  if (ending == ".png") return ImageFormat::png;
  return std::nullopt;
}

void check_writable(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (!image_format(file))
    throw InputError(fmt::format(
        "{}: cannot tell the format of the image from {}\nexpected: a name that ends in .exr (float, all "
        "layers) "
        "or .png (8-bit sRGB)",
        file.string(), ending.empty() ? "a name without an ending" : fmt::format("the ending '{}'", ending)));
  check_destination(file);
}

}  // namespace etendue
