#include "texture/texels.h"

#include <algorithm>
#include <cmath>

namespace etendue {

using Between = TexelLattice::Between;

TexelLattice texel_lattice(const ColorTexture& texture) {
  if (is_uniform(texture)) return {{1, 1}, {0, 0}, Between::constant};
  if (const auto* checkerboard = std::get_if<Checkerboard>(&texture))
    return {{1.0 / checkerboard->scale.x, 1.0 / checkerboard->scale.y},
            {checkerboard->delta.x, checkerboard->delta.y},
            Between::constant};
  if (const auto* image = std::get_if<ImageTexture>(&texture)) {
    const bool is_bilinear = image->interpolation == ImageTexture::Interpolation::bilinear;
    const double center = is_bilinear ? 0.5 : 0;
    return {{double(image->width), double(image->height)},
            {center, center},
            is_bilinear ? Between::bilinear : Between::constant};
  }
  constexpr double per_ripple = 8;
  return {{8 * per_ripple, 8 * per_ripple}, {0, 0}, Between::other};
}

double largest_luminance(const ColorTexture& texture, const Vec2<double>& low, const Vec2<double>& high) {
  if (const Colorf* color = std::get_if<Colorf>(&texture)) return luminance(*color);
  if (const auto* checkerboard = std::get_if<Checkerboard>(&texture))
    return std::max(luminance(checkerboard->even), luminance(checkerboard->odd));
  if (const auto* image = std::get_if<ImageTexture>(&texture)) return image->largest_luminance(low, high);
  return luminance(Colorf{1.2f, 1.2f, 0.5f});
}

double largest_luminance(const ColorTexture& texture) {
  // Mirrored, an image repeats itself after two units.
  return largest_luminance(texture, {0, 0}, {2, 2});
}

}  // namespace etendue
