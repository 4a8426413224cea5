// Image files: EXR with named layers and metadata, PNG in sRGB.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace etendue {

/// One float channel of an image, rows from the top.
struct Channel {
  std::string name;  ///< "R", "stderr.R", "light.ceiling.G" ...
  std::vector<float> values;
};

struct Image {
  int width = 0, height = 0;
  std::vector<Channel> channels;
  std::vector<std::pair<std::string, std::string>> metadata;

  const Channel* find(const std::string& name) const;
};

/// 32-bit float, ZIP. Written to a temporary file and renamed. Throws InputError with the path and the reason.
void write_exr(const std::filesystem::path& file, const Image& image);
/// R, G, B as 8-bit sRGB (IEC 61966-2-1), radiance 1 = white; NaN is magenta so that it is seen. Same errors.
void write_png(const std::filesystem::path& file, const Image& image);
/// Any single-part scanline or tiled EXR, all channels as float. Throws InputError.
Image read_exr(const std::filesystem::path& file);
/// Throws InputError unless the file's folder exists and can be written and its ending is .exr or .png:
/// asked before a render, not after.
void check_writable(const std::filesystem::path& file);

}  // namespace etendue
