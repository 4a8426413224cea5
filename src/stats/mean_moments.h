// How well a mean of many samples is known, rare events among them; and whether two such means are the same.
#pragma once

#include "stats/t_test.h"

#include <span>

namespace etendue {

/// An estimate (a mean, or a sum of independent means), with moments of its own distribution as far as its
/// samples tell them. Of sums of independent estimates each moment is the sum.
struct MeanMoments {
  double mean = 0;
  double variance = 0;  ///< Of `mean`.
  double third = 0;     ///< Third central moment of `mean`.
  double variance_error_sq =
      0;  ///< Of `variance` as an estimate: its variance, at least that of normal values.

  MeanMoments& operator+=(const MeanMoments& other);
  /// Of the estimate times `factor`.
  MeanMoments scaled(double factor) const;
  /// How much one more of the events that make the estimate noisy would add to it: `third` over `variance`,
  /// the mean size of its steps by their squares. 0 where it has no variance.
  double step() const { return variance > 0 ? third / variance : 0; }
  double standard_error() const;
};

/// Of the mean of independent values of one distribution; all but the mean are NaN where there are fewer than
/// three.
MeanMoments moments_of_mean(std::span<const float> values);

/// The variance of a - b if both have one expectation. Where a mean is low because events are missing, its
/// variance is low with it: mean and variance of a skewed sample go together, with the slope third / variance
/// (Hall 1992, "On the removal of skewness by transformation", uses the same to first order). So the lower
/// mean's variance is taken for where the other one is; of Poisson counts this is exact. Never less than the
/// sum of both.
/// \param step_a, step_b least steps, for events that have not been seen; 0: none are known
double variance_if_same(const MeanMoments& a, const MeanMoments& b, double step_a, double step_b);

/// Two-sided test of "both estimates have the same expectation": Welch's (Welch 1947) with variance_if_same
/// and with the degrees of freedom that the estimates' variances are known by (Satterthwaite 1946), which
/// heavy tails lower. Means that differ by no more than the rounding of float samples are the same. p is NaN
/// where nothing is known of the variances.
MeanTest test_same_mean(const MeanMoments& a, const MeanMoments& b, double step_a = 0, double step_b = 0);

/// The smallest difference of the means that test_same_mean at `level` would find with probability 0.9.
double smallest_difference(const MeanMoments& a, const MeanMoments& b, double step_a, double step_b,
                           double level);

}  // namespace etendue
