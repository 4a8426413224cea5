"""Relative variances of measured images, by place and method, with their intervals."""
import math
from dataclasses import dataclass

import numpy as np

from images import luminance
from intervals import Estimate, jackknife, mean_of, slope
from measure import INTEGRATORS

BUDGETS = ("samples", "time")
# A method's mean counts as found where it lies within so many standard errors of the reference's.
FOUND_WITHIN = 4


@dataclass
class Sampled:
    """What one method reached in one place at one budget."""
    relative_variance: Estimate  # mean over pixels of the variance between seeds / (mean luminance of the place)^2
    mean: float                  # mean luminance over all seeds
    mean_error: float            # its standard error: pixels are independent
    is_found: bool               # whether that mean is the reference's; if not, its variance says nothing


@dataclass
class Place:
    """A rectangle of the image: a whole image, or the pixels around a highlight."""
    info: dict
    mean: float    # luminance of the reference
    sampled: dict  # budget -> integrator -> Sampled

    def variance(self, budget, integrator):
        return self.sampled[budget][integrator].relative_variance

    def found(self, budget):
        return [i for i in INTEGRATORS if self.sampled[budget][i].is_found]

    def best_single(self, budget):
        """The better one of `light` and `direct`, if any has found the mean."""
        found = [i for i in ("light", "direct") if self.sampled[budget][i].is_found]
        return min(found or ("light", "direct"), key=lambda i: self.variance(budget, i).value)

    def over_best(self, budget, integrator):
        """Variance of a method over that of the better one of `light` and `direct`."""
        return self.variance(budget, integrator).over(self.variance(budget, self.best_single(budget)))

    def best(self, budget):
        """The best method, and those that cannot be told from it; none where no method found the mean."""
        found = self.found(budget)
        if not found:
            return []
        first = min(found, key=lambda i: self.variance(budget, i).value)
        return [i for i in found if i == first
                or self.variance(budget, i).over(self.variance(budget, first)).compared == "equal"]

    @property
    def average_from_theory(self):
        """(Var A + Var B) / 4, at equal samples."""
        return sum(self.variance("samples", i).value for i in ("light", "direct")) / 4


@dataclass
class Method:
    """What holds for a method in the whole image at one budget."""
    spp: int
    seconds: Estimate                 # processor time of one render
    relative_variance_trimmed: float  # without the worst 0.1 % of the pixels
    relative_variance_stderr: float   # all pixels, from the standard errors over replicates
    error_to_reference: float         # all pixels: mean squared error against the reference / (mean luminance)^2


@dataclass
class Scene:
    methods: dict          # budget -> integrator -> Method
    whole: Place           # all pixels
    lit: Place             # those that do not show the lights themselves
    places: list
    convergence: dict      # "image" or (plate, light) -> integrator -> list of (samples a pixel, relative variance)
    reference: np.ndarray  # luminance
    lights_end: float      # share of the image's height that shows the lights

    @property
    def worst_time_mismatch(self):
        seconds = [m.seconds.value for m in self.methods["time"].values()]
        return max(seconds) / min(seconds) - 1


def trimmed(values, left_out=0.001):
    """The mean without the largest values."""
    keep = values.size - int(np.ceil(values.size * left_out))
    return np.partition(values.ravel(), keep - 1)[:keep].mean()


def seed_variance(lum):
    """Mean over pixels of the variance between seeds, and the same with each seed left out."""
    total = lum.var(axis=0, ddof=1).mean()
    return total, [np.delete(lum, k, axis=0).var(axis=0, ddof=1).mean() for k in range(len(lum))]


def sampled(lum, reference, reference_error):
    """`lum` has the luminances of the place for each seed; the reference is that of the same pixels, with the standard
    error of its mean."""
    total, left_out = seed_variance(lum)
    mean, scale = lum.mean(), reference.mean() ** 2
    error = math.sqrt(total / lum.size)
    if scale == 0:  # black in the reference
        return Sampled(Estimate(0.0, 0.0, len(lum) - 1), mean, error, False)
    return Sampled(jackknife(total / scale, [v / scale for v in left_out]), mean, error,
                   is_found(mean, error, reference.mean(), reference_error))


