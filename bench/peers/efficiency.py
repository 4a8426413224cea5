"""How much a renderer makes of its time: efficiency = 1 / (relative variance x seconds), from images of several seeds.

Arrays of images are seeds x height x width x 3; what is compared is luminance, unless said otherwise.
"""
import math
import statistics
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2] / "report"))
from intervals import Estimate, jackknife, mean_of  # noqa: E402

LUMINANCE = np.array([0.212671, 0.715160, 0.072169])  # of linear Rec. 709
WORST_SHARE = 0.001  # of the pixels, which robust figures leave out
MEANS_WITHIN = 0.01  # of each other, or within so many standard errors; else a row is void
MEANS_WITHIN_ERRORS = 4
BLOCK_PX = 16
# Two-sided chance that any block of two right images is found to differ, were their block means normal
FALSE_ALARM = 1e-4


def luminance(images):
    return np.asarray(images, float) @ LUMINANCE


def relative_variance(luminances, is_robust=False):
    """Mean over pixels of the variance between seeds, over the square of the mean; its interval by leaving out each seed
    in turn. Robust: without the pixels of the largest variance."""
    def figure(stack):
        variance = stack.var(axis=0, ddof=1).ravel()
        if is_robust:
            keep = variance.size - math.ceil(variance.size * WORST_SHARE)
            variance = np.partition(variance, keep - 1)[:keep]
        return float(variance.mean()) / scale

    scale = float(luminances.mean()) ** 2
    return jackknife(figure(luminances), [figure(np.delete(luminances, k, axis=0)) for k in range(len(luminances))])


def efficiency(variance, seconds):
    """From a relative variance and one time a seed."""
    product = variance.times(mean_of(seconds))
    return Estimate(1 / product.value, product.log_error, product.degrees)


@dataclass(frozen=True)
class Agreement:
    """How far two renderers' images are apart."""
    ratio: float  # of the mean luminances
    ratio_error: float  # its standard error
    worst_block: tuple  # column and row, from the upper left, in blocks
    worst_z: float  # of that block: the difference over its standard error
    z_limit: float  # what chance does not exceed

    def what_differs(self):
        """In words; empty where the two agree."""
        apart = abs(self.ratio - 1)
        if apart > MEANS_WITHIN and apart > MEANS_WITHIN_ERRORS * self.ratio_error:
            return f"means differ by {100 * apart:.1f} %"
        if self.worst_z > self.z_limit:
            return f"block {self.worst_block} differs by {self.worst_z:.1f} standard errors"
        return ""


def block_means(stack):
    """The mean of each full block of pixels, and the standard error of its mean over seeds: pixels are independent."""
    seeds, height, width = stack.shape
    rows, columns = height // BLOCK_PX, width // BLOCK_PX
    cut = stack[:, :rows * BLOCK_PX, :columns * BLOCK_PX]
    blocks = cut.reshape(seeds, rows, BLOCK_PX, columns, BLOCK_PX)
    variance = blocks.var(axis=0, ddof=1).mean(axis=(1, 3)) / (BLOCK_PX**2 * seeds)
    return blocks.mean(axis=(0, 2, 4)), np.sqrt(variance)


def agreement(ours, theirs):
    """Of two stacks of luminances. Equal noise-free blocks agree."""
    ours, theirs = np.asarray(ours), np.asarray(theirs)
    (mean_a, error_a), (mean_b, error_b) = block_means(ours), block_means(theirs)
    error = np.hypot(error_a, error_b) + 1e-5 * (abs(mean_a) + abs(mean_b)) + 1e-12  # sums of floats are not exact
    z = abs(mean_a - mean_b) / error
    row, column = np.unravel_index(z.argmax(), z.shape)
    level = 1 - (1 - FALSE_ALARM) ** (1 / z.size)
    ratio = float(ours.mean() / theirs.mean())
    ratio_error = math.hypot(mean_error(ours), mean_error(theirs))
    return Agreement(ratio, ratio_error, (int(column), int(row)), float(z.max()),
                     statistics.NormalDist().inv_cdf(1 - level / 2))


def mean_error(stack):
    """Relative standard error of the mean of a stack; pixels are independent."""
    return math.sqrt(stack.var(axis=0, ddof=1).mean() / stack.size) / stack.mean()
