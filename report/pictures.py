"""The pictures of the page, from renders to what the template holds."""
import json
import math

import matplotlib
import numpy as np
from PIL import Image

from answers import name, worst_place
from images import crop, data_uri, heat, jpeg, luminance, pack, png, srgb
from measure import INTEGRATORS
from variance import BUDGETS
from words import sig

CROP = (132, 88)


def power_of_ten_range(scene_measured):
    """Range of the heat map: whole powers of ten around nearly all standard errors of the four methods."""
    errors = np.concatenate([luminance(scene_measured.equal_samples[i][0].pixels()[1])[::4, ::4].ravel()
                             for i in INTEGRATORS])
    errors = errors[errors > 0]
    low, high = np.percentile(errors, [5, 99.5])
    return 10.0 ** math.floor(math.log10(low)), 10.0 ** math.ceil(math.log10(high))


def ticks(low, high):
    decades = round(math.log10(high / low))
    return [(100 * k / decades, sig(low * 10 ** k, 1)) for k in range(decades + 1)]


def cost(render):
    s = render.stats
    return f"{s['spp']} samples a pixel, {s['processor_seconds']:.3g} s of processor time"


def sheets(measured, heat_range):
    def pictures(renders, paint):
        return [{"uri": data_uri(jpeg(paint(r[0])), "jpeg"), "caption": f"{i}: {cost(r[0])}"}
                for i, r in renders.items()]

    return [
        {"title": "Equal samples", "pictures": pictures(measured.equal_samples, lambda r: srgb(r.pixels()[0]))},
        {"title": "Equal time", "pictures": pictures(measured.equal_time, lambda r: srgb(r.pixels()[0]))},
        {"title": "Standard error at equal samples", "heat": True,
         "pictures": pictures(measured.equal_samples, lambda r: heat(luminance(r.pixels()[1]), *heat_range))},
    ]


def viewer_data(measured, heat_range):
    images, costs = {}, {}
    for i in INTEGRATORS:
        for budget, renders in zip(BUDGETS, (measured.equal_samples[i], measured.equal_time[i])):
            images[f"{i}-{budget}"] = data_uri(pack(*renders[0].pixels()), "png")
            costs[f"{i}-{budget}"] = f"{i}: {cost(renders[0])}"
    images["reference"] = data_uri(pack(*measured.reference.pixels()), "png")
    costs["reference"] = f"reference: mis, {cost(measured.reference)}"
    stats = measured.reference.stats
    colors = (matplotlib.colormaps["inferno"](np.arange(256))[:, :3] * 255).astype(int).ravel().tolist()
    return json.dumps({"width": stats["width"], "height": stats["height"], "heat": heat_range, "colors": colors,
                       "images": images, "costs": costs}, separators=(",", ":"))


def marks(scene):
    """The two places that the exercise asks about, as shares of the picture in percent, for rings around them."""
    found = []
    for letter, method in (("A", "light"), ("B", "direct")):
        x0, y0, x1, y1 = worst_place(scene.places, method).info["rect"]
        found.append({"letter": letter, "left": 100 * x0, "top": 100 * y0, "width": 100 * (x1 - x0),
                      "height": 100 * (y1 - y0)})
    return found


def figure(measured, scene):
    """The exercise's figure: the plates by area sampling and by directional sampling."""
    titles = {"light": "area sampling (<code>light</code>)", "direct": "directional sampling (<code>direct</code>)"}
    pictures = [{"uri": data_uri(jpeg(srgb(measured.equal_samples[i][0].pixels()[0]), 85), "jpeg"), "title": title,
                 "alt": f"The Phong plates by {i}"} for i, title in titles.items()]
    return {"pictures": pictures, "marks": marks(scene), "spp": measured.equal_samples["light"][0].stats["spp"],
            "at": {letter: name(worst_place(scene.places, method))
                   for letter, method in (("A", "light"), ("B", "direct"))}}


def crops(measured, scene):
    """The two worst places: where area sampling and where directional sampling is worst."""
    found = []
    for method in ("light", "direct"):
        place = worst_place(scene.places, method)
        pictures = []
        renders = {i: r[0] for i, r in measured.equal_samples.items()} | {"reference": measured.reference}
        for i, render in renders.items():
            part = crop(srgb(render.pixels()[0]), place.info["rect"], *CROP).repeat(3, 0).repeat(3, 1)
            variance = f"<br>{sig(place.variance('samples', i).value)}" if i in INTEGRATORS else ""
            pictures.append({"uri": data_uri(png(Image.fromarray(part)), "png"),
                             "caption": f"<code>{i}</code>{variance}", "alt": f"{i}: {name(place)}"})
        at = name(place)
        found.append({"title": f"<strong>{at[0].upper() + at[1:]}</strong>, the worst place of <code>{method}</code>, "
                               f"with the relative variance of each method", "pictures": pictures})
    return found
