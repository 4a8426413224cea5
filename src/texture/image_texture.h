// A texture from an image file.
#pragma once

#include "base/color.h"
#include "base/lane_vec.h"
#include "base/simd_math.h"
#include "scenefile/parameters.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace etendue {

/// The image fills the unit square of uv: u to the right, v up, so that (0, 0) is its lower left corner.
struct ImageTexture {
  enum class Wrap { repeat, mirror, clamp };
  enum class Interpolation { bilinear, nearest };

  /// Linear colour, four floats a pixel (the fourth is not used), rows from the bottom.
  std::shared_ptr<const std::vector<float>> pixels;
  int width = 1, height = 1;
  Wrap wrap = Wrap::repeat;
  Interpolation interpolation = Interpolation::bilinear;

  template <class F>
  Color<F> at(const Vec2<F>& uv, const Mask<F>& lanes) const {
    // Other lanes may hold anything, NaN too, and must not reach beyond the image.
    const F u = select(lanes, uv.x, F(0)) * F(float(width)), v = select(lanes, uv.y, F(0)) * F(float(height));
    if (interpolation == Interpolation::nearest)
      return texel(wrapped(floor(u), width), wrapped(floor(v), height));
    const F x = u - F(0.5f), y = v - F(0.5f);  // Pixels have their colour at their centres.
    const F left = floor(x), bottom = floor(y);
    const F x0 = wrapped(left, width), x1 = wrapped(left + F(1), width);
    const F y0 = wrapped(bottom, height), y1 = wrapped(bottom + F(1), height);
    const F dx = x - left, dy = y - bottom;
    const Color<F> lower = texel(x0, y0) * (F(1) - dx) + texel(x1, y0) * dx;
    const Color<F> upper = texel(x0, y1) * (F(1) - dx) + texel(x1, y1) * dx;
    return lower * (F(1) - dy) + upper * dy;
  }

  /// At least as great as the luminance anywhere in this box of uv.
  double largest_luminance(const Vec2<double>& low, const Vec2<double>& high) const;

 private:
  /// The index from 0 to size - 1, as an integral float, of the pixel that stands at the integral `x`.
  template <class F>
  F wrapped(const F& x, int size) const {
    const F count = F(float(size)), last = F(float(size - 1));
    const auto modulo = [](const F& a, const F& n) { return a - floor(a / n) * n; };
    F index = x;
    if (wrap == Wrap::repeat) index = modulo(x, count);
    if (wrap == Wrap::mirror) {
      const F twice = modulo(x, count * F(2));
      index = min(twice, count * F(2) - F(1) - twice);
    }
    return min(max(index, F(0)), last);
  }

  template <class F>
  Color<F> texel(const F& x, const F& y) const {
    const Int<F> first = (to_int(y) * Int<F>(width) + to_int(x)) * Int<F>(4);
    return {gather(pixels->data(), first), gather(pixels->data() + 1, first),
            gather(pixels->data() + 2, first)};
  }
};

extern const Plugin image_texture_plugin;

/// The image files that the textures of a scene have asked for, each kept once.
struct TextureFiles {
  std::filesystem::path directory;  ///< Where names start from.

  /// The pixels, by the file, whether it is raw, and the layer.
  std::map<std::tuple<std::filesystem::path, bool, std::string>, ImageTexture> known = {};
};

/// Throws InputError for one that cannot be read, is larger than 2^29 pixels or
/// holds a value that is negative or not a number.
ImageTexture make_image_texture(const Object& description, TextureFiles& files,
                                std::vector<UnreadKey>& unread);

}  // namespace etendue
