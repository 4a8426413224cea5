#include "lint/checks.h"

#include <fmt/format.h>

namespace etendue {

namespace {

/// What reflects more than this is more than rounding above 1.
constexpr float above_one = 1.0001f;

void check_albedo(const LintContext& context, Findings& findings) {
  for (std::size_t id = 0; id < context.materials.size(); ++id) {
    const MaterialFacts& material = context.materials[id];
    const float largest = material.largest_albedo();
    if (largest <= above_one || material.is_dirac) continue;
    constexpr float hardly_meant = 2;
    const bool is_phong = std::holds_alternative<Phong>(context.scene.materials[std::int32_t(id)]);
    const std::string problem =
        fmt::format("this surface reflects up to {:.3g} times the light that it gets ({})", largest,
                    is_phong ? "kd + ks" : "albedo");
    if (largest > hardly_meant)
      findings.add("albedo-above-2", context.places.materials[id], problem,
                   "reflectances are fractions from 0 to 1: divide values from 0 to 255 by 255");
    else
      findings.add("albedo-above-1", context.places.materials[id], problem,
                   is_phong
                       ? "keep kd + ks at most 1 in each channel: light that is reflected again and again "
                         "grows else"
                       : "keep it at most 1: light that is reflected again and again grows else");
  }
}

/// Whether paths from what the camera sees ever lose light: they leave the scene or meet what absorbs.
bool loses_light(const LintContext& context) {
  ProbeNumbers numbers(3);
  int vertices = 0, sources = 0;
  constexpr int walks = 64, length = 32;
  for (int walk = 0; walk < walks; ++walk) {
    std::optional<ProbeHit> at = context.view.rays[std::size_t(4 * walk)].hit;
    for (int k = 0; k < length; ++k) {
      if (!at || !context.can_be_lit(*at)) return true;
      const MaterialFacts& material = context.material_of(*at);
      if (material.is_absorbing || material.largest_albedo() < 1) return true;
      ++vertices;
      sources += !material.is_dirac;
      at = probe(context.scene, ray_from(*at, next_direction(*at, material, numbers)));
    }
  }
  // Halls of mirrors have a lamp or a floor somewhere.
  return 2 * sources < vertices;
}

void check_light_kept_in(const LintContext& context, Findings& findings) {
  const PathRules* rules = context.subject.integrator.path_rules();
  if (!rules || rules->length() != PathLength::unlimited || context.scene.medium || context.view.hits == 0)
    return;
  if (loses_light(context)) return;
  for (const View::Seen& seen : context.view.rays)
    if (seen.hit) {
      const auto id = std::size_t(seen.hit->vertex.material);
      findings.add(
          "light-kept-in", context.places.materials[id],
          fmt::format("closed surfaces of albedo {:.3g} all around: no light is ever lost, so the answer is "
                      "infinite; images only show where paths ended",
                      context.materials[id].largest_albedo()),
          "give surfaces an albedo below 1, or open the space");
      return;
    }
}

}  // namespace

void check_materials(const LintContext& context, Findings& findings) {
  check_albedo(context, findings);
  check_light_kept_in(context, findings);
}

}  // namespace etendue
