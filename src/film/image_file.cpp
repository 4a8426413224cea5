#include "film/image_file.h"

#include "base/error.h"
#include "film/temporary_file.h"

#include <algorithm>
#include <fmt/format.h>

namespace etendue {

const Channel* Image::find(const std::string& name) const {
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const Channel& channel) { return channel.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

void check_writable(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending != ".exr" && ending != ".png")
    throw InputError(fmt::format(
        "{}: cannot tell the format of the image from {}\nexpected: a name that ends in .exr (float, all "
        "layers) "
        "or .png (8-bit sRGB)",
        file.string(), ending.empty() ? "a name without an ending" : fmt::format("the ending '{}'", ending)));
  check_destination(file);
}

}  // namespace etendue
