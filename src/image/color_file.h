// Image files as colours: for textures and environment maps.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace etendue {

/// Linear light with Rec. 709 primaries, three numbers a pixel, rows from the top.
struct ColorImage {
  int width = 0, height = 0;  ///< Pixels.
  std::vector<float> rgb;
  bool is_cube_map = false;  ///< The file says that it holds the six sides of a cube.
};

struct ColorRequest {
  bool is_raw = false;  ///< The numbers are not colours: neither decoded nor changed to other primaries.
  std::string layer;    ///< Of an EXR; empty: the one without a name, or the only one.
};

/// The file may be sound, but not for what was asked. what() goes on behind the file's name: "has no layer
/// 'x'".
struct ColorRequestError : std::runtime_error {
  enum class About { file, layer } about;
  std::string hint;
  ColorRequestError(About what, const std::string& problem, std::string what_to_do)
      : std::runtime_error(problem), about(what), hint(std::move(what_to_do)) {}
};

/// EXR, PNG, JPEG or Radiance HDR, told by its first bytes. What a file says of its colours is heeded
/// (docs/scene_format.md has all), its alpha is left aside. Numbers may be of any kind, NaN too, where the
/// format has them.
///
/// Throws InputError with the file's name for what cannot be read or understood, or
/// ColorRequestError. It never allocates more than
/// a file of that many bytes can hold, 512 MiB aside.
ColorImage read_colors(const std::filesystem::path& file, const ColorRequest& request = {});

}  // namespace etendue
