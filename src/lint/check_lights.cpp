#include "base/frame.h"
#include "lightsampler/light_sampler.h"
#include "lint/checks.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace etendue {

namespace {

/// What rays from a light meet first.
struct FromLight {
  int rays = 0, reached = 0;  ///< Reached: what the light can be found to light.
  int escaped = 0, backs = 0, blacks = 0, diracs = 0;
};

/// The shape of each light; -1: it is none.
std::vector<std::int32_t> shapes_of_lights(const Scene& scene) {
  std::vector<std::int32_t> shapes(std::size_t(scene.lights.count()), -1);
  for (std::int32_t id = 0; id < scene.geometry.count(); ++id)
    if (const std::int32_t light = scene.geometry.light[std::size_t(id)]; light >= 0)
      shapes[std::size_t(light)] = id;
  return shapes;
}

struct PointOnLight {
  Vec3f position, ng;
};

/// On the front of a shape that shines.
PointOnLight point_on(const Geometry& geometry, std::int32_t id, ProbeNumbers& numbers) {
  const auto at = std::size_t(id);
  if (geometry.sphere[at] >= 0) {
    const Sphere& sphere = geometry.spheres[std::size_t(geometry.sphere[at])];
    const Vec3f ng = square_to_uniform_sphere(numbers.two_units());
    return {sphere.center + ng * sphere.radius, ng};
  }
  if (geometry.disk[at] >= 0) {
    const Disk& disk = geometry.disks[std::size_t(geometry.disk[at])];
    const Vec2f u = square_to_uniform_disk(numbers.two_units());
    return {disk.center + disk.along_x * u.x + disk.along_y * u.y, disk.ng};
  }
  const auto triangle =
      std::size_t(geometry.first_triangle[at]) +
      std::size_t((std::uint64_t(numbers.bits()) * std::uint64_t(geometry.triangles[at])) >> 32);
  const auto corner = [&](std::size_t k) {
    return geometry.positions[std::size_t(geometry.indices[3 * triangle + k])];
  };
  const Vec3f edge_1 = corner(1) - corner(0), edge_2 = corner(2) - corner(0);
  const Vec2f u = square_to_triangle(numbers.two_units());
  return {corner(0) + edge_1 * u.x + edge_2 * u.y, normalize(cross(edge_1, edge_2))};
}

/// Rays off a light that is a shape or stands at a point.
class LightRays {
 public:
  LightRays(const Scene& scene, std::int32_t light, std::int32_t shape, bool is_front)
      : scene_(scene), shape_(shape), is_front_(is_front), numbers_(std::uint64_t(light) << 20) {
    if (shape_ < 0) bounds_ = *scene.lights.bounds(light);
  }
  Ray<float> next() {
    if (shape_ < 0) {
      const float most = 1 - bounds_.cos_emission, cone = std::clamp(most, 1e-4f, 2.0f);
      const bool is_everywhere = bounds_.cos_normals <= -1;
      const Vec3f direction = is_everywhere
                                  ? square_to_uniform_sphere(numbers_.two_units())
                                  : Frame<float>(bounds_.axis)
                                        .world_from_local(square_to_uniform_cone(numbers_.two_units(), cone));
      return {bounds_.box.low, direction};
    }
    const PointOnLight point = point_on(scene_.geometry, shape_, numbers_);
    const Vec3f ng = is_front_ ? point.ng : -point.ng;
    return {point.position + ng * clearance<float>(point.ng, abs_each(point.position), 0),
            Frame<float>(ng).world_from_local(square_to_cosine_hemisphere(numbers_.two_units()))};
  }

