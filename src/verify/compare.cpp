#include "verify/compare.h"

#include "stats/quantile.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

/// Of a material without rare hits those cells are tested with it that have none either.
bool belongs_to_material(const FilmCell& cell, const FilmCells& film) {
  return cell.material >= 0 && cell.has_rare_hits == (film.has_rare_hits[std::size_t(cell.material)] != 0);
}

/// Of each block with those around it.
std::vector<double> steps_around(const ComparedImage& image, const FilmCells& film) {
  const int columns = blocks_along(image.image.width), rows = blocks_along(image.image.height);
  std::vector<char> has_rare(image.blocks.size(), 0);
  for (const FilmCell& cell : film.cells)
    if (cell.has_rare_hits) has_rare[std::size_t(cell.block)] = 1;
  std::vector<double> steps;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      MeanMoments around;
      bool is_near_rare = false;
      for (int y = std::max(0, row - 1); y <= std::min(rows - 1, row + 1); ++y)
        for (int x = std::max(0, column - 1); x <= std::min(columns - 1, column + 1); ++x) {
          around += image.blocks[std::size_t(y * columns + x)];
          is_near_rare = is_near_rare || has_rare[std::size_t(y * columns + x)];
        }
      steps.push_back(std::max(around.step(), image.steps.at(is_near_rare)));
    }
  return steps;
}

/// Some cells of an image, weighted.
struct WeightedSum {
  MeanMoments moments{};
  double step_sum = 0, step_square_sum = 0;  // Of rare events, as if those made all of the means.

  void add(const MeanMoments& cell, double weight, double mean, double step) {
    moments += cell.scaled(weight);
    step_sum += weight * weight * step * mean;
    step_square_sum += weight * weight * weight * step * step * mean;
  }
  double step() const { return step_sum > 0 ? step_square_sum / step_sum : 0; }
};

constexpr int region_kinds = 4;

/// The tests of one pair.
class Tests {
 public:
  Tests(const ComparedImage& a, const ComparedImage& b, const FilmCells& film, double level)
      : a_(a), b_(b), film_(film), level_(level) {}

  MeanTest whole() const { return test_same_mean(a_.whole, b_.whole, a_.steps.most(), b_.steps.most()); }
  MeanTest material(std::size_t m) const {
    const bool has_rare = film_.has_rare_hits[m] != 0;
    return test_same_mean(a_.materials[m], b_.materials[m], a_.steps.at(has_rare), b_.steps.at(has_rare));
  }
  MeanTest block(std::size_t k) const {
    return test_same_mean(a_.blocks[k], b_.blocks[k], a_.block_steps[k], b_.block_steps[k]);
  }

  /// Notes a test that is one of `count` of its kind. A NaN tells nothing.
  void take(const Region& region, const MeanTest& test, std::size_t count, double ratio) {
    const double least = region.kind == Region::Kind::pixel ? least_p_of_replicates() : 0,
                 p = std::min(1.0, std::max(test.p_value, least) * double(count) * region_kinds);
    if (p < strongest.p_value) strongest = {region, test, p, ratio};
  }

  /// The same of all pixels; cheap where a pixel's difference is too small for any level that counts.
  void take_pixels() {
    const std::size_t count = a_.image.pixels.size();
    if (least_p_of_replicates() * double(count) * region_kinds > level_) return;
    const double least = -normal_quantile(level_ / (2 * double(count) * region_kinds));
    const int columns = blocks_along(a_.image.width);
    for (int y = 0; y < a_.image.height; ++y)
      for (int x = 0; x < a_.image.width; ++x) {
        const MeanMoments &a = a_.image.at(x, y), &b = b_.image.at(x, y);
        const double difference = a.mean - b.mean;
        if (!(difference * difference > least * least * (a.variance + b.variance))) continue;
        const std::size_t block = std::size_t(y / block_side * columns + x / block_side);
        take({Region::Kind::pixel, x, y, 0},
             test_same_mean(a, b, a_.block_steps[block], b_.block_steps[block]), count, a.mean / b.mean);
      }
  }

  Difference strongest{};

 private:
  /// Of a pixel with an edge through it all replicates of one image may lie on one side, and those of the
  /// other on the other: no test of so few values can be surer than that of all their permutations.
  double least_p_of_replicates() const {
    const double a = a_.image.replicates, b = b_.image.replicates;
    return std::min(1.0, 2 * std::exp(std::lgamma(a + 1) + std::lgamma(b + 1) - std::lgamma(a + b + 1)));
  }

  const ComparedImage &a_, &b_;
  const FilmCells& film_;
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

/// The same cells of two images, weighted.
struct WeightedPair {
  WeightedSum a{}, b{};

