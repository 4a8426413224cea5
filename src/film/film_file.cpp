#include "film/film_file.h"

#include "base/content_hash.h"
#include "base/error.h"
#include "base/temporary_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

namespace etendue {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::string_view magic = "ETDFILM\n";
constexpr std::uint32_t format_version = 1;
constexpr std::uint32_t longest_text = 1 << 16;
constexpr std::uint32_t most_blocks = 128;  // of a range: 64 ascending sizes, 64 descending
constexpr std::uint64_t bytes_per_pixel = 8 + 9 * 8, checksum_bytes = 8;

using PixelRecord = std::array<char, bytes_per_pixel>;

PixelRecord record_of(const PixelStatistics& pixel) {
  PixelRecord record;
  const double moments[]{pixel.mean.r, pixel.mean.g, pixel.mean.b, pixel.m2.r, pixel.m2.g,
                         pixel.m2.b,   pixel.m3.r,   pixel.m3.g,   pixel.m3.b};
  std::memcpy(record.data(), &pixel.count, sizeof pixel.count);
  std::memcpy(record.data() + sizeof pixel.count, moments, sizeof moments);
  return record;
}

PixelStatistics pixel_of(const PixelRecord& record) {
  PixelStatistics pixel;
  double m[9];
  std::memcpy(&pixel.count, record.data(), sizeof pixel.count);
  std::memcpy(m, record.data() + sizeof pixel.count, sizeof m);
  pixel.mean = {m[0], m[1], m[2]};
  pixel.m2 = {m[3], m[4], m[5]};
  pixel.m3 = {m[6], m[7], m[8]};
  return pixel;
}

/// In the order of the file; of a FilmOrigin, const or not.
auto texts_of(auto& origin) {
  return std::array{&origin.sampler, &origin.integrator, &origin.isa, &origin.dialect, &origin.software};
}

bool is_whole(const PixelStatistics& pixel, const FilmBlock& block) {
  return std::uint64_t(pixel.count) == block.last - block.first;
}

class Writer {
 public:
  explicit Writer(TemporaryFile& file) : file_(file) {}
  void bytes(const void* data, std::size_t count) {
    file_.write(data, count);
    hash_.add(data, count);
  }
  template <class T>
  void number(T value) {
    bytes(&value, sizeof value);
  }
  void text(const std::string& text) {
    number(std::uint32_t(text.size()));
    bytes(text.data(), text.size());
  }
  void checksum() { number(hash_.digest()); }

 private:
  TemporaryFile& file_;
  ContentHash hash_;
};

class FilmFileReader {
 public:
  explicit FilmFileReader(const std::filesystem::path& file)
      : file_(file), stream_(std::fopen(file.c_str(), "rbe"), std::fclose) {
    if (!stream_) fail(std::generic_category().message(errno));
    std::error_code error;
    size_ = std::filesystem::file_size(file, error);
    if (error) fail(error.message());
  }

  [[noreturn]] void fail(std::string_view problem) const {
    throw InputError(fmt::format("{}: cannot read this film: {}", file_.string(), problem));
  }
  [[noreturn]] void fail_as_cut_short() const {
    fail(fmt::format("it is cut short after {} bytes; it was not copied to its end", size_));
  }
  [[noreturn]] void fail_as_damaged(std::string_view what) const {
    fail(fmt::format("it is damaged: {}", what));
  }

  std::uint64_t left() const { return size_ - at_; }
  void bytes(void* data, std::size_t count) {
    if (count > left()) fail_as_cut_short();
    if (std::fread(data, 1, count, stream_.get()) != count)
      fail(std::generic_category().message(errno != 0 ? errno : EIO));
    hash_.add(data, count);
    at_ += count;
  }
  template <class T>
  T number() {
    T value;
    bytes(&value, sizeof value);
    return value;
  }
  std::string text() {
    const auto size = number<std::uint32_t>();
    if (size > longest_text) fail_as_damaged(fmt::format("a text of {} bytes", size));
    if (size > left()) fail_as_cut_short();
    std::string text(size, '\0');
    bytes(text.data(), size);
    return text;
  }
  void checksum() {
    const std::uint64_t expected = hash_.digest();
    if (number<std::uint64_t>() != expected) fail_as_damaged("its checksum is another one");
  }

