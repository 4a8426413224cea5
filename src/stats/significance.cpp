#include "stats/significance.h"

#include <cmath>
#include <stdexcept>

namespace etendue {

double sidak_level(double level, std::int64_t tests) {
  if (!(level > 0 && level < 1)) throw std::domain_error("sidak_level: the level must lie in (0, 1)");
  if (tests < 1) throw std::domain_error("sidak_level: there must be at least one test");
  return -std::expm1(std::log1p(-level) / double(tests));
}

bool is_rejected(double p_value, double level, std::int64_t tests) {
  return !(p_value >= sidak_level(level, tests));
}

}  // namespace etendue
