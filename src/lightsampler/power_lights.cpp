#include "lightsampler/power_lights.h"

#include <algorithm>
#include <utility>

namespace etendue {

PowerLights::PowerLights(const Lights& lights) {
  std::vector<double> powers;
  for (std::int32_t light = 0; light < lights.count(); ++light) powers.push_back(lights.power(light));
  // A light far away and huge has nearly all power, and may bring less than a lamp at hand.
  const double of_all_alike = 1 / double(std::max(lights.count(), 1));
  append_positive_shares(std::move(powers), shares_, std::max(0x1p-28, 0.01 * of_all_alike));
}

}  // namespace etendue
