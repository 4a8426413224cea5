#include "bsdf/glossy_lobes.h"

#include <algorithm>
#include <cmath>

namespace etendue {

void GlossyLobes::add(const GlossyLobe* lobe) {
  constexpr float least_roughness = 0x1p-10f;
  const bool has_lobe = lobe != nullptr && lobe->roughness >= least_roughness;
  has_lobe_.push_back(has_lobe ? 1 : 0);
  have_any_ = have_any_ || has_lobe;
  float narrowest = 1;
  for (int angle = 0; angle < ltc::angles; ++angle) {
    if (!has_lobe) {
      entries_.insert(entries_.end(), {1, 1, 0, 0, 0, 0});
      continue;
    }
    const float roughness = std::min(lobe->roughness, 1.0f);
    // The last row does for all that is smoother.
    const float place = std::min(-2 * std::log2(roughness), float(ltc::roughnesses - 1));
    const int before = std::min(int(place), ltc::roughnesses - 2);
    const auto value = [&](float ltc::Entry::*field) {
      const float low = lobe->table[std::size_t(before)][std::size_t(angle)].*field,
                  high = lobe->table[std::size_t(before + 1)][std::size_t(angle)].*field;
      return low + (high - low) * (place - float(before));
    };
    const float x = float(angle) / (ltc::angles - 1);
    using ltc::Entry;
    narrowest = std::min(narrowest, value(&Entry::a) * value(&Entry::b) * roughness * roughness);
    entries_.insert(entries_.end(), {value(&Entry::a) * roughness, value(&Entry::b) * roughness,
                                     value(&Entry::c) * roughness, value(&Entry::tan_tilt) * roughness,
                                     value(&Entry::albedo) * lobe->reflectance(1 - x * x), lobe->diffuse});
  }
  narrowest_.push_back(narrowest);
}

}  // namespace etendue
