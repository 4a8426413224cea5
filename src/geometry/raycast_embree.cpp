#include "base/error.h"
#include "geometry/bounds.h"
#include "geometry/raycast.h"

#include <array>
#include <cmath>
#include <cstring>
#include <embree3/rtcore.h>
#include <string>
#include <vector>

namespace etendue {

namespace {

// One packet type per width, under one set of names.

struct Query {
  RTCIntersectContext context;
  explicit Query(Coherence coherence) {
    rtcInitIntersectContext(&context);
    context.flags = coherence == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                     : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
};

/// Rays and hits of `width` lanes as arrays, whatever Embree calls them.
template <int width>
struct Packet;

template <>
struct Packet<1> {
  using Rays = RTCRay;
  using RayHits = RTCRayHit;
  static void intersect(const int* valid, RTCScene scene, Query& query, RayHits* packet) {
    if (*valid) rtcIntersect1(scene, &query.context, packet);
  }
  static void occluded(const int* valid, RTCScene scene, Query& query, Rays* packet) {
    if (*valid) rtcOccluded1(scene, &query.context, packet);
  }
};

#define ETENDUE_PACKET(width)                                                                \
  template <>                                                                                \
  struct Packet<width> {                                                                     \
    using Rays = RTCRay##width;                                                              \
    using RayHits = RTCRayHit##width;                                                        \
    static void intersect(const int* valid, RTCScene scene, Query& query, RayHits* packet) { \
      rtcIntersect##width(valid, scene, &query.context, packet);                             \
    }                                                                                        \
    static void occluded(const int* valid, RTCScene scene, Query& query, Rays* packet) {     \
      rtcOccluded##width(valid, scene, &query.context, packet);                              \
    }                                                                                        \
  }
ETENDUE_PACKET(4);
ETENDUE_PACKET(8);
ETENDUE_PACKET(16);

/// The first lane of a member, which is an array or, for width 1, a single value.
template <class T>
T* lanes_of(T& member) {
  return &member;
}
template <class T, std::size_t n>
T* lanes_of(T (&member)[n]) {
  return member;
}

template <int width, class To, class From>
void copy_lanes(To& to, const From* from) {
  static_assert(sizeof(To) == width * sizeof(From));
  std::memcpy(&to, from, sizeof(To));
}
template <int width, class From, class To>
void copy_lanes_back(To* to, const From& from) {
  static_assert(sizeof(From) == width * sizeof(To));
  std::memcpy(to, &from, sizeof(From));
}
template <class Member>
void set_bytes(Member& member, int byte) {
  std::memset(&member, byte, sizeof(member));
}

/// What Embree is given, and what its numbers mean. All spheres and disks are one Embree geometry. The meshes
/// are one each, numbered as ours, or, where a scene has very many shapes, joined into one: alone they cost
/// half a KiB each, and a look at each that is hit. Joined, hits must be named anew. Closest hits were 2 to
/// 12 % slower joined with 65 meshes, alike with 16,000, 12 to 20 % faster with 200,000.
struct Elements {
  static constexpr std::int32_t most_alone = 8192;

  std::vector<std::int32_t> shapes;  ///< Ids of the spheres and disks, in their order.
  // Where meshes are joined; else empty. The elements are all triangles, then the spheres and disks.
  std::vector<std::int32_t> owner;  ///< The geometry that an element is of.
  std::vector<std::int32_t> first;  ///< Of a geometry, its first element.
  std::int32_t triangles;           ///< Number of them: that of the first sphere or disk.
  // Geometry's tables, which stay where they are when it is moved.
  const std::int32_t *sphere, *disk;
  const Sphere* spheres;
  const Disk* disks;

  explicit Elements(const Geometry& geometry)
      : triangles(std::int32_t(geometry.triangle_count())),
        sphere(geometry.sphere.data()),
        disk(geometry.disk.data()),
        spheres(geometry.spheres.data()),
        disks(geometry.disks.data()) {
    for (std::int32_t id = 0; id < geometry.count(); ++id)
      if (sphere[id] >= 0 || disk[id] >= 0) shapes.push_back(id);
    if (geometry.count() <= most_alone) return;
    first = geometry.first_triangle;
    owner.reserve(geometry.triangle_count() + shapes.size());
    for (std::int32_t id = 0; id < geometry.count(); ++id)
      owner.insert(owner.end(), std::size_t(geometry.triangles[std::size_t(id)]), id);
    for (const std::int32_t id : shapes) {
      first[std::size_t(id)] = std::int32_t(owner.size());
      owner.push_back(id);
    }
  }

  bool are_joined() const { return !owner.empty(); }

