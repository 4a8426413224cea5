#include "scene/lamp_outlines.h"

#include "geometry/equal_places.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <span>
#include <utility>

namespace etendue {
namespace {

using Vec3d = Vec3<double>;

Vec3d widened(const Vec3f& v) { return {v.x, v.y, v.z}; }

/// The film, on which segments in the world leave their marks. Film space is where a point has its place on
/// the film (px) times its depth, and its depth.
class MarkedFilm {
 public:
  MarkedFilm(const Camera& camera, double filter_radius_px)
      : width_(camera.width_px), height_(camera.height_px), eye_(camera.origin) {
    const double volume = dot(camera.per_px_x, cross(camera.per_px_y, camera.at_film_origin));
    to_x_ = cross(camera.per_px_y, camera.at_film_origin) * (1 / volume);
    to_y_ = cross(camera.at_film_origin, camera.per_px_x) * (1 / volume);
    to_depth_ = cross(camera.per_px_x, camera.per_px_y) * (1 / volume);
    near_ = double(camera.start_depth) + camera.near_clip;
    far_ = double(camera.start_depth) + camera.far_clip;
    constexpr double rounding_px = 1.0 / 32;  // Of rays, in images up to 65536 pixels wide.
    reach_px_ = filter_radius_px + rounding_px;
    if (camera.has_lens) {
      const Vec3d lens_x = widened(camera.lens_x), lens_y = widened(camera.lens_y);
      lens_radius_ = std::max(length(lens_x), length(lens_y));
      blur_x_ = std::hypot(dot(to_x_, lens_x), dot(to_x_, lens_y));
      blur_y_ = std::hypot(dot(to_y_, lens_x), dot(to_y_, lens_y));
      inv_focus_distance_ = camera.inv_focus_distance;
    }
  }

  const Vec3d& eye() const { return eye_; }
  double lens_radius() const { return lens_radius_; }
  /// The planes beyond which nothing is seen, as depths.
  std::array<double, 2> clip_depths() const { return {near_, far_}; }
  const Vec3d& to_depth() const { return to_depth_; }

  Vec3d from_world(const Vec3d& at) const {
    const Vec3d along = at - eye_;
    return {dot(to_x_, along), dot(to_y_, along), dot(to_depth_, along)};
  }
  /// About how large a length (m) at a place in film space is (px), at the most.
  double size_px(double length_m, const Vec3d& at) const {
    const double depth = std::max(at.z, near_);
    return length_m * std::max(length(to_x_), length(to_y_)) / depth;
  }

  /// Whether the convex hull of places in film space is out of sight, their surroundings too.
  bool is_unseen(std::span<const Vec3d> places) const {
    const auto all = [&](auto&& is_beyond) { return std::all_of(places.begin(), places.end(), is_beyond); };
    if (all([&](const Vec3d& p) { return p.z < near_; })) return true;
    if (all([&](const Vec3d& p) { return p.z > far_; })) return true;
    if (lens_radius_ > 0) return false;
    return all([&](const Vec3d& p) { return p.x < -reach_px_ * p.z; }) ||
           all([&](const Vec3d& p) { return p.y < -reach_px_ * p.z; }) ||
           all([&](const Vec3d& p) { return p.x > (width_ + reach_px_) * p.z; }) ||
           all([&](const Vec3d& p) { return p.y > (height_ + reach_px_) * p.z; });
  }

  /// Marks where a segment in film space passes, or one that is off by `deviation` (m) at most.
  void mark(Vec3d a, Vec3d b, double deviation = 0) {
    if (is_exhausted() || !clip(a, b)) return;
    const double least_depth = std::min(a.z, b.z), depth_off = deviation * length(to_depth_);
    const double clear = std::max(least_depth - depth_off, near_);
    const double blur =
        std::max(std::abs(inv_focus_distance_ - 1 / a.z), std::abs(inv_focus_distance_ - 1 / b.z));
    a = a * (1 / a.z);
    b = b * (1 / b.z);
    const double off_x =
                     (deviation * length(to_x_) + std::max(std::abs(a.x), std::abs(b.x)) * depth_off) / clear,
                 off_y =
                     (deviation * length(to_y_) + std::max(std::abs(a.y), std::abs(b.y)) * depth_off) / clear;
    mark_on_film(a, b, reach_px_ + off_x + blur * blur_x_, reach_px_ + off_y + blur * blur_y_);
  }

