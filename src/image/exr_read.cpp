#include "base/error.h"
#include "image/exr_names.h"
#include "image/image_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescription.h>
#include <ImfVersion.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <span>
#include <stdexcept>

namespace etendue {
namespace {

/// What is wrong with the file; read_exr puts the path before it.
struct Unreadable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class MemoryStream : public Imf::IStream {
 public:
  MemoryStream(std::span<const char> bytes, const std::string& name) : IStream(name.c_str()), bytes_(bytes) {}
  bool read(char* to, int count) override {
    if (count < 0 || std::size_t(count) > bytes_.size() - position_) throw Unreadable("it ends too early");
    std::memcpy(to, bytes_.data() + position_, std::size_t(count));
    position_ += std::size_t(count);
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw Unreadable("it points behind its own end");
    position_ = position;
  }

 private:
  std::span<const char> bytes_;
  std::size_t position_ = 0;
};

/// Walks the attributes of a single-part header: OpenEXR allocates what an attribute claims to need before it
/// looks whether the file is that long.
void check_attribute_sizes(MemoryStream& stream, std::size_t file_size) {
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

/// Throws unless a file of so many bytes can hold what the header promises: OpenEXR and we allocate by the
/// header.
void check_size(const Imf::Header& header, bool is_tiled, std::size_t file_size) {
  constexpr double most_values = 2147483648.0;  // 8 GiB of floats.
  constexpr double small_tile_bytes = 64
                                      << 20;  // A tile may be larger than the image, but not beyond reason.
  const Imath::Box2i& window = header.dataWindow();
  const double width = double(window.max.x) - double(window.min.x) + 1;
  const double height = double(window.max.y) - double(window.min.y) + 1;
  double channels = 0, pixel_bytes = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
      throw Unreadable(
          fmt::format("its channel {} is subsampled ({} x {}), which is not supported; convert it to RGB",
                      c.name(), c.channel().xSampling, c.channel().ySampling));
    ++channels;
    pixel_bytes += c.channel().type == Imf::HALF ? 2 : 4;
  }
  if (channels == 0) throw Unreadable("it has no channels");

  double chunks, bytes_per_chunk;
  if (is_tiled) {
    const Imf::TileDescription& tiles = header.tileDescription();
    const double tile_width = tiles.xSize, tile_height = tiles.ySize;
    chunks = std::ceil(width / tile_width) * std::ceil(height / tile_height);
    bytes_per_chunk = 8 + 20;  // Its entry in the table of offsets; its indices and size.
    // OpenEXR reads whole rows of tiles.
    const double row_bytes = std::max(tile_width, width) * tile_height * pixel_bytes;
    if (row_bytes > std::max(small_tile_bytes, width * height * pixel_bytes))
      throw Unreadable(
          fmt::format("its tiles of {} x {} pixels do not fit its size", tiles.xSize, tiles.ySize));
  } else {
    chunks = std::ceil(height / lines_per_chunk(header.compression()));
    bytes_per_chunk = 8 + 8;
  }
  const std::string promise =
      fmt::format("its header promises {} x {} pixels of {} channels", width, height, channels);
  if (chunks * bytes_per_chunk > double(file_size) ||
      width * height * pixel_bytes > most_compression(header.compression()) * double(file_size))
    throw Unreadable(fmt::format("{}, more than {} bytes can hold", promise, file_size));
  if (width * height * channels > most_values)
    throw Unreadable(promise + ", more than the 2^31 values supported");
}

/// Checks all that OpenEXR would act upon before it looks at the rest of the file.
void check_header(std::span<const char> bytes, const std::string& name) {
  MemoryStream stream(bytes, name);
  char start[8] = {};
  stream.read(start, 8);
  if (!Imf::isImfMagic(start)) throw Unreadable("it is not an EXR file");
  const auto flags = [&](int byte) { return int(std::uint8_t(start[byte])) << 8 * (byte - 4); };
  int version = flags(4) | flags(5) | flags(6) | flags(7);
  if (Imf::getVersion(version) > Imf::EXR_VERSION || !Imf::supportsFlags(Imf::getFlags(version)))
    throw Unreadable("it is of an unknown version of EXR");
  if (Imf::isNonImage(version)) throw Unreadable("deep images are not supported; flatten it first");
  if (Imf::isMultiPart(version)) throw Unreadable("multi-part files are not supported; extract one part");
  check_attribute_sizes(stream, bytes.size());

  stream.seekg(8);
  Imf::Header header;
  header.readFrom(stream, version);
  const bool is_tiled = Imf::isTiled(version);
  header.sanityCheck(is_tiled);
  if (header.hasType() && header.type() != (is_tiled ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE))
    throw Unreadable(fmt::format("its type '{}' is not supported or contradicts its layout", header.type()));
  check_size(header, is_tiled, bytes.size());
}

Image read(std::span<const char> bytes, const std::string& name) {
  check_header(bytes, name);
  MemoryStream stream(bytes, name);
  Imf::InputFile input(stream);
  const Imf::Header& header = input.header();
  const Imath::Box2i& window = header.dataWindow();
  Image image;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
    image.channels.push_back(
        {c.name(), std::vector<float>(std::size_t(image.width) * std::size_t(image.height))});
  for (auto a = header.begin(); a != header.end(); ++a)
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute());
        text && !is_exr_own_name(a.name()))
      image.metadata.emplace_back(a.name(), text->value());

  Imf::FrameBuffer pixels;
  for (Channel& channel : image.channels)
    pixels.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), window, sizeof(float),
                                                 sizeof(float) * std::size_t(image.width)));
  input.setFrameBuffer(pixels);
  input.readPixels(window.min.y, window.max.y);
  return image;
}

std::vector<char> bytes_of(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw Unreadable("there is no such file");
  if (!std::filesystem::is_regular_file(file, error)) throw Unreadable("it is not a regular file");
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> bytes(std::filesystem::file_size(file));
  if (!stream.read(bytes.data(), std::streamsize(bytes.size())))
    throw Unreadable("it cannot be opened or read");
  return bytes;
}

/// Names in a corrupt file are arbitrary bytes, and messages go to terminals and JSON.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

}  // namespace

Image read_exr(const std::filesystem::path& file) {
  try {
    return read(bytes_of(file), file.filename().string());
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: cannot read this EXR image: not enough memory", file.string()));
  } catch (const std::exception& error) {
    throw InputError(
        fmt::format("{}: cannot read this EXR image: {}", file.string(), printable(error.what())));
  }
}

}  // namespace etendue
