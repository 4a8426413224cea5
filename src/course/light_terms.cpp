#include "course/light_terms.h"

#include <algorithm>

namespace etendue {

LightTerms right_terms(const LightPointFacts& facts) {
  const bool is_front = facts.cos_light > 0;
  return {facts.bsdf,
          is_front ? facts.radiance : Colorf{0, 0, 0},
          facts.is_visible ? 1.0 : 0.0,
          std::max(facts.cos_receiver, 0.0),
          std::max(facts.cos_light, 0.0),
          1 / (facts.distance * facts.distance),
          facts.area,
          1 / (facts.choice_probability * facts.points_per_sample),
          1};
}

}  // namespace etendue
