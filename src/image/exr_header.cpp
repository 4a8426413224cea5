#include "image/exr_header.h"

#include "image/exr_names.h"
#include "image/unreadable.h"

#include <ImfChannelList.h>
#include <ImfPartType.h>
#include <ImfTileDescription.h>
#include <ImfVersion.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

namespace etendue {

bool ExrBytes::read(char* to, int count) {
  if (count < 0 || std::size_t(count) > bytes_.size() - position_) throw Unreadable("it ends too early");
  std::memcpy(to, bytes_.data() + position_, std::size_t(count));
  position_ += std::size_t(count);
  return position_ < bytes_.size();
}

void ExrBytes::seekg(std::uint64_t position) {
  if (position > bytes_.size()) throw Unreadable("it points behind its own end");
  position_ = position;
}

namespace {

/// Walks the attributes of a header: OpenEXR allocates what an attribute claims to need before it looks
/// whether the file is that long.
void check_attribute_sizes(ExrBytes& stream, std::size_t file_size) {
  const auto read_name = [&] {
    std::string name;
    for (char c; stream.read(&c, 1), c != '\0'; name += c)
      if (name.size() == exr_longest_name) throw Unreadable("a name in its header is too long");
    return name;
  };
  for (std::string name; !(name = read_name()).empty();) {
    read_name();  // The type.
    std::uint8_t bytes[4];
    stream.read(reinterpret_cast<char*>(bytes), 4);
    const std::size_t size =
        bytes[0] | std::size_t(bytes[1]) << 8 | std::size_t(bytes[2]) << 16 | std::size_t(bytes[3]) << 24;
    if (size > file_size - stream.tellg())
      throw Unreadable(fmt::format("its attribute '{}' claims {} bytes, more than the file has", name, size));
    stream.seekg(stream.tellg() + size);
  }
}

int lines_per_chunk(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1;
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      throw Unreadable("its compression is unknown");
  }
}

/// How many bytes of pixels one byte of file can hold at most, rounded up: deflate reaches 1032, PXR24 first
/// drops one byte of four, DWA first keeps one of 64 values of a flat block. The rest stay below deflate.
double most_compression(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
      return 1;
    case Imf::DWAA_COMPRESSION:
    case Imf::DWAB_COMPRESSION:
      return 1100.0 * 64;
    default:
      return 1100.0 * 4 / 3;
  }
}

std::string promise_of(const Imf::Header& header) {
  int channels = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) ++channels;
  return fmt::format("its header promises {} x {} pixels of {} channels", width_of(header.dataWindow()),
                     height_of(header.dataWindow()), channels);
}

/// Throws unless the file is long enough for the part's table of chunks.
void check_chunks(const ExrPart& part, std::size_t file_size) {
  const Imath::Box2i& window = part.header.dataWindow();
  const double width = double(width_of(window)), height = double(height_of(window));
  double chunks, bytes_per_chunk;
  if (part.is_tiled) {
    const Imf::TileDescription& tiles = part.header.tileDescription();
    chunks = std::ceil(width / tiles.xSize) * std::ceil(height / tiles.ySize);
    bytes_per_chunk = 8 + 20;  // Its entry in the table of offsets; its indices and size.
  } else {
    chunks = part.is_deep ? 1 : std::ceil(height / lines_per_chunk(part.header.compression()));
    bytes_per_chunk = 8 + 8;
  }
  if (part.header.hasChunkCount()) chunks = std::max(chunks, double(part.header.chunkCount()));
  if (chunks * bytes_per_chunk > double(file_size))
    throw Unreadable(fmt::format("{}, more than {} bytes can hold", promise_of(part.header), file_size));
}

}  // namespace

