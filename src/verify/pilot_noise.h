// What a first look at each estimator tells: its time, and where on the film it is noisy. It decides how
// samples are spent and what counts how much; the images that are compared have samples of their own.
#pragma once

#include "verify/film_cells.h"

#include <span>
#include <vector>

namespace etendue {

struct PilotNoise {
  double seconds_per_sample = 0;  ///< Of one sample of all pixels.
  std::vector<MeanMoments> cells;
  int samples_per_pixel = 0;
  /// Of each cell, of one sample of a pixel: variance over the square of the mean. Pooled over the cells
  /// around that show the same material.
  std::vector<double> relative_variance{};
};

/// The median of the pilots' means (sums over pixels) of each cell.
std::vector<double> median_means(std::span<const PilotNoise> pilots);

/// \param means of the cells \param columns of blocks
void set_relative_variances(PilotNoise& pilot, const FilmCells& film, int columns,
                            std::span<const double> means);

/// Of the mean of a pixel with one sample over the whole image, cells weighted as below: what an estimator
/// can tell of a factor.
double whole_relative_variance(const PilotNoise& pilot, const FilmCells& film);

/// Weights of cells by which a factor between two images shows best: their mean over the variance of the
/// difference. They leave the mean over all cells as it is.
/// \param of_a, of_b relative variances of one sample \param samples_a, samples_b samples a pixel
std::vector<double> cell_weights(const FilmCells& film, std::span<const double> means,
                                 std::span<const double> of_a, int samples_a, std::span<const double> of_b,
                                 int samples_b);

/// How the time is divided, sum 1: so that the sum of the standard errors is least, but none gets less than a
/// third of an even share or more than three times it.
std::vector<double> shares_of_time(std::span<const PilotNoise> pilots, const FilmCells& film, double seconds);

}  // namespace etendue
