#include "base/error.h"
#include "image/image_file.h"
#include "support/error_of.h"
#include "support/temporary_folder.h"

#include <cmath>
#include <fstream>
#include <gmock/gmock.h>
#include <limits>
#include <png.h>

namespace etendue {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class PngFile : public testing::Test {
 protected:
  std::vector<int> bytes_of_file() const {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&png, file.c_str())) << png.message;
    EXPECT_EQ(png.format, png_uint_32(PNG_FORMAT_RGB));
    std::vector<png_byte> bytes(PNG_IMAGE_SIZE(png));
    EXPECT_TRUE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr)) << png.message;
    return {bytes.begin(), bytes.end()};
  }

  const test::TemporaryFolder temporary;
  const fs::path folder = temporary.path();
  const fs::path file = folder / "image.png";
};

TEST_F(PngFile, EncodesAsSrgb) {
  // Values of IEC 61966-2-1: 0.0031308 is where the straight part ends, 0.214041 encodes to 0.5 (127.5).
  const std::vector<float> linear{0, 0.0031308f, 0.18f, 0.2140f, 0.2142f, 0.5f, 1, 1.0f / 255 / 12.92f};
  const int size = int(linear.size());
  write_png(file, {size, 1, {{"B", linear}, {"G", linear}, {"R", linear}}, {}});
  const std::vector<int> bytes = bytes_of_file();
  const std::vector<int> expected{0, 10, 118, 127, 128, 188, 255, 1};
  for (int i = 0; i < size; ++i)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(bytes[3 * i + c], expected[i]) << linear[i];
}

TEST_F(PngFile, KeepsRowsAndChannelsInPlace) {
  write_png(file, {2, 2, {{"G", {0, 1, 0, 1}}, {"A", {9}}, {"R", {1, 0, 0, 1}}, {"B", {0, 0, 1, 1}}}, {}});
  EXPECT_EQ(bytes_of_file(), (std::vector<int>{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}));
}

TEST_F(PngFile, ShowsNaNAsMagentaAndClipsTheRest) {
  constexpr float infinity = std::numeric_limits<float>::infinity(),
                  nan = std::numeric_limits<float>::quiet_NaN();
  write_png(file,
            {4, 1, {{"R", {0, -1, infinity, 2}}, {"G", {nan, 0, 0, -infinity}}, {"B", {1, 0, 0, 0}}}, {}});
  EXPECT_EQ(bytes_of_file(), (std::vector<int>{255, 0, 255, 0, 0, 0, 255, 0, 0, 255, 0, 0}));
}

TEST_F(PngFile, IsTaggedSrgb) {
  write_png(file, {1, 1, {{"R", {1}}, {"G", {1}}, {"B", {1}}}, {}});
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_THAT(bytes, HasSubstr("sRGB"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST_F(PngFile, SaysWhatIsMissing) {
  EXPECT_THAT(test::error_of([&] {
                write_png(file, {1, 1, {{"R", {1}}, {"B", {1}}}, {}});
              }),
              HasSubstr("image.png: a PNG needs the channels R, G and B; G is missing"));
  EXPECT_THAT(test::error_of([&] {
                write_png(file, {2, 1, {{"R", {1}}, {"G", {1}}, {"B", {1}}}, {}});
              }),
              HasSubstr("channel R has 1 values, the image 2 x 1 pixels"));
  EXPECT_THAT(test::error_of([&] {
                write_png(folder / "none/a.png", {1, 1, {{"R", {1}}, {"G", {1}}, {"B", {1}}}, {}});
              }),
              HasSubstr("a.png: cannot write: No such file or directory"));
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(PngFile, AFullDiskIsCalledSo) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  std::vector<float> values(300 * 300);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = std::abs(std::sin(float(i * i)));  // Hard to compress.
  for (const std::string name : {"image.png", "image.exr"}) {
    fs::create_symlink("/dev/full", folder / name);
    const Image image{300, 300, {{"R", values}, {"G", values}, {"B", values}}, {}};
    EXPECT_THAT(test::error_of([&] {
                  name == "image.png" ? write_png(folder / name, image) : write_exr(folder / name, image);
                }),
                HasSubstr(name + ": cannot write: No space left on device"));
  }
}

TEST_F(PngFile, CheckWritableAsksBeforeTheRender) {
  EXPECT_NO_THROW(check_writable(file));
  EXPECT_NO_THROW(check_writable(folder / "a.b.exr"));
  EXPECT_NO_THROW(check_writable("image.exr"));
  EXPECT_THAT(test::error_of([&] { check_writable(folder / "image.jpg"); }),
              HasSubstr("the ending '.jpg'\nexpected: "));
  EXPECT_THAT(test::error_of([&] { check_writable(folder / "image"); }),
              HasSubstr("a name without an ending"));
  EXPECT_THAT(test::error_of([&] { check_writable(folder / "none/image.png"); }),
              HasSubstr("mkdir -p " + folder.string()));
  fs::create_directory(folder / "folder.png");
  EXPECT_THAT(test::error_of([&] { check_writable(folder / "folder.png"); }), HasSubstr("is a folder"));
  if (geteuid() != 0) {  // Root may write anywhere.
    fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_THAT(test::error_of([&] { check_writable(file); }), HasSubstr("no permission to write"));
    fs::permissions(folder, fs::perms::owner_all);
  }
}

}  // namespace
}  // namespace etendue
