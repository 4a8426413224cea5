// Running statistics of a few values that stand in a test.
#pragma once

#include "stats/running.h"

#include <initializer_list>

namespace etendue::test {

inline RunningStatistics statistics_of(std::initializer_list<double> values) {
  RunningStatistics statistics;
  for (const double value : values) statistics.add(value);
  return statistics;
}

}  // namespace etendue::test
