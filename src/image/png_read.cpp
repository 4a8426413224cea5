#include "base/error.h"
#include "image/image_file.h"

#include <array>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <png.h>
#include <vector>

namespace etendue {
namespace {

/// Linear light from the transfer function of IEC 61966-2-1.
float linear_from_srgb(double encoded) {
  return float(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
}

/// libpng leaves by longjmp where something is wrong, so what it jumps over must not need a destructor.
struct Decoder {
  const std::vector<png_byte>& bytes;
  std::size_t position = 0;
  std::array<char, 256> message{};
  png_structp png = nullptr;
  png_infop info = nullptr;
  png_uint_32 width = 0, height = 0;
  int bit_depth = 0;

  explicit Decoder(const std::vector<png_byte>& file) : bytes(file) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, [](png_structp, png_const_charp) {});
    if (png) info = png_create_info_struct(png);
    if (!info) throw std::bad_alloc();
  }
  ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
  Decoder(const Decoder&) = delete;

  [[noreturn]] static void fail(png_structp png, png_const_charp text) {
    auto* self = static_cast<Decoder*>(png_get_error_ptr(png));
    std::strncpy(self->message.data(), text, self->message.size() - 1);
    png_longjmp(png, 1);
  }
  static void read(png_structp png, png_bytep to, std::size_t count) {
    auto* self = static_cast<Decoder*>(png_get_io_ptr(png));
    if (count > self->bytes.size() - self->position) png_error(png, "it ends too early");
    std::memcpy(to, self->bytes.data() + self->position, count);
    self->position += count;
  }

  /// Width, height and depth, with transformations set to RGB of 8 or 16 bits. False: see `message`.
  bool read_header() {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_read_fn(png, this, read);
    png_read_info(png, info);
    width = png_get_image_width(png, info);
    height = png_get_image_height(png, info);
    // Deflate reaches 1032; a pixel may have a single bit.
    if (double(width) * height > 1032.0 * 8 * double(bytes.size()) ||
        double(width) * height > double(1 << 28))
      png_error(png, "its header promises more pixels than it can hold, or than 2^28");
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    png_set_strip_alpha(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    bit_depth = png_get_bit_depth(png, info);
    if (png_get_rowbytes(png, info) != std::size_t(width) * 3 * std::size_t(bit_depth / 8))
      png_error(png, "its pixels cannot be brought to RGB");
    return true;
  }
  bool read_rows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_image(png, rows);
    png_read_end(png, nullptr);
    return true;
  }
};

InputError unreadable(const std::filesystem::path& file, std::string_view why) {
  return InputError(fmt::format("{}: cannot read this PNG image: {}", file.string(), why));
}

std::vector<png_byte> bytes_of(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw unreadable(file, "there is no such file");
  if (!std::filesystem::is_regular_file(file, error)) throw unreadable(file, "it is not a regular file");
  std::ifstream stream(file, std::ios::binary);
  std::vector<png_byte> bytes(std::filesystem::file_size(file));
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size())))
    throw unreadable(file, "it cannot be opened or read");
  return bytes;
}

}  // namespace

Image read_png(const std::filesystem::path& file, PngEncoding encoding) {
  const std::vector<png_byte> bytes = bytes_of(file);
  Decoder decoder(bytes);
  if (!decoder.read_header()) throw unreadable(file, decoder.message.data());
  const std::size_t count = std::size_t(decoder.width) * decoder.height,
                    row_size = std::size_t(decoder.width) * 3 * std::size_t(decoder.bit_depth / 8);
  std::vector<png_byte> pixels(row_size * decoder.height);
  std::vector<png_bytep> rows(decoder.height);
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = pixels.data() + y * row_size;
  if (!decoder.read_rows(rows.data())) throw unreadable(file, decoder.message.data());

  const std::size_t levels = std::size_t(1) << decoder.bit_depth;
  std::vector<float> decoded(levels);
  for (std::size_t level = 0; level < levels; ++level) {
    const double value = double(level) / double(levels - 1);
    decoded[level] = encoding == PngEncoding::srgb ? linear_from_srgb(value) : float(value);
  }
  Image image;
  image.width = int(decoder.width);
  image.height = int(decoder.height);
  for (const char* name : {"R", "G", "B"}) image.channels.push_back({name, std::vector<float>(count)});
  const bool is_wide = decoder.bit_depth == 16;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const png_byte* value = pixels.data() + (3 * i + c) * (is_wide ? 2 : 1);
      image.channels[c].values[i] = decoded[is_wide ? std::size_t(value[0]) << 8 | value[1] : value[0]];
    }
  return image;
}

}  // namespace etendue
