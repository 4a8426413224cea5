#include "base/frame.h"
#include "geometry/bounds.h"
#include "lint/box_tree.h"
#include "lint/checks.h"
#include "lint/flat_overlap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <unordered_map>

namespace etendue {

namespace {

/// A triangle of all, or a disk: `triangle` is -1.
struct Piece {
  std::int32_t geometry, triangle;
};

/// Two shapes with a place that is on both.
struct Pair {
  std::int32_t a, b;  ///< a <= b.
  bool is_opposite;
  Vec3<double> middle, ng;  ///< Of the place; the normal is 0 of spheres.
};

Box widened(const Box& box) {
  const float largest = std::max({std::abs(box.low.x), std::abs(box.low.y), std::abs(box.low.z),
                                  std::abs(box.high.x), std::abs(box.high.y), std::abs(box.high.z)});
  const auto by = float(rounding_of(largest));
  return {box.low - Vec3f{by, by, by}, box.high + Vec3f{by, by, by}};
}

/// Which hashes there were, or others with the same low bits: 16 bits for each that is expected.
class SeenBits {
 public:
  explicit SeenBits(std::size_t expected) : words_(std::bit_ceil(expected / 4 + 1)) {}
  bool test(std::uint64_t hash) const { return (words_[word(hash)] >> (hash & 63) & 1) != 0; }
  bool test_and_set(std::uint64_t hash) {
    const bool was_set = test(hash);
    words_[word(hash)] |= std::uint64_t(1) << (hash & 63);
    return was_set;
  }

 private:
  std::size_t word(std::uint64_t hash) const { return std::size_t(hash >> 6) & (words_.size() - 1); }
  std::vector<std::uint64_t> words_;
};

class PairSearch {
 public:
  PairSearch(const Geometry& geometry, const std::vector<bool>& is_sensitive)
      : geometry_(geometry), is_sensitive_(is_sensitive) {}

  std::vector<Pair> find() {
    std::vector<Piece> small,
        rest;  // Of sensitive shapes that are no large meshes; all that is compared so far.
    std::vector<std::int32_t> large;
    for (std::int32_t id = 0; id < geometry_.count(); ++id)
      if (!is_sensitive_[std::size_t(id)])
        append_pieces(id, rest);
      else if (geometry_.triangles[std::size_t(id)] > most_within)
        large.push_back(id);
      else
        append_pieces(id, small);
    if (!small.empty()) {
      join(small, rest);
      join_with_itself(small);
    }
    rest.insert(rest.end(), small.begin(), small.end());
    for (const std::int32_t id : large) {
      std::vector<Piece> mesh;
      append_pieces(id, mesh);
      join(mesh, rest);
      find_folded(mesh);
      rest.insert(rest.end(), mesh.begin(), mesh.end());
    }
    find_spheres();
    std::sort(pairs_.begin(), pairs_.end(),
              [](const Pair& a, const Pair& b) { return std::pair(a.a, a.b) < std::pair(b.a, b.b); });
    return std::move(pairs_);
  }

 private:
  /// Larger meshes are not compared with themselves but for triangles with the same corners: their
  /// neighbours are too many.
  static constexpr std::int32_t most_within = 4096;
  static constexpr std::size_t most_pairs = 256;

  void append_pieces(std::int32_t id, std::vector<Piece>& pieces) const {
    const auto at = std::size_t(id);
    if (geometry_.disk[at] >= 0) pieces.push_back({id, -1});
    for (std::int32_t k = 0; k < geometry_.triangles[at]; ++k)
      pieces.push_back({id, geometry_.first_triangle[at] + k});
  }

  Box box_of_piece(const Piece& piece) const {
    if (piece.triangle < 0)
      return widened(box_of(geometry_.disks[std::size_t(geometry_.disk[std::size_t(piece.geometry)])]));
    Box box;
    for (std::size_t k = 0; k < 3; ++k)
      box.include(geometry_.positions[std::size_t(geometry_.indices[3 * std::size_t(piece.triangle) + k])]);
    return widened(box);
  }

  /// Along the normal, of any length.
  Vec3f across(const Piece& piece) const {
    if (piece.triangle < 0)
      return geometry_.disks[std::size_t(geometry_.disk[std::size_t(piece.geometry)])].ng;
    return cross(corner(piece, 1) - corner(piece, 0), corner(piece, 2) - corner(piece, 0));
  }
  /// Far wider than overlap_of, as lengths may be too small for floats.
  static bool are_nearly_parallel(const Vec3f& a, const Vec3f& b) {
    const float cosine = dot(a, b), lengths_sq = length_sq(a) * length_sq(b);
    return !(cosine * cosine < 0.9f * lengths_sq);
  }

