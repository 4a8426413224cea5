#include "lightsampler/power_lights.h"

#include <algorithm>

namespace etendue {

PowerLights::PowerLights(const Lights& lights) {
  std::vector<double> powers;
  double total = 0;
  for (std::int32_t light = 0; light < lights.count(); ++light) {
    powers.push_back(lights.power(light));
    total += powers.back();
  }
  // A light far away and huge has nearly all power, and may bring less than a lamp at hand. And shares are
  // whole numbers: one that rounds to 0 would leave its light out.
  const double least_share = std::max(0x1p-28, 0.01 / double(std::max(lights.count(), 1)));
  for (double& power : powers) power = total == 0 ? 1 : power > 0 ? std::max(power, least_share * total) : 0;
  append_cumulative_shares(powers, shares_);
}

}  // namespace etendue
