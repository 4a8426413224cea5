#include "lint/checks.h"

#include <algorithm>
#include <fmt/format.h>

namespace etendue {

namespace {

struct Reasons {
  int backs = 0, blacks = 0, mirrors = 0, unlit = 0, lit = 0;
};

/// Whether some light reaches what a camera ray has met.
bool is_lit(const LintContext& context, const ProbeHit& hit, ProbeNumbers& numbers) {
  const std::int32_t count = context.scene.lights.count(), looked_at = std::min(count, 64);
  for (std::int32_t k = 0; k < looked_at; ++k)
    if (is_lit_by(context.scene, hit, std::int32_t(std::int64_t(k) * count / looked_at), 2, numbers))
      return true;
  return false;
}

std::string of_shape(const LintContext& context, const ProbeHit& hit) {
  return context.places.shapes[std::size_t(hit.hit.geometry)].name;
}

}  // namespace

std::string reason_of_black_image(const LintSubject& subject) {
  const LintContext context(subject);
  Findings found;
  check_camera(context, found);
  check_lights(context, thorough, found);
  for (const Finding& finding : found.take())
    if (finding.severity != Severity::harmless)
      return fmt::format("{}\n  {}", finding.problem, finding.remedy);
  if (!subject.integrator.needs_lights())
    return fmt::format("{} shows black here: it knows no lights of the scene", subject.integrator.name);
  if (context.view.hits == 0) return "the camera meets no shape, and what lies behind them all is black";
  Reasons reasons;
  ProbeNumbers numbers(7);
  std::string example_of_black, example_of_unlit;
  for (const View::Seen& seen : context.view.rays) {
    if (!seen.hit) continue;
    const MaterialFacts& material = context.material_of(*seen.hit);
    if (!seen.hit->is_front && !material.is_two_sided) {
      ++reasons.backs;
    } else if (!(material.largest_albedo() > 0)) {
      ++reasons.blacks;
      example_of_black = of_shape(context, *seen.hit);
    } else if (material.is_dirac) {
      ++reasons.mirrors;
    } else if (is_lit(context, *seen.hit, numbers)) {
      ++reasons.lit;
    } else {
      ++reasons.unlit;
      example_of_unlit = of_shape(context, *seen.hit);
    }
  }
  if (reasons.lit > 0)
    return fmt::format(
        "light does reach what is seen ({} of {} probe rays), but {} has not found it in {} samples a "
        "pixel\n  take more samples, or mis or path_mis",
        reasons.lit, context.view.hits, subject.integrator.name, subject.samples_per_pixel);
  if (reasons.unlit > 0)
    return fmt::format(
        "no light reaches what is seen, such as the {}: lights are hidden from it, or face away\n  "
        "look at the scene with --integrator normals; path_mis follows light that is reflected",
        example_of_unlit);
  if (reasons.backs >= reasons.blacks && reasons.backs >= reasons.mirrors)
    return "all that is seen is seen from behind, where it is black\n  turn faces round, or look from the "
           "other side";
  if (reasons.blacks >= reasons.mirrors)
    return fmt::format("all that is seen is black, such as the {}\n  give its bsdf a reflectance above 0",
                       example_of_black);
  return fmt::format(
      "only mirrors and glass are seen, in which {} finds nothing that shines\n  take path_mis",
      subject.integrator.name);
}

std::size_t count_lit_pixels(const LintSubject& subject, const std::vector<Pixel>& dark) {
  if (dark.empty() || !subject.integrator.needs_lights() || subject.scene.medium) return 0;
  const LintContext context(subject);
  const Scene& scene = subject.scene;
  ProbeNumbers numbers(8);
  const std::size_t looked_at = std::min<std::size_t>(dark.size(), 256);
  std::size_t lit = 0;
  for (std::size_t k = 0; k < looked_at; ++k) {
    const Pixel& pixel = dark[k * dark.size() / looked_at];
    const CameraRay<float> ray = scene.camera.ray(float(pixel.x) + 0.5f, float(pixel.y) + 0.5f);
    const auto hit = probe(scene, {ray.origin, ray.direction}, ray.t_near, ray.t_far);
    lit += hit && context.can_be_lit(*hit) && !context.material_of(*hit).is_dirac &&
           is_lit(context, *hit, numbers);
  }
  return lit * dark.size() / looked_at;
}

}  // namespace etendue
