#include "image/color_space.h"
#include "image/decoders.h"
#include "image/orientation.h"
#include "image/unreadable.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace etendue {
namespace {

using Rgbe = std::array<unsigned char, 4>;

class HdrReader {
 public:
  explicit HdrReader(Bytes bytes) : bytes_(bytes) {}

  std::string_view line() {
    const std::string_view text = rest();
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) throw Unreadable("it ends too early");
    position_ += end + 1;
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
  unsigned char byte() {
    if (position_ == bytes_.size()) throw Unreadable("it ends too early");
    return bytes_[position_++];
  }
  Rgbe pixel() {
    Rgbe value;
    for (unsigned char& part : value) part = byte();
    return value;
  }
  /// As pixel, but it stays to be read.
  Rgbe next_pixel() {
    const std::size_t before = position_;
    const Rgbe value = pixel();
    position_ = before;
    return value;
  }
  std::size_t left() const { return bytes_.size() - position_; }

 private:
  std::string_view rest() const {
    return std::string_view(reinterpret_cast<const char*>(bytes_.data()), bytes_.size()).substr(position_);
  }
  Bytes bytes_;
  std::size_t position_ = 0;
};

/// Numbers between blanks; throws unless there are `count`, all finite.
template <std::size_t count>
std::array<double, count> numbers_of_header(std::string_view name, std::string_view text) {
  std::array<double, count> values{};
  for (double& value : values) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t+"), text.size()));
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || !std::isfinite(value))
      throw Unreadable(fmt::format("its {} is not {} number{}", name, count, count == 1 ? "" : "s"));
    text.remove_prefix(std::size_t(end - text.data()));
  }
  return values;
}

struct Header {
  bool is_xyz = false, has_exposure = false;
  std::array<double, 3> exposure{1, 1, 1};  ///< What the pixels were multiplied by.
  std::optional<Chromaticities> chromaticities;
  Orientation orientation;
  int width = 0, height = 0;  ///< As stored: pixels of a row, and rows.
};

/// "-Y 64 +X 128": rows from the top, their pixels from the left.
void read_resolution(std::string_view line, Header& header) {
  const auto fail = [&] { return Unreadable(fmt::format("its size '{}' is none", line)); };
  const auto axis = [&](bool& is_x, bool& is_rising) {
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    if (line.size() < 3 || (line[0] != '+' && line[0] != '-') || (line[1] != 'X' && line[1] != 'Y'))
      throw fail();
    is_rising = line[0] == '+';
    is_x = line[1] == 'X';
    line.remove_prefix(2);
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    int size = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), size);
    if (error != std::errc() || size < 1) throw fail();
    line.remove_prefix(std::size_t(end - line.data()));
    return size;
  };
  bool rows_are_along_x = false, rows_rise = false, pixels_are_along_x = false, pixels_rise = false;
  header.height = axis(rows_are_along_x, rows_rise);
  header.width = axis(pixels_are_along_x, pixels_rise);
  if (rows_are_along_x == pixels_are_along_x) throw fail();
  // X runs to the right and Y up.
  header.orientation = {rows_are_along_x, rows_rise != rows_are_along_x, pixels_rise != pixels_are_along_x};
}

Header read_header(HdrReader& reader) {
  Header header;
  reader.line();
  for (std::string_view line; !(line = reader.line()).empty();) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos || line.starts_with('#') || line.starts_with('\t')) continue;
    const std::string_view name = line.substr(0, equals), value = line.substr(equals + 1);
    if (name == "FORMAT") {
      header.is_xyz = value == "32-bit_rle_xyze";
      if (!header.is_xyz && value != "32-bit_rle_rgbe")
        throw Unreadable(fmt::format("its format '{}' is not supported", value));
    } else if (name == "EXPOSURE") {
      header.has_exposure = true;
      for (double& factor : header.exposure) factor *= numbers_of_header<1>(name, value)[0];
    } else if (name == "COLORCORR") {
      for (std::size_t k = 0; k < 3; ++k) header.exposure[k] *= numbers_of_header<3>(name, value)[k];
    } else if (name == "PRIMARIES") {
      const auto n = numbers_of_header<8>(name, value);
      header.chromaticities = {{{{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}}}, {n[6], n[7]}};
    }
  }
  for (const double factor : header.exposure)
    if (!(factor > 0 && std::isfinite(1 / factor))) throw Unreadable("its exposure is not above 0");
  read_resolution(reader.line(), header);
  return header;
}

