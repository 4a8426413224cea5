"""The tables of the page's results, and the sentences that go with them."""
import math

from measure import INTEGRATORS
from variance import BUDGETS, decay
from words import bare_interval, sig


def bold_best(estimates):
    """The integrators whose figure is the smallest, and those that cannot be told from it."""
    if not estimates:
        return []
    first = min(estimates, key=lambda i: estimates[i].value)
    return [i for i in estimates if i == first or estimates[i].over(estimates[first]).compared == "equal"]


def method_rows(scene, budget):
    """Of the whole image without the lights: samples, time, variance and what it is worth against `light`."""
    rows, lit = [], scene.lit
    found = lit.found(budget)
    best = bold_best({i: lit.variance(budget, i) for i in found})
    for i in INTEGRATORS:
        m = scene.methods[budget][i]
        if i not in found:
            variance, gain, trimmed = "mean not found", "–", "–"
        else:
            v = lit.variance(budget, i)
            variance, trimmed = f"{sig(v.value)} {bare_interval(v)}", sig(m.relative_variance_trimmed)
            ratio = lit.variance(budget, "light").over(v) if "light" in found else None
            if ratio and budget == "samples":  # worth: variance times time
                ratio = ratio.times(scene.methods[budget]["light"].seconds.over(m.seconds))
            gain = "1" if i == "light" else f"{sig(ratio.value, 2)} {bare_interval(ratio)}" if ratio else "–"
        whole = scene.whole.sampled[budget][i]
        rows.append({"method": i, "spp": m.spp, "seconds": f"{sig(m.seconds.value)} {bare_interval(m.seconds, 3)}",
                     "variance": variance, "is_best": i in best, "trimmed": trimmed, "gain": gain,
                     "whole": sig(whole.relative_variance.value) if whole.is_found else "mean not found"})
    return rows


def check_rows(scene):
    rows = []
    for i in INTEGRATORS:
        m, s = scene.methods["samples"][i], scene.whole.sampled["samples"][i]
        rows.append({"method": i, "cells": [sig(s.relative_variance.value), sig(m.relative_variance_stderr),
                                            sig(m.error_to_reference), f"{sig(s.mean, 5)} ± {sig(s.mean_error, 2)}"]})
    return rows


def check_words(scene):
    s = [scene.whole.sampled["samples"][i] for i in INTEGRATORS]
    stated = [scene.methods["samples"][i].relative_variance_stderr for i in INTEGRATORS]
    apart = max(max(a / x.relative_variance.value, x.relative_variance.value / a) for a, x in zip(stated, s)) - 1
    text = f"The renderer's own standard errors and the seeds agree on the variance within {sig(100 * apart, 2)} %. "
    worst = max(abs(a.mean - b.mean) / math.hypot(a.mean_error, b.mean_error) for a in s for b in s if a is not b)
    if worst < 4:  # six pairs: larger by chance in less than one report in 2000
        return text + (f"The means of the four methods, which share no sample, differ by at most {sig(worst, 2)} "
                       f"standard "
                       f"errors, as unbiased estimates of one picture do.")
    return text + (f"<strong>The means of two methods differ by {sig(worst, 2)} standard errors: more than chance "
                   f"explains easily.</strong>")


def place_rows(scene):
    """Of the named places of the still life, at both budgets."""
    rows = []
    for p in scene.places:
        for budget in BUDGETS:
            best = p.best(budget)
            rows.append({"name": p.info["name"], "what": p.info["what"], "budget": budget, "cells": [
                {"text": f"{sig(p.variance(budget, i).value, 2)} {bare_interval(p.variance(budget, i))}"
                 if p.sampled[budget][i].is_found else "mean not found", "best": i in best} for i in INTEGRATORS]})
    return rows


def slope_rows(panels):
    """Method -> slope with its interval in each panel."""
    rows = []
    for i in INTEGRATORS:
        falls = [decay(curves[i]) for _, curves in panels]
        rows.append({"method": i, "cells": [f"{f[0]:.2f} ± {f[1]:.2f}".replace("-", "−") if f else "–" for f in falls]})
    return rows


def lights_words(scene):
    """How much of the variance lies in the strip of the image that shows the lights themselves."""
    total = {i: scene.whole.variance("samples", i).value * scene.whole.mean ** 2 * scene.reference.size
             for i in INTEGRATORS}
    end = scene.reference.size * (1 - scene.lights_end)
    share = {i: 1 - scene.lit.variance("samples", i).value * scene.lit.mean ** 2 * end / total[i] for i in INTEGRATORS}
    return ("The camera also sees the lights, above the plates, and at the rim of a small bright light a pixel is "
            "noisy with "
            "every method alike. That strip holds "
            + ", ".join(f"{sig(100 * share[i], 2)} % of the variance of <code>{i}</code>" for i in INTEGRATORS)
            + ". The tables leave it out; their last column has it in.")
