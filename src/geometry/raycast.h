// Ray casting: blocks of rays in packets of a given width.
#pragma once

#include "geometry/geometry.h"

#include <cstdint>
#include <memory>

namespace etendue {

/// Whether neighbouring rays of a packet run side by side: then the packet is traced as one, which is faster;
/// rays that do not are slower that way.
enum class Coherence { incoherent, coherent };

/// What rays do at the edges that triangles share. `fast`: a few in 1e7 pass between two of them.
/// `watertight`: none does, where the two use the same vertices; rays then cost about a seventh more.
enum class Edges { fast, watertight };

/// Rays as structure of arrays, read at positions 0 .. count - 1; directions need not be unit.
struct RaySpan {
  const float *origin_x, *origin_y, *origin_z;
  const float *direction_x, *direction_y, *direction_z;
  const float *t_near, *t_far;
  const std::int32_t* is_active;  ///< -1: trace it; 0: its hit has geometry = -1 and nothing else of meaning.
  int count;
};

/// Where hits go. geometry = -1: none. The normal is geometric, not normalised; barycentric (u, v) belong to
/// vertices 1, 2.
struct HitSpan {
  float* t;
  float *ng_x, *ng_y, *ng_z;
  float *u, *v;
  std::int32_t *geometry, *primitive;
};

/// Segments from an origin along a direction up to t = t_far, read through `order`.
struct SegmentSpan {
  const float *origin_x, *origin_y, *origin_z;
  const float *direction_x, *direction_y, *direction_z;
  const std::int32_t* order;  ///< Positions of the segments, in the order of tracing; -1: an empty lane.
  int count;
  float t_far;
};

/// An acceleration structure over a Geometry, whose tables it reads where they are: the Geometry must outlive
/// it and not grow; it may be moved.
class RayCaster {
 public:
  explicit RayCaster(const Geometry& geometry, Edges edges = Edges::fast);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// Nearest hits. \param width lanes a packet: 1, 4, 8 or 16. Arrays hold a multiple of `width` entries.
  void closest_hits(const RaySpan& rays, const HitSpan& hits, int width, Coherence coherence) const;

  /// Sets is_visible[order[i]] to -1 where nothing lies within segment i, else 0.
  void unoccluded(const SegmentSpan& segments, std::int32_t* is_visible, int width,
                  Coherence coherence) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace etendue
