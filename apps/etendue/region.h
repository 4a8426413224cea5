// Parts of an image whose mean and error a render says.
#pragma once

#include "film/pixel_rectangle.h"

#include <string>
#include <vector>

namespace etendue::app {

struct ImageRegion {
  std::string name;
  PixelRectangle pixels;
};

/// From texts "NAME=X0,Y0,X1,Y1". Throws InputError for one that is not of that form, is empty, reaches out
/// of the image, or has the name of another or of the image itself ("image").
std::vector<ImageRegion> regions_of(const std::vector<std::string>& texts, int width_px, int height_px);

}  // namespace etendue::app