 private:
  const Scene& scene_;
  std::int32_t shape_;
  bool is_front_;
  ProbeNumbers numbers_;
  LightBounds bounds_{};
};

/// Whether what the ray has met can show the light of a light by the integrator's techniques.
bool shows_light(const LintContext& context, const ProbeHit& hit, bool is_dirac_light) {
  if (!context.can_be_lit(hit)) return false;
  if (!context.material_of(hit).is_dirac) return true;
  const PathRules* rules = context.subject.integrator.path_rules();
  const bool samples_bsdf = rules->bsdf_samples(0) > 0;
  return !is_dirac_light && samples_bsdf;
}

/// Until it is clear that light gets somewhere.
FromLight rays_from(const LintContext& context, LightRays rays, bool is_dirac_light) {
  constexpr int most = 1024;
  FromLight found;
  while (found.rays < most && found.reached == 0) {
    ++found.rays;
    const auto hit = probe(context.scene, rays.next());
    if (!hit)
      ++found.escaped;
    else if (shows_light(context, *hit, is_dirac_light))
      ++found.reached;
    else if (context.can_be_lit(*hit))
      ++found.diracs;
    else if (!hit->is_front)
      ++found.backs;
    else
      ++found.blacks;
  }
  return found;
}

/// A look from the receivers' side, which finds what is small and far away.
bool lights_what_is_seen(const LintContext& context, std::int32_t light, bool is_dirac_light) {
  ProbeNumbers numbers(std::uint64_t(light) << 20 | 1);
  for (const View::Seen& seen : context.view.rays)
    if (seen.hit && shows_light(context, *seen.hit, is_dirac_light) &&
        is_lit_by(context.scene, *seen.hit, light, 1, numbers))
      return true;
  return false;
}

/// Whether the camera sees the front of a light.
bool is_seen(const LintContext& context, std::int32_t shape) {
  if (std::any_of(context.view.rays.begin(), context.view.rays.end(), [&](const View::Seen& seen) {
        return seen.hit && seen.hit->hit.geometry == shape && seen.hit->is_front;
      }))
    return true;
  // It may be too small for a grid of rays.
  ProbeNumbers numbers(4);
  const Camera& camera = context.scene.camera;
  for (int k = 0; k < 64; ++k) {
    const PointOnLight point = point_on(context.scene.geometry, shape, numbers);
    const Vec3f from = point.position + point.ng * clearance<float>(point.ng, abs_each(point.position), 0);
    if (dot(camera.eye() - from, point.ng) > 0 && is_in_view(camera, from) &&
        is_visible(context.scene, from, camera.eye()))
      return true;
  }
  return false;
}

/// Where paths get to that start with a ray: whether one escapes, sees the camera, or sees a light at
/// infinity.
enum class Space { open, closed };
Space space_around(const LintContext& context, LightRays rays) {
  constexpr int walks = 32, length = 16;
  ProbeNumbers numbers(5);
  for (int walk = 0; walk < walks; ++walk) {
    std::optional<ProbeHit> at = probe(context.scene, rays.next());
    for (int k = 0; k < length; ++k) {
      if (!at) return Space::open;
      const Vec3f to_camera = normalize(context.scene.camera.eye() - at->vertex.position);
      const bool is_on_side = dot(at->vertex.ng, to_camera) * dot(at->vertex.ng, at->vertex.wo) > 0;
      if ((is_on_side || context.material_of(*at).is_two_sided) &&
          is_visible(context.scene, at->vertex.origin_of_ray(to_camera), context.scene.camera.eye()))
        return Space::open;
      at = probe(context.scene, ray_from(*at, next_direction(*at, context.material_of(*at), numbers)));
    }
  }
  return Space::closed;
}

/// Whether paths from what the camera sees get out of the scene, where lights at infinity are.
bool gets_out(const LintContext& context) {
  if (context.view.hits < int(context.view.rays.size())) return true;
  constexpr int length = 16;
  ProbeNumbers numbers(6);
  for (std::size_t walk = 0; walk < context.view.rays.size(); walk += 4) {
    std::optional<ProbeHit> at = context.view.rays[walk].hit;
    for (int k = 0; k < length && at; ++k)
      at = probe(context.scene, ray_from(*at, next_direction(*at, context.material_of(*at), numbers)));
    if (!at) return true;
  }
  return false;
}

class LightCheck {
 public:
  LightCheck(const LintContext& context, Findings& findings)
      : context_(context), findings_(findings), shapes_(shapes_of_lights(context.scene)) {}

