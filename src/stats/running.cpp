#include "stats/running.h"

#include <cmath>
#include <limits>

namespace etendue {

void RunningStatistics::add(double value) {
  ++count;
  const double difference = value - mean;
  mean += difference / double(count);
  const double added = difference * (value - mean), step = difference / double(count);
  m3 += step * (added * double(count - 2) - 3 * m2);
  m2 += added;
}

double RunningStatistics::variance() const {
  return count < 2 ? std::numeric_limits<double>::quiet_NaN() : m2 / double(count - 1);
}

double RunningStatistics::standard_error() const { return std::sqrt(variance() / double(count)); }

double RunningStatistics::skewness() const {
  if (count < 3 || m2 == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(double(count)) * m3 / (m2 * std::sqrt(m2));
}

}  // namespace etendue
