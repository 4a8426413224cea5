#include "render/invalid_samples.h"

#include <algorithm>
#include <tuple>

namespace etendue {

namespace {

bool is_before(const InvalidSample& a, const InvalidSample& b) {
  return std::tie(a.y, a.x, a.replicate, a.index) < std::tie(b.y, b.x, b.replicate, b.index);
}

}  // namespace

void InvalidSamples::add(const InvalidSample& sample) {
  ++count_;
  note(sample);
}

void InvalidSamples::add(const InvalidSamples& others) {
  count_ += others.count_;
  for (const InvalidSample& sample : others.first_) note(sample);
}

void InvalidSamples::note(const InvalidSample& sample) {
  const auto at = std::upper_bound(first_.begin(), first_.end(), sample, is_before);
  if (at == first_.end() && first_.size() == most_noted) return;
  first_.insert(at, sample);
  if (first_.size() > most_noted) first_.pop_back();
}

}  // namespace etendue
