// Is a mean what it should be? Student's t-test, Welch's for two samples, the z-test, and Student's interval.
#pragma once

#include "stats/running.h"

namespace etendue {

/// What a test found. Judge it with is_rejected (stats/significance.h).
struct MeanTest {
  double statistic = 0;           ///< Deviation in standard errors, signed.
  double degrees_of_freedom = 0;  ///< Infinite for the z-test; 0 where no test was possible.
  /// Probability of at least this deviation, either way, if the null hypothesis holds. NaN where no test was
  /// possible: fewer than 2 values (their spread is unknown), or a value that is NaN or infinite.
  double p_value = 0;
};

/// Student's one-sample t-test of "the mean is `reference`", two-sided (Student 1908). The variance is taken
/// as at least `variance_floor` >= 0, as some published test files require; without a floor, a sample of zero
/// variance has p = 1 where its mean equals the reference and p = 0 otherwise.
MeanTest t_test(const RunningStatistics& sample, double reference, double variance_floor = 0);

/// Welch's test of "both samples have the same mean", two-sided, variances not assumed equal (Welch 1947,
/// "The generalization of 'Student's' problem when several different population variances are involved";
/// degrees of freedom by Satterthwaite 1946). If both variances are zero: p = 1 where the means are equal,
/// else p = 0.
MeanTest welch_t_test(const RunningStatistics& a, const RunningStatistics& b);

/// Two-sided test of "the expectation of `value` is `reference`" for a normal value whose `standard_error` >=
/// 0 is known. Zero standard error: p = 1 where the two are equal, else p = 0. A negative one: NaN.
MeanTest z_test(double value, double reference, double standard_error);

struct Interval {
  double lower = 0, upper = 0;
};

/// Contains the true mean of a normal sample with probability `confidence` in (0, 1). The whole line where
/// count < 2; a single point where the sample's variance is zero; NaN where the sample holds a NaN or an
/// infinity. Throws std::domain_error for a confidence outside its range.
Interval student_t_interval(const RunningStatistics& sample, double confidence);

}  // namespace etendue
