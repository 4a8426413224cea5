#!/usr/bin/python3
"""The arithmetic of efficiency.py on arrays whose answers are known. Seeds are fixed; the bounds of the statistical ones
are so wide that a fresh seed would fail one in 1e5 times."""
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from efficiency import agreement, efficiency, luminance, relative_variance  # noqa: E402


def noisy(seed, spread, shape=(8, 64, 64), mean=2.0):
    return np.random.default_rng(seed).normal(mean, spread, shape)


class Efficiency(unittest.TestCase):
    def test_relative_variance_of_two_values(self):
        stack = np.array([[[1.0, 3.0]], [[3.0, 5.0]]])  # each pixel has variance 2; the mean is 3
        self.assertAlmostEqual(relative_variance(np.concatenate([stack, stack[:1]])).value,
                               np.var([1, 3, 1], ddof=1) / np.mean([[1, 3, 1], [3, 5, 3]]) ** 2)

    def test_relative_variance_of_noise(self):
        found = relative_variance(noisy(1, 0.4))
        self.assertAlmostEqual(found.value, 0.04, delta=0.04 * 4.5 * np.sqrt(2 / (7 * 64 * 64)))

    def test_interval_holds_the_truth_as_often_as_it_says(self):
        inside = 0
        for seed in range(200):
            found = relative_variance(noisy(seed, 0.4, (6, 16, 16)))
            inside += found.low <= 0.04 <= found.high
        # Of 200 at 95 %: 190, standard deviation 3.1; the jackknife is a little careful.
        self.assertGreaterEqual(inside, 177)

    def test_robust_leaves_the_worst_pixels_out(self):
        stack = noisy(2, 0.4)
        stack[:, 3, 5] += np.arange(8) * 1000.0 - 3500
        self.assertGreater(relative_variance(stack).value, 1)
        self.assertAlmostEqual(relative_variance(stack, is_robust=True).value, 0.04, delta=0.004)

    def test_efficiency_is_one_over_variance_times_time(self):
        variance = relative_variance(noisy(3, 0.4))
        found = efficiency(variance, [0.5, 0.5, 0.5, 0.5])
        self.assertAlmostEqual(found.value, 1 / (variance.value * 0.5))
        self.assertAlmostEqual(found.log_error, variance.log_error)
        self.assertGreater(efficiency(variance, [0.4, 0.6, 0.4, 0.6]).log_error, variance.log_error)

    def test_luminance(self):
        self.assertAlmostEqual(float(luminance([1.0, 1.0, 1.0])), 1, places=5)


class Agreement(unittest.TestCase):
    def test_same_expectation_agrees(self):
        self.assertEqual(agreement(noisy(4, 0.4), noisy(5, 0.1)).what_differs(), "")
        self.assertEqual(agreement(np.full((6, 32, 32), 2.0), np.full((6, 32, 32), 2.0)).what_differs(), "")

    def test_brighter_by_two_per_cent_is_found(self):
        self.assertIn("means differ by 2.", agreement(noisy(6, 0.4, mean=2.04), noisy(7, 0.4)).what_differs())

    def test_noise_of_the_mean_is_no_difference(self):
        self.assertEqual(agreement(noisy(8, 80.0), noisy(9, 80.0)).what_differs(), "")

    def test_one_block_that_is_off_is_found_and_named(self):
        ours = noisy(10, 0.1)
        ours[:, 16:32, 48:64] += 0.03
        self.assertIn("block (3, 1)", agreement(ours, noisy(11, 0.1)).what_differs())


if __name__ == "__main__":
    unittest.main()
