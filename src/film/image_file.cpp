#include "film/image_file.h"

#include "base/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <unistd.h>

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
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw InputError(fmt::format("{}: is a folder; give the name of a file", file.string()));
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, error))
    throw InputError(fmt::format("{}: the folder {} does not exist; make it first: mkdir -p {}",
                                 file.string(), folder.string(), folder.string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(
        fmt::format("{}: no permission to write in the folder {}", file.string(), folder.string()));
}

}  // namespace etendue
