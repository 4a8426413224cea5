#!/usr/bin/python3
"""Is scripts/image_blocks.py right on made-up pictures whose means are known? The random numbers are always the same;
with others one comparison in 10,000 of pictures that agree would tell otherwise."""
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from image_blocks import Picture, compare  # noqa: E402

LEVEL = 1e-4
SIZE = (260, 388)  # 16 x 24 blocks and the rim
REPLICATES = 8


def radiance():
    """Falls from 1 to 0.02 across."""
    return np.broadcast_to(np.geomspace(1, 0.02, SIZE[1]), SIZE).copy()


def picture(rng, spp, contribution, mean):
    """Of samples that give either `contribution` or nothing; grey."""
    finds = rng.binomial(spp // REPLICATES, mean / contribution, size=(REPLICATES, *SIZE))
    means = finds * (contribution * REPLICATES / spp)
    pixels, stderr = means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(REPLICATES)
    return Picture(np.stack([pixels] * 3, axis=2), spp, np.stack([stderr] * 3, axis=2))


class ImageBlocks(unittest.TestCase):
    def setUp(self):
        self.rng = np.random.default_rng(1)

    def test_pictures_of_one_scene_agree(self):
        found = compare(picture(self.rng, 64, 2, radiance()), picture(self.rng, 256, 2, radiance()), LEVEL)
        self.assertTrue(found.is_agreed)
        self.assertAlmostEqual(found.rms_z, 1, delta=0.15)

    def test_light_that_few_samples_find_is_noise(self):
        # 0.8 to 41 finds in a block: of the darkest blocks nearly a half has none, and so no standard error.
        rare = picture(self.rng, 64, 400, radiance())
        well_known = picture(self.rng, 4096, 2, radiance())
        for pair in ((rare, well_known), (well_known, rare)):
            self.assertTrue(compare(*pair, LEVEL).is_agreed)

    def test_darker_by_one_percent_everywhere_is_seen(self):
        found = compare(picture(self.rng, 64, 2, radiance()), picture(self.rng, 64, 2, 0.99 * radiance()), LEVEL)
        self.assertGreater(found.global_z, found.global_limit_z)

    def test_darker_by_one_percent_in_one_corner_is_seen(self):
        mean = radiance()
        mean[-68:, :68] *= 0.99
        found = compare(picture(self.rng, 16384, 2, radiance()), picture(self.rng, 16384, 2, mean), LEVEL)
        self.assertGreater(found.max_z, found.limit_z)

    def test_rare_light_that_is_left_out_is_seen(self):
        mean = radiance()
        mean[100:164] *= 0.5
        found = compare(picture(self.rng, 4096, 2, radiance()), picture(self.rng, 4096, 20, mean), LEVEL)
        self.assertGreater(found.max_z, found.limit_z)


if __name__ == "__main__":
    unittest.main()