  /// From Embree's names, whose primitives are elements, to ours.
  void name_hits(const HitSpan& hits, int count) const {
    for (int i = 0; i < count; ++i) {
      const bool is_hit = hits.geometry[i] != -1;
      const std::int32_t element = is_hit ? hits.primitive[i] : 0, id = owner[std::size_t(element)];
      hits.geometry[i] = is_hit ? id : -1;
      hits.primitive[i] = element - first[std::size_t(id)];
    }
  }
};

template <int width>
void closest_hits_wide(RTCScene scene, const Elements& elements, const RaySpan& rays, const HitSpan& hits,
                       Coherence coherence) {
  Query query(coherence);
  alignas(64) typename Packet<width>::RayHits packet;
  alignas(64) std::int32_t valid[width];
  set_bytes(packet.ray.time, 0);
  set_bytes(packet.ray.flags, 0);
  set_bytes(packet.ray.id, 0);
  set_bytes(packet.ray.mask, 0xff);
  set_bytes(packet.hit.instID[0], 0xff);
  for (int i = 0; i < rays.count; i += width) {
    copy_lanes<width>(packet.ray.org_x, rays.origin_x + i);
    copy_lanes<width>(packet.ray.org_y, rays.origin_y + i);
    copy_lanes<width>(packet.ray.org_z, rays.origin_z + i);
    copy_lanes<width>(packet.ray.dir_x, rays.direction_x + i);
    copy_lanes<width>(packet.ray.dir_y, rays.direction_y + i);
    copy_lanes<width>(packet.ray.dir_z, rays.direction_z + i);
    copy_lanes<width>(packet.ray.tnear, rays.t_near + i);
    copy_lanes<width>(packet.ray.tfar, rays.t_far + i);
    copy_lanes<width>(valid, rays.is_active + i);
    set_bytes(packet.hit.geomID, 0xff);
    Packet<width>::intersect(valid, scene, query, &packet);
    copy_lanes_back<width>(hits.t + i, packet.ray.tfar);
    copy_lanes_back<width>(hits.ng_x + i, packet.hit.Ng_x);
    copy_lanes_back<width>(hits.ng_y + i, packet.hit.Ng_y);
    copy_lanes_back<width>(hits.ng_z + i, packet.hit.Ng_z);
    copy_lanes_back<width>(hits.u + i, packet.hit.u);
    copy_lanes_back<width>(hits.v + i, packet.hit.v);
    copy_lanes_back<width>(hits.geometry + i, packet.hit.geomID);
    copy_lanes_back<width>(hits.primitive + i, packet.hit.primID);
  }
  if (elements.are_joined()) elements.name_hits(hits, rays.count);
}

template <int width>
void unoccluded_wide(RTCScene scene, const SegmentSpan& segments, std::int32_t* is_visible,
                     Coherence coherence) {
  Query query(coherence);
  alignas(64) typename Packet<width>::Rays packet;
  alignas(64) std::int32_t valid[width];
  set_bytes(packet.time, 0);
  set_bytes(packet.flags, 0);
  set_bytes(packet.id, 0);
  set_bytes(packet.mask, 0xff);
  set_bytes(packet.tnear, 0);
  for (int i = 0; i < segments.count; i += width) {
    for (int lane = 0; lane < width; ++lane) {
      const std::int32_t at = segments.order[i + lane];
      valid[lane] = at >= 0 ? -1 : 0;
      const std::int32_t from = at >= 0 ? at : 0;
      lanes_of(packet.org_x)[lane] = segments.origin_x[from];
      lanes_of(packet.org_y)[lane] = segments.origin_y[from];
      lanes_of(packet.org_z)[lane] = segments.origin_z[from];
      lanes_of(packet.dir_x)[lane] = segments.direction_x[from];
      lanes_of(packet.dir_y)[lane] = segments.direction_y[from];
      lanes_of(packet.dir_z)[lane] = segments.direction_z[from];
      lanes_of(packet.tfar)[lane] = segments.t_far;
    }
    Packet<width>::occluded(valid, scene, query, &packet);
    // Embree marks an occluded ray by tfar = -infinity.
    for (int lane = 0; lane < width; ++lane)
      if (valid[lane]) is_visible[segments.order[i + lane]] = lanes_of(packet.tfar)[lane] >= 0 ? -1 : 0;
  }
}

/// Where a ray meets a shape that is not made of triangles; t is NaN where it does not.
struct ShapeHit {
  double t = std::nan("");
  Vec3<double> ng{};    ///< Not normalised.
  double u = 0, v = 0;  ///< What surface_uv() takes.
};

struct Segment {
  Vec3<double> origin, direction;
  double t_near, t_far;

