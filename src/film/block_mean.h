// The mean over a block of pixels of a film, for tests of whether two images are alike.
#pragma once

#include "film/film.h"
#include "stats/running.h"

#include <algorithm>
#include <cstdint>

namespace etendue {

/// A channel of a pixel: &Color<double>::r, g or b.
using Channel64 = double Color<double>::*;
inline constexpr Channel64 channels64[]{&Color<double>::r, &Color<double>::g, &Color<double>::b};

/// The mean over a square block of pixels, which are independent, as a sample whose standard error and
/// degrees of freedom (Satterthwaite 1946) Welch's test can take.
inline RunningStatistics block_mean(const Film& film, int x_begin, int y_begin, int block_px,
                                    Channel64 channel) {
  double mean = 0, variance = 0, fourth = 0;
  int pixels = 0;
  for (int y = y_begin; y < std::min(y_begin + block_px, film.height()); ++y)
    for (int x = x_begin; x < std::min(x_begin + block_px, film.width()); ++x) {
      const PixelStatistics& pixel = film.at(x, y);
      const double error_sq = pixel.m2.*channel / double(pixel.count - 1) / double(pixel.count);
      mean += pixel.mean.*channel;
      variance += error_sq;
      fourth += error_sq * error_sq / double(pixel.count - 1);
      ++pixels;
    }
  const auto count = std::int64_t(fourth > 0 ? variance * variance / fourth : 2) + 1;
  variance /= double(pixels) * pixels;
  return {count, mean / pixels, variance * double(count) * double(count - 1)};
}

}  // namespace etendue
