#include "verify/foreign_image.h"

#include "base/error.h"
#include "image/color_file.h"
#include "image/color_space.h"
#include "image/image_file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>

namespace etendue {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

ColorImage colors_of_size(const std::filesystem::path& file, int width, int height) {
  ColorImage colors = read_colors(file);
  if (colors.width != width || colors.height != height)
    throw InputError(fmt::format("{}: {} x {} pixels, the scene's image has {} x {}\nrender it at that size",
                                 file.string(), colors.width, colors.height, width, height));
  return colors;
}

double luminance_at(const std::vector<float>& rgb, std::size_t k) {
  return luminance(Color<double>{rgb[3 * k], rgb[3 * k + 1], rgb[3 * k + 2]});
}

/// A layer's variances by the names R, G, B; false where the file has none. Channels are taken to go
/// together.
bool take_layer(const Image& image, const std::string& layer, bool is_variance, MomentImage& to) {
  const Channel *r = image.find(layer + ".R"), *g = image.find(layer + ".G"), *b = image.find(layer + ".B");
  if (!r || !g || !b) return false;
  for (std::size_t k = 0; k < to.pixels.size(); ++k) {
    const auto error = [&](const Channel* channel) {
      return is_variance ? std::sqrt(double(channel->values[k])) : double(channel->values[k]);
    };
    const double l = luminance(Color<double>{error(r), error(g), error(b)});
    to.pixels[k].variance = l * l;
  }
  return true;
}

/// Errors taken for those of many samples.
void set_normal(MeanMoments& pixel) {
  const double freedom = MomentImage{}.replicates - 1;
  pixel.third = 0;
  pixel.variance_error_sq = 2 * pixel.variance * pixel.variance / freedom;
}

/// Mean over the pixels that both know of how far they are apart, in units of noise and a fiftieth of the
/// value, at most 100 each. \param foreign(x, y) NaN: not known
double misfit(const MomentImage& reference, const std::function<double(int, int)>& foreign) {
  constexpr double most = 100, tolerance = 0.02;
  double sum = 0, count = 0;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      const double theirs = foreign(x, y);
      if (!std::isfinite(theirs)) continue;
      const MeanMoments& ours = reference.at(x, y);
      sum += std::min(most,
                      std::abs(theirs - ours.mean) / (ours.standard_error() + tolerance * ours.mean + 1e-12));
      ++count;
    }
  return count > 0 ? sum / count : most;
}

/// As the mean of neighbours: what an image shows whose pixels lie half a pixel farther along dx, dy.
MomentImage shifted_by_half(const MomentImage& image, int dx, int dy) {
  MomentImage shifted = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const int there_x = std::clamp(x + dx, 0, image.width - 1),
                there_y = std::clamp(y + dy, 0, image.height - 1);
      shifted.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)].mean =
          (image.at(x, y).mean + image.at(there_x, y).mean + image.at(x, there_y).mean +
           image.at(there_x, there_y).mean) /
          4;
    }
  return shifted;
}

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace

ForeignImage read_foreign_image(const std::filesystem::path& file, const std::filesystem::path& stderr_file,
                                int width, int height) {
  const ColorImage colors = colors_of_size(file, width, height);
  ForeignImage foreign;
  const std::string ending = file.extension().string();
  foreign.is_8_bit = ending == ".png" || ending == ".PNG" || ending == ".jpg" || ending == ".jpeg";
  foreign.image = {width, height, std::vector<MeanMoments>(colors.rgb.size() / 3)};
  for (std::size_t k = 0; k < foreign.image.pixels.size(); ++k) {
    const double l = luminance_at(colors.rgb, k);
    const float brightest = std::max({colors.rgb[3 * k], colors.rgb[3 * k + 1], colors.rgb[3 * k + 2]});
    foreign.image.pixels[k] = {l, unknown, 0, 0};
    foreign.is_readable.push_back(std::isfinite(l) && !(foreign.is_8_bit && brightest >= 0.999f));
  }
  if (!stderr_file.empty()) {
    const ColorImage errors = colors_of_size(stderr_file, width, height);
    for (std::size_t k = 0; k < foreign.image.pixels.size(); ++k) {
      const double l = luminance_at(errors.rgb, k);
      foreign.image.pixels[k].variance = l * l;
    }
    foreign.noise = fmt::format("of {}", stderr_file.string());
  } else if (image_format(file) == ImageFormat::exr) {
    const Image layers = read_exr(file);
    if (take_layer(layers, "stderr", false, foreign.image))
      foreign.noise = "of its layer stderr";
    else if (take_layer(layers, "variance", true, foreign.image))
      foreign.noise = "of its layer variance";
  }
  if (!foreign.noise.empty())
    for (MeanMoments& pixel : foreign.image.pixels) set_normal(pixel);
  return foreign;
}

