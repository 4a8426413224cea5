#include "image/color_space.h"
#include "image/decoders.h"
#include "image/icc_profile.h"
#include "image/orientation.h"
#include "image/unreadable.h"

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <memory>
#include <utility>
// libjpeg's headers need <cstdio>.
#include <jerror.h>
#include <jpeglib.h>

namespace etendue {
namespace {

/// libjpeg leaves by longjmp where something is wrong, so what it jumps over must not need a destructor.
struct JpegReader {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf end;
  std::array<char, JMSG_LENGTH_MAX> message{};

  explicit JpegReader(Bytes file) : bytes_(file) {
    jpeg.err = jpeg_std_error(&errors);
    jpeg.client_data = this;
    errors.error_exit = fail;
    errors.emit_message = [](j_common_ptr common, int level) {
      // Warnings mean that pixels were made up; these three do not.
      const int code = common->err->msg_code;
      if (level < 0 && code != JWRN_EXTRANEOUS_DATA && code != JWRN_ADOBE_XFORM && code != JWRN_JFIF_MAJOR)
        fail(common);
    };
    progress.progress_monitor = [](j_common_ptr common) {
      // Each scan of a progressive file may change every pixel: a small file could take hours.
      constexpr int most_scans = 500;
      auto* const self = static_cast<JpegReader*>(common->client_data);
      if (self->jpeg.input_scan_number > most_scans) self->fail_with("it has more than 500 scans");
    };
  }
  ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
  JpegReader(const JpegReader&) = delete;

  [[noreturn]] static void fail(j_common_ptr common) {
    auto* const self = static_cast<JpegReader*>(common->client_data);
    common->err->format_message(common, self->message.data());
    std::longjmp(self->end, 1);
  }
  [[noreturn]] void fail_with(const char* text) {
    std::snprintf(message.data(), message.size(), "%s", text);
    std::longjmp(end, 1);
  }

  /// Also the markers before the pixels. False: see `message`.
  bool read_header() {
    if (setjmp(end)) return false;
    jpeg_create_decompress(&jpeg);
    jpeg.progress = &progress;
    jpeg_mem_src(&jpeg, bytes_.data(), bytes_.size());
    constexpr unsigned longest = 0xffff;
    jpeg_save_markers(&jpeg, JPEG_APP0 + 1, longest);  // Exif
    jpeg_save_markers(&jpeg, JPEG_APP0 + 2, longest);  // The colour profile
    jpeg_read_header(&jpeg, TRUE);
    // A block of 64 pixels has at least a bit, but for arithmetic coding.
    const double pixels = double(jpeg.image_width) * jpeg.image_height;
    if (pixels > 1024.0 * double(bytes_.size()) || pixels > double(1 << 28))
      fail_with("its header promises more pixels than it can hold, or than 2^28");
    if (jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK)
      fail_with("it is in CMYK, inks and not light; convert it to sRGB");
    if (jpeg.jpeg_color_space == JCS_UNKNOWN) fail_with("its colour space is unknown; convert it to sRGB");
    jpeg.out_color_space = JCS_RGB;
    return true;
  }
  /// The colour profile, to be freed, or null.
  bool read_profile(JOCTET*& bytes, unsigned& size) {
    if (setjmp(end)) return false;
    if (!jpeg_read_icc_profile(&jpeg, &bytes, &size)) bytes = nullptr;
    return true;
  }
  /// To `to`, three bytes a pixel.
  bool read_rows(unsigned char* to) {
    if (setjmp(end)) return false;
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
      unsigned char* row = to + std::size_t(jpeg.output_scanline) * jpeg.output_width * 3;
      jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
    return true;
  }

 private:
  Bytes bytes_;
};

Orientation orientation_of(const jpeg_decompress_struct& jpeg) {
  constexpr std::string_view exif{"Exif\0\0", 6};
  for (const jpeg_marker_struct* marker = jpeg.marker_list; marker; marker = marker->next) {
    const Bytes data(marker->data, marker->data_length);
    if (marker->marker == JPEG_APP0 + 1 && begins_with(data, exif))
      return exif_orientation(data.subspan(exif.size()));
  }
  return {};
}

/// None where the file has none, or one of sRGB.
std::unique_ptr<IccProfile> profile_of(JpegReader& reader) {
  JOCTET* bytes = nullptr;
  unsigned size = 0;
  if (!reader.read_profile(bytes, size)) throw Unreadable(reader.message.data());
  if (!bytes) return nullptr;
  const std::unique_ptr<JOCTET, decltype(&std::free)> owner(bytes, &std::free);
  auto profile = std::make_unique<IccProfile>(Bytes(bytes, size));
  return profile->is_srgb() ? nullptr : std::move(profile);
}

ColorImage decode_jpeg(Bytes bytes, const ColorRequest& request) {
  JpegReader reader(bytes);
  if (!reader.read_header()) throw Unreadable(reader.message.data());
  const std::size_t values = 3 * std::size_t(reader.jpeg.image_width) * reader.jpeg.image_height;
  const std::unique_ptr<IccProfile> profile = request.is_raw ? nullptr : profile_of(reader);
  const Orientation orientation = orientation_of(reader.jpeg);
  std::vector<unsigned char> pixels(values);
  if (!reader.read_rows(pixels.data())) throw Unreadable(reader.message.data());
  std::array<float, 256> decoded;
  for (std::size_t level = 0; level < decoded.size(); ++level) {
    const double value = double(level) / 255;
    decoded[level] = float(request.is_raw || profile ? value : linear_from_srgb(value));
  }
  ColorImage image{int(reader.jpeg.image_width), int(reader.jpeg.image_height), std::vector<float>(values)};
  for (std::size_t i = 0; i < values; ++i) image.rgb[i] = decoded[pixels[i]];
  if (profile) profile->convert_to_rec709(image.rgb);
  return upright(std::move(image), orientation);
}

}  // namespace

const Decoder jpeg_decoder{"JPEG", [](Bytes begin) { return begins_with(begin, "\xff\xd8\xff"); },
                           decode_jpeg};

}  // namespace etendue
