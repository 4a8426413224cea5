"""Do two noisy pictures of one scene agree? A z-test of block means, the noises of both estimated.

Blocks, not pixels: Nori splats a sample into all pixels within 2 px, so that neighbouring pixels share samples;
Etendue draws each pixel's samples from the pixel filter, so that its pixels are independent. The expectation is the
same but for two things at edges: Nori reads its filter from a table of 32 steps, and divides each pixel by its own
sum of weights. A mean of 16 x 16 pixels sees next to nothing of them. The outermost 2 px are left out: Nori has no
samples beyond the picture, so there its filter is cut off.

The noise of the mean over a block of n pixels, N samples a pixel:
- Ours: the sum of the pixels' squared standard errors / n^2.
- The reference's: a splatted sample spreads a total weight of 1 (to 1.4 %, the ripple of the pixels' grid) over the
  pixels around it, so a block's mean is that of all samples in it, whose positions are uniform in their pixels: its
  variance is the sum over pixels of Var_box / (N n^2), with Var_box of one sample somewhere in the pixel. (Samples at
  the block's rim count in part, which can only make it smaller.) We know Var_gauss, of one sample under the pixel
  filter: our squared standard error times our number of samples, which must be independent ones for that. The
  Gaussian is wider than the box, so Var_gauss also holds how the picture itself changes within a pixel or so: where
  that is nothing the two are equal, and elsewhere Var_gauss is the larger, so that the test loses power and gains no
  alarms.
- From the reference itself, as a check of that: in each block the means of 4 x 4 pixels of the difference, less a
  plane. What is left has 13 degrees of freedom, too few to judge single blocks at the level needed. So only its
  median ratio to what the estimates above predict is given, as `noise_ratio`, where the prediction knows that our
  noise is white and the reference's correlated by Nori's filter. About 1 where noise is due to light; below 1 where
  it is due to edges.
- There are two cases in which our samples do not tell the reference's noise. It may have been sampled in another way
  (a sphere light over its whole surface, say): then the median above is beyond SAMPLED_OTHERWISE. Or few samples find
  the light, and ours are those that did not: then a few pixels make up most of the block's difference, which is when
  (sum d^2)^2 / sum d^4 is below FEW_PIXELS, where normal noise would have 85. In these cases, and only there, since
  it takes what is really different for noise too, the scatter of the reference is taken instead where it is more,
  that of the block or of the 3 x 3 blocks around it.
- Light that few samples find: a block whose samples happened not to find it is too dark, and its standard errors,
  from what was found, too small by more. Its noise must be at least what its radiance implies. Contributions X of
  mean m have variance a m - m^2, where a = E[X^2] / E[X] is the size of the contributions, each weighted by what it
  gives. It is taken from the 3 x 3 blocks around, pooled, which have more finds than one block; m is that of the
  brighter picture, since both are estimates of the same mean. This is done only where it can matter: finds that a
  block should have UNSEEN of, it almost surely has some of (all but 5 in 100,000), so that UNSEEN a / (N n) is the
  most that it can be short of; where its standard error is larger than that, it stays as it is. The mean of the whole
  picture has all the finds there are, and keeps its standard error too.
- Where an edge's blur just reaches a pixel, perhaps none of our N samples found it, and our standard error is 0. One
  more sample could have: so the range of the picture over 5 x 5 pixels / N is added to each pixel's standard error
  (squared); next to nothing but there.
- Nori sums in single precision: ROUNDING, relative to the brightest channel, is added.

A picture of ours may take the reference's place. Then its own standard errors tell its noise.

No estimate helps where the variance is infinite: light samples where a surface meets a light, say, whose inverse
square grows without bound. Such a picture is too dark until very many samples. So it should not be the one of two.

Half of the false alarms may come from the blocks, half from the means of the whole picture.
"""
import math
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

BLOCK = 16
SUB_BLOCK = 4
RIM_PX = 2
ROUNDING = 2e-5
SAMPLED_OTHERWISE = 1.25
FEW_PIXELS = 25
UNSEEN = 10  # finds
MEDIAN_CHI2_13 = 12.3398  # of the chi-squared distribution with 13 degrees of freedom


@dataclass
class Picture:
    pixels: np.ndarray  # rows x columns x 3
    spp: int  # samples a pixel
    stderr: np.ndarray = None  # of the pixels; None: a reference of Nori's, sampled as ours is


@dataclass
class Comparison:
    blocks: int  # times channels
    max_z: float  # of a block
    worst_block_px: tuple  # x, y of its corner
    limit_z: float  # what max_z may be
    global_limit_z: float  # what global_z may be
    expected_max_z: float  # the median of max_z where the pictures agree
    rms_z: float
    global_z: float  # of the channel whose whole picture disagrees most
    global_difference: float  # of that channel, relative
    global_stderr: float  # relative
    noise_ratio: float
    p_value: float  # of max_z and global_z together, Sidak
    z_map: np.ndarray  # blocks down x across x 3

    @property
    def is_agreed(self):
        return self.max_z <= self.limit_z and abs(self.global_z) <= self.global_limit_z


