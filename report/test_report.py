#!/usr/bin/python3
"""Tests of the report's own arithmetic: `/usr/bin/python3 report/test_report.py`. They need no renderer."""
import sys
import unittest
from types import SimpleNamespace

sys.dont_write_bytecode = True

import numpy as np  # noqa: E402

from answers import hit_chance, one_in, sig, spread  # noqa: E402
from formulas import FORMULAS, as_image, formula  # noqa: E402
from images import luminance, pack, srgb, unpack  # noqa: E402
from variance import Region, half_maximum_angle_deg, highlight_width_px, pixels_of, trimmed  # noqa: E402


class Packing(unittest.TestCase):
    def test_round_trip_keeps_values_and_errors(self):
        random = np.random.default_rng(1)
        rgb = 10 ** random.uniform(-3, 3, (32, 48, 1)) * random.uniform(0.2, 1, (32, 48, 3))
        stderr = rgb * 0.1
        back, error = unpack(pack(rgb, stderr))
        self.assertLess(np.abs(luminance(back) / luminance(rgb) - 1).max(), 0.006)
        self.assertLess(np.abs(back - rgb).max(axis=2).max() / rgb.max(), 0.02)
        self.assertLess(np.abs(error / luminance(stderr) - 1).max(), 0.095)

    def test_zero_stays_zero(self):
        back, error = unpack(pack(np.zeros((2, 2, 3)), np.zeros((2, 2, 3))))
        self.assertEqual(np.abs(back).max() + error.max(), 0)

    def test_srgb_of_known_values(self):
        self.assertEqual(srgb(np.array([0, 0.5, 1, 7])).tolist(), [0, 188, 255, 255])


class Statistics(unittest.TestCase):
    def test_trimmed_leaves_out_the_largest(self):
        values = np.ones(1000)
        values[17] = 1e9
        self.assertEqual(trimmed(values), 1)

    def test_regions_meet_without_overlap(self):
        left, right = pixels_of([0, 0, 0.34, 1], (4, 10)), pixels_of([0.34, 0, 1, 1], (4, 10))
        self.assertEqual(left[1].stop, right[1].start)

    def test_average_is_better_than_both_below_a_factor_of_three(self):
        for worse, is_better in ((2.9, True), (3.1, False)):
            region = Region({}, 1, {"light": worse, "direct": 1.0})
            self.assertEqual(region.average_from_theory < region.best_single, is_better)

    def test_width_of_a_gaussian_highlight(self):
        x, y = np.meshgrid(np.arange(200), np.arange(60))
        image = np.exp(-((x - 90) ** 2 + (y - 30) ** 2) / (2 * 20 ** 2))
        width = highlight_width_px(SimpleNamespace(reference=image), [0.3, 0.2, 0.6, 0.8])
        self.assertAlmostEqual(width, 2.355 * 20, delta=2.5)

    def test_half_maximum_of_a_small_and_of_a_large_light(self):
        lobe_deg = np.degrees(np.sqrt(2 * np.log(2) / 100))
        self.assertAlmostEqual(half_maximum_angle_deg(100, 0.1), lobe_deg, delta=0.1)
        self.assertAlmostEqual(half_maximum_angle_deg(1e4, 10), 10, delta=0.2)


class Phong(unittest.TestCase):
    def test_chance_and_spread_against_sampling(self):
        random = np.random.default_rng(2)
        n, half_angle_deg = 10, 20.0
        cos_limit = np.cos(np.radians(half_angle_deg))
        cos_alpha = random.random(200_000) ** (1 / (n + 1))
        self.assertAlmostEqual((cos_alpha > cos_limit).mean(), hit_chance(n, half_angle_deg), delta=0.005)
        lobe = random.uniform(cos_limit, 1, 200_000) ** n
        self.assertAlmostEqual((lobe ** 2).mean() / lobe.mean() ** 2, spread(n, half_angle_deg), delta=0.01)


class Words(unittest.TestCase):
    def test_numbers(self):
        self.assertEqual([sig(v) for v in (0, 0.012345, 1.5, 1234.5, -2)], ["0", "0.0123", "1.50", "1 230", "−2.00"])
        self.assertEqual(sig(0.99996), "1.00")

    def test_chances(self):
        self.assertEqual(one_in(0.99), "nearly every sample")
        self.assertEqual(one_in(0.01), "one sample in 100")

    def test_every_formula_is_drawn_and_spoken(self):
        for name, (_, spoken) in FORMULAS.items():
            self.assertIn(spoken[:20], formula(name))
            self.assertIn("data:image/svg+xml", as_image(formula(name)))


if __name__ == "__main__":
    unittest.main()
