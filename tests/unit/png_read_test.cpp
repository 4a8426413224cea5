// PNG files as colours.
//
// Seen to fail when: 16-bit values are read low byte first; gAMA is passed over, or heeded beside an sRGB
// chunk; cICP is passed over; cHRM is applied to raw values; a profile is passed over; two of Exif's
// orientations are exchanged.
#include "support/color_profile.h"
#include "support/temporary_image.h"

#include <cmath>
#include <functional>
#include <gmock/gmock.h>
#include <png.h>

namespace etendue {
namespace {

using testing::ElementsAre;
using testing::FloatEq;
using testing::FloatNear;
using testing::HasSubstr;

double linear_from_png(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

class PngRead : public test::ImageFileTest {
 protected:
  using Chunks = std::vector<std::pair<std::string, std::string>>;

  /// One row of pixels of these bytes, with chunks between the header and them.
  void write_row(int width, int bit_depth, int color_type, std::vector<png_byte> row,
                 const Chunks& chunks = {}, const std::string& profile = "") const {
    std::FILE* stream = std::fopen(file.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_set_IHDR(png, info, png_uint_32(width), 1, bit_depth, color_type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    const png_color palette[]{{255, 0, 0}, {0, 188, 0}};
    if (color_type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 2);
    if (!profile.empty())
      png_set_iCCP(png, info, "a profile", PNG_COMPRESSION_TYPE_BASE,
                   reinterpret_cast<png_const_bytep>(profile.data()), png_uint_32(profile.size()));
    png_write_info(png, info);
    for (const auto& [type, data] : chunks)
      png_write_chunk(png, reinterpret_cast<png_const_bytep>(type.data()),
                      reinterpret_cast<png_const_bytep>(data.data()), data.size());
    png_write_row(png, row.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(stream);
  }
  /// One pixel of 255 128 64.
  std::vector<float> pixel_with(const Chunks& chunks, const std::string& profile = "") const {
    write_row(1, 8, PNG_COLOR_TYPE_RGB, {255, 128, 64}, chunks, profile);
    return pixel(read(), 0);
  }
};

/// A number of a PNG chunk.
std::string word(unsigned value) {
  return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}
const auto gamma_1 = std::pair("gAMA", word(100000)), gamma_2_2 = std::pair("gAMA", word(45455));
const auto srgb = std::pair("sRGB", std::string(1, '\0'));
std::string chromaticities(std::initializer_list<unsigned> numbers) {
  std::string text;
  for (const unsigned number : numbers) text += word(number);
  return text;
}
const auto rec2020 =
    std::pair("cHRM", chromaticities({31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600}));
std::pair<const char*, std::string> cicp(int primaries, int transfer, int matrix = 0, int range = 1) {
  return {"cICP", {char(primaries), char(transfer), char(matrix), char(range)}};
}

const double half = 128 / 255.0, quarter = 64 / 255.0;
const auto as_srgb =
    ElementsAre(1, FloatEq(float(linear_from_png(half))), FloatEq(float(linear_from_png(quarter))));
const auto as_linear = ElementsAre(1, FloatEq(float(half)), FloatEq(float(quarter)));

TEST_F(PngRead, EveryKindOfPixelIsDecoded) {
  const auto first = [&](bool is_raw, std::size_t i) { return pixel(read({is_raw, ""}), i); };
  write_row(2, 8, PNG_COLOR_TYPE_RGB, {255, 188, 0, 1, 10, 11});
  EXPECT_THAT(first(false, 0), ElementsAre(1, float(linear_from_png(188 / 255.0)), 0));
  EXPECT_THAT(first(false, 1),
              ElementsAre(float(linear_from_png(1 / 255.0)), float(linear_from_png(10 / 255.0)),
                          float(linear_from_png(11 / 255.0))));
  EXPECT_THAT(first(true, 0), ElementsAre(1, float(188 / 255.0), 0));
  write_row(1, 16, PNG_COLOR_TYPE_RGB_ALPHA, {0x12, 0x34, 0xff, 0xff, 0, 1, 0, 0});
  EXPECT_THAT(first(false, 0),
              ElementsAre(float(linear_from_png(0x1234 / 65535.0)), 1, float(linear_from_png(1 / 65535.0))));
  write_row(1, 16, PNG_COLOR_TYPE_GRAY, {0x12, 0x34});
  const float grey = float(0x1234 / 65535.0);
  EXPECT_THAT(first(true, 0), ElementsAre(grey, grey, grey));
  write_row(8, 1, PNG_COLOR_TYPE_GRAY, {0b01000000});
  EXPECT_THAT(first(false, 0), ElementsAre(0, 0, 0));
  EXPECT_THAT(first(false, 1), ElementsAre(1, 1, 1));
  write_row(2, 8, PNG_COLOR_TYPE_PALETTE, {0, 1});
  EXPECT_THAT(first(false, 1), ElementsAre(0, float(linear_from_png(188 / 255.0)), 0));
}

TEST_F(PngRead, GammaCountsUnlessAnSrgbChunkIsThere) {
  EXPECT_THAT(pixel_with({}), as_srgb);
  EXPECT_THAT(pixel_with({gamma_1}), as_linear);
  EXPECT_THAT(pixel_with({gamma_2_2}), ElementsAre(1, FloatNear(float(std::pow(half, 2.2)), 1e-5f),
                                                   FloatNear(float(std::pow(quarter, 2.2)), 1e-5f)));
  EXPECT_THAT(pixel_with({gamma_1, srgb}), as_srgb);
  EXPECT_THAT(pixel_with({srgb, gamma_2_2}), as_srgb);
  write_row(1, 8, PNG_COLOR_TYPE_RGB, {255, 128, 64}, {{"gAMA", word(0)}});
  EXPECT_THAT(error(), HasSubstr("its chunk gAMA is damaged"));
}

TEST_F(PngRead, OtherPrimariesBecomeThoseOfRec709) {
  // ITU-R BT.2087, table 2 backwards.
  const auto converted = ElementsAre(FloatNear(float(1.6605 - 0.5876 * half - 0.0728 * quarter), 2e-4f),
                                     FloatNear(float(-0.1246 + 1.1329 * half - 0.0083 * quarter), 2e-4f),
                                     FloatNear(float(-0.0182 - 0.1006 * half + 1.1187 * quarter), 2e-4f));
  EXPECT_THAT(pixel_with({gamma_1, rec2020}), converted);
  EXPECT_THAT(pixel_with({cicp(9, 8), gamma_2_2}), converted);
  EXPECT_THAT(pixel_with({srgb, rec2020}), as_srgb);
  EXPECT_THAT(pixel_with({gamma_1,
                          {"cHRM", chromaticities({31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000})}}),
              as_linear);
  // Red of Rec. 2020 lies outside: no channel gets less than nothing. White stays white.
  write_row(2, 8, PNG_COLOR_TYPE_RGB, {255, 0, 0, 128, 128, 128}, {gamma_1, rec2020});
  EXPECT_THAT(pixel(read(), 0), ElementsAre(FloatNear(1.6605f, 2e-4f), 0, 0));
  for (const float value : pixel(read(), 1)) EXPECT_NEAR(value, half, 1e-5);
  EXPECT_THAT(pixel(read({true, ""}), 0), ElementsAre(1, 0, 0));
}

TEST_F(PngRead, CodePointsComeFirst) {
  EXPECT_THAT(pixel_with({cicp(1, 8), srgb}), as_linear);
  EXPECT_THAT(pixel_with({cicp(1, 13), gamma_1}), as_srgb);
  write_row(1, 8, PNG_COLOR_TYPE_RGB, {255, 128, 64}, {cicp(9, 16)});
  EXPECT_THAT(error(), HasSubstr("its chunk cICP asks for the primaries 9, the transfer 16 (PQ)"));
  EXPECT_THAT(pixel(read({true, ""}), 0), as_linear);
  write_row(1, 8, PNG_COLOR_TYPE_RGB, {255, 128, 64}, {cicp(1, 13, 0, 0)});
  EXPECT_THAT(error(), HasSubstr("a narrow range"));
}

TEST_F(PngRead, ProfilesAreHeeded) {
  const std::string p3 = test::rgb_profile(test::p3_primaries, 1);
  const auto from_p3 = ElementsAre(FloatNear(float(1.2249 - 0.2247 * half), 2e-3f),
                                   FloatNear(float(-0.0420 + 1.0419 * half), 2e-3f),
                                   FloatNear(float(-0.0197 - 0.0786 * half + 1.0979 * quarter), 2e-3f));
  EXPECT_THAT(pixel_with({}, p3), from_p3);
  EXPECT_THAT(pixel_with({gamma_2_2}, p3), from_p3);
  const std::array<std::array<double, 2>, 3> rec709{{{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}}};
  const std::vector<float> power = pixel_with({}, test::rgb_profile(rec709, 1.8));
  EXPECT_NEAR(power[1], std::pow(half, 1.8), 2e-3);
  write_row(1, 8, PNG_COLOR_TYPE_RGB, {255, 128, 64}, {{"iCCP", "x"}});
  EXPECT_THAT(error(), HasSubstr("its colour profile is damaged"));
  EXPECT_THAT(pixel(read({true, ""}), 0), as_linear);
}

TEST_F(PngRead, ExifTurnsThePicture) {
  // A row of two becomes a column: clockwise with the first pixel above, counter-clockwise with it below.
  for (const auto& [orientation, first, second] : {std::tuple{6, 255, 0}, {8, 0, 255}}) {
    write_row(2, 8, PNG_COLOR_TYPE_GRAY, {255, 0},
              {{"eXIf", test::exif_of_orientation(char(orientation), false)}});
    const ColorImage image = read({true, ""});
    EXPECT_EQ(image.width, 1);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.rgb[0], float(first) / 255);
    EXPECT_EQ(image.rgb[3], float(second) / 255);
  }
}

TEST_F(PngRead, BadFilesAreErrors) {
  EXPECT_THAT(error(), HasSubstr("there is no such file"));
  write_row(60, 8, PNG_COLOR_TYPE_RGB, std::vector<png_byte>(180, 77), {gamma_1, rec2020, cicp(9, 8)},
            test::rgb_profile(test::p3_primaries, 2.2));
  expect_bad_files_are_errors();
}

}  // namespace
}  // namespace etendue