  /// Where the clip planes cut a convex polygon in film space, its image ends too.
  void mark_cuts(std::span<const Vec3d> corners, double deviation = 0) {
    for (const double depth : clip_depths()) {
      std::array<Vec3d, 2> cuts;
      std::size_t count = 0;
      for (std::size_t k = 0; k < corners.size() && count < 2; ++k) {
        const Vec3d &a = corners[k], &b = corners[k + 1 == corners.size() ? 0 : k + 1];
        if ((a.z < depth) == (b.z < depth)) continue;
        cuts[count] = a + (b - a) * ((depth - a.z) / (b.z - a.z));
        cuts[count++].z = depth;
      }
      if (count == 2) mark(cuts[0], cuts[1], deviation);
    }
  }

  std::vector<std::uint8_t> take_marks() { return std::move(marks_); }

 private:
  /// To what the clip planes leave; false where that is nothing.
  bool clip(Vec3d& a, Vec3d& b) const {
    if (std::max(a.z, b.z) < near_ || std::min(a.z, b.z) > far_) return false;
    const auto cut = [](Vec3d& beyond, const Vec3d& other, double depth) {
      beyond = beyond + (other - beyond) * ((depth - beyond.z) / (other.z - beyond.z));
      beyond.z = depth;
    };
    if (a.z < near_) cut(a, b, near_);
    if (b.z < near_) cut(b, a, near_);
    if (a.z > far_) cut(a, b, far_);
    if (b.z > far_) cut(b, a, far_);
    return true;
  }

  /// All pixels whose centres are within the reach of the segment, along x and along y.
  void mark_on_film(const Vec3d& a, const Vec3d& b, double reach_x, double reach_y) {
    const auto [top, bottom] = std::minmax(a.y, b.y);
    const int first = first_pixel(top - reach_y), end = end_pixel(bottom + reach_y, height_);
    for (int y = first; y < end && !is_exhausted(); ++y) {
      double from = a.x, to = b.x;
      if (a.y != b.y) {
        const double per_y = (b.x - a.x) / (b.y - a.y);
        const auto x_at = [&](double at_y) { return a.x + (std::clamp(at_y, top, bottom) - a.y) * per_y; };
        from = x_at(y + 0.5 - reach_y);
        to = x_at(y + 0.5 + reach_y);
      }
      const int first_x = first_pixel(std::min(from, to) - reach_x),
                end_x = end_pixel(std::max(from, to) + reach_x, width_);
      if (first_x < end_x) mark_row(y, first_x, end_x);
    }
  }
  /// Pixels in an image of which the centres lie from `from` on.
  static int first_pixel(double from) { return int(std::clamp(std::ceil(from - 0.5), 0.0, 65536.0)); }
  /// Behind the last whose centre lies before `to`.
  static int end_pixel(double to, int count) {
    return int(std::clamp(std::floor(to - 0.5) + 1, 0.0, double(count)));
  }

  /// Very many outlines, or much blurred ones, must not take longer than the image.
  bool is_exhausted() const {
    return marks_made_ > std::max(std::int64_t{16} * width_ * height_, std::int64_t{1} << 24);
  }

  void mark_row(int y, int first, int end) {
    marks_made_ += end - first;
    if (marks_.empty()) marks_.resize(std::size_t(width_) * std::size_t(height_));
    std::memset(&marks_[std::size_t(y) * std::size_t(width_) + std::size_t(first)], 1,
                std::size_t(end - first));
  }

  const int width_, height_;
  const Vec3d eye_;
  Vec3d to_x_, to_y_, to_depth_;  ///< Rows of the matrix from the world to film space.
  double near_, far_, reach_px_;
  double lens_radius_ = 0;          ///< m
  double blur_x_ = 0, blur_y_ = 0;  ///< Of a point, half of it: px, per difference of 1 / depth to the focus.
  double inv_focus_distance_ = 0;
  std::int64_t marks_made_ = 0;
  std::vector<std::uint8_t> marks_;
};

/// Sides of polygons that nothing continues. Two triangles that the eye sees from the side that shines and
/// that lie beside each other run along their common side in opposite directions.
class OpenSides {
 public:
  explicit OpenSides(std::size_t most_sides) : slots_(std::bit_ceil(2 * most_sides + 1)) {}

