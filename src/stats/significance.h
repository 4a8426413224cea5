// When a p-value rejects: one level for a whole family of tests (Sidak, Holm).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// The level for each of `tests` >= 1 independent tests such that all of them together reject a true
/// hypothesis with probability `level` in (0, 1) at most: 1 - (1 - level)^(1/tests) (Sidak 1967, "Rectangular
/// confidence regions for the means of multivariate normal distributions"), exact for tiny levels and many
/// tests too. Throws std::domain_error outside these ranges.
double sidak_level(double level, std::int64_t tests);

/// Whether a test, one of `tests`, rejects at the family-wise `level`. A NaN p-value (no test was possible)
/// is rejected: what could not be tested has not passed. Throws as sidak_level does.
bool is_rejected(double p_value, double level, std::int64_t tests = 1);

/// The p-values of a family, each raised so that those below a level are what Holm's procedure rejects at it:
/// then a true hypothesis is rejected with at most that probability, however the tests depend on one another
/// (Holm 1979, "A simple sequentially rejective multiple test procedure"). NaN, of tests that were not
/// possible, stays, and counts as no member of the family.
std::vector<double> holm_adjusted(std::span<const double> p_values);

}  // namespace etendue
