// Image files for tests of readers.
#pragma once

#include "image/color_file.h"
#include "support/error_of.h"
#include "support/temporary_folder.h"

#include <array>
#include <gtest/gtest.h>
#include <vector>

namespace etendue::test {

/// A file that is written by bytes, or by name by a library, and read as colours.
class ImageFileTest : public testing::Test {
 protected:
  ColorImage read(const ColorRequest& request = {}) const { return read_colors(file, request); }
  std::string error(const ColorRequest& request = {}) const {
    try {
      return error_of([&] { read(request); });
    } catch (const ColorRequestError& error) {
      return std::string(error.what()) + "\n" + error.hint;
    }
  }
  static std::vector<float> pixel(const ColorImage& image, std::size_t i) {
    return {image.rgb.begin() + std::ptrdiff_t(3 * i), image.rgb.begin() + std::ptrdiff_t(3 * i + 3)};
  }
  /// Every file that ends early is an error that names it, and none that is changed crashes; those changed
  /// and read have all their pixels.
  void expect_bad_files_are_errors(std::size_t first_cut = 0) const {
    const std::string good = read_file(file);
    for (std::size_t size = first_cut; size < good.size(); ++size) {
      write_file(file, good.substr(0, size));
      EXPECT_NE(error(), "") << size;
      if (size > 16) {
        EXPECT_NE(error().find(file.string() + ": cannot read this"), std::string::npos) << size;
      }
    }
    for (std::size_t i = 0; i < good.size(); ++i)
      for (const int change : {0x01, 0x80, 0xff}) {
        std::string bad = good;
        bad[i] = char(bad[i] ^ change);
        write_file(file, bad);
        try {
          const ColorImage image = read();
          EXPECT_EQ(image.rgb.size(), 3 * std::size_t(image.width) * std::size_t(image.height));
        } catch (const InputError&) {
        } catch (const ColorRequestError&) {
        }
      }
    write_file(file, good);
  }

  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "image";
};

/// An Exif block of this orientation, as TIFF numbers it.
inline std::string exif_of_orientation(char orientation, bool is_little_endian) {
  if (is_little_endian)
    return std::string("II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0", 18) + orientation +
           std::string("\0\0\0\0\0\0\0", 7);
  return std::string("MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0", 19) + orientation +
         std::string("\0\0\0\0\0\0", 6);
}

}  // namespace etendue::test
