#include "lightsampler/light_tree.h"

#include "light/inversion_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

namespace etendue {

namespace {

/// Of so many facets and more, up to four share a leaf, so that the tree needs no more memory than they do.
constexpr std::size_t many_facets = 1 << 16, most_in_leaf = 4;

struct Facet {
  LightFacet id;
  Vec3f center;  ///< Of its box.
  float radius;
  Vec3f axis;
  float cos_normals;
  double power;
};

float component(const Vec3f& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// Sums over facets, of which the cost of a cluster is made.
struct Sums {
  Box box;
  Vec3<double> normal{0, 0, 0};  ///< Weighed by power; of facets that shine all round nothing.
  double power = 0;

  void add(const Facet& facet) {
    const Vec3f reach{facet.radius, facet.radius, facet.radius};
    box.include(facet.center - reach);
    box.include(facet.center + reach);
    const double weight = facet.cos_normals > 0 ? facet.power : 0;
    normal = normal + Vec3<double>{facet.axis.x, facet.axis.y, facet.axis.z} * weight;
    power += facet.power;
  }
  void add(const Sums& more) {
    if (!(more.power > 0)) return;
    box.include(more.box.low);
    box.include(more.box.high);
    normal = normal + more.normal;
    power += more.power;
  }
  double cost() const {
    if (!(power > 0)) return 0;
    const Vec3f diagonal = box.high - box.low;
    return power * double(length_sq(diagonal)) * (2 - length(normal) / power);
  }
};

class TreeBuilder {
 public:
  explicit TreeBuilder(std::vector<Facet>& facets)
      : facets_(facets),
        sparse_(2 * facets.size() - 1),
        most_in_leaf_(facets.size() >= many_facets ? most_in_leaf : 1) {
    build(0, 1, 0, 0, facets.size());
  }

  /// The clusters, level by level.
  std::vector<LightCluster> clusters() const {
    std::vector<LightCluster> ordered{sparse_[0]};
    for (std::size_t i = 0; i < ordered.size(); ++i) {
      const std::int32_t from = ordered[i].first_child;
      if (from == 0) continue;
      ordered[i].first_child = std::int32_t(ordered.size());
      for (const std::int32_t side : {0, 1}) {
        ordered.push_back(sparse_[std::size_t(from + side)]);
        ordered.back().parent = std::int32_t(i);
      }
    }
    return ordered;
  }

 private:
  /// The cluster `at` over facets [begin, end), whose children and theirs have room from `room` on.
  void build(std::size_t at, std::size_t room, int depth, std::size_t begin, std::size_t end) {
    LightCluster& cluster = sparse_[at];
    cluster = around(begin, end);
    if (end - begin <= most_in_leaf_) return;
    const std::size_t middle = split(begin, end, depth);
    cluster.first_child = std::int32_t(room);
    const std::size_t room_left = room + 2, room_right = room_left + 2 * (middle - begin) - 2;
    const auto left = [&] { build(room, room_left, depth + 1, begin, middle); };
    const auto right = [&] { build(room + 1, room_right, depth + 1, middle, end); };
    constexpr std::size_t worth_a_task = 4096;
    if (end - begin < worth_a_task) {
      left();
      right();
    } else {
      tbb::parallel_invoke(left, right);
    }
  }

  LightCluster around(std::size_t begin, std::size_t end) const {
    Sums sums;
    for (std::size_t i = begin; i < end; ++i) sums.add(facets_[i]);
    LightCluster c{};
    c.begin = std::int32_t(begin);
    c.end = std::int32_t(end);
    c.power = float(sums.power);
    c.center = (sums.box.low + sums.box.high) * 0.5f;
    double radius = 0;
    for (std::size_t i = begin; i < end; ++i)
      radius = std::max(radius, double(length(facets_[i].center - c.center)) + facets_[i].radius);
    c.radius_sq = float(radius * radius * (1 + 1e-5));
    c.cos_normals = -1;
    c.axis = {0, 0, 1};
    const double size = length(sums.normal);
    if (!(size > 0)) return c;
    const Vec3<double> axis = sums.normal * (1 / size);
    double widest = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Facet& f = facets_[i];
      const double cosine = axis.x * f.axis.x + axis.y * f.axis.y + axis.z * f.axis.z;
      widest = std::max(widest, std::acos(std::clamp(cosine, -1.0, 1.0)) + std::acos(double(f.cos_normals)));
    }
    c.axis = {float(axis.x), float(axis.y), float(axis.z)};
    c.cos_normals = widest < 3.1 ? float(std::cos(widest)) - 1e-6f : -1;
    return c;
  }

  /// Parts the facets in two; returns where the second part begins.
  std::size_t split(std::size_t begin, std::size_t end, int depth) {
    Box centers;
    for (std::size_t i = begin; i < end; ++i) centers.include(facets_[i].center);
    constexpr int bins = 16;
    double best = std::numeric_limits<double>::infinity();
    int best_axis = -1, best_bin = 0;
    const auto bin_of = [&](const Facet& facet, int axis) {
      const float low = component(centers.low, axis), size = component(centers.high, axis) - low;
      return std::clamp(int(float(bins) * ((component(facet.center, axis) - low) / size)), 0, bins - 1);
    };
    // A tree of which each split leaves little on one side could be as deep as it has facets.
    constexpr int deep = 60;
    for (int axis = 0; axis < 3 && depth < deep; ++axis) {
      if (!(component(centers.high, axis) > component(centers.low, axis))) continue;
      std::array<Sums, bins> sums;
      for (std::size_t i = begin; i < end; ++i) sums[std::size_t(bin_of(facets_[i], axis))].add(facets_[i]);
      std::array<double, bins> cost_below{};
      Sums below, above;
      for (int b = 0; b + 1 < bins; ++b) {
        below.add(sums[std::size_t(b)]);
        cost_below[std::size_t(b)] = below.cost();
      }
      for (int b = bins - 1; b > 0; --b) {
        above.add(sums[std::size_t(b)]);
        const double cost = cost_below[std::size_t(b - 1)] + above.cost();
        if (cost < best) {
          best = cost;
          best_axis = axis;
          best_bin = b;
        }
      }
    }
    const auto first = facets_.begin() + std::ptrdiff_t(begin), last = facets_.begin() + std::ptrdiff_t(end);
    if (best_axis >= 0) {
      const auto middle =
          std::partition(first, last, [&](const Facet& f) { return bin_of(f, best_axis) < best_bin; });
      if (middle != first && middle != last) return std::size_t(middle - facets_.begin());
    }
    const Vec3f size = centers.high - centers.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = (begin + end) / 2;
    std::nth_element(first, facets_.begin() + std::ptrdiff_t(middle), last,
                     [&](const Facet& a, const Facet& b) {
                       return component(a.center, axis) < component(b.center, axis);
                     });
    return middle;
  }

  std::vector<Facet>& facets_;
  std::vector<LightCluster> sparse_;
  std::size_t most_in_leaf_;
};

Facet facet_of(const Lights& lights, const LightFacet& id, const LightBounds& bounds) {
  const Vec3f center = (bounds.box.low + bounds.box.high) * 0.5f;
  // The centre is rounded: one corner may be farther from it than the others.
  const Vec3f above = bounds.box.high - center, below = center - bounds.box.low;
  const Vec3f reach{std::max(above.x, below.x), std::max(above.y, below.y), std::max(above.z, below.z)};
  return {id,
          center,
          length(reach),
          bounds.axis,
          bounds.cos_emission < 0 ? -1 : bounds.cos_normals,
          lights.facet_power(id.light, id.facet)};
}

}  // namespace

LightTree::LightTree(const Lights& lights) {
  std::vector<Facet> facets;
  std::int32_t facets_so_far = 0;
  for (std::int32_t light = 0; light < lights.count(); ++light) {
    const std::int32_t count = lights.facet_count(light);
    if (!lights.facet_bounds(light, 0)) {
      beside_.push_back(light);
      first_of_light_.push_back(-1);
      continue;
    }
    first_of_light_.push_back(facets_so_far);
    facets_so_far += count;
    const std::size_t first = facets.size();
    facets.resize(first + std::size_t(count));
    tbb::parallel_for(std::int32_t(0), count, [&](std::int32_t facet) {
      facets[first + std::size_t(facet)] =
          facet_of(lights, {light, facet}, *lights.facet_bounds(light, facet));
    });
  }
  if (facets.empty()) return;
  double total = 0;
  for (const Facet& facet : facets) total += facet.power;
  // Relative to all, as floats cannot hold every power. Of little power is not of none: a facet that is never
  // chosen would be missing.
  constexpr double least_share = 0x1p-28;
  for (Facet& facet : facets)
    facet.power = total == 0 ? 1.0 : facet.power > 0 ? std::max(facet.power / total, least_share) : 0;

  clusters_ = TreeBuilder(facets).clusters();
  places_.resize(facets.size());
  leaves_.resize(facets.size());
  std::vector<double> powers;
  for (const Facet& facet : facets) {
    places_[std::size_t(first_of_light_[std::size_t(facet.id.light)] + facet.id.facet)] =
        std::int32_t(facets_.size());
    facets_.push_back(facet.id);
    powers.push_back(facet.power);
  }
  append_cumulative_shares(powers, shares_);
  guide_shift_ =
      std::max(std::countr_zero(std::uint32_t(inversion_whole)) - int(std::bit_width(facets.size())), 0);
  std::int32_t last = 0;
  for (std::int32_t at = 0; at <= inversion_whole >> guide_shift_; ++at) {
    while (last + 1 < facet_count() && shares_[std::size_t(last) + 1] <= at << guide_shift_) ++last;
    guide_.push_back(last);
  }
  guide_.push_back(last);  // Of the share of all, and what stands behind it.
  while (ranks() > most_ranks) ++rank_shift_;
  for (std::size_t i = 0; i < clusters_.size(); ++i)
    if (clusters_[i].first_child == 0)
      std::fill(leaves_.begin() + clusters_[i].begin, leaves_.begin() + clusters_[i].end, std::int32_t(i));
}

}  // namespace etendue