  void add(std::int32_t begin, std::int32_t end) {
    for (std::size_t s = slot_of(end, begin); slots_[s].state != State::empty; s = next(s))
      if (slots_[s].state == State::open && slots_[s].begin == end && slots_[s].end == begin) {
        slots_[s].state = State::closed;
        return;
      }
    std::size_t s = slot_of(begin, end);
    while (slots_[s].state != State::empty) s = next(s);
    slots_[s] = {begin, end, State::open};
  }

  /// f(begin, end) for each.
  template <class Function>
  void for_each(Function&& f) const {
    for (const Slot& slot : slots_)
      if (slot.state == State::open) f(slot.begin, slot.end);
  }

 private:
  enum class State : std::uint8_t { empty, open, closed };
  struct Slot {
    std::int32_t begin = 0, end = 0;
    State state = State::empty;
  };
  std::size_t slot_of(std::int32_t begin, std::int32_t end) const {
    const std::uint64_t key = std::uint64_t(std::uint32_t(begin)) << 32 | std::uint32_t(end);
    return std::size_t((key * 0x9e3779b97f4a7c15u) >> 20) & (slots_.size() - 1);
  }
  std::size_t next(std::size_t s) const { return (s + 1) & (slots_.size() - 1); }
  std::vector<Slot> slots_;
};

/// A triangle of a lamp that the eye sees from a side that shines.
struct SeenTriangle {
  std::array<std::int32_t, 3> vertices;  ///< Counter-clockwise from there.
  bool is_sure;                          ///< All of the lens sees this side.
};

std::vector<SeenTriangle> seen_triangles(MarkedFilm& film, const Geometry& geometry, std::size_t id,
                                         bool is_twosided) {
  std::vector<SeenTriangle> seen;
  const std::int32_t* indices = &geometry.indices[3 * std::size_t(geometry.first_triangle[id])];
  for (std::int32_t t = 0; t < geometry.triangles[id]; ++t, indices += 3) {
    std::array<Vec3d, 3> world, places;
    for (std::size_t k = 0; k < 3; ++k) world[k] = widened(geometry.positions[std::size_t(indices[k])]);
    const Vec3d across = cross(world[1] - world[0], world[2] - world[0]);
    const double height = dot(across, film.eye() - world[0]);
    const bool is_sure = std::abs(height) > length(across) * film.lens_radius();
    if (is_sure && height < 0 && !is_twosided) continue;
    for (std::size_t k = 0; k < 3; ++k) places[k] = film.from_world(world[k]);
    if (film.is_unseen(places)) continue;
    film.mark_cuts(places);
    seen.push_back({{indices[0], indices[height > 0 ? 1 : 2], indices[height > 0 ? 2 : 1]}, is_sure});
  }
  return seen;
}

void mark_mesh(MarkedFilm& film, const Geometry& geometry, std::size_t id, bool is_twosided) {
  const std::vector<SeenTriangle> seen = seen_triangles(film, geometry, id, is_twosided);
  if (seen.empty()) return;
  std::vector<std::int32_t> vertices;
  for (const SeenTriangle& triangle : seen)
    vertices.insert(vertices.end(), triangle.vertices.begin(), triangle.vertices.end());
  const EqualPlaces place_of(geometry.positions, vertices);
  const auto mark = [&](std::int32_t begin, std::int32_t end) {
    const auto on_film = [&](std::int32_t vertex) {
      return film.from_world(widened(geometry.positions[std::size_t(vertex)]));
    };
    film.mark(on_film(begin), on_film(end));
  };
  OpenSides open(vertices.size());
  for (const SeenTriangle& triangle : seen)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t begin = place_of(triangle.vertices[k]),
                         end = place_of(triangle.vertices[k == 2 ? 0 : k + 1]);
      if (triangle.is_sure)
        open.add(begin, end);
      else  // Seen from one place of the lens or another, it may end there.
        mark(begin, end);
    }
  open.for_each(mark);
}

/// \param along_x,along_y from the centre to the ellipse, its axes or what is sheared like them (m)
/// \param deviation of the true outline from it (m)
void mark_ellipse(MarkedFilm& film, const Vec3d& center, const Vec3d& along_x, const Vec3d& along_y,
                  double deviation = 0) {
  const double radius = std::max(length(along_x), length(along_y));
  // So many sides that these are off by about 1/13 px; those nearer to the camera may be off by more, which
  // their deviation says.
  const double size_px = film.size_px(radius, film.from_world(center));
  const int sides = int(std::clamp(8 * std::sqrt(size_px), 8.0, 512.0));
  std::vector<Vec3d> corners;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    corners.push_back(film.from_world(center + along_x * std::cos(angle) + along_y * std::sin(angle)));
  }
  if (film.is_unseen(corners)) return;
  const double off =
      deviation + (length(along_x) + length(along_y)) * (1 - std::cos(std::numbers::pi / sides));
  for (int k = 0; k < sides; ++k)
    film.mark(corners[std::size_t(k)], corners[std::size_t(k + 1 == sides ? 0 : k + 1)], off);
  film.mark_cuts(corners, off);
}

