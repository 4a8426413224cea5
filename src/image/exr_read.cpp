#include "image/exr_read.h"

#include "base/error.h"
#include "image/decoders.h"
#include "image/exr_names.h"
#include "image/image_file.h"
#include "image/unreadable.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStringAttribute.h>
#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace etendue {

std::vector<float> in_display_window(const Imf::Header& header, std::vector<float> data, std::size_t values) {
  const Imath::Box2i& shown = header.displayWindow();
  const Imath::Box2i& there = header.dataWindow();
  if (shown == there) return data;
  std::vector<float> result(width_of(shown) * height_of(shown) * values);
  const int left = std::max(shown.min.x, there.min.x), right = std::min(shown.max.x, there.max.x);
  if (left > right) return result;
  for (int y = std::max(shown.min.y, there.min.y); y <= std::min(shown.max.y, there.max.y); ++y) {
    const auto at = [&](const Imath::Box2i& window) {
      return std::ptrdiff_t(
          (std::size_t(y - window.min.y) * width_of(window) + std::size_t(left - window.min.x)) * values);
    };
    std::copy_n(data.begin() + at(there), std::size_t(right - left + 1) * values, result.begin() + at(shown));
  }
  return result;
}

void read_exr_channels(std::span<const unsigned char> file, const std::vector<ExrPart>& parts,
                       std::size_t number, const std::vector<ExrTarget>& targets) {
  const Imf::Header& header = parts[number].header;
  const Imath::Box2i& window = header.dataWindow();
  Imf::FrameBuffer pixels;
  for (const ExrTarget& target : targets) {
    const Imf::Channel& channel = header.channels()[target.channel];
    if (channel.xSampling != 1 || channel.ySampling != 1)
      throw Unreadable(
          fmt::format("its channel {} is subsampled ({} x {}), which is not supported; convert it to RGB",
                      target.channel, channel.xSampling, channel.ySampling));
    pixels.insert(target.channel,
                  Imf::Slice::Make(Imf::FLOAT, target.first, window, sizeof(float) * target.step,
                                   sizeof(float) * target.step * width_of(window)));
  }
  ExrBytes stream(file);
  Imf::MultiPartInputFile input(stream);
  Imf::InputPart reader(input, int(number));
  reader.setFrameBuffer(pixels);
  reader.readPixels(window.min.y, window.max.y);
}

Image read_exr(const std::filesystem::path& file) {
  try {
    const std::vector<unsigned char> bytes = bytes_of(file);
    const std::vector<ExrPart> parts = read_exr_headers(bytes);
    const Imf::Header& header = parts[0].header;
    check_exr_pixels(parts[0], bytes.size());
    Image image;
    image.width = int(width_of(header.displayWindow()));
    image.height = int(height_of(header.displayWindow()));
    std::vector<ExrTarget> targets;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      image.channels.push_back(
          {c.name(), std::vector<float>(width_of(header.dataWindow()) * height_of(header.dataWindow()))});
      targets.push_back({c.name(), image.channels.back().values.data(), 1});
    }
    read_exr_channels(bytes, parts, 0, targets);
    for (Channel& channel : image.channels)
      channel.values = in_display_window(header, std::move(channel.values), 1);
    for (auto a = header.begin(); a != header.end(); ++a)
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute());
          text && !is_exr_own_name(a.name()))
        image.metadata.emplace_back(a.name(), text->value());
    return image;
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: cannot read this EXR image: not enough memory", file.string()));
  } catch (const std::exception& error) {
    throw InputError(
        fmt::format("{}: cannot read this EXR image: {}", file.string(), printable(error.what())));
  }
}

}  // namespace etendue
