#include "image/color_space.h"
#include "image/decoders.h"
#include "image/icc_profile.h"
#include "image/orientation.h"
#include "image/unreadable.h"

#include <array>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <png.h>
#include <utility>
#include <vector>

namespace etendue {
namespace {

/// The data of the first chunk of this type before the pixels; nullopt where there is none. What libpng
/// does not know, or drops because something is wrong with it, it does not tell.
std::optional<Bytes> chunk(Bytes png, std::string_view type) {
  constexpr std::size_t signature = 8, frame = 12;  // Length, type, and the checksum behind the data.
  for (std::size_t at = signature; png.size() - at >= frame;) {
    const std::size_t length = std::size_t(png[at]) << 24 | std::size_t(png[at + 1]) << 16 |
                               std::size_t(png[at + 2]) << 8 | png[at + 3];
    if (length > png.size() - at - frame || begins_with(png.subspan(at + 4), "IDAT")) break;
    if (begins_with(png.subspan(at + 4), type)) return png.subspan(at + 8, length);
    at += frame + length;
  }
  return std::nullopt;
}

/// libpng leaves by longjmp where something is wrong, so what it jumps over must not need a destructor.
struct PngReader {
  const Bytes bytes;
  std::size_t position = 0;
  std::array<char, 256> message{};
  png_structp png = nullptr;
  png_infop info = nullptr;
  png_uint_32 width = 0, height = 0;
  int bit_depth = 0;

  explicit PngReader(Bytes file) : bytes(file) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, [](png_structp, png_const_charp) {});
    if (png) info = png_create_info_struct(png);
    if (!info) throw std::bad_alloc();
  }
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReader(const PngReader&) = delete;

  [[noreturn]] static void fail(png_structp png, png_const_charp text) {
    auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(self->message.data(), text, self->message.size() - 1);
    png_longjmp(png, 1);
  }
  static void read(png_structp png, png_bytep to, std::size_t count) {
    auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
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

/// How the numbers of a file become linear light with Rec. 709 primaries.
struct PngColors {
  enum class Transfer { linear, srgb, power } transfer = Transfer::srgb;
  double exponent = 1;  ///< Of `power`.
  std::optional<Chromaticities> chromaticities;
  std::unique_ptr<IccProfile> profile;  ///< Where there is one, nothing else counts.

  double decode(double value) const {
    if (profile || transfer == Transfer::linear) return value;
    return transfer == Transfer::srgb ? linear_from_srgb(value) : std::pow(value, exponent);
  }
};

/// Code points of ITU-T H.273. Video's range and matrices have no place in a PNG.
PngColors colors_of_code_points(Bytes cicp) {
  if (cicp.size() != 4) throw Unreadable("its chunk cICP is damaged");
  constexpr int primaries_rec709 = 1, primaries_rec2020 = 9, primaries_p3_d65 = 12;
  constexpr int transfer_linear = 8, transfer_srgb = 13;
  PngColors colors;
  if (cicp[0] == primaries_rec2020)
    colors.chromaticities = {{{{0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}}}, rec709.white};
  else if (cicp[0] == primaries_p3_d65)
    colors.chromaticities = {{{{0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}}}, rec709.white};
  const bool is_known = cicp[0] == primaries_rec709 || colors.chromaticities;
  if (!is_known || (cicp[1] != transfer_linear && cicp[1] != transfer_srgb) || cicp[2] != 0 || cicp[3] != 1)
    throw Unreadable(
        fmt::format("its chunk cICP asks for the primaries {}, the transfer {}{}, the matrix {} and {} "
                    "range of ITU-T H.273, which are not supported; convert it to sRGB",
                    cicp[0], cicp[1],
                    cicp[1] == 16   ? " (PQ)"
                    : cicp[1] == 18 ? " (HLG)"
                                    : "",
                    cicp[2], cicp[3] == 1 ? "the full" : "a narrow"));
  if (cicp[1] == transfer_linear) colors.transfer = PngColors::Transfer::linear;
  return colors;
}

/// In the order of the PNG specification (third edition, section 4.3): cICP, iCCP, sRGB, gAMA with cHRM.
PngColors colors_of(const PngReader& reader) {
  if (const auto cicp = chunk(reader.bytes, "cICP")) return colors_of_code_points(*cicp);
  PngColors colors;
  png_charp name;
  png_bytep profile;
  png_uint_32 profile_size;
  int compression, intent;
  const bool is_srgb = png_get_sRGB(reader.png, reader.info, &intent) != 0;
  if (chunk(reader.bytes, "iCCP") && !is_srgb) {  // libpng knows the usual profiles of sRGB.
    if (!png_get_iCCP(reader.png, reader.info, &name, &compression, &profile, &profile_size))
      throw Unreadable("its colour profile is damaged, or not one of its kind of pixels; remove the profile");
    colors.profile = std::make_unique<IccProfile>(Bytes(profile, profile_size));
    if (colors.profile->is_srgb()) colors.profile.reset();
    return colors;
  }
  if (is_srgb) return colors;
  if (chunk(reader.bytes, "gAMA")) {
    constexpr double digits = 1e-3;
    double gamma;
    if (!png_get_gAMA(reader.png, reader.info, &gamma)) throw Unreadable("its chunk gAMA is damaged");
    colors.transfer = std::abs(gamma - 1) < digits ? PngColors::Transfer::linear : PngColors::Transfer::power;
    colors.exponent = 1 / gamma;
  }
  if (chunk(reader.bytes, "cHRM")) {
    Chromaticities& c = colors.chromaticities.emplace();
    auto& [red, green, blue] = c.primaries;
    if (!png_get_cHRM(reader.png, reader.info, &c.white.x, &c.white.y, &red.x, &red.y, &green.x, &green.y,
                      &blue.x, &blue.y))
      throw Unreadable("its chunk cHRM is damaged");
  }
  return colors;
}

ColorImage decode_png(Bytes bytes, const ColorRequest& request) {
  PngReader reader(bytes);
  if (!reader.read_header()) throw Unreadable(reader.message.data());
  const std::size_t row_size = std::size_t(reader.width) * 3 * std::size_t(reader.bit_depth / 8);
  std::vector<png_byte> pixels(row_size * reader.height);
  std::vector<png_bytep> rows(reader.height);
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = pixels.data() + y * row_size;
  if (!reader.read_rows(rows.data())) throw Unreadable(reader.message.data());
  PngColors colors;
  if (request.is_raw)
    colors.transfer = PngColors::Transfer::linear;
  else
    colors = colors_of(reader);

  const std::size_t levels = std::size_t(1) << reader.bit_depth;
  std::vector<float> decoded(levels);
  for (std::size_t level = 0; level < levels; ++level)
    decoded[level] = float(colors.decode(double(level) / double(levels - 1)));
  ColorImage image{int(reader.width), int(reader.height),
                   std::vector<float>(3 * std::size_t(reader.width) * reader.height)};
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    image.rgb[i] =
        decoded[reader.bit_depth == 16 ? std::size_t(pixels[2 * i]) << 8 | pixels[2 * i + 1] : pixels[i]];
  if (colors.profile)
    colors.profile->convert_to_rec709(image.rgb);
  else if (colors.chromaticities)
    if (const auto matrix = rec709_from(*colors.chromaticities)) convert_colors(*matrix, image.rgb);
  const std::optional<Bytes> exif = chunk(bytes, "eXIf");
  return exif ? upright(std::move(image), exif_orientation(*exif)) : image;
}

}  // namespace

const Decoder png_decoder{"PNG", [](Bytes begin) { return begins_with(begin, "\x89PNG"); }, decode_png};

}  // namespace etendue
