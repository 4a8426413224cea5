// What is odd about a scene as a whole: what a render would show, but not explain.
//
// To add a check: give it a row in the table in lint.cpp and a section in docs/lint.md, and let one of the
// functions of lint/checks.h find it.
#pragma once

#include "base/error.h"
#include "integrator/integrator.h"
#include "scene/scene.h"
#include "scene/scene_places.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// harmless: the image is what the file says, and that may be meant. doubtful: it is hardly what was meant.
/// wrong: the image lacks what the file has, or integrators disagree about it.
enum class Severity { harmless, doubtful, wrong };
std::string_view severity_name(Severity severity);

struct Check {
  std::string_view id;
  Severity severity;
  std::string_view meaning;
};
const std::vector<Check>& lint_checks();

/// One thing that is odd.
struct Finding {
  std::string_view id;  ///< Of the check that found it.
  Severity severity;
  Location where;                       ///< The object in the file.
  std::string problem;                  ///< What is wrong, on one line; it names the object.
  std::string remedy;                   ///< What to do.
  std::vector<std::int32_t> to_lift{};  ///< Ids of lights that render moves off what they lie in.
};

/// A scene and how it is to be rendered. Nothing of it is copied.
struct LintSubject {
  const Scene& scene;
  const ScenePlaces& places;
  const IntegratorSettings& integrator;
  int samples_per_pixel;
};

/// How long to look: each of this many lights is probed, evenly spaced among all.
struct LintEffort {
  std::int32_t most_lights;
};
inline constexpr LintEffort thorough{1 << 20}, brief{256};

/// All findings, in the same order in each run.
std::vector<Finding> lint(const LintSubject& subject, const LintEffort& effort);

/// How far (m) a light that lies in another surface is to be moved along its front, so that rays from the
/// camera and from all over the scene can tell the two apart: 32 roundings of the longest of them.
float lift_of_lights(const Scene& scene);

/// Why an image of the scene that is black everywhere is black: one sentence, in which the objects are named.
std::string reason_of_black_image(const LintSubject& subject);

struct Pixel {
  int x, y;
};
/// Of pixels in which no sample found light, how many show a surface that light does reach: their error bars
/// of 0 are too small. Looks at 256 of them at most, and scales up.
std::size_t count_lit_pixels(const LintSubject& subject, const std::vector<Pixel>& dark);

}  // namespace etendue
