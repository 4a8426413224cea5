#include "sampler/replicates.h"

#include "base/error.h"

#include <algorithm>
#include <fmt/format.h>

namespace etendue {

ReplicatesBy replicates_by_from_name(std::string_view name) {
  if (name == "block") return ReplicatesBy::block;
  if (name == "scrambling") return ReplicatesBy::scrambling;
  throw InputError({}, fmt::format("unknown way to make replicates '{}'", name),
                   known_names(name, {"block", "scrambling"}));
}

std::string_view replicates_by_name(ReplicatesBy by) {
  return by == ReplicatesBy::block ? "block" : "scrambling";
}

int default_replicates(int samples_per_pixel) {
  constexpr int least = 8, most_samples = 64;
  const int wanted = std::max(least, (samples_per_pixel - 1) / most_samples + 1);
  int best = samples_per_pixel;
  for (int d = 1; d <= samples_per_pixel / d; ++d) {
    if (samples_per_pixel % d != 0) continue;
    for (const int divisor : {d, samples_per_pixel / d})
      if (divisor >= wanted) best = std::min(best, divisor);
  }
  return best;
}

}  // namespace etendue