def is_found(mean, error, reference, reference_error):
    return mean > 0 and abs(mean - reference) <= FOUND_WITHIN * math.hypot(error, reference_error)


def evaluate(measured, layout):
    reference, error = (luminance(p.astype(np.float64)) for p in measured.reference.pixels())
    everywhere = (slice(None), slice(None))
    lit = (slice(round(layout.get("lights_end", 0) * reference.shape[0]), None), slice(None))
    infos = layout["regions"]
    where = [everywhere, lit, *(pixels_of(info["rect"], reference.shape) for info in infos)]
    for info, at in zip(infos, where[2:]):
        if reference[at].size == 0:
            raise ValueError(f"region {info} holds no pixel of the image")
    places = [Place(info, reference[at].mean(), {b: {} for b in BUDGETS}) for info, at in zip([{}, {}, *infos], where)]
    methods = {b: {} for b in BUDGETS}
    for budget, renders in zip(BUDGETS, (measured.equal_samples, measured.equal_time)):
        for i in INTEGRATORS:
            pixels = [[p.astype(np.float64) for p in r.pixels()] for r in renders[i]]
            lum = np.stack([luminance(p[0]) for p in pixels])
            for place, at in zip(places, where):
                place.sampled[budget][i] = sampled(lum[(slice(None), *at)], reference[at], error_of_mean(error[at]))
            scale = reference[lit].mean() ** 2
            methods[budget][i] = Method(
                renders[i][0].stats["spp"], mean_of([r.stats["processor_seconds"] for r in renders[i]]),
                trimmed(lum[(slice(None), *lit)].var(axis=0, ddof=1)) / scale,
                np.mean([(luminance(p[1]) ** 2).mean() for p in pixels]) / reference.mean() ** 2,
                ((lum - reference) ** 2).mean() / reference.mean() ** 2)
    return Scene(methods, *places[:2], places[2:], convergence(measured, layout), reference,
                 layout.get("lights_end", 0))


def convergence(measured, layout):
    """Relative variances from the standard errors over replicates, against the samples: of the image without the
    lights, and of the places that `layout` names; no point where the mean was not found."""
    kept = {}
    last, last_error = (luminance(p.astype(np.float64)) for p in measured.convergence["mis"][-1].pixels())
    where = {"image": (slice(round(layout.get("lights_end", 0) * last.shape[0]), None), slice(None))}
    where |= {(info["plate"], info["light"]): pixels_of(info["rect"], last.shape) for info in layout["regions"]
              if "plate" in info}
    for name, at in where.items():
        kept[name] = {i: [] for i in INTEGRATORS}
        mean, mean_error = last[at].mean(), error_of_mean(last_error[at])
        for i, renders in measured.convergence.items():
            for r in renders:
                lum, error = (luminance(p.astype(np.float64))[at] for p in r.pixels())
                if is_found(lum.mean(), error_of_mean(error), mean, mean_error):
                    kept[name][i].append((r.stats["spp"], (error ** 2).mean() / mean ** 2))
    return kept


def error_of_mean(errors):
    """Standard error of the mean over pixels with these standard errors."""
    return math.sqrt((errors ** 2).sum()) / errors.size


def decay(points):
    """Power of the number of samples with which the variance falls, and half of its 95 % interval; None where there are
    too few points."""
    if len(points) < 3 or min(v for _, v in points) <= 0:
        return None
    return slope([math.log(n) for n, _ in points], [math.log(v) for _, v in points])


def pixels_of(rect, shape):
    """Slices of the pixels whose centres lie in a rectangle given in image fractions."""
    x0, y0, x1, y1 = rect
    h, w = shape
    return (slice(int(np.ceil(y0 * h - 0.5)), int(np.ceil(y1 * h - 0.5))),
            slice(int(np.ceil(x0 * w - 0.5)), int(np.ceil(x1 * w - 0.5))))


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