std::vector<ExrPart> read_exr_headers(std::span<const unsigned char> file) {
  ExrBytes stream(file);
  char start[8] = {};
  stream.read(start, 8);
  if (!Imf::isImfMagic(start)) throw Unreadable("it is not an EXR file");
  const auto flags = [&](int byte) { return int(std::uint8_t(start[byte])) << 8 * (byte - 4); };
  int version = flags(4) | flags(5) | flags(6) | flags(7);
  if (Imf::getVersion(version) > Imf::EXR_VERSION || !Imf::supportsFlags(Imf::getFlags(version)))
    throw Unreadable("it is of an unknown version of EXR");
  const bool is_multi_part = Imf::isMultiPart(version);

  std::vector<ExrPart> parts;
  const auto is_end_of_headers = [&] {
    char next;
    stream.read(&next, 1);
    stream.seekg(stream.tellg() - 1);
    return next == '\0';
  };
  do {
    const std::uint64_t begin = stream.tellg();
    check_attribute_sizes(stream, file.size());
    stream.seekg(begin);
    ExrPart part{};
    part.header.readFrom(stream, version);
    if (is_multi_part && (!part.header.hasType() || !part.header.hasName()))
      throw Unreadable("one of its parts has no name or no type");
    const std::string type = part.header.hasType() ? part.header.type() : "";
    part.is_tiled = is_multi_part ? Imf::isTiled(type) : Imf::isTiled(version);
    part.is_deep = is_multi_part ? Imf::isDeepData(type) : Imf::isNonImage(version);
    if (!type.empty() && !Imf::isSupportedType(type))
      throw Unreadable(fmt::format("its type '{}' is not supported", type));
    if (!type.empty() && (Imf::isTiled(type) != part.is_tiled || Imf::isDeepData(type) != part.is_deep))
      throw Unreadable(fmt::format("its type '{}' contradicts its layout", type));
    part.header.sanityCheck(part.is_tiled, is_multi_part);
    if (is_multi_part) part.name = part.header.name();
    check_chunks(part, file.size());
    parts.push_back(std::move(part));
  } while (is_multi_part && !is_end_of_headers());
  return parts;
}

void check_exr_pixels(const ExrPart& part, std::size_t file_size) {
  constexpr double most_values = 2147483648.0;  // 8 GiB of floats.
  constexpr double small_tile_bytes = 64
                                      << 20;  // A tile may be larger than the image, but not beyond reason.
  const Imf::Header& header = part.header;
  if (part.is_deep) throw Unreadable("deep images are not supported; flatten it first");
  const double width = double(width_of(header.dataWindow())), height = double(height_of(header.dataWindow()));
  double channels = 0, pixel_bytes = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    ++channels;
    pixel_bytes +=
        (c.channel().type == Imf::HALF ? 2.0 : 4.0) / (c.channel().xSampling * c.channel().ySampling);
  }
  if (channels == 0) throw Unreadable("it has no channels");
  if (part.is_tiled) {
    // OpenEXR reads whole rows of tiles.
    const Imf::TileDescription& tiles = header.tileDescription();
    const double row_bytes = std::max<double>(tiles.xSize, width) * tiles.ySize * pixel_bytes;
    if (row_bytes > std::max(small_tile_bytes, width * height * pixel_bytes))
      throw Unreadable(
          fmt::format("its tiles of {} x {} pixels do not fit its size", tiles.xSize, tiles.ySize));
  }
  const std::string promise = promise_of(header);
  if (width * height * pixel_bytes > most_compression(header.compression()) * double(file_size))
    throw Unreadable(fmt::format("{}, more than {} bytes can hold", promise, file_size));
  if (width * height * channels > most_values)
    throw Unreadable(promise + ", more than the 2^31 values supported");

  // Beside the data window all is black, so that the file's length says nothing.
  constexpr double small_window_values = 1 << 27;  // 512 MiB of floats.
  const double shown = double(width_of(header.displayWindow())) * double(height_of(header.displayWindow()));
  if (shown * channels > std::min(most_values, std::max(small_window_values, 16 * width * height * channels)))
    throw Unreadable(
        fmt::format("its display window of {} x {} pixels is far larger than the {} x {} that it has",
                    width_of(header.displayWindow()), height_of(header.displayWindow()), width, height));
}

}  // namespace etendue