/// The four parts one after the other, each as runs and literal bytes.
void read_parts(HdrReader& reader, std::vector<Rgbe>& row) {
  reader.pixel();
  for (std::size_t part = 0; part < 4; ++part)
    for (std::size_t x = 0; x < row.size();) {
      constexpr int longest_literal = 128;
      const int code = reader.byte();
      const bool is_run = code > longest_literal;
      const auto length = std::size_t(is_run ? code - longest_literal : code);
      if (length == 0 || length > row.size() - x) throw Unreadable("a row of it does not fit its width");
      const unsigned char repeated = is_run ? reader.byte() : 0;
      for (const std::size_t end = x + length; x < end; ++x) row[x][part] = is_run ? repeated : reader.byte();
    }
}

/// Pixels as they are; 1 1 1 n repeats the one before, n << 8 k times where k such stand before it.
void read_rgbe_pixels(HdrReader& reader, std::vector<Rgbe>& row) {
  int shift = 0;
  for (std::size_t x = 0; x < row.size();) {
    const Rgbe pixel = reader.pixel();
    if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
      row[x++] = pixel;
      shift = 0;
      continue;
    }
    const std::size_t count = shift < 32 ? std::size_t(pixel[3]) << shift : row.size() + 1;
    if (x == 0 || count > row.size() - x) throw Unreadable("a row of it does not fit its width");
    std::fill_n(row.begin() + std::ptrdiff_t(x), count, row[x - 1]);
    x += count;
    shift += 8;
  }
}

void read_row(HdrReader& reader, std::vector<Rgbe>& row) {
  constexpr std::size_t least_width = 8, most_width = 0x7fff;  // Of a row in parts.
  const Rgbe next = reader.next_pixel();
  const bool is_in_parts =
      row.size() >= least_width && row.size() <= most_width && next[0] == 2 && next[1] == 2 && next[2] < 128;
  if (!is_in_parts) return read_rgbe_pixels(reader, row);
  if (std::size_t(next[2]) << 8 != row.size() - next[3] || next[3] > row.size())
    throw Unreadable("a row of it does not fit its width");
  read_parts(reader, row);
}

ColorImage decode_hdr(Bytes bytes, const ColorRequest& request) {
  HdrReader reader(bytes);
  const Header header = read_header(reader);
  const double pixels = double(header.width) * header.height;
  // Four bytes can repeat a pixel 255 times, more of them in a row even more often.
  if (pixels > 1024.0 * double(reader.left()) || pixels > double(1 << 28))
    throw Unreadable(fmt::format("its header promises {} x {} pixels, more than it can hold, or than 2^28",
                                 header.width, header.height));
  ColorImage image{header.width, header.height, std::vector<float>(3 * std::size_t(pixels))};
  std::vector<Rgbe> row(std::size_t(header.width));
  std::size_t i = 0;
  for (int y = 0; y < header.height; ++y) {
    read_row(reader, row);
    for (const Rgbe& pixel : row) {
      const double unit = pixel[3] == 0 ? 0 : std::ldexp(1.0, pixel[3] - (128 + 8));
      for (std::size_t k = 0; k < 3; ++k) image.rgb[i++] = float(pixel[k] * unit / header.exposure[k]);
    }
  }
  std::optional<ColorMatrix> matrix;
  if (header.is_xyz) {
    // X, Y and Z are primaries themselves, and Radiance's white has equal energy.
    matrix = rec709_from({{{{1, 0}, {0, 1}, {0, 0}}}, {1 / 3.0, 1 / 3.0}});
    // With an exposure Y is luminance, of which Radiance reckons 179 lm to 1 W.
    constexpr double white_efficacy = 179;
    if (header.has_exposure)
      for (auto& matrix_row : *matrix)
        for (double& factor : matrix_row) factor /= white_efficacy;
  } else if (header.chromaticities) {
    matrix = rec709_from(*header.chromaticities);
  }
  if (matrix && !request.is_raw) convert_colors(*matrix, image.rgb);
  return upright(std::move(image), header.orientation);
}

}  // namespace

const Decoder hdr_decoder{"Radiance HDR", [](Bytes begin) { return begins_with(begin, "#?"); }, decode_hdr};

}  // namespace etendue
