#include "stats/running.h"

#include <cmath>
#include <limits>

namespace etendue {

void RunningStatistics::add(double value) {
  ++count;
  const double difference = value - mean;
  mean += difference / double(count);
  m2 += difference * (value - mean);
}

double RunningStatistics::variance() const {
  return count < 2 ? std::numeric_limits<double>::quiet_NaN() : m2 / double(count - 1);
}

double RunningStatistics::standard_error() const { return std::sqrt(variance() / double(count)); }

RunningStatistics combine(const RunningStatistics& a, const RunningStatistics& b) {
  if (a.count == 0) return b;
  if (b.count == 0) return a;
  const double difference = b.mean - a.mean;
  const double share_b = double(b.count) / double(a.count + b.count);
  return {a.count + b.count, a.mean + difference * share_b,
          a.m2 + b.m2 + difference * difference * (double(a.count) * share_b)};
}

}  // namespace etendue
