#include "base/error.h"
#include "base/temporary_file.h"
#include "image/image_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <fmt/format.h>
#include <png.h>
#include <vector>

namespace etendue {
namespace {

/// The transfer function of IEC 61966-2-1 from linear light, rounded to 8 bits.
png_byte srgb_byte(float linear) {
  const double x = std::clamp(double(linear), 0.0, 1.0);
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return png_byte(std::lround(255 * encoded));
}

const std::vector<float>& values_of(const std::filesystem::path& file, const Image& image, const char* name) {
  const Channel* channel = image.find(name);
  if (!channel)
    throw InputError(
        fmt::format("{}: a PNG needs the channels R, G and B; {} is missing", file.string(), name));
  if (image.width < 1 || image.height < 1 ||
      channel->values.size() != std::size_t(image.width) * std::size_t(image.height))
    throw InputError(fmt::format("{}: channel {} has {} values, the image {} x {} pixels", file.string(),
                                 name, channel->values.size(), image.width, image.height));
  return channel->values;
}

using Pixels = std::vector<std::array<png_byte, 3>>;

Pixels pixels_of(const std::filesystem::path& file, const Image& image) {
  const auto &r = values_of(file, image, "R"), &g = values_of(file, image, "G"),
             &b = values_of(file, image, "B");
  Pixels pixels(r.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (std::isnan(r[i]) || std::isnan(g[i]) || std::isnan(b[i]))
      pixels[i] = {255, 0, 255};
    else
      pixels[i] = {srgb_byte(r[i]), srgb_byte(g[i]), srgb_byte(b[i])};
  }
  return pixels;
}

/// 8 bits: libpng then tags the file as sRGB.
png_image png_of(const Image& image, png_uint_32 format) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = png_uint_32(image.width);
  png.height = png_uint_32(image.height);
  png.format = format;
  return png;
}

}  // namespace

void write_png(const std::filesystem::path& file, const Image& image) {
  const Pixels pixels = pixels_of(file, image);
  TemporaryFile temporary(file);
  png_image png = png_of(image, PNG_FORMAT_RGB);
  errno = 0;
  if (!png_image_write_to_stdio(&png, temporary.stream(), 0, pixels.data(), 0, nullptr))
    temporary.fail_to_write(png.message);
  temporary.commit();
}

std::string grey_png(const Image& image) {
  std::vector<png_byte> greens;
  for (const auto& pixel : pixels_of("a picture", image)) greens.push_back(pixel[1]);
  png_image png = png_of(image, PNG_FORMAT_GRAY);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, greens.data(), 0, nullptr))
    throw InputError(png.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace etendue