  void check(std::int32_t light) {
    const Scene& scene = context_.scene;
    if (!(luminance(scene.lights.largest_radiance(light)) > 0))
      return add("light-black", light, "shines with 0: it adds nothing", "give it a radiance, or remove it");
    const std::int32_t shape = shapes_[std::size_t(light)];
    const bool is_dirac = shape < 0 && scene.lights.bounds(light).has_value();
    if (is_dirac && !context_.subject.integrator.path_rules()->light_samples()) return;  // Said once for all.
    if (scene.medium) return;  // What it lights is everywhere.
    if (shape < 0 && !is_dirac)
      check_infinite(light);
    else
      check_reach(light, shape, is_dirac);
  }

 private:
  void add(std::string_view id, std::int32_t light, const std::string& problem, const std::string& remedy) {
    const ScenePlaces::Light& place = context_.places.lights[std::size_t(light)];
    findings_.add(id, place.where, fmt::format("the light '{}' {}", place.name, problem), remedy);
  }

  void check_infinite(std::int32_t light) {
    if (!has_looked_out_) gets_out_ = gets_out(context_);
    has_looked_out_ = true;
    if (!gets_out_)
      add("light-closed-in", light, "is shut out: what the camera sees is closed all around",
          "open the space with a window, or put lights inside");
  }

  void check_reach(std::int32_t light, std::int32_t shape, bool is_dirac) {
    const LightRays front(context_.scene, light, shape, true);
    const FromLight found = rays_from(context_, front, is_dirac);
    if (found.reached > 0) return check_space(light, shape, front);
    if (shape >= 0 && context_.scene.lights.is_twosided<float>(light, true)) {
      const LightRays back(context_.scene, light, shape, false);
      if (rays_from(context_, back, is_dirac).reached > 0) return check_space(light, shape, back);
    }
    if (lights_what_is_seen(context_, light, is_dirac)) return;
    const bool is_in_picture = shape >= 0 && is_seen(context_, shape);
    if (2 * found.diracs > found.rays)
      return add("light-behind-glass", light,
                 fmt::format("is behind mirrors or glass on all sides, where {} cannot find it",
                             context_.subject.integrator.name),
                 is_dirac ? "no ray can meet a point: take a small area light, with path_mis or path_mats"
                          : "take path_mis or path_mats");
    if (shape >= 0) {
      const FromLight behind = rays_from(context_, LightRays(context_.scene, light, shape, false), is_dirac);
      const ScenePlaces::Shape& place = context_.places.shapes[std::size_t(shape)];
      if (behind.reached > 0 && place.is_turned_over)
        return add(
            "light-turned-over", light,
            "shines away from all that it could light: its transform is a mirror image, which has turned "
            "the front of its mesh over",
            "turn its faces round (the order of their corners), give the mesh vertex normals, or take a "
            "rotation instead");
      if (behind.reached > 0 && !is_in_picture)
        return add("light-faces-nothing", light, "faces away from all that it could light",
                   "it shines from its front side only: turn it round");
    }
    if (is_in_picture) return;  // A lamp to look at.
    add("light-faces-nothing", light,
        found.backs > found.escaped && found.backs > found.blacks
            ? "reaches only surfaces seen from behind, where they are black"
        : found.blacks > found.escaped ? "reaches only black surfaces"
                                       : "faces nothing that it could light",
        "move or turn it, or turn the faces round that it should light");
  }

  void check_space(std::int32_t light, std::int32_t shape, const LightRays& front) {
    if (shape >= 0 && is_seen(context_, shape)) return;
    if (space_around(context_, front) == Space::closed && !is_found_by_view(light))
      add("light-closed-in", light, "shines into a closed space that the camera does not see",
          "open the space, or put the light or the camera on the other side");
  }

