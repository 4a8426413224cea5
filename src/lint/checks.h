// The checks of a scene, by subject.
#pragma once

#include "lint/lint.h"
#include "lint/probe.h"

#include <string>
#include <string_view>
#include <vector>

namespace etendue {

class Findings {
 public:
  /// \param id of the table
  void add(std::string_view id, const Location& where, std::string problem, std::string remedy,
           std::vector<std::int32_t> to_lift = {});
  std::size_t count() const { return all_.size(); }
  std::vector<Finding> take() { return std::move(all_); }

 private:
  std::vector<Finding> all_;
};

/// What all checks know of the subject.
struct LintContext {
  explicit LintContext(const LintSubject& subject);

  const LintSubject& subject;
  const Scene& scene;
  const ScenePlaces& places;
  std::vector<MaterialFacts> materials;
  View view;

  const MaterialFacts& material_of(const ProbeHit& hit) const;
  /// Whether a surface, seen from this side, scatters light at all.
  bool can_be_lit(const ProbeHit& hit) const;
  /// Whether it matters which is met first of this shape and another in the same place: of lights and
  /// dielectrics.
  bool is_sensitive(std::int32_t geometry) const;
};

void check_camera(const LintContext& context, Findings& findings);
void check_lights(const LintContext& context, const LintEffort& effort, Findings& findings);
void check_materials(const LintContext& context, Findings& findings);
void check_coincident_surfaces(const LintContext& context, Findings& findings);
void check_repeated_shapes(const LintContext& context, Findings& findings);
void check_rounding(const LintContext& context, Findings& findings);

}  // namespace etendue
