#include "geometry/convex_pieces.h"

#include "geometry/equal_places.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

namespace etendue {
namespace {

using Vec3d = Vec3<double>;

/// Of a float, relative: places nearer to a line or plane than their own rounding lie in it.
constexpr double place_rounding = 0x1p-22;
constexpr double area_tolerance = 0x1p-20;
constexpr double least_cos_of_normals = 1 - 0x1p-21;

/// Polygons that grow by joining. A side is one of the 3 n half-edges of the triangles: it begins at one
/// vertex for ever, and ends farther on where corners in a straight line have been left out.
class Joining {
 public:
  Joining(std::span<const Vec3f> positions, std::span<const std::int32_t> indices)
      : positions_(positions), place_(positions, indices) {
    const std::size_t sides = indices.size();
    begin_.resize(sides), end_.resize(sides), opposite_.assign(sides, none), owner_.resize(sides);
    polygons_.resize(sides / 3), parent_.resize(sides / 3);
    std::iota(parent_.begin(), parent_.end(), 0);
    for (std::size_t s = 0; s < sides; ++s) {
      const std::size_t triangle = s / 3, next = s % 3 == 2 ? s - 2 : s + 1;
      begin_[s] = place_(indices[s]);
      end_[s] = place_(indices[next]);
      owner_[s] = std::int32_t(triangle);
      polygons_[triangle].sides[s % 3] = std::int32_t(s);
    }
    for (Polygon& polygon : polygons_) {
      polygon.count = 3;
      polygon.grown = 0;
      const Vec3d across = twice_vector_area(polygon);
      const double size = length(across);
      polygon.area = 0.5 * size;
      polygon.normal = size > 0 ? across * (1 / size) : Vec3d{0, 0, 0};
    }
    std::vector<std::int32_t> all(sides);
    std::iota(all.begin(), all.end(), 0);
    open_ = find_opposites(all);
  }

  void join_all() {
    std::vector<std::int32_t> open = by_length(std::exchange(open_, {}));
    // A side that failed is tried again when one of its polygons has grown since.
    constexpr int most_rounds = 32;
    for (round_ = 1; round_ <= most_rounds; ++round_) {
      std::size_t kept = 0;
      bool is_any_joined = false;
      for (const std::int32_t s : open) {
        if (!is_shared(s)) continue;
        if (grown(s) >= round_ - 1 && join(s))
          is_any_joined = true;
        else
          open[kept++] = s;
      }
      if (!is_any_joined) break;
      open.resize(kept);
      const std::vector<std::int32_t> shared = find_opposites(std::exchange(alone_, {}));
      open.insert(open.end(), shared.begin(), shared.end());
    }
  }

  ConvexPieces result() {
    ConvexPieces pieces;
    pieces.first_corner.push_back(0);
    pieces.piece.resize(polygons_.size());
    std::vector<std::int32_t> number(polygons_.size(), none);
    for (std::size_t t = 0; t < polygons_.size(); ++t) {
      const std::int32_t root = root_of(std::int32_t(t));
      std::int32_t& piece = number[std::size_t(root)];
      if (piece == none) {
        piece = pieces.count();
        for (const std::int32_t s : corners_of(polygons_[std::size_t(root)]))
          pieces.corners.push_back(at(begin_[std::size_t(s)]));
        pieces.first_corner.push_back(std::int32_t(pieces.corners.size()));
      }
      pieces.piece[t] = piece;
    }
    return pieces;
  }

 private:
  static constexpr std::int32_t none = -1;

  struct Polygon {
    std::array<std::int32_t, most_corners> sides;
    int count;
    int grown;     ///< The round in which it has grown last.
    double area;   ///< The sum of its triangles' (m^2).
    Vec3d normal;  ///< Unit; 0 of a triangle without area.
  };

  static std::span<const std::int32_t> corners_of(const Polygon& polygon) {
    return {polygon.sides.data(), std::size_t(polygon.count)};
  }
  const Vec3f& at(std::int32_t vertex) const { return positions_[std::size_t(vertex)]; }
  Vec3d place_of(std::int32_t vertex) const { return widen(at(vertex)); }
  Vec3d begin_of(std::int32_t side) const { return place_of(begin_[std::size_t(side)]); }

  std::int32_t root_of(std::int32_t triangle) {
    while (parent_[std::size_t(triangle)] != triangle)
      triangle = parent_[std::size_t(triangle)] = parent_[std::size_t(parent_[std::size_t(triangle)])];
    return triangle;
  }

  Vec3d twice_vector_area(const Polygon& polygon) const {
    const Vec3d origin = begin_of(polygon.sides[0]);
    Vec3d sum{0, 0, 0};
    Vec3d previous = begin_of(polygon.sides[1]) - origin;
    for (std::size_t k = 2; k < std::size_t(polygon.count); ++k) {
      const Vec3d next = begin_of(polygon.sides[k]) - origin;
      sum = sum + cross(previous, next);
      previous = next;
    }
    return sum;
  }