  bool has(double t) const { return t > t_near && t < t_far; }
};

/// The nearest root of |origin + t direction - center| = radius.
ShapeHit nearest_hit(const Sphere& sphere, const Segment& ray) {
  const Vec3<double> from_center = ray.origin - widen(sphere.center);
  const double a = length_sq(ray.direction), half_b = dot(from_center, ray.direction);
  // The discriminant from the distance of the line to the centre: no cancellation for distant spheres
  // (Hearn and Baker, in Haines et al. 2019, "Precision improvements for ray/sphere intersection").
  const Vec3<double> closest = from_center - ray.direction * (half_b / a);
  const double discriminant = double(sphere.radius) * sphere.radius - length_sq(closest);
  if (discriminant < 0) return {};
  const double half_chord = std::sqrt(discriminant / a), middle = -half_b / a;
  for (const double t : {middle - half_chord, middle + half_chord})
    if (ray.has(t)) return {t, from_center + ray.direction * t};
  return {};
}

/// The point of the plane, as x and y of the unit disk that the transform made into this one.
ShapeHit nearest_hit(const Disk& disk, const Segment& ray) {
  const Vec3<double> along_x = widen(disk.along_x), along_y = widen(disk.along_y);
  const Vec3<double> across = cross(along_x, along_y), to_center = widen(disk.center) - ray.origin;
  const double t = dot(to_center, across) / dot(ray.direction, across);
  if (!ray.has(t)) return {};
  const Vec3<double> from_center = ray.direction * t - to_center;
  const double x = dot(cross(from_center, along_y), across) / length_sq(across),
               y = dot(cross(along_x, from_center), across) / length_sq(across);
  if (!(x * x + y * y <= 1)) return {};
  return {t, widen(disk.ng), x, y};
}

/// f(shape) with the sphere or disk that Embree numbers `primitive`.
template <class Function>
auto with_shape(const Elements& elements, unsigned primitive, Function&& f) {
  const auto id = std::size_t(elements.shapes[primitive]);
  return elements.sphere[id] >= 0 ? f(elements.spheres[elements.sphere[id]])
                                  : f(elements.disks[elements.disk[id]]);
}

void shape_bounds(const RTCBoundsFunctionArguments* args) {
  with_shape(*static_cast<const Elements*>(args->geometryUserPtr), args->primID, [&](const auto& shape) {
    const Box box = box_of(shape);
    RTCBounds& bounds = *args->bounds_o;
    bounds.lower_x = box.low.x;
    bounds.lower_y = box.low.y;
    bounds.lower_z = box.low.z;
    bounds.upper_x = box.high.x;
    bounds.upper_y = box.high.y;
    bounds.upper_z = box.high.z;
  });
}

template <class Shape, class RayN>
ShapeHit hit_lane(const Shape& shape, RayN* rays, unsigned n, unsigned lane) {
  return nearest_hit(
      shape, {{RTCRayN_org_x(rays, n, lane), RTCRayN_org_y(rays, n, lane), RTCRayN_org_z(rays, n, lane)},
              {RTCRayN_dir_x(rays, n, lane), RTCRayN_dir_y(rays, n, lane), RTCRayN_dir_z(rays, n, lane)},
              RTCRayN_tnear(rays, n, lane),
              RTCRayN_tfar(rays, n, lane)});
}

void shape_intersect(const RTCIntersectFunctionNArguments* args) {
  const Elements& elements = *static_cast<const Elements*>(args->geometryUserPtr);
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  with_shape(elements, args->primID, [&](const auto& shape) {
    for (unsigned lane = 0; lane < args->N; ++lane) {
      if (!args->valid[lane]) continue;
      const ShapeHit hit = hit_lane(shape, rays, args->N, lane);
      if (!(hit.t == hit.t)) continue;
      RTCRayN_tfar(rays, args->N, lane) = float(hit.t);
      RTCHitN_Ng_x(hits, args->N, lane) = float(hit.ng.x);
      RTCHitN_Ng_y(hits, args->N, lane) = float(hit.ng.y);
      RTCHitN_Ng_z(hits, args->N, lane) = float(hit.ng.z);
      RTCHitN_u(hits, args->N, lane) = float(hit.u);
      RTCHitN_v(hits, args->N, lane) = float(hit.v);
      RTCHitN_geomID(hits, args->N, lane) =
          elements.are_joined() ? args->geomID : unsigned(elements.shapes[args->primID]);
      RTCHitN_primID(hits, args->N, lane) =
          elements.are_joined() ? unsigned(elements.triangles) + args->primID : 0;
    }
  });
}

void shape_occluded(const RTCOccludedFunctionNArguments* args) {
  with_shape(*static_cast<const Elements*>(args->geometryUserPtr), args->primID, [&](const auto& shape) {
    for (unsigned lane = 0; lane < args->N; ++lane) {
      if (!args->valid[lane]) continue;
      const ShapeHit hit = hit_lane(shape, args->ray, args->N, lane);
      if (hit.t == hit.t) RTCRayN_tfar(args->ray, args->N, lane) = -INFINITY;
    }
  });
}

RTCGeometry make_triangles(RTCDevice device, const Geometry& geometry, std::int32_t first,
                           std::int32_t count) {
  RTCGeometry made = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(made, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, geometry.positions.data(), 0,
                             sizeof(Vec3f), geometry.positions.size() - 1);
  rtcSetSharedGeometryBuffer(made, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, geometry.indices.data(),
                             std::size_t(first) * 3 * sizeof(std::int32_t), 3 * sizeof(std::int32_t),
                             std::size_t(count));
  return made;
}

/// \param elements stay where they are for as long as the geometry lives
RTCGeometry make_shapes(RTCDevice device, const Elements& elements) {
  RTCGeometry made = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(made, unsigned(elements.shapes.size()));
  rtcSetGeometryUserData(made, const_cast<Elements*>(&elements));
  rtcSetGeometryBoundsFunction(made, shape_bounds, nullptr);
  rtcSetGeometryIntersectFunction(made, shape_intersect);
  rtcSetGeometryOccludedFunction(made, shape_occluded);
  return made;
}

[[noreturn]] void throw_embree_error(RTCDevice device, const char* doing) {
  throw InputError("the ray caster failed " + std::string(doing) + " (Embree error " +
                   std::to_string(int(rtcGetDeviceError(device))) + "); is there enough memory?");
}

}  // namespace

struct RayCaster::Embree {
  Elements elements;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  explicit Embree(const Geometry& geometry) : elements(geometry) {}
  ~Embree() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

RayCaster::RayCaster(const Geometry& geometry, Edges edges) : embree_(std::make_unique<Embree>(geometry)) {
  // Without a number of threads: Embree would hold the whole process to it for as long as the device lives.
  embree_->device = rtcNewDevice("");
  if (!embree_->device) throw_embree_error(nullptr, "to start");
  embree_->scene = rtcNewScene(embree_->device);
  if (edges == Edges::watertight) rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  const auto attach = [&](RTCGeometry made, std::int32_t number) {
    rtcCommitGeometry(made);
    rtcAttachGeometryByID(embree_->scene, made, unsigned(number));
    rtcReleaseGeometry(made);
  };
  const Elements& elements = embree_->elements;
  if (elements.are_joined() && elements.triangles > 0) {
    attach(make_triangles(embree_->device, geometry, 0, elements.triangles), 0);
  } else {
    for (std::int32_t id = 0; id < geometry.count(); ++id)
      if (const auto at = std::size_t(id); geometry.triangles[at] > 0)
        attach(make_triangles(embree_->device, geometry, geometry.first_triangle[at], geometry.triangles[at]),
               id);
  }
  if (!elements.shapes.empty())
    attach(make_shapes(embree_->device, elements), elements.are_joined() ? 1 : geometry.count());
  rtcCommitScene(embree_->scene);
  if (const RTCError error = rtcGetDeviceError(embree_->device); error != RTC_ERROR_NONE)
    throw InputError("the ray caster could not build the scene (Embree error " + std::to_string(int(error)) +
                     "); is there enough memory?");
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

void RayCaster::closest_hits(const RaySpan& rays, const HitSpan& hits, int width, Coherence coherence) const {
  switch (width) {
    case 1:
      return closest_hits_wide<1>(embree_->scene, embree_->elements, rays, hits, coherence);
    case 4:
      return closest_hits_wide<4>(embree_->scene, embree_->elements, rays, hits, coherence);
    case 8:
      return closest_hits_wide<8>(embree_->scene, embree_->elements, rays, hits, coherence);
    default:
      return closest_hits_wide<16>(embree_->scene, embree_->elements, rays, hits, coherence);
  }
}

void RayCaster::unoccluded(const SegmentSpan& segments, std::int32_t* is_visible, int width,
                           Coherence coherence) const {
  switch (width) {
    case 1:
      return unoccluded_wide<1>(embree_->scene, segments, is_visible, coherence);
    case 4:
      return unoccluded_wide<4>(embree_->scene, segments, is_visible, coherence);
    case 8:
      return unoccluded_wide<8>(embree_->scene, segments, is_visible, coherence);
    default:
      return unoccluded_wide<16>(embree_->scene, segments, is_visible, coherence);
  }
}

}  // namespace etendue