 private:
  std::filesystem::path file_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
  std::uint64_t size_ = 0, at_ = 0;
  ContentHash hash_;
};

void read_magic_and_version(FilmFileReader& in) {
  std::array<char, magic.size()> start{};
  in.bytes(start.data(), std::min<std::uint64_t>(start.size(), in.left()));
  if (std::string_view(start.data(), start.size()) != magic)
    in.fail("it is another kind of file, not a film that Etendue has saved");
  if (const auto version = in.number<std::uint32_t>(); version != format_version)
    in.fail(
        fmt::format("its format is version {}, and this program reads version {}", version, format_version));
}

FilmBlock read_block(FilmFileReader& in, int width, int height) {
  const auto first = in.number<std::uint64_t>(), last = in.number<std::uint64_t>();
  FilmBlock block{first, last, Film(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      PixelRecord record;
      in.bytes(record.data(), record.size());
      PixelStatistics& pixel = block.film.at(x, y);
      pixel = pixel_of(record);
      if (!is_whole(pixel, block))
        in.fail_as_damaged(
            fmt::format("pixel ({}, {}) has {} of replicates {} to {}", x, y, pixel.count, first, last));
    }
  return block;
}

void check_writable(const std::filesystem::path& file, const FilmState& state) {
  const auto fail = [&](std::string_view problem) {
    throw InputError(fmt::format("{}: cannot save this film: {}", file.string(), problem));
  };
  if (state.origin.samples_per_replicate <= 0)
    fail(fmt::format("{} samples a replicate", state.origin.samples_per_replicate));
  for (const std::string* text : texts_of(state.origin))
    if (text->size() > longest_text) fail(fmt::format("a text of {} bytes is too long for it", text->size()));
  if (state.film.blocks().empty()) fail("it has no replicates");
  for (const FilmBlock& block : state.film.blocks())
    for (int y = 0; y < state.film.height(); ++y)
      for (int x = 0; x < state.film.width(); ++x)
        if (!is_whole(block.film.at(x, y), block))
          fail(fmt::format("it is a fragment: pixel ({}, {}) lacks replicates", x, y));
}

}  // namespace

void write_film(const std::filesystem::path& file, const FilmState& state) {
  check_writable(file, state);
  const FilmOrigin& origin = state.origin;
  TemporaryFile temporary(file);
  Writer out(temporary);
  out.bytes(magic.data(), magic.size());
  out.number(format_version);
  out.number(std::uint32_t(state.film.width()));
  out.number(std::uint32_t(state.film.height()));
  out.number(origin.seed);
  out.number(origin.scene_hash);
  out.number(std::uint64_t(origin.samples_per_replicate));
  out.number(std::uint8_t(origin.replicates_by == ReplicatesBy::scrambling));
  for (const std::string* text : texts_of(origin)) out.text(*text);
  out.number(std::uint32_t(state.film.blocks().size()));
  for (const FilmBlock& block : state.film.blocks()) {
    out.number(block.first);
    out.number(block.last);
    for (int y = 0; y < state.film.height(); ++y)
      for (int x = 0; x < state.film.width(); ++x) {
        const PixelRecord record = record_of(block.film.at(x, y));
        out.bytes(record.data(), record.size());
      }
  }
  out.checksum();
  temporary.commit();
}

FilmState read_film(const std::filesystem::path& file) {
  FilmFileReader in(file);
  read_magic_and_version(in);
  const auto width = in.number<std::uint32_t>(), height = in.number<std::uint32_t>();
  FilmOrigin origin;
  origin.seed = in.number<std::uint64_t>();
  origin.scene_hash = in.number<std::uint64_t>();
  origin.samples_per_replicate = std::int64_t(in.number<std::uint64_t>());
  if (origin.samples_per_replicate <= 0)
    in.fail_as_damaged(fmt::format("{} samples a replicate", origin.samples_per_replicate));
  const auto scrambling = in.number<std::uint8_t>();
  if (scrambling > 1) in.fail_as_damaged(fmt::format("replicates of kind {}", scrambling));
  origin.replicates_by = scrambling ? ReplicatesBy::scrambling : ReplicatesBy::block;
  for (std::string* text : texts_of(origin)) *text = in.text();
  const auto count = in.number<std::uint32_t>();
  constexpr std::uint32_t most_px = 1u << 30;
  if (width == 0 || height == 0 || width > most_px || height > most_px || count == 0 || count > most_blocks)
    in.fail_as_damaged(fmt::format("{} films of {} x {} pixels", count, width, height));
  // Before anything is allocated.
  const double wanted = double(count) * (16 + double(width) * height * bytes_per_pixel) + checksum_bytes;
  if (wanted > double(in.left())) in.fail_as_cut_short();
  if (wanted < double(in.left())) in.fail_as_damaged("it is longer than its pixels");
  std::vector<FilmBlock> blocks;
  for (std::uint32_t k = 0; k < count; ++k) blocks.push_back(read_block(in, int(width), int(height)));
  in.checksum();
  try {
    return {std::move(origin), FilmStack(std::move(blocks))};
  } catch (const InputError& error) {
    in.fail_as_damaged(error.what());
  }
}

}  // namespace etendue
