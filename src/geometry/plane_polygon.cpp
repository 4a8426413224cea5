#include "geometry/plane_polygon.h"

#include <cmath>
#include <cstddef>
#include <geos_c.h>
#include <map>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace etendue {
namespace {

using Place = std::array<double, 2>;
using Triangle = std::array<std::uint32_t, 3>;
using Context = std::unique_ptr<std::remove_pointer_t<GEOSContextHandle_t>, decltype(&GEOS_finish_r)>;

struct Destroy {
  GEOSContextHandle_t context;
  void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(context, geometry); }
  void operator()(GEOSMakeValidParams* params) const { GEOSMakeValidParams_destroy_r(context, params); }
};
template <class T>
using Owned = std::unique_ptr<T, Destroy>;

double doubled_area_of(const Place& a, const Place& b, const Place& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

class PlanePolygon {
 public:
  PlanePolygon(std::span<const Vec2<double>> polygon) : context_(GEOS_init_r(), GEOS_finish_r) {
    for (std::uint32_t k = 0; k < polygon.size(); ++k) {
      ring_.push_back({polygon[k].x, polygon[k].y});
      corner_at_.emplace(ring_.back(), k);
    }
    for (std::size_t k = 1; k + 1 < ring_.size(); ++k)
      doubled_area_ += doubled_area_of(ring_[0], ring_[k], ring_[k + 1]);
    ring_.push_back(ring_[0]);
  }

  /// False where a triangle has a corner that the polygon has not, or where their areas do not sum up to its
  /// own: it crosses itself.
  bool triangulate(std::vector<Triangle>& triangles) const {
    const Owned<GEOSGeometry> pieces = delaunay();
    if (!pieces) return false;
    triangles.clear();
    double sum = 0;
    for (int i = 0; i < GEOSGetNumGeometries_r(context(), pieces.get()); ++i) {
      const auto triangle = triangle_of(GEOSGetGeometryN_r(context(), pieces.get(), i), sum);
      if (!triangle) return false;
      triangles.push_back(*triangle);
    }
    return std::abs(sum - std::abs(doubled_area_)) <= 1e-6 * sum;
  }

 private:
  GEOSContextHandle_t context() const { return context_.get(); }

  Owned<GEOSGeometry> delaunay() const {
    const Destroy destroy{context()};
    GEOSGeometry* const ring = GEOSGeom_createLinearRing_r(
        context(),
        GEOSCoordSeq_copyFromBuffer_r(context(), ring_[0].data(), static_cast<unsigned>(ring_.size()), 0, 0));
    if (!ring) return {nullptr, destroy};
    Owned<GEOSGeometry> area(GEOSGeom_createPolygon_r(context(), ring, nullptr, 0), destroy);
    if (area && GEOSisValid_r(context(), area.get()) != 1) {
      // By lines, which leaves out edges that are walked there and back.
      const Owned<GEOSMakeValidParams> by_lines(GEOSMakeValidParams_create_r(context()), destroy);
      GEOSMakeValidParams_setMethod_r(context(), by_lines.get(), GEOS_MAKE_VALID_LINEWORK);
      area.reset(GEOSMakeValidWithParams_r(context(), area.get(), by_lines.get()));
    }
    return {area ? GEOSConstrainedDelaunayTriangulation_r(context(), area.get()) : nullptr, destroy};
  }

  /// In the polygon's turn; its area, doubled, is added to `sum`.
  std::optional<Triangle> triangle_of(const GEOSGeometry* triangle, double& sum) const {
    const GEOSCoordSequence* const ring =
        GEOSGeom_getCoordSeq_r(context(), GEOSGetExteriorRing_r(context(), triangle));
    std::array<Place, 3> place;
    Triangle corners;
    for (unsigned k = 0; k < 3; ++k) {
      GEOSCoordSeq_getXY_r(context(), ring, k, &place[k][0], &place[k][1]);
      const auto corner = corner_at_.find(place[k]);
      if (corner == corner_at_.end()) return std::nullopt;
      corners[k] = corner->second;
    }
    const double doubled_area = doubled_area_of(place[0], place[1], place[2]);
    if ((doubled_area < 0) != (doubled_area_ < 0)) std::swap(corners[1], corners[2]);
    sum += std::abs(doubled_area);
    return corners;
  }

  Context context_;
  std::map<Place, std::uint32_t> corner_at_;  ///< The first at each.
  std::vector<Place> ring_;                   ///< The first again at the end.
  double doubled_area_ = 0;                   ///< Positive where the polygon turns left.
};

}  // namespace
}  // namespace etendue

extern "C" bool etendue_triangulate_in_plane(std::span<const etendue::Vec2<double>> polygon,
                                             std::vector<std::array<std::uint32_t, 3>>& triangles) {
  return etendue::PlanePolygon(polygon).triangulate(triangles);
}
