"""Variances, relative variances and efficiencies from measured images."""
from dataclasses import dataclass

import numpy as np

from images import luminance
from measure import INTEGRATORS


@dataclass
class Method:
    """What one integrator reached in one scene at equal samples."""
    seconds: float
    spp: int
    samples_per_second: float
    relative_variance: float          # from independent seeds
    relative_variance_trimmed: float  # the same without the worst 0.1 % of pixels
    relative_variance_stderr: float   # from the standard errors over replicates
    error_to_reference: float         # mean squared error against the reference / (mean luminance)^2
    mean: float                       # mean luminance over all seeds
    mean_error: float                 # its standard error: pixels are independent

    @property
    def efficiency(self):
        return 1 / (self.relative_variance * self.seconds)

    @property
    def efficiency_trimmed(self):
        return 1 / (self.relative_variance_trimmed * self.seconds)


@dataclass
class EqualTime:
    seconds: float
    spp: int
    relative_variance: float  # from the standard errors over replicates
    error_to_reference: float


@dataclass
class Scene:
    methods: dict
    equal_time: dict
    variance: dict      # integrator -> variance of a pixel's luminance at equal samples, per pixel
    reference: np.ndarray  # luminance
    worst_time_mismatch: float


def trimmed(values, left_out=0.001):
    """The mean without the largest values."""
    keep = values.size - int(np.ceil(values.size * left_out))
    return np.partition(values.ravel(), keep - 1)[:keep].mean()


def evaluate(measured):
    reference = luminance(measured.reference.pixels()[0].astype(np.float64))
    mean_sq = reference.mean() ** 2
    methods, equal_time, variances = {}, {}, {}
    for i in INTEGRATORS:
        renders = measured.equal_samples[i]
        pixels = [r.pixels() for r in renders]
        lum = np.stack([luminance(p[0].astype(np.float64)) for p in pixels])
        variance = lum.var(axis=0, ddof=1)
        from_stderr = np.mean([luminance(p[1].astype(np.float64)) ** 2 for p in pixels], axis=0)
        stats = renders[0].stats
        seconds = measured.seconds(i)
        methods[i] = Method(
            seconds=seconds, spp=stats["spp"], samples_per_second=stats["samples"] / seconds,
            relative_variance=variance.mean() / mean_sq, relative_variance_trimmed=trimmed(variance) / mean_sq,
            relative_variance_stderr=from_stderr.mean() / mean_sq,
            error_to_reference=((lum[0] - reference) ** 2).mean() / mean_sq,
            mean=lum.mean(), mean_error=np.sqrt(variance.mean() / lum.size))
        variances[i] = variance
        timed = measured.equal_time[i]
        rgb, stderr = (p.astype(np.float64) for p in timed.pixels())
        equal_time[i] = EqualTime(timed.stats["seconds_render"], timed.stats["spp"],
                                  (luminance(stderr) ** 2).mean() / mean_sq,
                                  ((luminance(rgb) - reference) ** 2).mean() / mean_sq)
    seconds = [t.seconds for t in equal_time.values()]
    return Scene(methods, equal_time, variances, reference, max(seconds) / min(seconds) - 1)


def pixels_of(rect, shape):
    """Slices of the pixels whose centres lie in a rectangle given in image fractions."""
    x0, y0, x1, y1 = rect
    h, w = shape
    return (slice(int(np.ceil(y0 * h - 0.5)), int(np.ceil(y1 * h - 0.5))),
            slice(int(np.ceil(x0 * w - 0.5)), int(np.ceil(x1 * w - 0.5))))


@dataclass
class Region:
    """The pixels of one place: relative variance = mean variance / (mean luminance of the place)^2."""
    info: dict
    mean: float
    relative_variance: dict

    @property
    def average_from_theory(self):
        """(Var A + Var B) / 4."""
        return (self.relative_variance["light"] + self.relative_variance["direct"]) / 4

    @property
    def best_single(self):
        return min(self.relative_variance["light"], self.relative_variance["direct"])


def evaluate_regions(scene, regions):
    found = []
    for info in regions:
        where = pixels_of(info["rect"], scene.reference.shape)
        if scene.reference[where].size == 0:
            raise ValueError(f"region {info} holds no pixel of the image")
        mean = scene.reference[where].mean()
        found.append(Region(info, mean, {i: scene.variance[i][where].mean() / mean ** 2 for i in INTEGRATORS}))
    return found


def half_maximum_angle_deg(n, half_angle_deg):
    """Where a round light with that half angle, blurred by the lobe cos^n, has fallen to half of its maximum. The
    lobe must not be narrower than a thirtieth of the light."""
    light = np.radians(half_angle_deg)
    step = np.linspace(-light, light, 61)
    x, y = np.meshgrid(step, step)
    disc = np.hypot(x, y) <= light
    angles = np.linspace(0, light + 4 / np.sqrt(n), 400)
    seen = np.array([np.exp(-n / 2 * ((x[disc] - a) ** 2 + y[disc] ** 2)).sum() for a in angles])
    return np.degrees(angles[np.argmax(seen < seen[0] / 2)])


def highlight_width_px(scene, rect):
    """Width of a highlight at half of its maximum, in pixels: of the mean of the rows in the middle third of its
    rectangle, smoothed over a twelfth of its width against the noise of the reference."""
    h, w = scene.reference.shape
    third = (rect[3] - rect[1]) / 3
    rows = slice(int((rect[1] + third) * h), int(np.ceil((rect[3] - third) * h)))
    blur = max(1, round((rect[2] - rect[0]) * w / 12))
    profile = np.convolve(scene.reference[rows].mean(axis=0), np.full(blur, 1 / blur), "same")
    left, right = int(rect[0] * w), int(np.ceil(rect[2] * w))
    peak = left + int(np.argmax(profile[left:right]))
    half = profile[peak] / 2
    first = last = peak
    while first > 0 and profile[first - 1] >= half:
        first -= 1
    while last < w - 1 and profile[last + 1] >= half:
        last += 1
    return last - first + 1