  FlatPiece flat(const Piece& piece) const {
    return piece.triangle < 0
               ? disk_piece(geometry_.disks[std::size_t(geometry_.disk[std::size_t(piece.geometry)])])
               : triangle_piece(geometry_, std::size_t(piece.triangle));
  }

  void note(std::int32_t a, std::int32_t b, bool is_opposite, const Vec3<double>& middle,
            const Vec3<double>& ng) {
    if (known_.emplace(std::min(a, b), std::max(a, b)).second)
      pairs_.push_back({std::min(a, b), std::max(a, b), is_opposite, middle, ng});
  }

  void compare(const Piece& a, const Piece& b) {
    if (pairs_.size() >= most_pairs) return;
    if (known_.count({std::min(a.geometry, b.geometry), std::max(a.geometry, b.geometry)}) > 0) return;
    if (!are_nearly_parallel(across(a), across(b))) return;  // Most are told apart by this.
    const FlatPiece piece = flat(a);
    if (const Overlap overlap = overlap_of(piece, flat(b)); overlap.is_there)
      note(a.geometry, b.geometry, overlap.is_opposite, overlap.middle, piece.ng);
  }

  BoxTree tree_over(const std::vector<Piece>& pieces) const {
    std::vector<Box> boxes;
    boxes.reserve(pieces.size());
    for (const Piece& piece : pieces) boxes.push_back(box_of_piece(piece));
    return BoxTree(boxes);
  }

  /// Each of the one with each of the other, by a tree over the fewer.
  void join(const std::vector<Piece>& a, const std::vector<Piece>& b) {
    const std::vector<Piece>&few = a.size() < b.size() ? a : b, &many = a.size() < b.size() ? b : a;
    const BoxTree tree = tree_over(few);
    for (const Piece& piece : many)
      tree.for_each_meeting(box_of_piece(piece), [&](std::uint32_t k) { compare(piece, few[k]); });
  }

  void join_with_itself(const std::vector<Piece>& pieces) {
    tree_over(pieces).for_each_pair([&](std::uint32_t a, std::uint32_t b) { compare(pieces[a], pieces[b]); });
  }

  /// Two triangles of one large mesh with the same corners.
  void find_folded(const std::vector<Piece>& mesh) {
    std::vector<std::uint64_t> hashes;
    hashes.reserve(mesh.size());
    for (const Piece& piece : mesh) hashes.push_back(corners_hash(piece));
    // Few hashes are left that may be there twice, and few triangles that have them.
    std::vector<std::uint64_t> repeated;
    SeenBits seen(hashes.size());
    for (const std::uint64_t hash : hashes)
      if (seen.test_and_set(hash)) repeated.push_back(hash);
    SeenBits may_be_repeated(repeated.size());
    for (const std::uint64_t hash : repeated) may_be_repeated.test_and_set(hash);
    std::unordered_map<std::uint64_t, std::size_t> first;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      if (!may_be_repeated.test(hashes[i])) continue;
      const auto [found, is_new] = first.emplace(hashes[i], i);
      if (!is_new && corners_of(mesh[found->second]) == corners_of(mesh[i]))
        return compare(mesh[i], mesh[found->second]);
    }
  }

  const Vec3f& corner(const Piece& piece, std::size_t k) const {
    return geometry_.positions[std::size_t(geometry_.indices[3 * std::size_t(piece.triangle) + k])];
  }

  std::array<std::array<float, 3>, 3> corners_of(const Piece& piece) const {
    std::array<std::array<float, 3>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f& p = corner(piece, k);
      corners[k] = {p.x, p.y, p.z};
    }
    std::sort(corners.begin(), corners.end());
    return corners;
  }

  /// The same whatever their order.
  std::uint64_t corners_hash(const Piece& piece) const {
    const auto bits = [](float x) {
      return std::uint64_t(std::bit_cast<std::uint32_t>(x + 0.0f));
    };  // Of -0, 0.
    std::uint64_t sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f& p = corner(piece, k);
      const std::uint64_t mixed =
          (bits(p.x) << 32 | bits(p.y)) * 0x9e3779b97f4a7c15u ^ bits(p.z) * 0xbf58476d1ce4e5b9u;
      sum += (mixed ^ mixed >> 29) * 0x94d049bb133111ebu;
    }
    return sum >> 20;
  }

  /// Spheres of one centre and radius.
  void find_spheres() {
    std::vector<std::int32_t> ids;
    for (std::int32_t id = 0; id < geometry_.count(); ++id)
      if (geometry_.sphere[std::size_t(id)] >= 0) ids.push_back(id);
    const auto sphere = [&](std::int32_t id) -> const Sphere& {
      return geometry_.spheres[std::size_t(geometry_.sphere[std::size_t(id)])];
    };
    std::sort(ids.begin(), ids.end(), [&](std::int32_t a, std::int32_t b) {
      return std::pair(sphere(a).center.x, a) < std::pair(sphere(b).center.x, b);
    });
    for (std::size_t i = 0; i < ids.size(); ++i)
      for (std::size_t k = i + 1; k < ids.size() && pairs_.size() < most_pairs; ++k) {
        const Sphere &a = sphere(ids[i]), &b = sphere(ids[k]);
        const Vec3f apart = b.center - a.center;
        const double rounding = rounding_of(
            std::max({std::abs(a.center.x), std::abs(a.center.y), std::abs(a.center.z)}) + a.radius);
        if (apart.x > rounding) break;
        if (!is_sensitive_[std::size_t(ids[i])] && !is_sensitive_[std::size_t(ids[k])]) continue;
        if (std::sqrt(double(length_sq(apart))) + std::abs(double(a.radius) - b.radius) <= rounding)
          note(ids[i], ids[k], false, {a.center.x, a.center.y, a.center.z}, {0, 0, 0});
      }
  }

  const Geometry& geometry_;
  const std::vector<bool>& is_sensitive_;
  std::vector<Pair> pairs_;
  std::set<std::pair<std::int32_t, std::int32_t>> known_;
};