void mark_circle(MarkedFilm& film, const Vec3d& center, const Vec3d& axis, double radius, double deviation) {
  const Vec3d other = std::abs(axis.x) < std::abs(axis.y) ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d across = cross(axis, other) * (radius / length(cross(axis, other)));
  mark_ellipse(film, center, across, cross(axis, across) * (1 / length(axis)), deviation);
}

void mark_sphere(MarkedFilm& film, const Sphere& sphere, bool is_twosided) {
  const Vec3d center = widened(sphere.center), to_eye = film.eye() - center;
  const double radius = sphere.radius, distance = length(to_eye), lens = film.lens_radius();
  if (distance > radius + lens) {
    // Where rays touch it. From elsewhere in the lens they do so at other places, at most this far away.
    const double nearest = distance - lens;
    const double turn = lens / nearest * (1 + radius / std::sqrt(nearest * nearest - radius * radius));
    const double cosine = radius / distance;
    mark_circle(film, center + to_eye * (cosine * cosine), to_eye, radius * std::sqrt(1 - cosine * cosine),
                radius * turn);
  } else if (distance > radius - lens && lens > 0) {
    mark_circle(film, center, film.to_depth(), radius, 2 * radius);
  } else if (!is_twosided) {
    return;
  }
  const double per_depth = 1 / length(film.to_depth());
  for (const double depth : film.clip_depths()) {
    const double height = (depth - film.from_world(center).z) * per_depth;
    if (std::abs(height) < radius)
      mark_circle(film, center + film.to_depth() * (height * per_depth), film.to_depth(),
                  std::sqrt(radius * radius - height * height), 0);
  }
}

void mark_disk(MarkedFilm& film, const Disk& disk, bool is_twosided) {
  const Vec3d center = widened(disk.center);
  if (dot(widened(disk.ng), film.eye() - center) < -film.lens_radius() && !is_twosided) return;
  mark_ellipse(film, center, widened(disk.along_x), widened(disk.along_y));
}

}  // namespace

LampOutlines::LampOutlines(const Camera& camera, const PixelFilter& filter, const Geometry& geometry,
                           const Lights& lights)
    : width_(camera.width_px) {
  if (filter.is_signed()) return;
  MarkedFilm film(camera, filter.radius_px());
  for (std::size_t id = 0; id < std::size_t(geometry.count()); ++id) {
    const std::int32_t light = geometry.light[id];
    if (light < 0) continue;
    const bool is_twosided = lights.is_twosided<float>(light, true);
    if (geometry.sphere[id] >= 0)
      mark_sphere(film, geometry.spheres[std::size_t(geometry.sphere[id])], is_twosided);
    else if (geometry.disk[id] >= 0)
      mark_disk(film, geometry.disks[std::size_t(geometry.disk[id])], is_twosided);
    else
      mark_mesh(film, geometry, id, is_twosided);
  }
  is_at_outline_ = film.take_marks();
}

std::int64_t LampOutlines::pixel_count() const {
  return std::count(is_at_outline_.begin(), is_at_outline_.end(), std::uint8_t(1));
}

}  // namespace etendue
