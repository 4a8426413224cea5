// What a film says of means over all pixels where they are alike.
#pragma once

#include "film/block_mean.h"

namespace etendue {

/// Where all pixels should be the same: each is one more independent estimate.
inline RunningStatistics statistics_of_pixels(const Film& film, Channel64 channel) {
  RunningStatistics statistics;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) statistics.add(film.at(x, y).mean.*channel);
  return statistics;
}

}  // namespace etendue