/// Whether light or the camera sees the place from the side that `ng` points to, as neither does inside of
/// solids.
bool is_seen_from(const LintContext& context, const Vec3f& place, const Vec3f& ng) {
  const Vec3f from = place + ng * clearance<float>(ng, abs_each(place), 0);
  if (dot(context.scene.camera.eye() - from, ng) > 0 &&
      is_visible(context.scene, from, context.scene.camera.eye()))
    return true;
  ProbeNumbers numbers(9);
  const Frame<float> frame(ng);
  for (int k = 0; k < 32; ++k)
    if (const auto hit = probe(
            context.scene, {from, frame.world_from_local(square_to_cosine_hemisphere(numbers.two_units()))});
        hit && context.can_be_lit(*hit))
      return true;
  return false;
}

void report(const LintContext& context, const Pair& pair, Findings& findings) {
  const Vec3f place{float(pair.middle.x), float(pair.middle.y), float(pair.middle.z)},
      ng{float(pair.ng.x), float(pair.ng.y), float(pair.ng.z)};
  if (length_sq(ng) > 0 && !is_seen_from(context, place, ng) && !is_seen_from(context, place, -ng)) return;
  const Geometry& geometry = context.scene.geometry;
  const bool is_first = geometry.light[std::size_t(pair.a)] >= 0,
             is_second = geometry.light[std::size_t(pair.b)] >= 0;
  const std::int32_t one = is_first || !is_second ? pair.a : pair.b, other = one == pair.a ? pair.b : pair.a;
  const ScenePlaces::Shape &shape = context.places.shapes[std::size_t(one)],
                           &in = context.places.shapes[std::size_t(other)];
  const Vec3<double>& origin = context.scene.origin;
  const std::string where = fmt::format("about {:.4g} {:.4g} {:.4g}", origin.x + pair.middle.x,
                                        origin.y + pair.middle.y, origin.z + pair.middle.z);
  const std::string second =
      one == other ? "itself" : fmt::format("the {} (line {})", in.name, line_and_column(in.where).line);
  const std::string apart = "move them apart, if only by a millimetre";
  if (is_first && is_second)
    findings.add(
        "lights-in-one-place", shape.where,
        fmt::format("the light {} lies in one place with {}{}, {}: which of the two a ray meets is chance",
                    shape.name, second, pair.is_opposite ? ", back to back" : "", where),
        pair.is_opposite ? "remove one, and let the other shine from both sides: <boolean name=\"twosided\" "
                           "value=\"true\"/> in its light; or " +
                               apart
                         : "remove one of them, or " + apart,
        pair.is_opposite && one != other ? std::vector{pair.a, pair.b} : std::vector<std::int32_t>{});
  else if (is_first || is_second)
    findings.add(
        "light-in-surface", shape.where,
        fmt::format("the light {} lies in one plane with {}, {}: which of the two a ray meets is chance, and "
                    "integrators disagree",
                    shape.name, second, where),
        apart + ", or cut a hole for the light", {one});
  else
    findings.add("glass-in-surface", shape.where,
                 fmt::format("the {} lies in one place with {}, {}: which of the two a ray meets is chance",
                             shape.name, second, where),
                 "let one reach into the other, or leave a gap");
}

}  // namespace

void check_coincident_surfaces(const LintContext& context, Findings& findings) {
  std::vector<bool> are_sensitive;
  for (std::int32_t id = 0; id < context.scene.geometry.count(); ++id)
    are_sensitive.push_back(context.is_sensitive(id));
  for (const Pair& pair : PairSearch(context.scene.geometry, are_sensitive).find())
    report(context, pair, findings);
}

}  // namespace etendue
