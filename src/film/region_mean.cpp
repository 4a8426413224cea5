#include "film/region_mean.h"

#include "stats/quantile.h"

#include <cmath>
#include <limits>

namespace etendue {
namespace {

/// A mean of independent ones.
class MeanOfMeans {
 public:
  void add(double mean, double error, std::int64_t replicates) {
    const double error_sq = error * error;
    mean_ += mean;
    error_sq_ += error_sq;
    fourth_ += error_sq * error_sq / double(replicates - 1);
    ++count_;
  }
  KnownMean known(double confidence) const {
    const double mean = mean_ / double(count_), error = std::sqrt(error_sq_) / double(count_);
    if (!(error > 0)) return {mean, error, {mean - error, mean + error}};
    const double half_width =
        error * student_t_quantile((1 + confidence) / 2, error_sq_ * error_sq_ / fourth_);
    return {mean, error, {mean - half_width, mean + half_width}};
  }

 private:
  double mean_ = 0, error_sq_ = 0, fourth_ = 0;
  std::int64_t count_ = 0;
};

}  // namespace

RegionMean region_mean(const Film& film, std::span<const PixelInterval> intervals,
                       const PixelRectangle& region, double confidence) {
  Color<MeanOfMeans> channels;
  MeanOfMeans of_luminance;
  for (int y = region.y_begin; y < region.y_end; ++y)
    for (int x = region.x_begin; x < region.x_end; ++x) {
      const PixelStatistics& pixel = film.at(x, y);
      if (pixel.count == 0) continue;
      const Color<double> error = standard_error(pixel);
      channels.r.add(pixel.mean.r, error.r, pixel.count);
      channels.g.add(pixel.mean.g, error.g, pixel.count);
      channels.b.add(pixel.mean.b, error.b, pixel.count);
      of_luminance.add(luminance(pixel.mean),
                       intervals[std::size_t(y) * std::size_t(film.width()) + std::size_t(x)].luminance_error,
                       pixel.count);
    }
  return {{channels.r.known(confidence), channels.g.known(confidence), channels.b.known(confidence)},
          of_luminance.known(confidence)};
}

}  // namespace etendue
