#!/usr/bin/python3
"""Recomputes every number of 3.3.4 on the page from the renders in its cache: `check_numbers.py out/demo`.

It shares no code with what wrote the page: it finds the renders by what their statistics say, reads them with another
interface of OpenImageIO, and takes variances from differences of pairs of seeds. Exit code 1 where a number differs,
where one of 3.3.4 is not recomputed, or where there are too few.
"""
import html.parser
import itertools
import json
import math
import re
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

SCENES = Path(__file__).resolve().parent.parent / "scenes" / "ex3"
# Two-sided 95 % points of Student's t
T_95 = {3: 3.18245, 4: 2.77645, 5: 2.57058, 6: 2.44691, 7: 2.36462}
# A light's name; what the brackets are; how variance falls
NEXT_TO_NUMBERS = re.compile(r"light \d|95\s% interval|1/N")


class Section(html.parser.HTMLParser):
    """The numbers of the head's sentence and of 3.3.4, and the text of 3.3.4 without them."""

    def __init__(self, page):
        super().__init__()
        self.numbers, self.text = [], ""
        self.is_inside, self.data, self.skipped = False, None, 0
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        a = dict(attributes)
        if tag == "h3":
            self.is_inside = a.get("id") == "best-of-both"
        if tag in ("h3", "svg", "th", "style", "script") or a.get("class") == "label":
            self.skipped += 1
        if tag == "data":
            self.data = [a["data-key"], float(a["value"]), ""]

    def handle_endtag(self, tag):
        if tag == "section":
            self.is_inside = False
        if tag in ("h3", "svg", "th", "style", "script") or (tag == "td" and self.skipped):
            self.skipped -= 1
        if tag == "data":
            self.numbers.append(self.data)
            self.data = None

    def handle_data(self, text):
        if self.data:
            self.data[2] += text
        elif self.is_inside and not self.skipped:
            self.text += text


def shown_value(text):
    """The number that a text shows, and half of a unit in its last place."""
    mantissa, _, exponent = text.replace("−", "-").replace(" ", "").replace("\u00a0", "").partition("·10")
    scale = 10.0 ** int(exponent or 0)
    digits = len(mantissa.partition(".")[2])
    value = float(mantissa)
    trailing = len(mantissa) - len(mantissa.rstrip("0")) if not digits else 0
    return value * scale, 0.5 * scale * 10.0 ** (trailing - digits)


def brightness(file, first=0):
    """Luminance of an EXR file's pixels, or of their standard error (`first` = 3)."""
    pixels = oiio.ImageBuf(str(file)).get_pixels(oiio.FLOAT).astype(float)
    return 0.212671 * pixels[:, :, first] + 0.715160 * pixels[:, :, first + 1] + 0.072169 * pixels[:, :, first + 2]


def renders(cache):
    """(integrator, samples) -> [(seed, image, processor seconds, file)] of the plates, without those of one seed."""
    found = [(json.loads(f.read_text()), f.with_suffix(".exr")) for f in sorted(cache.glob("*.json"))]
    found = [(s, f) for s, f in found if Path(s["scene"]).stem.startswith("phong_plates")]
    kept = defaultdict(list)
    for s, f in found:
        name = "reference" if s["seed"] > 1000 else s["integrator"]
        kept[name, s["spp"], s["width"]].append((s["seed"], f, s["processor_seconds"]))
    # the renders of the convergence are of one seed
    return {(name, spp): [(seed, brightness(f), seconds, f) for seed, f, seconds in sorted(group)]
            for (name, spp, _), group in kept.items() if len(group) > 1 or name == "reference"}


def pair_variance(images):
    """Mean over pixels of the sum over pairs of (a - b)^2 / (n (n - 1))."""
    n = len(images)
    return sum(((a - b) ** 2).mean() for a, b in itertools.combinations(images, 2)) / (n * (n - 1))


def log_jackknife(images):
    """Squared standard error of the logarithm of pair_variance."""
    n = len(images)
    logs = [math.log(pair_variance(images[:k] + images[k + 1:])) for k in range(n)]
    return (n - 1) * (sum(x * x for x in logs) / n - (sum(logs) / n) ** 2)


