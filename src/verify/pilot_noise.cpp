#include "verify/pilot_noise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace etendue {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<double> median_means(std::span<const PilotNoise> pilots) {
  std::vector<double> means, of_cell;
  for (std::size_t k = 0; k < pilots.front().cells.size(); ++k) {
    of_cell.clear();
    for (const PilotNoise& pilot : pilots) of_cell.push_back(std::max(0.0, pilot.cells[k].mean));
    means.push_back(median(of_cell));
  }
  return means;
}

void set_relative_variances(PilotNoise& pilot, const FilmCells& film, int columns,
                            std::span<const double> means) {
  // No cell is taken to be known so well that a few of them would be all that counts; nor much better than
  // others of its material, as it may be one in which the pilot has missed a rare event.
  constexpr double least_of_median = 0.05, least_of_material = 0.5;
  std::map<std::tuple<std::int32_t, std::int32_t, bool>, std::size_t> cell_of;
  struct Sums {
    double variance = 0, mean_sq = 0;

    void add(double variance_of_one, double mean, int pixels) {
      variance += std::isfinite(variance_of_one) ? variance_of_one : 0;
      mean_sq += mean * mean / pixels;
    }
    double relative() const { return mean_sq > 0 ? variance / mean_sq : 0; }
  };
  const auto add_to = [&](Sums& sums, std::size_t k) {
    sums.add(pilot.cells[k].variance * pilot.samples_per_pixel, means[k], film.cells[k].pixels);
  };
  std::map<std::pair<std::int32_t, bool>, Sums> of_material;
  for (std::size_t k = 0; k < film.cells.size(); ++k) {
    const FilmCell& cell = film.cells[k];
    cell_of[{cell.block, cell.material, cell.has_rare_hits}] = k;
    add_to(of_material[{cell.material, cell.has_rare_hits}], k);
  }
  std::vector<double> known;
  pilot.relative_variance.clear();
  for (const FilmCell& cell : film.cells) {
    Sums around;
    for (int row = -1; row <= 1; ++row)
      for (int column = -1; column <= 1; ++column) {
        const int there = cell.block % columns + column;
        if (there < 0 || there >= columns) continue;
        const auto near =
            cell_of.find({cell.block + row * columns + column, cell.material, cell.has_rare_hits});
        if (near != cell_of.end()) add_to(around, near->second);
      }
    const double relative = std::max(
        around.relative(), least_of_material * of_material[{cell.material, cell.has_rare_hits}].relative());
    pilot.relative_variance.push_back(relative);
    if (relative > 0) known.push_back(relative);
  }
  const double middle = known.empty() ? 1 : median(known);
  // A cell without variance is one of which the pilot has seen nothing.
  for (double& relative : pilot.relative_variance)
    relative = relative > 0 ? std::max(relative, least_of_median * middle) : middle;
}

double whole_relative_variance(const PilotNoise& pilot, const FilmCells& film) {
  double precision = 0;
  for (std::size_t k = 0; k < film.cells.size(); ++k)
    precision += film.cells[k].pixels / pilot.relative_variance[k];
  return 1 / precision;
}

std::vector<double> cell_weights(const FilmCells& film, std::span<const double> means,
                                 std::span<const double> of_a, int samples_a, std::span<const double> of_b,
                                 int samples_b) {
  std::vector<double> weights;
  double weighted = 0, sum = 0;
  for (std::size_t k = 0; k < film.cells.size(); ++k) {
    const double relative = of_a[k] / samples_a + of_b[k] / samples_b;
    weights.push_back(means[k] > 0 ? film.cells[k].pixels / (means[k] * relative) : 0);
    weighted += weights.back() * means[k];
    sum += means[k];
  }
  if (weighted > 0)
    for (double& weight : weights) weight *= sum / weighted;
  return weights;
}

std::vector<double> shares_of_time(std::span<const PilotNoise> pilots, const FilmCells& film,
                                   double seconds) {
  // The standard error of k is root(cost / time), and its derivative by time the same for all of them.
  constexpr double hopeless = 0.05, most = 3;
  const double even = seconds / double(pilots.size());
  std::vector<double> cost, shares;
  for (const PilotNoise& pilot : pilots)
    cost.push_back(std::max(whole_relative_variance(pilot, film) * pilot.seconds_per_sample, 1e-300));
  const double middle = median(cost);
  for (const double each : cost)
    shares.push_back(
        std::sqrt(each / even) > hopeless ? 1 / most : std::clamp(std::cbrt(each / middle), 1 / most, most));
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= sum;
  return shares;
}

}  // namespace etendue
