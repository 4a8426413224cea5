#include "verify/foreign_image.h"

#include "base/error.h"
#include "image/color_file.h"
#include "image/color_space.h"
#include "image/image_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>

namespace etendue {
namespace {

constexpr double unknown_value = std::numeric_limits<double>::quiet_NaN();

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

/// The three channels of a layer; of the one without a name R, G and B.
struct ColorLayer {
  const Channel *r, *g, *b;

  ColorLayer(const Image& image, const std::string& layer)
      : r(image.find(layer.empty() ? "R" : layer + ".R")),
        g(image.find(layer.empty() ? "G" : layer + ".G")),
        b(image.find(layer.empty() ? "B" : layer + ".B")) {}
  bool is_there() const { return r && g && b; }
  Color<double> at(std::size_t k) const { return {r->values[k], g->values[k], b->values[k]}; }
};

/// The variance of the luminance where those of the channels are known: they are taken to go together.
double variance_of_luminance(const Color<double>& variances) {
  const auto root = [](double variance) { return std::sqrt(std::max(0.0, variance)); };
  const double error = luminance(Color<double>{root(variances.r), root(variances.g), root(variances.b)});
  return error * error;
}

/// The layer NAME of which there is an m2_NAME, the second moment of one sample.
std::optional<std::string> layer_with_second_moment(const Image& image) {
  const std::string begin = "m2_", end = ".R";
  for (const Channel& channel : image.channels)
    if (channel.name.starts_with(begin) && channel.name.ends_with(end))
      return channel.name.substr(begin.size(), channel.name.size() - begin.size() - end.size());
  return std::nullopt;
}

void take_noise_of_layers(const Image& image, std::optional<int> samples_per_pixel, ForeignImage& to) {
  std::vector<MeanMoments>& pixels = to.image.pixels;
  const auto take = [&](const std::string& layer, auto&& variances_at) {
    for (std::size_t k = 0; k < pixels.size(); ++k)
      pixels[k].variance = variance_of_luminance(variances_at(k));
    to.noise = fmt::format("of its layer {}", layer);
  };
  if (const ColorLayer errors(image, "stderr"); errors.is_there()) {
    take("stderr", [&](std::size_t k) { return errors.at(k) * errors.at(k); });
  } else if (const ColorLayer variances(image, "variance"); variances.is_there()) {
    take("variance", [&](std::size_t k) { return variances.at(k); });
  } else {
    const std::optional<std::string> moments = layer_with_second_moment(image);
    const ColorLayer of_sample(image, "Variance"), second(image, moments ? "m2_" + *moments : "m2_"),
        mean_of_it(image, moments.value_or("")), unnamed(image, "");
    const ColorLayer& mean = mean_of_it.is_there() ? mean_of_it : unnamed;
    const bool has_moments = second.is_there() && mean.is_there();
    if (!of_sample.is_there() && !has_moments) return;
    if (!samples_per_pixel) {
      to.hint = fmt::format("its layer {} is of one sample: --against-spp N says how many there were",
                            of_sample.is_there() ? "Variance" : "m2_" + *moments);
      return;
    }
    const double share = 1.0 / *samples_per_pixel;
    if (of_sample.is_there())
      take("Variance", [&](std::size_t k) { return of_sample.at(k) * share; });
    else
      take("m2_" + *moments,
           [&](std::size_t k) { return (second.at(k) + mean.at(k) * mean.at(k) * -1.0) * share; });
  }
}

/// Errors taken for those of many samples.
void set_normal(MeanMoments& pixel) {
  const double freedom = MomentImage{}.replicates - 1;
  pixel.third = 0;
  pixel.variance_error_sq = 2 * pixel.variance * pixel.variance / freedom;
}

/// Mean over the pixels that both know of how far they are apart, in units of noise and a fiftieth of the
/// value, at most 100 each. \param foreign(x, y) NaN: not known
double misfit_of_image(const MomentImage& reference, const std::function<double(int, int)>& foreign) {
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

double encoded_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// Of a number that is rounded to 8 bits of sRGB.
double rounding_variance_8_bit(double linear) {
  const double srgb = encoded_srgb(std::max(0.0, linear)),
               step = linear_from_srgb(srgb + 0.5 / 255) - linear_from_srgb(std::max(0.0, srgb - 0.5 / 255));
  return step * step / 12;
}

}  // namespace

ForeignImage read_foreign_image(const ForeignFiles& files, int width, int height) {
  const ColorImage colors = colors_of_size(files.image, width, height);
  ForeignImage foreign;
  std::string ending = files.image.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  foreign.is_8_bit = ending == ".png" || ending == ".jpg" || ending == ".jpeg";
  foreign.image = {width, height, std::vector<MeanMoments>(colors.rgb.size() / 3)};
  for (std::size_t k = 0; k < foreign.image.pixels.size(); ++k) {
    const double l = luminance_at(colors.rgb, k);
    const float brightest = std::max({colors.rgb[3 * k], colors.rgb[3 * k + 1], colors.rgb[3 * k + 2]});
    foreign.image.pixels[k] = {l, unknown_value, 0, 0};
    foreign.is_readable.push_back(std::isfinite(l) && !(foreign.is_8_bit && brightest >= 0.999f));
  }
  if (!files.standard_errors.empty()) {
    const ColorImage errors = colors_of_size(files.standard_errors, width, height);
    for (std::size_t k = 0; k < foreign.image.pixels.size(); ++k) {
      const double l = luminance_at(errors.rgb, k);
      foreign.image.pixels[k].variance = l * l;
    }
    foreign.noise = fmt::format("of {}", files.standard_errors.string());
  } else if (image_format(files.image) == ImageFormat::exr) {
    take_noise_of_layers(read_exr(files.image), files.samples_per_pixel, foreign);
  }
  if (!foreign.noise.empty())
    for (std::size_t k = 0; k < foreign.image.pixels.size(); ++k) {
      MeanMoments& pixel = foreign.image.pixels[k];
      if (!std::isfinite(pixel.variance) || pixel.variance < 0) foreign.is_readable[k] = false;
      set_normal(pixel);
    }
  return foreign;
}

void estimate_noise(ForeignImage& foreign, const MomentImage& reference) {
  // Where all pixels of a block are rounded the same way, their differences do not show it.
  constexpr double pixels_rounded_alike = block_side * block_side;
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
          if (foreign.is_8_bit) pixel.variance += pixels_rounded_alike * rounding_variance_8_bit(pixel.mean);
          set_normal(pixel);
        }
    }
  foreign.noise = "estimated from how neighbouring pixels differ";
}

std::optional<std::string> likely_mishap(const ForeignImage& foreign, const MomentImage& reference) {
  const int width = reference.width, height = reference.height;
  const auto at = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= width || y >= height) return unknown_value;
    const std::size_t k = std::size_t(y) * std::size_t(width) + std::size_t(x);
    return foreign.is_readable[k] ? foreign.image.pixels[k].mean : unknown_value;
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
       [&](int x, int y) { return encoded_srgb(std::max(0.0, at(x, y))); }},
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
  double least = explained * misfit_of_image(reference, at);
  std::optional<std::string> best;
  const auto consider = [&](double left, const std::string& what) {
    if (left >= least) return;
    least = left;
    best = what;
  };
  for (const Mishap& mishap : mishaps) consider(misfit_of_image(reference, mishap.undone), mishap.what);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (dx != 0 || dy != 0)
        consider(misfit_of_image(shifted_by_half(reference, dx, dy), at),
                 fmt::format("its pixels lie half a pixel off, by {:+.1f}, {:+.1f}", 0.5 * dx, 0.5 * dy));
  return best;
}

}  // namespace etendue