class Recomputed:
    """Key -> value, for all that the page says in 3.3.4."""

    def __init__(self, cache):
        layout = json.loads((SCENES / "phong_plates.regions.json").read_text())
        self.values = {"places": len(layout["regions"])}
        self.renders = renders(cache)
        _, self.reference, _, file = next(v[0] for (i, _), v in self.renders.items() if i == "reference")
        self.reference_error = brightness(file, 3)
        spp = min(n for (i, n) in self.renders if i == "mis")  # mis is the slowest or close: the fewest samples it has
        smallest = min(n for i, n in self.renders if i != "reference")
        assert spp == smallest, "no method has fewer samples than at equal samples"
        budgets = {"samples": {i: spp for i in ("light", "direct", "average", "mis")}}
        budgets["time"] = {i: max(n for j, n in self.renders if j == i) for i in budgets["samples"]}
        self.seeds = len(self.renders["mis", spp])
        self.t = T_95[self.seeds - 1]
        self.values |= {"samples/spp": spp, "seeds": self.seeds}
        for budget, samples in budgets.items():
            self.add_budget(budget, samples, layout)

    def add_estimate(self, key, value, log_error_sq):
        wide = math.exp(self.t * math.sqrt(log_error_sq))
        self.values |= {key: value, key + "/low": value / wide, key + "/high": value * wide}

    def add_budget(self, budget, samples, layout):
        images = {i: [r[1] for r in self.renders[i, n]] for i, n in samples.items()}
        for i, n in samples.items():
            seconds = [r[2] for r in self.renders[i, n]]
            middle = sum(seconds) / len(seconds)
            spread = sum((s - middle) ** 2 for s in seconds) / (len(seconds) - 1) / len(seconds)
            self.values[f"{budget}/spp/{i}"] = n
            self.add_estimate(f"{budget}/seconds/{i}", middle, spread / middle ** 2)
        self.ratios, theory = defaultdict(list), []
        for region in layout["regions"]:
            theory.append(self.add_place(budget, region, images))
        if budget == "samples":
            self.values |= {"samples/theory/low": min(theory), "samples/theory/high": max(theory)}
        for i in ("average", "mis"):
            ends = [(r, r / math.exp(self.t * math.sqrt(e)), r * math.exp(self.t * math.sqrt(e)), e)
                    for r, e in self.ratios[i]]
            better, worse = sum(e[2] < 1 for e in ends), sum(e[1] > 1 for e in ends)
            self.values |= {f"{budget}/{i}/better": better, f"{budget}/{i}/worse": worse,
                            f"{budget}/{i}/equal": len(ends) - better - worse,
                            f"{budget}/{i}/not_found": len(layout["regions"]) - len(ends)}
            value, _, _, error = max(ends)
            self.add_estimate(f"{budget}/{i}/largest_loss", value, error)
        first = round(layout["lights_end"] * len(self.reference))
        below = {i: [image[first:] for image in images[i]] for i in images}
        for i in ("light", "direct", "average"):
            self.add_estimate(f"{budget}/lit/{i}/over_mis", pair_variance(below[i]) / pair_variance(below["mis"]),
                              log_jackknife(below[i]) + log_jackknife(below["mis"]))

    def add_place(self, budget, region, images):
        """Adds a place's numbers; returns the measured variance of the average over that of the formula."""
        height, width = self.reference.shape
        x0, y0, x1, y1 = region["rect"]
        rows = [y for y in range(height) if y0 <= (y + 0.5) / height < y1]
        columns = [x for x in range(width) if x0 <= (x + 0.5) / width < x1]
        at = np.ix_(rows, columns)
        brightness_sq = self.reference[at].mean() ** 2
        variance, error_sq, found = {}, {}, set()
        for i in images:
            here = [image[at] for image in images[i]]
            variance[i], error_sq[i] = pair_variance(here) / brightness_sq, log_jackknife(here)
            self.add_estimate(f"{budget}/{region['plate']}/{region['light']}/{i}", variance[i], error_sq[i])
            count = here[0].size
            noise_sq = variance[i] * brightness_sq / (count * len(here))
            noise_sq += (self.reference_error[at] ** 2).sum() / count ** 2
            if abs(np.mean(here) - self.reference[at].mean()) <= 4 * math.sqrt(noise_sq):
                found.add(i)
        better = min(found & {"light", "direct"} or {"light", "direct"}, key=variance.get)
        for i in found & {"average", "mis"}:
            ratio, error = variance[i] / variance[better], error_sq[i] + error_sq[better]
            self.ratios[i].append((ratio, error))
            self.add_estimate(f"{budget}/{region['plate']}/{region['light']}/{i}/over_best", ratio, error)
        formula = 0.25 * variance["light"] + 0.25 * variance["direct"]
        if budget == "samples":
            self.values[f"samples/{region['plate']}/{region['light']}/theory"] = formula
        return variance["average"] / formula


def problems_of(section, values):
    for key, value, text in section.numbers:
        if key not in values:
            yield f"{key}: nothing recomputes it (the page says {text})"
            continue
        own = values[key]
        if abs(value - own) > 2e-3 * abs(own):  # the page's quantiles of t have four digits
            yield f"{key}: the page has {value!r}, recomputed {own!r}"
        shown, unit = shown_value(text)
        if abs(shown - value) > 1.001 * unit:
            yield f"{key}: the page shows {text} for {value!r}"
    for number in re.findall(r"\S*\d\S*", NEXT_TO_NUMBERS.sub("", section.text)):
        yield f"3.3.4 has the number {number} without a key"


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: check_numbers.py FOLDER, the one with index.html and cache")
    folder = Path(sys.argv[1])
    section = Section((folder / "index.html").read_text())
    problems = list(problems_of(section, Recomputed(folder / "cache").values))
    if len(section.numbers) < 200:
        problems.append(f"3.3.4 has {len(section.numbers)} numbers only")
    for problem in problems:
        print(f"check_numbers: {problem}", file=sys.stderr)
    print(f"{len(section.numbers)} numbers of 3.3.4 recomputed, {len(problems)} problems")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
