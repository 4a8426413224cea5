#include "light/textured_patches.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace etendue {

namespace {

struct Corner {
  Vec3<double> place;
  Vec2<double> uv;
};

Vec2<double> operator-(const Vec2<double>& a, const Vec2<double>& b) { return {a.x - b.x, a.y - b.y}; }
double size(const Vec2<double>& v) { return std::hypot(v.x, v.y); }

TexturedPatch patch_at(const Corner& origin, const Corner& along_s, const Corner& along_t) {
  return {origin.place, along_s.place - origin.place, along_t.place - origin.place,
          origin.uv,    along_s.uv - origin.uv,       along_t.uv - origin.uv};
}

/// Whether `corner` is where the patch as a parallelogram has its fourth.
bool is_fourth(const Corner& corner, const TexturedPatch& patch) {
  constexpr double tolerance = 1e-5;
  const Vec3<double> off = corner.place - patch.origin - patch.edge_s - patch.edge_t;
  const Vec2<double> uv_off = corner.uv - patch.uv - patch.uv_s - patch.uv_t;
  return length(off) <= tolerance * std::min(length(patch.edge_s), length(patch.edge_t)) &&
         size(uv_off) <= tolerance * std::max(size(patch.uv_s), size(patch.uv_t));
}

class Triangles {
 public:
  Triangles(const Geometry& geometry, std::int32_t geometry_id)
      : geometry_(geometry), first_(std::size_t(geometry.first_triangle[std::size_t(geometry_id)])) {
    const auto count = std::size_t(geometry.triangles[std::size_t(geometry_id)]);
    for (std::size_t side = 0; side < 3 * count; ++side)
      sides_.push_back({{vertex(side), vertex(next(side))}, side});
    std::sort(sides_.begin(), sides_.end());
  }

  std::size_t count() const { return sides_.size() / 3; }
  static std::size_t next(std::size_t side) { return side % 3 == 2 ? side - 2 : side + 1; }
  Corner corner(std::size_t side) const {
    const auto v = std::size_t(vertex(side));
    const Vec2f& uv = geometry_.uvs[v];
    return {widen(geometry_.positions[v]), {uv.x, uv.y}};
  }
  /// The side of another triangle that runs the other way, or none_.
  static constexpr std::size_t none = std::size_t(-1);
  std::size_t opposite(std::size_t side) const {
    const std::pair<std::int32_t, std::int32_t> ends{vertex(next(side)), vertex(side)};
    const auto at = std::lower_bound(sides_.begin(), sides_.end(), std::pair{ends, std::size_t(0)});
    return at != sides_.end() && at->first == ends ? at->second : none;
  }

 private:
  std::int32_t vertex(std::size_t side) const { return geometry_.indices[3 * first_ + side]; }
  const Geometry& geometry_;
  std::size_t first_;
  std::vector<std::pair<std::pair<std::int32_t, std::int32_t>, std::size_t>> sides_;
};

}  // namespace

TexturedPatches textured_patches(const Geometry& geometry, std::int32_t geometry_id) {
  const Triangles triangles(geometry, geometry_id);
  TexturedPatches result;
  constexpr std::int32_t open = -1;
  result.of_triangle.assign(triangles.count(), open);
  for (std::size_t t = 0; t < triangles.count(); ++t) {
    if (result.of_triangle[t] != open) continue;
    result.of_triangle[t] = std::int32_t(result.patches.size());
    result.patches.push_back(
        patch_at(triangles.corner(3 * t), triangles.corner(3 * t + 1), triangles.corner(3 * t + 2)));
    for (std::size_t side = 3 * t; side < 3 * t + 3; ++side) {
      const std::size_t opposite = triangles.opposite(side);
      if (opposite == Triangles::none || result.of_triangle[opposite / 3] != open) continue;
      // The shared side is the diagonal that the patch's origin does not lie on.
      const std::size_t along_s = side, along_t = Triangles::next(side), origin = Triangles::next(along_t);
      TexturedPatch patch =
          patch_at(triangles.corner(origin), triangles.corner(along_s), triangles.corner(along_t));
      const std::size_t fourth = Triangles::next(Triangles::next(opposite));
      if (!is_fourth(triangles.corner(fourth), patch)) continue;
      patch.is_triangle = false;
      result.patches.back() = patch;
      result.of_triangle[opposite / 3] = result.of_triangle[t];
      break;
    }
  }
  return result;
}

}  // namespace etendue
