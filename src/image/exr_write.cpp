#include "base/error.h"
#include "base/temporary_file.h"
#include "image/exr_names.h"
#include "image/image_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <cerrno>
#include <fmt/format.h>
#include <system_error>

namespace etendue {
namespace {

/// OpenEXR swallows what its destructors meet; the stream's own error state does not forget.
class StdioStream : public Imf::OStream {
 public:
  StdioStream(std::FILE* stream, const std::string& name) : OStream(name.c_str()), stream_(stream) {}
  int error() const { return error_; }  ///< What the system said of the first write that failed; 0: none has.
  void write(const char* bytes, int count) override {
    if (std::fwrite(bytes, 1, std::size_t(count), stream_) != std::size_t(count)) fail();
  }
  std::uint64_t tellp() override { return std::uint64_t(ftello(stream_)); }
  void seekp(std::uint64_t position) override {
    if (fseeko(stream_, off_t(position), SEEK_SET) != 0) fail();
  }

 private:
  [[noreturn]] void fail() {
    if (error_ == 0) error_ = errno;
    throw std::system_error(errno, std::generic_category());
  }
  std::FILE* stream_;
  int error_ = 0;
};

void check_name(const std::filesystem::path& file, const char* what, const std::string& name, bool is_taken) {
  if (name.empty() || name.size() > exr_longest_name)
    throw InputError(fmt::format("{}: the name '{}' of a {} has {} bytes; EXR allows 1 to {}", file.string(),
                                 name, what, name.size(), exr_longest_name));
  if (is_taken) throw InputError(fmt::format("{}: two {}s are named '{}'", file.string(), what, name));
}

Imf::Header header_of(const std::filesystem::path& file, const Image& image) {
  if (image.width < 1 || image.height < 1)
    throw InputError(fmt::format("{}: an image of {} x {} pixels", file.string(), image.width, image.height));
  Imf::Header header(image.width, image.height);
  // Noise hardly gets smaller: ZIP takes seven times as long and leaves 8 % less.
  header.compression() = Imf::RLE_COMPRESSION;
  for (const Channel& channel : image.channels) {
    check_name(file, "channel", channel.name, header.channels().findChannel(channel.name));
    if (channel.values.size() != std::size_t(image.width) * std::size_t(image.height))
      throw InputError(fmt::format("{}: channel {} has {} values, the image {} x {} pixels", file.string(),
                                   channel.name, channel.values.size(), image.width, image.height));
    header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
  }
  for (const auto& [name, text] : image.metadata) {
    if (is_exr_own_name(name))
      throw InputError(
          fmt::format("{}: metadata cannot be named '{}': EXR itself uses that name", file.string(), name));
    check_name(file, "metadata field", name, header.find(name) != header.end());
    header.insert(name, Imf::StringAttribute(text));
  }
  return header;
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Image& image) {
  const Imf::Header header = header_of(file, image);
  Imf::FrameBuffer pixels;
  for (const Channel& channel : image.channels) {
    // OpenEXR has one type for reading and writing; it only reads from here.
    char* values = reinterpret_cast<char*>(const_cast<float*>(channel.values.data()));
    pixels.insert(channel.name,
                  Imf::Slice(Imf::FLOAT, values, sizeof(float), sizeof(float) * std::size_t(image.width)));
  }
  TemporaryFile temporary(file);
  StdioStream stream(temporary.stream(), file.string());
  try {
    Imf::OutputFile output(stream, header);
    output.setFrameBuffer(pixels);
    output.writePixels(image.height);
  } catch (const std::exception& error) {
    errno = stream.error();
    temporary.fail_to_write(error.what());
  }
  if (stream.error() != 0) {  // In a destructor.
    errno = stream.error();
    temporary.fail_to_write("");
  }
  temporary.commit();
}

}  // namespace etendue
