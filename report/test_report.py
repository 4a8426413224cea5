#!/usr/bin/python3
"""Tests of the report's own arithmetic: `/usr/bin/python3 report/test_report.py`. They need no renderer."""
import sys
import unittest
from types import SimpleNamespace

sys.dont_write_bytecode = True

import numpy as np  # noqa: E402

from answers import one_in  # noqa: E402
from formulas import FORMULAS, as_image, formula  # noqa: E402
from images import luminance, pack, srgb, unpack  # noqa: E402
from intervals import Estimate, jackknife, mean_of, slope  # noqa: E402
from measure import FIRST_SEED, FULL, INTEGRATORS, QUICK, REFERENCE_SEED, minutes  # noqa: E402
from predict import hit_chance, relative_variances, spread  # noqa: E402
from variance import (Place, Sampled, convergence, half_maximum_angle_deg, highlight_width_px,  # noqa: E402
                      is_found, pixels_of, sampled, trimmed)
from words import interval, keyed, sig  # noqa: E402


def a_place(**values):
    """A place with these relative variances, known within 2 %; None for a mean that was not found."""
    methods = {i: Sampled(Estimate(v or 0.0, 0.01, 4), 1.0 if v else 0.0, 0.1, v is not None)
               for i, v in values.items()}
    return Place({}, 1.0, {"samples": methods, "time": methods})


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
            place = a_place(light=worse, direct=1.0)
            self.assertEqual(place.average_from_theory < place.variance("samples", place.best_single("samples")).value,
                             is_better)

    def test_no_best_where_the_mean_was_not_found(self):
        place = a_place(light=0.5, direct=None, average=0.7, mis=0.3)
        self.assertEqual(place.best("time"), ["mis"])
        self.assertEqual(place.best_single("time"), "light")
        black = sampled(np.zeros((5, 4, 4)), np.ones((4, 4)), 1e-6)
        self.assertFalse(black.is_found)
        self.assertFalse(sampled(np.zeros((5, 4, 4)), np.zeros((4, 4)), 0).is_found)

    def test_a_tie_has_no_single_best(self):
        self.assertEqual(a_place(light=1.0, direct=3.0, average=2.0, mis=1.01).best("samples"), ["light", "mis"])

    def test_found_within_four_errors(self):
        self.assertTrue(is_found(1.0, 0.1, 1.39, 0.01))
        self.assertFalse(is_found(1.0, 0.1, 1.42, 0.01))
        self.assertFalse(is_found(0.0, 0.0, 1.0, 0.5))

    def test_ratio_says_better_equal_or_worse(self):
        one = Estimate(1.0, 0.1, 4)
        said = [Estimate(v, 0.1, 4).over(one).compared for v in (0.5, 0.9, 1.1, 2.0)]
        self.assertEqual(said, ["better", "equal", "equal", "worse"])
        self.assertAlmostEqual(one.within, np.exp(2.776 * 0.1) - 1)

    def test_intervals_cover(self):
        """Of 400 intervals for a known variance of 1000 normal pixels; 95 % nominal. With this seed and 400 intervals
        fewer than 0.91 or more than 0.99 come by chance less than once in 3000 seeds."""
        random = np.random.default_rng(5)
        inside = {"jackknife": 0, "mean": 0}
        for _ in range(400):
            lum = random.normal(10, 2, (5, 1000))
            variance = sampled(lum, np.full(1000, 10.0), 0).relative_variance
            inside["jackknife"] += variance.low <= 0.04 <= variance.high
            mean = mean_of(random.normal(10, 0.5, 5))
            inside["mean"] += mean.low <= 10 <= mean.high
        for name, count in inside.items():
            self.assertTrue(0.91 <= count / 400 <= 0.99, f"{name}: {count / 400}")

    def test_convergence_has_no_point_where_the_mean_was_not_found(self):
        def render(spp, value, error):
            return SimpleNamespace(stats={"spp": spp},
                                   pixels=lambda: (np.full((8, 8, 3), value), np.full((8, 8, 3), error)))

        few = [render(8, 0.5, 0.01), render(16, 1.0, 0.2)]  # half of the light at 8
        measured = SimpleNamespace(convergence={i: few for i in INTEGRATORS} | {"mis": [render(16, 1.0, 0.1)]})
        curves = convergence(measured, {"regions": []})["image"]
        self.assertEqual([n for n, _ in curves["average"]], [16])
        self.assertAlmostEqual(curves["average"][0][1], 0.04)

    def test_jackknife_of_a_constant(self):
        self.assertEqual(jackknife(2.0, [2.0, 2.0, 2.0]).log_error, 0)

    def test_slope_of_a_power(self):
        rise, error = slope([0, 1, 2, 3], [5, 3.5, 2, 0.5])
        self.assertAlmostEqual(rise, -1.5)
        self.assertAlmostEqual(error, 0)
        self.assertAlmostEqual(slope([0, 1, 2, 3], [0, 1.1, 1.9, 3.0])[1], 4.303 * np.sqrt(0.018 / 2 / 5))

    def test_no_two_methods_share_a_seed(self):
        for effort in (FULL, QUICK):
            seeds = [REFERENCE_SEED] + [first + k for first in FIRST_SEED.values() for k in range(effort.seeds)]
            self.assertEqual(len(seeds), len(set(seeds)))

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


    def test_predicted_variances_against_sampling(self):
        """Drawn in space, not in the plane: within 12 % at these angles; the noise of the sampling is below 2 %."""
        random = np.random.default_rng(7)
        n, light, samples = 300, np.radians(2.0), 64
        edge = light + np.arccos(0.5 ** (1 / n))
        count = 3_000_000
        x, y = random.uniform(-edge, edge, (2, count))
        cos_alpha = random.random(count) ** (1 / (n + 1))
        alpha, phi = np.arccos(cos_alpha), random.uniform(0, 2 * np.pi, count)
        hits = np.hypot(x + alpha * np.cos(phi), y + alpha * np.sin(phi)) < light
        # E[X^2] of a pixel is its chance P, so the mean of P (1 - P) needs pairs of samples of one pixel
        other_alpha, other_phi = np.arccos(random.random(count) ** (1 / (n + 1))), random.uniform(0, 2 * np.pi, count)
        others = np.hypot(x + other_alpha * np.cos(other_phi), y + other_alpha * np.sin(other_phi)) < light
        direct = (hits.mean() - (hits & others).mean()) / hits.mean() ** 2 / samples
        # a point on the whole sphere of one of four lights; in the far half, or on another light, nothing
        cos_at_light = random.uniform(-1, 1, (2, count))
        around = random.uniform(0, 2 * np.pi, (2, count))
        at = light * np.sqrt(1 - cos_at_light ** 2)
        chosen = random.integers(0, 4, (2, count)) == 0
        away = np.hypot(x - at * np.cos(around), y - at * np.sin(around))
        first, second = np.where(chosen & (cos_at_light > 0), np.cos(away) ** n * cos_at_light, 0)
        area = ((first ** 2).mean() - (first * second).mean()) / first.mean() ** 2 / samples
        predicted = relative_variances(n, 2.0, 4, samples)
        self.assertAlmostEqual(predicted["direct"] / direct, 1, delta=0.12)
        self.assertAlmostEqual(predicted["light"] / area, 1, delta=0.12)


class Words(unittest.TestCase):
    def test_numbers(self):
        self.assertEqual([sig(v) for v in (0, 0.012345, 1.5, 1234.5, -2)], ["0", "0.0123", "1.50", "1\u00a0230", "−2.00"])
        self.assertEqual(sig(0.99996), "1.00")

    def test_numbers_carry_their_value(self):
        self.assertEqual(keyed("a/b", 1234.5), '<data data-key="a/b" value="1234.5">1\u00a0230</data>')
        self.assertIn('data-key="a/low"', interval("a", Estimate(1.0, 0.1, 4)))

    def test_time_left(self):
        self.assertEqual([minutes(s) for s in (42.4, 89, 91, 400)], ["42 s", "89 s", "2 min", "7 min"])

    def test_chances(self):
        self.assertEqual(one_in(0.99), "nearly every sample")
        self.assertEqual(one_in(0.01), "one sample in 100")

    def test_every_formula_is_drawn_and_spoken(self):
        for name, (_, spoken) in FORMULAS.items():
            self.assertIn(spoken[:20], formula(name))
            self.assertIn("data:image/svg+xml", as_image(formula(name)))


if __name__ == "__main__":
    unittest.main()
