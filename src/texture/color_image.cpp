#include "texture/color_image.h"

#include "scenefile/existing_file.h"

#include <fmt/format.h>

namespace etendue {

ColorImage read_color_image(const Parameters& parameters, std::string_view name,
                            const std::filesystem::path& directory, bool is_raw) {
  const std::filesystem::path file = existing_file(parameters, name, directory, "an image");
  try {
    return read_colors(file, {is_raw, parameters.has("layer") ? parameters.text("layer") : ""});
  } catch (const ColorRequestError& error) {
    const bool is_about_layer = error.about == ColorRequestError::About::layer;
    throw InputError(parameters.location(is_about_layer ? "layer" : name),
                     fmt::format("'{}' {}", parameters.text(name), error.what()), error.hint);
  }
}

}  // namespace etendue
