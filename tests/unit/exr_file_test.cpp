#include "base/error.h"
#include "image/image_file.h"
#include "support/data_folder.h"
#include "support/error_of.h"
#include "support/temporary_folder.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <gmock/gmock.h>
#include <limits>
#include <sys/resource.h>

namespace etendue {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class ExrFile : public testing::Test {
 protected:
  void write_bytes(const std::string& bytes) {
    fs::remove(file);  // Cutting a file short and filling it again makes some file systems wait for the disk.
    std::ofstream(file, std::ios::binary) << bytes;
  }
  std::string read_bytes() const {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::size_t files_in_folder() const {
    return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  const test::TemporaryFolder temporary;
  const fs::path folder = temporary.path();
  const fs::path file = folder / "image.exr";
};

Image small_image() {
  constexpr float infinity = std::numeric_limits<float>::infinity(),
                  nan = std::numeric_limits<float>::quiet_NaN();
  return {3,
          2,
          {{"R", {0, 1, 2, 3, 4, 5}},
           {"G", {0.1f, -1, 1e-40f, 3e38f, infinity, nan}},
           {"B", {1, 1, 1, 1, 1, 1}},
           {"stderr.R", {-0.0f, 1e-10f, 0, 0, 0, 0}},
           {"light.a name longer than thirty-one bytes.R", {6, 5, 4, 3, 2, 1}}},
          {{"seed", "7"}, {"scene", "caf\xc3\xa9.xml"}, {"comments", ""}}};
}

Image constant_image(int width, int height) {
  return {width, height, {{"R", std::vector<float>(std::size_t(width) * std::size_t(height), 0.5f)}}, {}};
}

TEST_F(ExrFile, KeepsEveryBitEveryNameAndTheMetadata) {
  const Image written = small_image();
  write_exr(file, written);
  const Image image = read_exr(file);
  EXPECT_EQ(image.width, 3);
  EXPECT_EQ(image.height, 2);
  ASSERT_EQ(image.channels.size(), written.channels.size());
  for (const Channel& channel : written.channels) {
    const Channel* found = image.find(channel.name);
    ASSERT_NE(found, nullptr) << channel.name;
    ASSERT_EQ(found->values.size(), channel.values.size());
    EXPECT_EQ(std::memcmp(found->values.data(), channel.values.data(), 6 * sizeof(float)), 0) << channel.name;
  }
  EXPECT_THAT(image.metadata, testing::UnorderedElementsAreArray(written.metadata));
  EXPECT_EQ(image.find("r"), nullptr);
  EXPECT_EQ(files_in_folder(), 1u) << "a temporary file was left";
}

TEST_F(ExrFile, KeepsALargeImageOfManyChunks) {
  Image written = constant_image(301, 157);
  for (std::size_t i = 0; i < written.channels[0].values.size(); ++i)
    written.channels[0].values[i] = float(i * i);
  write_exr(file, written);
  EXPECT_EQ(read_exr(file).channels[0].values, written.channels[0].values);
}

TEST_F(ExrFile, ReadsTheMostCompressibleImage) {  // The guards must not refuse what a small file truly holds.
  const Image written = constant_image(4096, 1024);
  Imf::Header header(written.width, written.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer pixels;
  for (const Channel& channel : written.channels) {
    header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
    char* values = reinterpret_cast<char*>(const_cast<float*>(channel.values.data()));
    pixels.insert(channel.name,
                  Imf::Slice(Imf::FLOAT, values, sizeof(float), sizeof(float) * std::size_t(written.width)));
  }
  {
    Imf::OutputFile output(file.string().c_str(), header);
    output.setFrameBuffer(pixels);
    output.writePixels(written.height);
  }
  EXPECT_LT(fs::file_size(file), 64 * 1024u);
  EXPECT_EQ(read_exr(file).channels[0].values, written.channels[0].values);
}

TEST_F(ExrFile, ReplacesAnOlderFile) {
  write_bytes("old");
  write_exr(file, small_image());
  EXPECT_EQ(read_exr(file).width, 3);
}

/// 37 x 21 pixels from (-5, 100) on, all of the image, written by OpenEXR itself: H (half), F (float) and U
/// (unsigned) count pixels.
struct ForeignImage {
  static constexpr int width = 37, height = 21;
  static inline const Imath::Box2i window{{-5, 100}, {-5 + width - 1, 100 + height - 1}};
  ForeignImage() : ForeignImage(window) {}
  explicit ForeignImage(const Imath::Box2i& display_window) : header(display_window, window) {
    for (int i = 0; i < width * height; ++i) {
      h.push_back(float(i));
      f.push_back(float(i) + 0.25f);
      u.push_back(unsigned(i) * 1000);
    }
    add("H", Imf::HALF, h.data());
    add("F", Imf::FLOAT, f.data());
    add("U", Imf::UINT, u.data());
  }
  template <class T>
  void add(const char* name, Imf::PixelType type, T* values) {
    header.channels().insert(name, Imf::Channel(type));
    pixels.insert(name, Imf::Slice::Make(type, values, window, sizeof(T), sizeof(T) * width));
  }

  Imf::Header header;
  Imf::FrameBuffer pixels;
  std::vector<half> h;
  std::vector<float> f;
  std::vector<unsigned> u;
};

void expect_foreign_image(const Image& image) {
  ASSERT_EQ(image.width, ForeignImage::width);
  ASSERT_EQ(image.height, ForeignImage::height);
  ASSERT_EQ(image.channels.size(), 3u);
  for (int i = 0; i < ForeignImage::width * ForeignImage::height; ++i) {
    ASSERT_EQ(image.find("H")->values[i], float(i));
    ASSERT_EQ(image.find("F")->values[i], float(i) + 0.25f);
    ASSERT_EQ(image.find("U")->values[i], float(i * 1000));
  }
}

TEST_F(ExrFile, ReadsHalfAndUnsignedInAnOffsetWindowUpsideDown) {
  ForeignImage foreign;
  foreign.header.lineOrder() = Imf::DECREASING_Y;
  {
    Imf::OutputFile output(file.c_str(), foreign.header);
    output.setFrameBuffer(foreign.pixels);
    output.writePixels(ForeignImage::height);
  }
  expect_foreign_image(read_exr(file));
}

/// The display window is the image: black where there is no data, without the data beside it.
TEST_F(ExrFile, ShowsItsDisplayWindow) {
  const auto shown_in = [&](const Imath::Box2i& display) {
    ForeignImage foreign(display);
    Imf::OutputFile output(file.c_str(), foreign.header);
    output.setFrameBuffer(foreign.pixels);
    output.writePixels(ForeignImage::height);
  };
  for (const Imath::Box2i& display : {Imath::Box2i({-10, 90}, {40, 130}), Imath::Box2i({0, 105}, {9, 107}),
                                      Imath::Box2i({-20, 110}, {0, 150}), Imath::Box2i({20, 0}, {50, 104}),
                                      Imath::Box2i({100, 100}, {102, 101})}) {
    shown_in(display);
    const Image image = read_exr(file);
    ASSERT_EQ(image.width, display.max.x - display.min.x + 1);
    ASSERT_EQ(image.height, display.max.y - display.min.y + 1);
    const std::vector<float>& values = image.find("F")->values;
    ASSERT_EQ(values.size(), std::size_t(image.width) * std::size_t(image.height));
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const int column = x + display.min.x + 5, row = y + display.min.y - 100;
        const bool is_there =
            column >= 0 && column < ForeignImage::width && row >= 0 && row < ForeignImage::height;
        ASSERT_EQ(values[std::size_t(y * image.width + x)],
                  is_there ? float(row * ForeignImage::width + column) + 0.25f : 0)
            << x << ' ' << y;
      }
  }
  shown_in({{0, 0}, {30000, 30000}});
  EXPECT_THAT(test::error_of([&] { read_exr(file); }),
              HasSubstr("its display window of 30001 x 30001 pixels is far larger than the 37 x 21"));
}

TEST_F(ExrFile, ReadsTiledFilesOfEveryLevelMode) {
  for (const auto mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS}) {
    ForeignImage foreign;
    foreign.header.setTileDescription(Imf::TileDescription(16, 8, mode));
    {
      Imf::TiledOutputFile output(file.c_str(), foreign.header);
      output.setFrameBuffer(foreign.pixels);
      for (int y = 0; y < output.numYLevels();
           ++y)  // All levels hold pixels of the first; only that is read.
        for (int x = 0; x < output.numXLevels(); ++x)
          if (output.isValidLevel(x, y))
            output.writeTiles(0, output.numXTiles(x) - 1, 0, output.numYTiles(y) - 1, x, y);
    }
    expect_foreign_image(read_exr(file));
  }
}

TEST_F(ExrFile, ReadsEveryCompressionInLinesAndTiles) {
  for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
    for (const bool is_tiled : {false, true}) {
      ForeignImage foreign;
      foreign.header.compression() = Imf::Compression(compression);
      if (is_tiled) {
        foreign.header.setTileDescription(Imf::TileDescription(16, 8));
        Imf::TiledOutputFile output(file.c_str(), foreign.header);
        output.setFrameBuffer(foreign.pixels);
        output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
      } else {
        Imf::OutputFile output(file.c_str(), foreign.header);
        output.setFrameBuffer(foreign.pixels);
        output.writePixels(ForeignImage::height);
      }
      const Image image = read_exr(file);
      for (int i = 0; i < ForeignImage::width * ForeignImage::height; ++i) {
        // B44 and DWA are lossy, and rows differ by 37.
        ASSERT_NEAR(image.find("H")->values[i], i, compression < Imf::B44_COMPRESSION ? 0 : 37)
            << compression;
        ASSERT_NEAR(image.find("F")->values[i], i + 0.25, 0.01) << compression;  // PXR24 drops a byte.
        ASSERT_EQ(image.find("U")->values[i], float(i * 1000)) << compression;
      }
    }
}

TEST_F(ExrFile, RefusesAnImageThatIsNotOne) {
  Image image = small_image();
  image.channels[1].values.pop_back();
  EXPECT_THAT(test::error_of([&] { write_exr(file, image); }),
              HasSubstr("channel G has 5 values, the image 3 x 2"));
  image = small_image();
  image.channels[1].name = "R";
  EXPECT_THAT(test::error_of([&] { write_exr(file, image); }), HasSubstr("two channels are named 'R'"));
  image.channels[1].name = "";
  EXPECT_THAT(test::error_of([&] { write_exr(file, image); }), HasSubstr("EXR allows 1 to 255"));
  image = small_image();
  image.metadata.emplace_back("dataWindow", "x");
  EXPECT_THAT(test::error_of([&] { write_exr(file, image); }), HasSubstr("EXR itself uses that name"));
  image.metadata.back().first = "seed";
  EXPECT_THAT(test::error_of([&] { write_exr(file, image); }),
              HasSubstr("two metadata fields are named 'seed'"));
  EXPECT_THAT(test::error_of([&] { write_exr(file, Image{}); }), HasSubstr("0 x 0"));
  EXPECT_EQ(files_in_folder(), 0u);
}

TEST_F(ExrFile, AWriteThatFailsNamesTheReasonAndLeavesTheOldFile) {
  EXPECT_THAT(test::error_of([&] { write_exr(folder / "none" / "a.exr", small_image()); }),
              HasSubstr("a.exr: cannot write: No such file or directory"));

  write_exr(file, small_image());
  Image large = constant_image(64, 64);
  for (std::size_t i = 0; i < large.channels[0].values.size(); ++i)  // Hard to compress.
    large.channels[0].values[i] = std::sin(float(i * i));
  rlimit old_limit;
  getrlimit(RLIMIT_FSIZE, &old_limit);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  // As on a full disk, at the start, in the middle, and in the last bytes, which OpenEXR writes in a
  // destructor.
  write_exr(folder / "complete.exr", large);
  const auto complete = fs::file_size(folder / "complete.exr");
  for (const std::uintmax_t bytes : {std::uintmax_t(100), complete / 2, complete - 1}) {
    const rlimit limit{bytes, old_limit.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string error = test::error_of([&] { write_exr(file, large); });
    setrlimit(RLIMIT_FSIZE, &old_limit);
    EXPECT_THAT(error, HasSubstr("image.exr: cannot write: File too large")) << bytes;
  }
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(read_exr(file).width, 3);
  EXPECT_EQ(files_in_folder(), 2u) << "a temporary file was left";
}

TEST_F(ExrFile, SaysWhyItCannotRead) {
  EXPECT_THAT(test::error_of([&] { read_exr(folder / "none.exr"); }), HasSubstr("there is no such file"));
  EXPECT_THAT(test::error_of([&] { read_exr(folder); }), HasSubstr("not a regular file"));
  EXPECT_THAT(test::error_of([&] { read_exr("/dev/zero"); }), HasSubstr("not a regular file"));
  write_bytes("");
  EXPECT_THAT(test::error_of([&] { read_exr(file); }),
              HasSubstr("image.exr: cannot read this EXR image: it ends too early"));
  write_bytes("\x89PNG\r\n\x1a\n and so on");
  EXPECT_THAT(test::error_of([&] { read_exr(file); }), HasSubstr("it is not an EXR file"));
}

TEST_F(ExrFile, RefusesDeepAndOversizedFiles) {
  write_exr(file, small_image());
  const std::string good = read_bytes();
  std::string bad = good;
  bad[5] |= 0x08;
  write_bytes(bad);
  EXPECT_THAT(test::error_of([&] { read_exr(file); }), HasSubstr("deep images are not supported"));
  bad = good;
  bad[5] |= 0x10;
  write_bytes(bad);
  EXPECT_THAT(test::error_of([&] { read_exr(file); }), HasSubstr("one of its parts has no name or no type"));
  // name, type, size of the box, then min x, min y, max x, max y.
  const std::size_t window = good.find("dataWindow") + sizeof("dataWindow") + sizeof("box2i") + 4;
  bad = good;
  bad[window + 10] = 0x7f;
  write_bytes(bad);
  EXPECT_THAT(test::error_of([&] { read_exr(file); }),
              HasSubstr("its header promises 8323075 x 2 pixels of 5 channels"));
  bad = good;
  bad[window + 14] = 0x7f;
  write_bytes(bad);
  EXPECT_THAT(test::error_of([&] { read_exr(file); }),
              HasSubstr("its header promises 3 x 8323074 pixels of 5 channels"));
  bad = good;
  bad[good.find("seed") + sizeof("seed") + sizeof("string") + 3] = 0x7f;
  write_bytes(bad);
  EXPECT_THAT(test::error_of([&] { read_exr(file); }),
              HasSubstr("its attribute 'seed' claims 2130706433 bytes"));
  bad[good.find("seed")] = '\xe9';
  write_bytes(bad);
  EXPECT_THAT(test::error_of([&] { read_exr(file); }),
              HasSubstr("its attribute '?eed' claims 2130706433 bytes"));
}

TEST_F(ExrFile, EveryPrefixOfAFileIsAnError) {
  write_exr(file, small_image());
  const std::string good = read_bytes();
  for (std::size_t size = 0; size < good.size(); ++size) {
    write_bytes(good.substr(0, size));
    EXPECT_THAT(test::error_of([&] { read_exr(file); }), HasSubstr("image.exr: cannot read this EXR image: "))
        << size;
  }
}

TEST_F(ExrFile,
       NoChangedByteCrashes) {  // An image or an error; either is right, the test is that we come back.
  write_exr(file, small_image());
  const std::string good = read_bytes();
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (const int change : {0x01, 0x80, 0xff}) {
      std::string bad = good;
      bad[i] = char(bad[i] ^ change);
      write_bytes(bad);
      test::error_of([&] { read_exr(file); });
    }
  }
}

TEST_F(ExrFile, BadFilesGiveAnErrorOrAnImage) {
  const fs::path bad = test::data_folder() / "badinput/exr";
  if (!fs::exists(bad)) GTEST_SKIP() << "no " << bad;
  int errors = 0, images = 0;
  for (const auto& entry : fs::directory_iterator(bad)) {
    try {
      const Image image = read_exr(entry.path());
      ++images;
      for (const Channel& channel : image.channels)
        EXPECT_EQ(channel.values.size(), std::size_t(image.width) * std::size_t(image.height))
            << entry.path();
    } catch (const InputError& error) {
      ++errors;
      EXPECT_THAT(error.what(), HasSubstr(entry.path().string() + ": cannot read this EXR image: "));
    }
  }
  EXPECT_GT(errors, 0);
  EXPECT_GT(images, 0);
}

TEST_F(ExrFile, ValidFilesOfEveryCompressionAreRead) {
  const fs::path valid = test::data_folder() / "badinput/exr-valid";
  if (!fs::exists(valid)) GTEST_SKIP() << "no " << valid;
  for (const auto& entry : fs::directory_iterator(valid)) {
    EXPECT_NO_THROW({
      const Image image = read_exr(entry.path());
      EXPECT_FALSE(image.channels.empty());
      EXPECT_GT(image.channels.at(0).values.size(), 0u);
    }) << entry.path();
  }
}

TEST_F(ExrFile, LosslessCompressionsAgree) {
  const fs::path valid = test::data_folder() / "badinput/exr-valid";
  if (!fs::exists(valid)) GTEST_SKIP() << "no " << valid;
  for (const auto& [one, other] :
       {std::pair("f16_uncompressed.exr", "f16_piz.exr"), std::pair("f16_uncompressed.exr", "f16_rle.exr"),
        std::pair("f32_zip.exr", "f32_piz.exr")}) {
    const Image image = read_exr(valid / one), same = read_exr(valid / other);
    for (const Channel& channel : image.channels) {
      ASSERT_NE(same.find(channel.name), nullptr) << other;
      EXPECT_TRUE(same.find(channel.name)->values == channel.values) << other << ' ' << channel.name;
    }
  }
}

}  // namespace
}  // namespace etendue
