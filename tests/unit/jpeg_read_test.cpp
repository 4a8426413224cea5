// JPEG files as colours.
//
// Seen to fail when: values are taken as linear; warnings of libjpeg are not errors; CMYK is not refused; the
// profile or Exif's orientation is passed over.
#include "support/color_profile.h"
#include "support/temporary_image.h"

#include <cmath>
#include <cstdio>
#include <gmock/gmock.h>
// libjpeg's header needs <cstdio>.
#include <jpeglib.h>

namespace etendue {
namespace {

using testing::HasSubstr;

double linear_from_jpeg(double encoded) { return std::pow((encoded + 0.055) / 1.055, 2.4); }

struct JpegKind {
  J_COLOR_SPACE space = JCS_RGB;
  int components = 3;
  bool is_progressive = false;
  std::string exif = {}, profile = {};
};

class JpegRead : public test::ImageFileTest {
 protected:
  /// 16 x 24 pixels: the upper 16 rows have these values, the lower 8 are black.
  void write(const std::vector<unsigned char>& color, const JpegKind& kind) const {
    std::FILE* stream = std::fopen(file.c_str(), "wb");
    jpeg_error_mgr errors;
    jpeg_compress_struct jpeg{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_stdio_dest(&jpeg, stream);
    jpeg.image_width = 16;
    jpeg.image_height = 24;
    jpeg.input_components = kind.components;
    jpeg.in_color_space = kind.space;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (kind.is_progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    if (!kind.exif.empty()) {
      const std::string data = std::string("Exif\0\0", 6) + kind.exif;
      jpeg_write_marker(&jpeg, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(data.data()),
                        unsigned(data.size()));
    }
    if (!kind.profile.empty())
      jpeg_write_icc_profile(&jpeg, reinterpret_cast<const JOCTET*>(kind.profile.data()),
                             unsigned(kind.profile.size()));
    for (int y = 0; y < 24; ++y) {
      std::vector<unsigned char> row;
      for (int x = 0; x < 16; ++x)
        for (const unsigned char value : color) row.push_back(y < 16 ? value : 0);
      unsigned char* begin = row.data();
      jpeg_write_scanlines(&jpeg, &begin, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::fclose(stream);
  }
  void expect_near(const std::vector<float>& color, double r, double g, double b) const {
    EXPECT_NEAR(color[0], r, 0.015);
    EXPECT_NEAR(color[1], g, 0.015);
    EXPECT_NEAR(color[2], b, 0.015);
  }
};

const double r = 200 / 255.0, g = 120 / 255.0, b = 60 / 255.0;

TEST_F(JpegRead, BaselineProgressiveAndGrey) {
  for (const bool is_progressive : {false, true}) {
    write({200, 120, 60}, {.is_progressive = is_progressive});
    const ColorImage image = read();
    EXPECT_EQ(image.width, 16);
    ASSERT_EQ(image.height, 24);
    expect_near(pixel(image, 16 * 4), linear_from_jpeg(r), linear_from_jpeg(g), linear_from_jpeg(b));
    expect_near(pixel(image, 16 * 23), 0, 0, 0);
    expect_near(pixel(read({true, ""}), 0), r, g, b);
  }
  write({120}, {.space = JCS_GRAYSCALE, .components = 1});
  expect_near(pixel(read(), 0), linear_from_jpeg(g), linear_from_jpeg(g), linear_from_jpeg(g));
}

TEST_F(JpegRead, InksAreRefused) {
  write({200, 120, 60, 10}, {.space = JCS_CMYK, .components = 4});
  EXPECT_THAT(error(), HasSubstr("image: cannot read this JPEG image: it is in CMYK"));
}

TEST_F(JpegRead, ProfilesAreHeeded) {
  write({200, 120, 60}, {.profile = test::rgb_profile(test::p3_primaries, 2.2)});
  const double lr = std::pow(r, 2.2), lg = std::pow(g, 2.2), lb = std::pow(b, 2.2);
  expect_near(pixel(read(), 0), 1.2249 * lr - 0.2247 * lg, -0.0420 * lr + 1.0419 * lg,
              -0.0197 * lr - 0.0786 * lg + 1.0979 * lb);
  expect_near(pixel(read({true, ""}), 0), r, g, b);
  write({200, 120, 60}, {.profile = "no profile"});
  EXPECT_THAT(error(), HasSubstr("its colour profile is damaged"));
}

TEST_F(JpegRead, ExifTurnsThePicture) {
  write({200, 120, 60}, {.exif = test::exif_of_orientation(3, true)});
  expect_near(pixel(read(), 0), 0, 0, 0);
  write({200, 120, 60}, {.exif = test::exif_of_orientation(6, true)});  // The first row is at the right.
  const ColorImage image = read();
  EXPECT_EQ(image.width, 24);
  expect_near(pixel(image, 0), 0, 0, 0);
  expect_near(pixel(image, 23), linear_from_jpeg(r), linear_from_jpeg(g), linear_from_jpeg(b));
  EXPECT_EQ(read({true, ""}).height, 16);
}

TEST_F(JpegRead, BadFilesAreErrors) {
  for (const bool is_progressive : {false, true}) {
    write({200, 120, 60}, {.is_progressive = is_progressive});
    const std::string good = test::read_file(file);
    expect_bad_files_are_errors();
    std::string huge = good;
    const std::size_t frame = huge.find(is_progressive ? "\xff\xc2" : "\xff\xc0");
    huge[frame + 5] = huge[frame + 7] = char(0xf0);
    test::write_file(file, huge);
    EXPECT_THAT(error(), HasSubstr("promises more pixels"));
  }
}

}  // namespace
}  // namespace etendue
