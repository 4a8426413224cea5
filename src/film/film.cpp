#include "film/film.h"

#include "base/error.h"
#include "stats/running.h"

#include <bit>
#include <fmt/format.h>
#include <limits>

namespace etendue {
namespace {

RunningStatistics channel(const PixelStatistics& pixel, double Color<double>::*c) {
  return {pixel.count, pixel.mean.*c, pixel.m2.*c, pixel.m3.*c};
}

PixelStatistics sum_of_range(std::span<const Color<double>> means, std::uint64_t first) {
  if (means.size() == 1) return {1, means[0], {0, 0, 0}, {0, 0, 0}};
  const std::uint64_t split = replicate_split(first, first + means.size());
  return combine(sum_of_range(means.first(split - first), first),
                 sum_of_range(means.subspan(split - first), split));
}

}  // namespace

PixelStatistics combine(const PixelStatistics& a, const PixelStatistics& b) {
  PixelStatistics both;
  both.count = a.count + b.count;
  for (const auto c : {&Color<double>::r, &Color<double>::g, &Color<double>::b}) {
    const RunningStatistics sum = combine(channel(a, c), channel(b, c));
    both.mean.*c = sum.mean;
    both.m2.*c = sum.m2;
    both.m3.*c = sum.m3;
  }
  return both;
}

std::uint64_t replicate_split(std::uint64_t first, std::uint64_t last) {
  return (last - 1) & ~(std::bit_floor(first ^ (last - 1)) - 1);
}

PixelStatistics combine_replicates(std::span<const Color<double>> means, std::uint64_t first) {
  return means.empty() ? PixelStatistics{} : sum_of_range(means, first);
}

Color<double> standard_error(const PixelStatistics& pixel) {
  return {channel(pixel, &Color<double>::r).standard_error(),
          channel(pixel, &Color<double>::g).standard_error(),
          channel(pixel, &Color<double>::b).standard_error()};
}

void check_film_size(int width, int height) {
  if (width <= 0 || height <= 0)
    throw InputError(
        fmt::format("an image of {} x {} pixels: width and height must be at least 1", width, height));
}

Film::Film(int width, int height) : width_(width), height_(height) {
  check_film_size(width, height);
  pixels_.resize(std::size_t(width) * std::size_t(height));
}

Color<double> Film::mean() const {
  Color<double> sum{0, 0, 0};
  std::int64_t rendered = 0;
  for (const PixelStatistics& pixel : pixels_) {
    if (pixel.count == 0) continue;
    sum = sum + pixel.mean;
    ++rendered;
  }
  if (rendered == 0) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    return {unknown, unknown, unknown};
  }
  return {sum.r / double(rendered), sum.g / double(rendered), sum.b / double(rendered)};
}

}  // namespace etendue
