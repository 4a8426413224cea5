#include "lightsampler/cluster_visibility.h"

#include <algorithm>
#include <cmath>

namespace etendue {

std::vector<double> ClusterVisibility::means() const {
  std::vector<double> asked = asked_, free = free_, means(nodes_.size());
  for (std::size_t node = nodes_.size(); node-- > 1;) {
    const auto parent = std::size_t(nodes_[node].parent);
    asked[parent] += asked[node];
    free[parent] += free[node];
  }
  constexpr double rays_of_parent = 2;
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    const double around = node == 0 ? 1 : means[std::size_t(nodes_[node].parent)];
    means[node] = (free[node] + rays_of_parent * around) / (asked[node] + rays_of_parent);
  }
  return means;
}

double share_left(double visibility) {
  constexpr double seen_enough = 0.25, least = 0x1p-8;
  return std::sqrt(std::clamp(visibility, least, seen_enough) / seen_enough);
}

}  // namespace etendue
