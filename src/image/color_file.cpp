#include "image/color_file.h"

#include "base/error.h"
#include "image/decoders.h"
#include "image/image_file.h"
#include "image/unreadable.h"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <new>

namespace etendue {

std::vector<unsigned char> bytes_of(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw Unreadable("there is no such file");
  if (!std::filesystem::is_regular_file(file, error)) throw Unreadable("it is not a regular file");
  std::ifstream stream(file, std::ios::binary);
  std::vector<unsigned char> bytes(std::filesystem::file_size(file));
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size())))
    throw Unreadable("it cannot be opened or read");
  return bytes;
}

/// A file that calls itself an EXR or a PNG and is not was most likely taken for another: it is not read as
/// what it happens to be.
void check_name(const std::filesystem::path& file, const Decoder& decoder) {
  if (&decoder == &exr_decoder || &decoder == &png_decoder || !image_format(file)) return;
  throw ColorRequestError(
      ColorRequestError::About::file,
      fmt::format("is neither an EXR nor a PNG image, as its name has it, but a {} image", decoder.name),
      fmt::format("if it is the one you mean, let its name end in {}",
                  &decoder == &jpeg_decoder ? ".jpg" : ".hdr"));
}

std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

ColorImage read_colors(const std::filesystem::path& file, const ColorRequest& request) {
  std::string format = "image";
  const auto unreadable = [&](const std::string& why) {
    return InputError(fmt::format("{}: cannot read this {}: {}", file.string(), format, why));
  };
  try {
    const std::vector<unsigned char> bytes = bytes_of(file);
    const Bytes begin = Bytes(bytes).first(std::min<std::size_t>(bytes.size(), 16));
    for (const Decoder* decoder : {&exr_decoder, &png_decoder, &jpeg_decoder, &hdr_decoder})
      if (decoder->is_begun_by(begin)) {
        check_name(file, *decoder);
        format = fmt::format("{} image", decoder->name);
        if (!request.layer.empty() && decoder != &exr_decoder)
          throw ColorRequestError(ColorRequestError::About::layer,
                                  fmt::format("is a {}, which has no layers", format), "leave 'layer' out");
        return decoder->decode(bytes, request);
      }
    throw ColorRequestError(ColorRequestError::About::file,
                            "is neither an EXR nor a PNG, JPEG or Radiance HDR image",
                            "convert it to one of these");
  } catch (const ColorRequestError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw unreadable("not enough memory");
  } catch (const std::exception& error) {
    throw unreadable(printable(error.what()));
  }
}

}  // namespace etendue
