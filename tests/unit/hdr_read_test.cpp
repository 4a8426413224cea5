// Radiance HDR files.
//
// Seen to fail when: EXPOSURE multiplies, or only the last one counts; a repeated repeat counts once; the
// parts of a row are taken in another order; one of the eight orientations is another.
#include "support/temporary_image.h"

#include <gmock/gmock.h>

namespace etendue {
namespace {

using testing::ElementsAre;
using testing::FloatEq;
using testing::FloatNear;
using testing::HasSubstr;

class HdrRead : public test::ImageFileTest {
 protected:
  void write(const std::string& pixels, const std::string& size = "-Y 1 +X 1", const std::string& lines = "",
             const std::string& format = "32-bit_rle_rgbe") const {
    test::write_file(
        file, "#?RADIANCE\n# a comment\n" + lines + "FORMAT=" + format + "\n\n" + size + "\n" + pixels);
  }
};

/// 1, 0.5, 0.25 in red, green, blue.
const std::string color{char(128), 64, 32, char(129)};
std::string grey_pixel(int mantissa) { return {char(mantissa), char(mantissa), char(mantissa), char(136)}; }

TEST_F(HdrRead, PixelsShareAnExponent) {
  write(color + std::string("\0\0\0\0", 4) + std::string("\xff\x01\x80\x01", 4), "-Y 1 +X 3");
  EXPECT_THAT(pixel(read(), 0), ElementsAre(1, 0.5f, 0.25f));
  EXPECT_THAT(pixel(read(), 1), ElementsAre(0, 0, 0));
  EXPECT_THAT(pixel(read(), 2), ElementsAre(255 * 0x1p-135f, 0x1p-135f, 128 * 0x1p-135f));
  test::write_file(file, "#?RGBE\r\n\r\n-Y 1 +X 1\r\n" + color);
  EXPECT_THAT(pixel(read(), 0), ElementsAre(1, 0.5f, 0.25f));
}

TEST_F(HdrRead, RunsOfBothKinds) {
  // 300 pixels, then 2: repeats of 44 and, in a row, of 1 << 8.
  const std::string repeat{1, 1, 1};
  write(color + repeat + char(43) + repeat + char(1) + grey_pixel(7) + grey_pixel(9), "-Y 1 +X 302");
  const ColorImage old_runs = read();
  for (std::size_t i = 0; i < 300; ++i) ASSERT_THAT(pixel(old_runs, i), ElementsAre(1, 0.5f, 0.25f)) << i;
  EXPECT_EQ(pixel(old_runs, 300)[0], 7);
  EXPECT_EQ(pixel(old_runs, 301)[0], 9);
  // Nine pixels in parts: red 1 to 9, green a run of 9, blue a run of 5 and four more, one exponent.
  const std::string row = std::string("\x02\x02\x00\x09", 4) + "\x09\x01\x02\x03\x04\x05\x06\x07\x08\x09" +
                          "\x89\x0b" + "\x85\x14\x04\x15\x16\x17\x18" + "\x89\x88";
  write(row + row, "-Y 2 +X 9");
  const ColorImage parts = read();
  for (std::size_t i = 0; i < 18; ++i)
    EXPECT_THAT(pixel(parts, i), ElementsAre(float(i % 9 + 1), 11, float(i % 9 < 5 ? 20 : 16 + i % 9))) << i;
}

TEST_F(HdrRead, ExposureAndColorCorrectionAreTakenBack) {
  write(color, "-Y 1 +X 1", "EXPOSURE=4\nEXPOSURE= 0.5\nCOLORCORR=1 2 0.5\n");
  EXPECT_THAT(pixel(read(), 0), ElementsAre(0.5f, 0.125f, 0.25f));
  write(color, "-Y 1 +X 1", "EXPOSURE=0\n");
  EXPECT_THAT(error(), HasSubstr("its exposure is not above 0"));
  write(color, "-Y 1 +X 1", "COLORCORR=1 2\n");
  EXPECT_THAT(error(), HasSubstr("its COLORCORR is not 3 numbers"));
}

TEST_F(HdrRead, PrimariesAndXyzBecomeRec709) {
  write(color + grey_pixel(100), "-Y 1 +X 2", "PRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .329\n");
  EXPECT_THAT(pixel(read(), 0), ElementsAre(1, 0.5f, 0.25f));
  write(color + grey_pixel(100), "-Y 1 +X 2",
        "PRIMARIES= 0.708 0.292 0.17 0.797 0.131 0.046 0.3333 0.3333\n");
  EXPECT_GT(pixel(read(), 0)[0], 1.2f);
  for (const float value : pixel(read(), 1)) EXPECT_NEAR(value, 100, 1e-3);  // White is white.
  EXPECT_THAT(pixel(read({true, ""}), 0), ElementsAre(1, 0.5f, 0.25f));
  write(color, "-Y 1 +X 1", "PRIMARIES=.1 .1 .2 .2 .3 .3 .3 .3\n");
  EXPECT_THAT(error(), HasSubstr("its primaries lie on a line"));

  write(grey_pixel(100) + std::string("\x40\x50\x60\x81", 4), "-Y 1 +X 2", "", "32-bit_rle_xyze");
  for (const float value : pixel(read(), 0)) EXPECT_NEAR(value, 100, 0.01);
  const std::vector<float> rgb = pixel(read(), 1);
  EXPECT_NEAR(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2], 80 / 128.0,
              0.02);  // Y, but for the white.
  write(grey_pixel(179), "-Y 1 +X 1", "EXPOSURE=0.5\n", "32-bit_rle_xyze");
  EXPECT_NEAR(pixel(read(), 0)[1], 2, 0.001);
  write(color, "-Y 1 +X 1", "", "spectral");
  EXPECT_THAT(error(), HasSubstr("its format 'spectral' is not supported"));
}

TEST_F(HdrRead, TheEightOrientations) {
  // Stored 1 2 3 / 4 5 6, from 10 on.
  std::string pixels;
  for (int i = 1; i <= 6; ++i) pixels += grey_pixel(10 + i);
  for (const auto& [size, width, expected] : {std::tuple{"-Y 2 +X 3", 3, "123456"},
                                              {"-Y 2 -X 3", 3, "321654"},
                                              {"+Y 2 +X 3", 3, "456123"},
                                              {"+Y 2 -X 3", 3, "654321"},
                                              {"+X 2 -Y 3", 2, "142536"},
                                              {"+X 2 +Y 3", 2, "362514"},
                                              {"-X 2 -Y 3", 2, "415263"},
                                              {"-X 2 +Y 3", 2, "635241"}}) {
    write(pixels, size);
    const ColorImage image = read();
    EXPECT_EQ(image.width, width);
    std::string seen;
    for (std::size_t i = 0; i < 6; ++i) seen += char('0' - 10 + int(pixel(image, i)[0]));
    EXPECT_EQ(seen, expected) << size;
  }
  for (const char* size : {"-Y 2 +Y 3", "-Y 0 +X 3", "-Y 2", "Y 2 X 3", "-Y 99999999999 +X 1"}) {
    write(pixels, size);
    EXPECT_THAT(error(), HasSubstr("its size")) << size;
  }
}

TEST_F(HdrRead, BadFilesAreErrors) {
  write(color, "-Y 100000 +X 100000");
  EXPECT_THAT(error(),
              HasSubstr("image: cannot read this Radiance HDR image: its header promises 100000 x 100000"));
  write(std::string("\x01\x01\x01\x05", 4), "-Y 1 +X 5");  // Nothing to repeat.
  EXPECT_THAT(error(), HasSubstr("does not fit its width"));
  write(std::string("\x02\x02\x00\x09", 4) + color + color, "-Y 1 +X 8");
  EXPECT_THAT(error(), HasSubstr("does not fit its width"));
  EXPECT_THAT(error({false, "diffuse"}), HasSubstr("is a Radiance HDR image, which has no layers"));
  const std::string row =
      std::string("\x02\x02\x00\x09", 4) + "\x09\x01\x02\x03\x04\x05\x06\x07\x08\x09\x89\x0b\x89\x14\x89\x88";
  write(row + row, "-Y 2 +X 9", "EXPOSURE=2\nPRIMARIES= 0.708 0.292 0.17 0.797 0.131 0.046 0.3333 0.3333\n");
  expect_bad_files_are_errors();
}

}  // namespace
}  // namespace etendue