  /// Pairs sides that run to and fro between two vertices, and keeps those that stay alone. Where several
  /// meet, those in one plane come first. \return one side of each new pair in a plane
  std::vector<std::int32_t> find_opposites(const std::vector<std::int32_t>& sides) {
    // By the lesser of their vertices, then by the greater.
    std::vector<std::int32_t> first(place_.count() + 1, 0), sorted(sides.size()), shared;
    const auto bucket = [&](std::int32_t s) { return std::size_t(least_vertex(s) - place_.first()); };
    for (const std::int32_t s : sides) ++first[bucket(s) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::int32_t> fill(first.begin(), first.end() - 1);
    for (const std::int32_t s : sides) sorted[std::size_t(fill[bucket(s)]++)] = s;
    for (std::size_t b = 0; b + 1 < first.size(); ++b) {
      const auto from = sorted.begin() + first[b], to = sorted.begin() + first[b + 1];
      std::sort(from, to, [&](std::int32_t s, std::int32_t t) {
        return greatest_vertex(s) != greatest_vertex(t) ? greatest_vertex(s) < greatest_vertex(t) : s < t;
      });
      for (auto i = from; i != to;) {
        const auto j =
            std::find_if(i, to, [&](std::int32_t s) { return greatest_vertex(s) != greatest_vertex(*i); });
        pair_up({i, j}, shared);
        i = j;
      }
    }
    return shared;
  }

  void pair_up(std::span<const std::int32_t> sides, std::vector<std::int32_t>& shared) {
    const auto is_free = [&](std::int32_t s) {
      return owner_[std::size_t(s)] != none && opposite_[std::size_t(s)] == none;
    };
    for (const bool is_flat : {true, false})
      for (const std::int32_t s : sides)
        for (const std::int32_t t : sides) {
          const bool is_pair = begin_[std::size_t(s)] < end_[std::size_t(s)] &&
                               begin_[std::size_t(s)] == end_[std::size_t(t)] && is_free(s) && is_free(t);
          if (!is_pair || (is_flat && !are_in_plane(s, t))) continue;
          opposite_[std::size_t(s)] = t;
          opposite_[std::size_t(t)] = s;
          if (is_flat) shared.push_back(s);
        }
    for (const std::int32_t s : sides)
      if (is_free(s)) alone_.push_back(s);
  }

  std::int32_t least_vertex(std::int32_t s) const {
    return std::min(begin_[std::size_t(s)], end_[std::size_t(s)]);
  }
  std::int32_t greatest_vertex(std::int32_t s) const {
    return std::max(begin_[std::size_t(s)], end_[std::size_t(s)]);
  }
  const Vec3d& normal_at(std::int32_t side) const {
    return polygons_[std::size_t(owner_[std::size_t(side)])].normal;
  }

  /// The longest first, to within a tenth.
  std::vector<std::int32_t> by_length(const std::vector<std::int32_t>& sides) const {
    const auto bin = [&](std::int32_t s) {  // The exponent of the square and three bits more.
      const auto squared = float(length_sq(place_of(end_[std::size_t(s)]) - begin_of(s)));
      return 4095 - (std::bit_cast<std::uint32_t>(squared) >> 20);
    };
    std::vector<std::uint32_t> bins(sides.size());
    std::transform(sides.begin(), sides.end(), bins.begin(), bin);
    std::vector<std::size_t> first(4097, 0);
    for (const std::uint32_t b : bins) ++first[b + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::int32_t> sorted(sides.size());
    for (std::size_t k = 0; k < sides.size(); ++k) sorted[first[bins[k]]++] = sides[k];
    return sorted;
  }

  bool is_shared(std::int32_t s) const {
    const std::int32_t other = opposite_[std::size_t(s)];
    return other != none && owner_[std::size_t(s)] != none && owner_[std::size_t(other)] != none;
  }
  /// The last round in which a polygon on one of its sides has grown.
  int grown(std::int32_t s) const {
    const auto of = [&](std::int32_t side) {
      return polygons_[std::size_t(owner_[std::size_t(side)])].grown;
    };
    return std::max(of(s), of(opposite_[std::size_t(s)]));
  }
  bool are_in_plane(std::int32_t s, std::int32_t t) const {
    return dot(normal_at(s), normal_at(t)) >= least_cos_of_normals;
  }

  enum class Turn { left, straight, right };

  /// How a polygon with this normal turns at `here`.
  static Turn turn_at(const Vec3d& before, const Vec3d& here, const Vec3d& after, const Vec3d& normal) {
    const Vec3d along = after - before;
    const double off = dot(cross(here - before, along), normal);  // times the length of `along`
    const double tolerance = place_rounding * largest(before, here, after) * length(along);
    return off > tolerance ? Turn::left : off < -tolerance ? Turn::right : Turn::straight;
  }
  static double largest(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    double most = 0;
    for (const Vec3d& v : {a, b, c}) most = std::max({most, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return most;
  }

  /// The polygons on both sides of a side become one, if that is flat, convex and has few enough corners.
  bool join(std::int32_t side) {
    const std::int32_t other = opposite_[std::size_t(side)];
    const std::int32_t id = owner_[std::size_t(side)], other_id = owner_[std::size_t(other)];
    Polygon &left = polygons_[std::size_t(id)], &right = polygons_[std::size_t(other_id)];
    if (id == other_id || !are_in_plane(side, other)) return false;

    // All sides of both but the two that meet, from the one after `side` on, in their turn.
    std::array<std::int32_t, 2 * most_corners> sides;
    std::size_t count = 0;
    const auto take = [&](const Polygon& polygon, std::int32_t from) {
      const auto all = corners_of(polygon);
      const auto at = std::size_t(std::find(all.begin(), all.end(), from) - all.begin());
      for (std::size_t k = 1; k < all.size(); ++k) sides[count++] = all[(at + k) % all.size()];
    };
    take(left, side);
    const std::size_t first_of_right = count;
    take(right, other);

    const double area = left.area + right.area;
    const Vec3d sum = left.normal * left.area + right.normal * right.area;
    const Vec3d normal = sum * (1 / length(sum));
    const auto turn = [&](std::size_t k) {
      return turn_at(begin_of(sides[(k + count - 1) % count]), begin_of(sides[k]),
                     begin_of(sides[(k + 1) % count]), normal);
    };
    const Turn at_first = turn(0), at_second = turn(first_of_right);
    if (at_first == Turn::right || at_second == Turn::right) return false;
    Polygon joined{{}, 0, round_, area, normal};
    const std::size_t corners = count - (at_first == Turn::straight) - (at_second == Turn::straight);
    if (corners < 3 || corners > std::size_t(most_corners)) return false;
    for (std::size_t k = 0; k < count; ++k)
      if ((k != 0 || at_first != Turn::straight) && (k != first_of_right || at_second != Turn::straight))
        joined.sides[std::size_t(joined.count++)] = sides[k];
    if (!is_flat(joined) || std::abs(0.5 * length(twice_vector_area(joined)) - area) > area_tolerance * area)
      return false;

    if (at_first == Turn::straight) lengthen(sides[count - 1], sides[0]);
    if (at_second == Turn::straight) lengthen(sides[first_of_right - 1], sides[first_of_right]);
    owner_[std::size_t(side)] = owner_[std::size_t(other)] = none;
    for (const std::int32_t s : corners_of(joined)) owner_[std::size_t(s)] = id;
    parent_[std::size_t(other_id)] = id;
    left = joined;
    return true;
  }

  bool is_flat(const Polygon& polygon) const {
    const Vec3d origin = begin_of(polygon.sides[0]);
    return std::all_of(corners_of(polygon).begin() + 1, corners_of(polygon).end(), [&](std::int32_t s) {
      const Vec3d corner = begin_of(s);
      return std::abs(dot(corner - origin, polygon.normal)) <=
             place_rounding * largest(origin, corner, corner);
    });
  }

  /// A side takes in the one after it. What it is the opposite of then is found after the round.
  void lengthen(std::int32_t side, std::int32_t after) {
    for (const std::int32_t s : {side, after}) {
      std::int32_t& other = opposite_[std::size_t(s)];
      if (other == none) continue;
      opposite_[std::size_t(other)] = none;
      alone_.push_back(other);
      other = none;
    }
    owner_[std::size_t(after)] = none;
    end_[std::size_t(side)] = end_[std::size_t(after)];
    alone_.push_back(side);
  }

  std::span<const Vec3f> positions_;
  EqualPlaces place_;
  // Per side: where it begins and ends, the side of the same vertices the other way round, whose it is.
  std::vector<std::int32_t> begin_, end_, opposite_, owner_;
  std::vector<Polygon> polygons_;     ///< By the number of one of their triangles.
  std::vector<std::int32_t> parent_;  ///< Of each triangle: another of its polygon, or itself.
  int round_ = 0;
  std::vector<std::int32_t> open_;   ///< One of each pair of opposite sides in a plane.
  std::vector<std::int32_t> alone_;  ///< Sides without an opposite; some of them are gone, or twice there.
};

}  // namespace

ConvexPieces convex_pieces(std::span<const Vec3f> positions, std::span<const std::int32_t> indices) {
  if (indices.empty()) return {{}, {0}, {}};
  Joining joining(positions, indices);
  joining.join_all();
  return joining.result();
}

}  // namespace etendue