def p_two_sided(z):
    return math.erfc(abs(z) / math.sqrt(2))


def z_two_sided(p):
    return -NormalDist().inv_cdf(p / 2)


def sidak(p, count):
    """Level of the least of `count` p-values."""
    return -math.expm1(count * math.log1p(-p)) if p < 1 else 1.0


def sidak_each(p, count):
    """The inverse: the level of each one of `count` for a level p of all."""
    return -math.expm1(math.log1p(-p) / count)


def block_sums(pixels, size):
    rows, columns = (np.arange(0, n, size) for n in pixels.shape[:2])
    return np.add.reduceat(np.add.reduceat(pixels, rows, axis=0), columns, axis=1)


def plane_remover():
    """16 x 16: takes a plane away from 4 x 4 values."""
    side = BLOCK // SUB_BLOCK
    y, x = np.mgrid[0:side, 0:side]
    plane = np.stack([np.ones(side * side), x.ravel(), y.ravel()], axis=1)
    return np.eye(side * side) - plane @ np.linalg.inv(plane.T @ plane) @ plane.T


def scatter_factor(lag_correlation):
    """Expected mean square of sub-block means less a plane, in units of the block mean's variance, for noise with the
    given correlation (up to a factor) over 0, 1, 2 ... px along each axis."""
    lags = np.abs(np.arange(BLOCK)[:, None] - np.arange(BLOCK)[None, :])
    pixels = np.concatenate([lag_correlation, np.zeros(BLOCK)])[lags]
    average = np.kron(np.eye(BLOCK // SUB_BLOCK), np.full((1, SUB_BLOCK), 1 / SUB_BLOCK))
    line = average @ pixels @ average.T
    square = np.kron(line, line)
    return np.trace(plane_remover() @ square) / 13 / square.mean()


def nori_lag_correlation():
    """Of the pixels of white noise splatted with Nori's Gaussian (radius 2 px, standard deviation 0.5 px)."""
    x = np.linspace(-8, 8, 16001)
    g = np.where(np.abs(x) < 2, np.exp(-2 * x * x) - math.exp(-8), 0)
    return np.array([np.sum(g * np.roll(g, 1000 * lag)) for lag in range(5)])


FACTOR_WHITE = scatter_factor(np.array([1.0]))
FACTOR_NORI = scatter_factor(nori_lag_correlation())


def sub_block_scatter(difference):
    """Mean square (13 degrees of freedom) for each block and channel. In place of a block that the picture's edge
    cuts, the whole one that ends there."""
    rows, columns = (np.minimum(np.arange(0, n, BLOCK), n - BLOCK)[:, None] + np.arange(BLOCK)
                     for n in difference.shape[:2])
    h, w = len(rows), len(columns)
    side = BLOCK // SUB_BLOCK
    whole_blocks = difference[np.ix_(rows.ravel(), columns.ravel())]
    means = whole_blocks.reshape(h, side, SUB_BLOCK, w, side, SUB_BLOCK, 3).mean(axis=(2, 5))
    flat = means.transpose(0, 2, 4, 1, 3)
    return np.sum((flat.reshape(h, w, 3, side * side) @ plane_remover()) ** 2, axis=3) / 13


def local_range(pixels):
    """Largest minus least over 5 x 5 pixels."""
    padded = np.pad(pixels, ((2, 2), (2, 2), (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, (5, 5), axis=(0, 1))
    return windows.max(axis=(3, 4)) - windows.min(axis=(3, 4))


def smoothed(blocks):
    """Means over 3 x 3 blocks."""
    padded = np.pad(blocks, ((1, 1), (1, 1), (0, 0)), mode="edge")
    return np.lib.stride_tricks.sliding_window_view(padded, (3, 3), axis=(0, 1)).mean(axis=(3, 4))


def z_of(difference, variance):
    """0 where both agree to the bit, infinite where they must and do not."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(difference == 0, 0.0, difference / np.sqrt(variance))


def variance_by_size(told, sums_of_squares, sums, mean, samples):
    """`told`, the variances of means over blocks of `samples` samples, or what the size of the contributions around
    implies where some may be unseen. All: blocks."""
    first = smoothed(sums)
    size = np.divide(smoothed(sums_of_squares), first, out=np.zeros_like(first), where=first > 0)
    can_be_short = UNSEEN * size / samples > np.sqrt(told)
    return np.where(can_be_short, np.maximum(told, (size * mean - mean ** 2) / samples), told)


def compare(ours, reference, level):
    """Two `Picture`s, ours with standard errors. `level`: how often pictures that agree may be told to disagree."""
    def inner(pixels):
        return pixels[RIM_PX:-RIM_PX, RIM_PX:-RIM_PX].astype(np.float64)

    def variances(picture):
        """(what the standard errors tell, at least what the contributions' size implies)"""
        pixels, stderr = inner(picture.pixels), inner(picture.stderr)
        told = block_sums(stderr ** 2 + (local_range(pixels) / picture.spp) ** 2, BLOCK) / counts ** 2
        squares = block_sums(picture.spp * stderr ** 2 + pixels ** 2, BLOCK)
        return told, variance_by_size(told, squares, block_sums(pixels, BLOCK), mean, counts * picture.spp)

    pixels, reference_pixels = inner(ours.pixels), inner(reference.pixels)
    counts = block_sums(np.ones_like(pixels), BLOCK)
    mean = np.maximum(block_sums(pixels, BLOCK), block_sums(reference_pixels, BLOCK)) / counts
    brightness = block_sums(np.abs(reference_pixels).max(axis=2, keepdims=True), BLOCK) / counts
    rounding = (ROUNDING * brightness) ** 2
    ours_told, ours_variance = variances(ours)
    if reference.stderr is None:
        factor, share = FACTOR_NORI, ours.spp / reference.spp
        reference_told, reference_variance = share * ours_told, share * ours_variance
    else:
        factor = FACTOR_WHITE
        reference_told, reference_variance = variances(reference)

    pixel_difference = pixels - reference_pixels
    scatter = sub_block_scatter(pixel_difference) * BLOCK ** 2 / counts
    predicted = FACTOR_WHITE * ours_told + factor * reference_told
    is_noisy = predicted > 100 * rounding
    ratio = np.median(scatter[is_noisy] / predicted[is_noisy]) / (MEDIAN_CHI2_13 / 13) if is_noisy.any() else math.nan
    is_few = block_sums(pixel_difference ** 2, BLOCK) ** 2 < FEW_PIXELS * block_sums(pixel_difference ** 4, BLOCK)
    is_untold = is_few | bool(ratio > SAMPLED_OTHERWISE)
    own = np.maximum(scatter - FACTOR_WHITE * ours_told, 0) / factor
    own = np.maximum(own, smoothed(own))
    reference_told, reference_variance = (np.where(is_untold, np.maximum(v, own), v)
                                          for v in (reference_told, reference_variance))

    total = ours_variance + reference_variance + rounding
    difference = block_sums(pixel_difference, BLOCK) / counts
    z = z_of(difference, total)
    area = counts / counts.sum(axis=(0, 1))
    whole = np.sum(area * difference, axis=(0, 1))
    whole_reference = np.sum(area * block_sums(reference_pixels, BLOCK) / counts, axis=(0, 1))
    whole_variance = np.sum(area ** 2 * (ours_told + reference_told), axis=(0, 1))
    whole_variance += (ROUNDING * whole_reference.max()) ** 2
    whole_z = z_of(whole, whole_variance)
    channel = int(np.argmax(np.abs(whole_z)))
    unit = whole_reference[channel] or math.inf

    worst = np.unravel_index(np.argmax(np.abs(z)), z.shape)
    half = sidak_each(level, 2)
    p_values = [sidak(p_two_sided(float(np.abs(a).max())), a.size) for a in (z, whole_z)]
    return Comparison(
        blocks=z.size, max_z=float(np.abs(z).max()),
        worst_block_px=(int(worst[1]) * BLOCK + RIM_PX, int(worst[0]) * BLOCK + RIM_PX),
        limit_z=z_two_sided(sidak_each(half, z.size)),
        global_limit_z=z_two_sided(sidak_each(half, whole_z.size)),
        expected_max_z=z_two_sided(sidak_each(0.5, z.size)), rms_z=float(np.sqrt(np.mean(z[total > 0] ** 2))),
        global_z=float(whole_z[channel]), global_difference=float(whole[channel] / unit),
        global_stderr=float(np.sqrt(whole_variance[channel]) / unit), noise_ratio=float(ratio),
        p_value=sidak(min(p_values), 2), z_map=z)


def is_right_way_round(ours, variance, reference):
    """Is no mirror image of the reference much more like our picture than the reference itself? `variance`: of a
    pixel of the difference. A picture that is its own mirror image is the right way round."""
    difference = [ours - m for m in (reference, reference[:, ::-1], reference[::-1], reference[::-1, ::-1])]
    noise = block_sums(variance, BLOCK) + variance.mean() * BLOCK * BLOCK / 100
    upright, *mirrored = (float(np.mean(block_sums(d, BLOCK) ** 2 / noise)) for d in difference)
    return all(upright < 1.2 * m for m in mirrored)
