// Image files: EXR with named layers and metadata, PNG in sRGB.
#pragma once

#include <filesystem>
#include <optional>
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
  int width = 0, height = 0;  ///< Pixels.
  std::vector<Channel> channels;
  std::vector<std::pair<std::string, std::string>> metadata;  ///< Name and text: "seed", "7".

  /// The channel of this exact name, or nullptr.
  const Channel* find(const std::string& name) const;
};

/// 32-bit float, run-length encoded. Written to a temporary file in the same folder and renamed, so that a crash leaves the
/// old file or the new one. Values are kept bit for bit, NaN and infinities too. Throws InputError with the
/// path and the reason: an image that does not fit its size, two channels of one name, metadata under a name
/// that EXR uses itself, a file that cannot be written.
void write_exr(const std::filesystem::path& file, const Image& image);

/// R, G, B as 8-bit sRGB (IEC 61966-2-1), radiance 1 = white. What is brighter is white, what is negative
/// black: a PNG holds no more. A pixel with a NaN is magenta so that it is seen. Renamed and errors as
/// write_exr; all three channels are needed.
void write_png(const std::filesystem::path& file, const Image& image);
/// The bytes of a PNG of a grey image, of its channel G, encoded as by write_png.
std::string grey_png(const Image& image);

/// The first part of an EXR, scanlines or tiles: what its display window shows, black beside the data window;
/// all channels as float by name in alphabetical order, and the attributes that are strings. Of a mip-mapped
/// file, the full size. Throws InputError for what cannot be read, deep and chroma-subsampled files among it;
/// it never allocates more than a file of that many bytes can hold, 512 MiB aside.
Image read_exr(const std::filesystem::path& file);

enum class ImageFormat { exr, png };
/// By the ending of the name, in small letters or capitals; none where it is neither.
std::optional<ImageFormat> image_format(const std::filesystem::path& file);

/// Throws InputError unless the file's folder exists and can be written and its ending is .exr or .png:
/// asked before a render, not after.
void check_writable(const std::filesystem::path& file);

}  // namespace etendue