void estimate_noise(ForeignImage& foreign, const MomentImage& reference) {
  // Half the squared difference of neighbours' residuals: what both images show alike drops out, what changes
  // slowly too. Pooled over blocks.
  MomentImage& image = foreign.image;
  const auto residual = [&](int x, int y) { return image.at(x, y).mean - reference.at(x, y).mean; };
  for (int top = 0; top < image.height; top += block_side)
    for (int left = 0; left < image.width; left += block_side) {
      const int bottom = std::min(top + block_side, image.height),
                right = std::min(left + block_side, image.width);
      double sum = 0, count = 0;
      for (int y = top; y < bottom; ++y)
        for (int x = left; x + 1 < right; ++x) {
          const double step = residual(x, y) - residual(x + 1, y);
          if (!std::isfinite(step)) continue;
          sum += step * step / 2 - (reference.at(x, y).variance + reference.at(x + 1, y).variance) / 2;
          ++count;
        }
      for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
          MeanMoments& pixel = image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
          pixel.variance = std::max(count > 0 ? sum / count : 0.0, 1e-8 * pixel.mean * pixel.mean);
          set_normal(pixel);
        }
    }
  foreign.noise = "estimated from how neighbouring pixels differ";
}

std::optional<std::string> likely_mishap(const ForeignImage& foreign, const MomentImage& reference) {
  const int width = reference.width, height = reference.height;
  const auto at = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= width || y >= height) return unknown;
    const std::size_t k = std::size_t(y) * std::size_t(width) + std::size_t(x);
    return foreign.is_readable[k] ? foreign.image.pixels[k].mean : unknown;
  };
  struct Mishap {
    std::string what;
    std::function<double(int, int)> undone;  ///< The image without it.
  };
  std::vector<Mishap> mishaps{
      {"it is upside down", [&](int x, int y) { return at(x, height - 1 - y); }},
      {"it is a mirror image, left for right", [&](int x, int y) { return at(width - 1 - x, y); }},
      {"it is turned by 180 degrees", [&](int x, int y) { return at(width - 1 - x, height - 1 - y); }},
      {"its numbers are sRGB, not linear light", [&](int x, int y) { return linear_from_srgb(at(x, y)); }},
      {"it was taken for sRGB and decoded, though its numbers were linear light",
       [&](int x, int y) { return srgb_from_linear(std::max(0.0, at(x, y))); }},
  };
  double ours = 0, theirs = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (const double value = at(x, y); std::isfinite(value))
        ours += reference.at(x, y).mean, theirs += value;
  if (theirs > 0 && ours > 0)
    mishaps.push_back({fmt::format("it is {:.4g} times as bright everywhere", theirs / ours),
                       [&, scale = ours / theirs](int x, int y) { return at(x, y) * scale; }});
  constexpr double explained = 0.7;  // What may be left of the misfit.
  double least = explained * misfit(reference, at);
  std::optional<std::string> best;
  const auto consider = [&](double left, const std::string& what) {
    if (left >= least) return;
    least = left;
    best = what;
  };
  for (const Mishap& mishap : mishaps) consider(misfit(reference, mishap.undone), mishap.what);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (dx != 0 || dy != 0)
        consider(misfit(shifted_by_half(reference, dx, dy), at),
                 fmt::format("its pixels lie half a pixel off, by {:+.1f}, {:+.1f}", 0.5 * dx, 0.5 * dy));
  return best;
}

}  // namespace etendue
