#include "lint/lint.h"

#include "geometry/bounds.h"
#include "lint/checks.h"

#include <algorithm>

namespace etendue {

std::string_view severity_name(Severity severity) {
  switch (severity) {
    case Severity::harmless:
      return "harmless";
    case Severity::doubtful:
      return "doubtful";
    case Severity::wrong:
      return "wrong";
  }
  return "";
}

const std::vector<Check>& lint_checks() {
  using enum Severity;
  static const std::vector<Check> table{
      {"camera-sees-nothing", wrong, "no shape is in view"},
      {"clipped-all", wrong, "all that is in view lies outside of the clip planes"},
      {"clipped-much", doubtful, "much of what is in view lies behind the far clip plane"},
      {"clip-default-moved", harmless, "what is in view lies behind Nori's default far clip plane"},
      {"camera-inside", doubtful, "the camera is inside of a shape that is black from inside"},
      {"camera-on-backs", doubtful, "all that is in view is seen from behind, where it is black"},
      {"large-units", harmless, "sizes look like millimetres"},
      {"light-black", doubtful, "a light has radiance, intensity or irradiance 0"},
      {"light-not-found", wrong, "a light that the integrator has no way to find"},
      {"light-turned-over", wrong, "a mirrored mesh shines away from all there is"},
      {"light-faces-nothing", doubtful, "a light reaches no surface that it could light"},
      {"light-behind-glass", wrong,
       "a light all of whose rays meet mirrors or glass, through which it cannot be found"},
      {"light-closed-in", doubtful, "a light shines into a closed space that the camera does not see"},
      {"light-never-chosen", doubtful, "a light that the light sampler will hardly ever choose"},
      {"mirrors-black", harmless, "mirrors or glass in view, which the integrator shows black"},
      {"albedo-above-2", doubtful, "a surface reflects more than twice the light that it gets"},
      {"albedo-above-1", harmless, "a surface reflects more light than it gets"},
      {"light-kept-in", wrong, "a closed space that loses no light: the answer is infinite"},
      {"lights-in-one-place", wrong, "two lights lie in one place"},
      {"light-in-surface", wrong, "a light lies in another surface"},
      {"glass-in-surface", harmless, "a dielectric lies in another surface"},
      {"repeated-shape", harmless, "a shape is there twice, in the same place"},
      {"rounded-place", doubtful, "a shape is so far from the rest that rounding changes it"},
  };
  return table;
}

void Findings::add(std::string_view id, const Location& where, std::string problem, std::string remedy,
                   std::vector<std::int32_t> to_lift) {
  const std::vector<Check>& table = lint_checks();
  const auto check =
      std::find_if(table.begin(), table.end(), [&](const Check& candidate) { return candidate.id == id; });
  all_.push_back(
      {check->id, check->severity, where, std::move(problem), std::move(remedy), std::move(to_lift)});
}

float lift_of_lights(const Scene& scene) {
  const Sphere bounds = bounding_sphere(scene.geometry);
  const float to_camera = length(scene.camera.start - bounds.center);
  return 0x1p-19f * (to_camera + 2 * bounds.radius + length(bounds.center));
}

LintContext::LintContext(const LintSubject& subject_of)
    : subject(subject_of),
      scene(subject.scene),
      places(subject.places),
      materials(facts_of(scene.materials)),
      view(look(scene)) {}

const MaterialFacts& LintContext::material_of(const ProbeHit& hit) const {
  return materials[std::size_t(hit.vertex.material)];
}

bool LintContext::can_be_lit(const ProbeHit& hit) const {
  const MaterialFacts& material = material_of(hit);
  return material.largest_albedo() > 0 && (hit.is_front || material.is_two_sided);
}

bool LintContext::is_sensitive(std::int32_t geometry) const {
  const auto at = std::size_t(geometry);
  return scene.geometry.light[at] >= 0 || materials[std::size_t(scene.geometry.material[at])].is_two_sided;
}

std::vector<Finding> lint(const LintSubject& subject, const LintEffort& effort) {
  const LintContext context(subject);
  Findings findings;
  check_camera(context, findings);
  check_lights(context, effort, findings);
  check_materials(context, findings);
  check_coincident_surfaces(context, findings);
  check_repeated_shapes(context, findings);
  check_rounding(context, findings);
  return findings.take();
}

}  // namespace etendue
