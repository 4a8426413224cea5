#include "light/polygon_table.h"

#include <algorithm>

namespace etendue {

std::int32_t PolygonTable::add(std::span<const Vec3f> corners) {
  const Vec3<double> apex = widen(corners.front());
  const auto before = std::int32_t(further_.size());
  Record record;
  Vec3<double> sum{0, 0, 0}, last{0, 0, 0};
  double longest_sq = 0;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const Vec3<double> side = widen(corners[k]) - apex, across = cross(last, side);
    const Side here{narrow(side), float(length(across))};
    if (k == 1) record.first_side = here.from_apex;
    if (k == 2) record.second_side = here.from_apex, record.twice_first_area = here.twice_area;
    if (k > 2) further_.push_back(here);
    sum = sum + across;
    last = side;
    longest_sq = std::max(longest_sq, length_sq(side));
  }
  record.apex = corners.front();
  record.area = float(0.5 * length(sum));
  record.ng = narrow(normalize(sum));
  has_long_ = has_long_ || is_long(0.5 * length(sum), longest_sq);
  record.further_and_corners = before << 4 | std::int32_t(corners.size());
  records_.push_back(record);
  return count() - 1;
}

}  // namespace etendue
