// Mistakes in the terms of a light sample, held against the very values of single samples.
#pragma once

#include "course/light_mistakes.h"
#include "course/probe_evidence.h"

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Mistakes made together, and how well they fit.
struct TermFit {
  std::vector<const TermMistake*> mistakes;
  double factor = 1;        ///< By which all is multiplied beside them.
  std::int64_t misses = 0;  ///< Samples whose value they do not give.

  bool is_of_one_class() const;
  /// Of misses, and of how much was assumed: less is better. In nats.
  double cost() const;
};

/// What the mistakes of a fit make of a sample.
Colorf predicted(const SampleEvidence& sample, const TermFit& fit);

struct TermFits {
  std::int64_t samples = 0;   ///< Compared.
  std::int64_t wrong = 0;     ///< Misses of no mistake at all.
  std::vector<TermFit> best;  ///< Of each set of classes the best way to make them, cheapest first.
};

/// Tries no mistake, each, and each two of them.
TermFits fit_terms(const ProbeEvidence& evidence, std::span<const SampleEvidence> samples);

}  // namespace etendue
