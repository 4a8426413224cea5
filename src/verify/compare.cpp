#include "verify/compare.h"

#include "stats/quantile.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

/// Of each block with those around it, and at least that of the whole image: where a highlight has been
/// missed, what else the blocks have found has small steps.
std::vector<double> steps_around(const ComparedImage& image) {
  const int columns = blocks_along(image.image.width), rows = blocks_along(image.image.height);
  std::vector<double> steps;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      MeanMoments around;
      for (int y = std::max(0, row - 1); y <= std::min(rows - 1, row + 1); ++y)
        for (int x = std::max(0, column - 1); x <= std::min(columns - 1, column + 1); ++x)
          around += image.blocks[std::size_t(y * columns + x)];
      steps.push_back(std::max({around.step(), image.whole.step(), image.unseen_step}));
    }
  return steps;
}

constexpr int region_kinds = 4;

/// The tests of one pair.
class Tests {
 public:
  Tests(const ComparedImage& a, const ComparedImage& b, double level) : a_(a), b_(b), level_(level) {}

  MeanTest whole() const { return test_same_mean(a_.whole, b_.whole, a_.unseen_step, b_.unseen_step); }
  MeanTest material(std::size_t m) const {
    return test_same_mean(a_.materials[m], b_.materials[m], std::max(a_.unseen_step, a_.whole.step()),
                          std::max(b_.unseen_step, b_.whole.step()));
  }
  MeanTest block(std::size_t k) const {
    return test_same_mean(a_.blocks[k], b_.blocks[k], a_.block_steps[k], b_.block_steps[k]);
  }

  /// Notes a test that is one of `count` of its kind. A NaN tells nothing.
  void take(const Region& region, const MeanTest& test, std::size_t count) {
    const double p = std::min(1.0, test.p_value * double(count) * region_kinds);
    if (p < strongest.p_value) strongest = {region, test, p};
  }

  /// The same of all pixels; cheap where a pixel's difference is too small for any level that counts.
  void take_pixels() {
    const std::size_t count = a_.image.pixels.size();
    const double least = -normal_quantile(level_ / (2 * double(count) * region_kinds));
    const int columns = blocks_along(a_.image.width);
    for (int y = 0; y < a_.image.height; ++y)
      for (int x = 0; x < a_.image.width; ++x) {
        const MeanMoments &a = a_.image.at(x, y), &b = b_.image.at(x, y);
        const double difference = a.mean - b.mean;
        if (!(difference * difference > least * least * (a.variance + b.variance))) continue;
        const std::size_t block = std::size_t(y / block_side * columns + x / block_side);
        take({Region::Kind::pixel, x, y, 0},
             test_same_mean(a, b, a_.block_steps[block], b_.block_steps[block]), count);
      }
  }

  Difference strongest{};

 private:
  const ComparedImage &a_, &b_;
  double level_;
};

/// Of the mean of a to that of b, with the 95 % interval of a quotient of two normal means by the delta
/// method.
void set_ratio(const MeanMoments& a, const MeanMoments& b, Comparison& comparison) {
  comparison.ratio = a.mean / b.mean;
  const double relative = std::sqrt(a.variance / (a.mean * a.mean) + b.variance / (b.mean * b.mean));
  const double factor = std::exp(normal_quantile(0.975) * relative);
  comparison.ratio_low = comparison.ratio / factor;
  comparison.ratio_high = comparison.ratio * factor;
}

}  // namespace

ComparedImage compared_image(MomentImage image, std::span<const std::int32_t> material_of_pixel,
                             int materials, double unseen_step) {
  ComparedImage compared{std::move(image), unseen_step};
  compared.materials.resize(std::size_t(materials));
  for (std::size_t k = 0; k < compared.image.pixels.size(); ++k) {
    compared.whole += compared.image.pixels[k];
    if (material_of_pixel[k] >= 0)
      compared.materials[std::size_t(material_of_pixel[k])] += compared.image.pixels[k];
  }
  compared.blocks = block_sums(compared.image);
  compared.block_steps = steps_around(compared);
  return compared;
}

void set_unseen_step(ComparedImage& image, double step) {
  image.unseen_step = step;
  image.block_steps = steps_around(image);
}

Comparison compare(const ComparedImage& a, const ComparedImage& b, double level) {
  Tests tests(a, b, level);
  Comparison comparison;
  tests.take({}, tests.whole(), 1);
  for (std::size_t m = 0; m < a.materials.size(); ++m)
    tests.take({Region::Kind::material, 0, 0, std::int32_t(m)}, tests.material(m), a.materials.size());
  const int columns = blocks_along(a.image.width);
  for (std::size_t k = 0; k < a.blocks.size(); ++k) {
    const Region region{Region::Kind::block, int(k) % columns * block_side, int(k) / columns * block_side, 0};
    const MeanTest test = tests.block(k);
    tests.take(region, test, a.blocks.size());
    if (std::abs(test.statistic) > std::abs(comparison.worst_block.test.statistic) || k == 0)
      comparison.worst_block = {region, test, std::min(1.0, test.p_value * double(a.blocks.size()))};
  }
  tests.take_pixels();
  comparison.strongest = tests.strongest;
  comparison.p_value = tests.strongest.p_value;
  set_ratio(a.whole, b.whole, comparison);
  const double mean = std::max(std::abs(a.whole.mean), std::abs(b.whole.mean));
  comparison.smallest_difference =
      mean > 0
          ? smallest_difference(a.whole, b.whole, a.unseen_step, b.unseen_step, level / region_kinds) / mean
          : 0;
  return comparison;
}

std::vector<double> block_differences(const ComparedImage& a, const ComparedImage& b) {
  const Tests tests(a, b, 1);
  std::vector<double> differences;
  for (std::size_t k = 0; k < a.blocks.size(); ++k) differences.push_back(tests.block(k).statistic);
  return differences;
}

std::vector<double> pixel_differences(const ComparedImage& a, const ComparedImage& b) {
  std::vector<double> differences;
  for (std::size_t k = 0; k < a.image.pixels.size(); ++k) {
    const MeanMoments &of_a = a.image.pixels[k], &of_b = b.image.pixels[k];
    const double difference = of_a.mean - of_b.mean, error_sq = of_a.variance + of_b.variance;
    differences.push_back(difference == 0 ? 0 : difference / std::sqrt(error_sq));
  }
  return differences;
}

}  // namespace etendue
