#include "verify/moment_image.h"

#include <algorithm>

namespace etendue {

MeanMoments MomentImage::sum_over(const PixelRectangle& rectangle) const {
  MeanMoments sum;
  for (int y = rectangle.y_begin; y < rectangle.y_end; ++y)
    for (int x = rectangle.x_begin; x < rectangle.x_end; ++x) sum += at(x, y);
  return sum;
}

MomentImage moment_image(const RenderResult& rendered) {
  MomentImage image{rendered.film.width(), rendered.film.height(), {}, rendered.replicates};
  image.pixels.reserve(std::size_t(image.width) * std::size_t(image.height));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      image.pixels.push_back(moments_of_mean(rendered.luminances.at(x, y, rendered.replicates)));
  return image;
}

std::vector<MeanMoments> block_sums(const MomentImage& image) {
  std::vector<MeanMoments> sums;
  for (int y = 0; y < image.height; y += block_side)
    for (int x = 0; x < image.width; x += block_side)
      sums.push_back(image.sum_over(
          {x, y, std::min(x + block_side, image.width), std::min(y + block_side, image.height)}));
  return sums;
}

}  // namespace etendue