  MeanTest test() const { return test_same_mean(a.moments, b.moments, a.step(), b.step()); }
  double ratio() const { return a.moments.mean / b.moments.mean; }
};

/// Relative to the larger mean; of two black images 0.
double smallest_relative_difference(const MeanMoments& a, const MeanMoments& b, double step_a, double step_b,
                                    double level) {
  const double mean = std::max(std::abs(a.mean), std::abs(b.mean));
  return mean > 0 ? smallest_difference(a, b, step_a, step_b, level) / mean : 0;
}

}  // namespace

ComparedImage compared_image(MomentImage image, const FilmCells& film) {
  ComparedImage compared{std::move(image)};
  compared.cells = film.sums(compared.image);
  compared.materials.resize(film.has_rare_hits.size());
  for (std::size_t k = 0; k < compared.cells.size(); ++k) {
    compared.whole += compared.cells[k];
    const FilmCell& cell = film.cells[k];
    if (belongs_to_material(cell, film)) compared.materials[std::size_t(cell.material)] += compared.cells[k];
  }
  compared.blocks = block_sums(compared.image);
  raise_steps(compared, film, steps_seen(compared, film));
  return compared;
}

LeastSteps steps_seen(const ComparedImage& image, const FilmCells& film) {
  MeanMoments others;
  for (std::size_t k = 0; k < image.cells.size(); ++k)
    if (!film.cells[k].has_rare_hits) others += image.cells[k];
  return {std::max(0.0, image.whole.step()), std::max(0.0, others.step())};
}

void raise_steps(ComparedImage& image, const FilmCells& film, const LeastSteps& least) {
  image.steps = {std::max(image.steps.of_lobes, least.of_lobes),
                 std::max(image.steps.of_others, least.of_others)};
  image.block_steps = steps_around(image, film);
  image.cell_steps.clear();
  for (const FilmCell& cell : film.cells) image.cell_steps.push_back(image.steps.at(cell.has_rare_hits));
}

Comparison compare(const ComparedImage& a, const ComparedImage& b, const FilmCells& film,
                   std::span<const double> means, std::span<const double> weights, double level) {
  Tests tests(a, b, film, level);
  Comparison comparison;
  WeightedPair whole;
  std::vector<WeightedPair> materials(a.materials.size());
  const bool are_all_rare =
      std::ranges::all_of(film.cells, [](const FilmCell& cell) { return cell.has_rare_hits; });
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const auto add_to = [&](WeightedPair& pair) {
      pair.a.add(a.cells[k], weights[k], means[k], a.cell_steps[k]);
      pair.b.add(b.cells[k], weights[k], means[k], b.cell_steps[k]);
    };
    const FilmCell& cell = film.cells[k];
    // One rare hit, were it only possible, would outweigh all that is known of the others.
    if (are_all_rare || !cell.has_rare_hits) add_to(whole);
    if (belongs_to_material(cell, film)) add_to(materials[std::size_t(cell.material)]);
  }
  tests.take({}, tests.whole(), 2, a.whole.mean / b.whole.mean);
  tests.take({.is_weighted = true}, whole.test(), 2, whole.ratio());
  for (std::size_t m = 0; m < a.materials.size(); ++m) {
    Region region{.kind = Region::Kind::material, .material = std::int32_t(m)};
    tests.take(region, tests.material(m), 2 * a.materials.size(), a.materials[m].mean / b.materials[m].mean);
    region.is_weighted = true;
    tests.take(region, materials[m].test(), 2 * a.materials.size(), materials[m].ratio());
  }
  const int columns = blocks_along(a.image.width);
  for (std::size_t k = 0; k < a.blocks.size(); ++k) {
    const Region region{Region::Kind::block, int(k) % columns * block_side, int(k) / columns * block_side, 0};
    const MeanTest test = tests.block(k);
    tests.take(region, test, a.blocks.size(), a.blocks[k].mean / b.blocks[k].mean);
    if (std::abs(test.statistic) > std::abs(comparison.worst_block.test.statistic) || k == 0)
      comparison.worst_block = {region, test, std::min(1.0, test.p_value * double(a.blocks.size()))};
  }
  tests.take_pixels();
  comparison.strongest = tests.strongest;
  comparison.p_value = tests.strongest.p_value;
  set_ratio(a.whole, b.whole, comparison);
  const double level_of_one = level / region_kinds / 2;
  comparison.smallest_difference =
      smallest_relative_difference(a.whole, b.whole, a.steps.most(), b.steps.most(), level_of_one);
  if (whole.a.moments.mean > 0 || whole.b.moments.mean > 0)
    comparison.smallest_difference =
        std::min(comparison.smallest_difference,
                 smallest_relative_difference(whole.a.moments, whole.b.moments, whole.a.step(),
                                              whole.b.step(), level_of_one));
  return comparison;
}

std::vector<double> block_differences(const ComparedImage& a, const ComparedImage& b) {
  std::vector<double> differences;
  for (std::size_t k = 0; k < a.blocks.size(); ++k)
    differences.push_back(
        test_same_mean(a.blocks[k], b.blocks[k], a.block_steps[k], b.block_steps[k]).statistic);
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