  bool is_found_by_view(std::int32_t light) const {
    ProbeNumbers numbers(std::uint64_t(light) << 20 | 2);
    return std::any_of(context_.view.rays.begin(), context_.view.rays.end(), [&](const View::Seen& seen) {
      return seen.hit && is_lit_by(context_.scene, *seen.hit, light, 1, numbers);
    });
  }

  const LintContext& context_;
  Findings& findings_;
  std::vector<std::int32_t> shapes_;
  bool has_looked_out_ = false, gets_out_ = false;
};

/// The lights at points or infinity that no ray can meet, where the integrator has only rays.
void check_unsampled(const LintContext& context, Findings& findings) {
  const Lights& lights = context.scene.lights;
  const std::string unseen = unseen_lights(context.subject.integrator, lights.dirac_count());
  if (unseen.empty()) return;
  const std::size_t line = unseen.find('\n');
  const std::vector<std::int32_t> shapes = shapes_of_lights(context.scene);
  std::int32_t first = 0;
  const auto is_infinite = [&](std::int32_t light) {
    for (std::int32_t k = 0; k < lights.infinite_count(); ++k)
      if (lights.infinite_light(k) == light) return true;
    return false;
  };
  while (shapes[std::size_t(first)] >= 0 || is_infinite(first)) ++first;
  findings.add("light-not-found", context.places.lights[std::size_t(first)].where, unseen.substr(0, line),
               unseen.substr(line + 1));
}

void check_choice(const LintContext& context, Findings& findings) {
  const Lights& lights = context.scene.lights;
  const std::string_view sampler = context.subject.integrator.light_sampler();
  const double samples = double(context.scene.camera.width_px) * context.scene.camera.height_px *
                         context.subject.samples_per_pixel;
  if (sampler == "uniform" && lights.count() > samples)
    findings.add("light-never-chosen", context.places.scene,
                 fmt::format("{} lights, of which one is chosen for each of {:.0f} samples: most never shine",
                             lights.count(), samples),
                 "take more samples, or --light-sampler power");
  if (sampler != "power") return;
  const LightSampler choice = light_sampler_for(context.subject.integrator, lights);
  for (std::int32_t light = 0; light < lights.count(); ++light) {
    const double share = choice.pmf<float>(Receiver<float>{}, light, 0);
    if (share <= 0 || share * samples >= 1) continue;
    const ScenePlaces::Light& place = context.places.lights[std::size_t(light)];
    findings.add(
        "light-never-chosen", place.where,
        fmt::format("the light '{}' has so small a share of the power that it is chosen {:.2g} times in "
                    "all samples of the image",
                    place.name, share * samples),
        "take --light-sampler uniform or all, or more samples");
  }
}

/// Light samples alone show nothing in mirrors.
void check_mirrors(const LintContext& context, Findings& findings) {
  const PathRules* rules = context.subject.integrator.path_rules();
  if (rules->bsdf_samples(0) > 0) return;
  const auto black = std::find_if(
      context.view.rays.begin(), context.view.rays.end(),
      [&](const View::Seen& seen) { return seen.hit && context.material_of(*seen.hit).is_dirac; });
  if (black == context.view.rays.end()) return;
  const ScenePlaces::Shape& shape = context.places.shapes[std::size_t(black->hit->hit.geometry)];
  findings.add("mirrors-black", shape.where,
               fmt::format("{} shows mirrors and smooth glass, such as the {}, black",
                           context.subject.integrator.name, shape.name),
               "take whitted, mis or path_mis to see what is in them");
}

}  // namespace

void check_lights(const LintContext& context, const LintEffort& effort, Findings& findings) {
  if (!context.subject.integrator.needs_lights()) return;
  check_unsampled(context, findings);
  const std::int32_t count = context.scene.lights.count(), looked_at = std::min(count, effort.most_lights);
  LightCheck check(context, findings);
  for (std::int32_t k = 0; k < looked_at; ++k) check.check(std::int32_t(std::int64_t(k) * count / looked_at));
  check_choice(context, findings);
  check_mirrors(context, findings);
}

}  // namespace etendue
