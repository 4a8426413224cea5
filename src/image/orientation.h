// Where the first row and the first column of a stored image belong in the picture.
#pragma once

#include "image/color_file.h"

#include <span>

namespace etendue {

/// Stored rows run along the picture's y, from its top down, and their pixels to the right, unless:
struct Orientation {
  bool is_transposed = false;  ///< Rows run along x, from the left on, and their pixels down.
  bool has_last_row_first = false, has_last_column_first = false;  ///< Of the rows and their pixels as above.

  bool is_upright() const { return !is_transposed && !has_last_row_first && !has_last_column_first; }
};

/// `stored` as it is to be seen.
ColorImage upright(ColorImage stored, const Orientation& orientation);

/// What an Exif block, which begins with a TIFF header, says; upright where it says nothing that can be read.
Orientation exif_orientation(std::span<const unsigned char> exif);

}  // namespace etendue
