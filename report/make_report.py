#!/usr/bin/python3
"""Renders the scenes of exercise 3 with every method and writes index.html and report.pdf.

Needs Debian's python3-numpy, python3-matplotlib, python3-jinja2, python3-pil, python3-openimageio and weasyprint.
"""
import argparse
import dataclasses
import datetime
import json
import math
import re
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True

import jinja2  # noqa: E402
import matplotlib  # noqa: E402
import numpy as np  # noqa: E402
import weasyprint  # noqa: E402
from PIL import Image  # noqa: E402

import answers  # noqa: E402
import plots  # noqa: E402
from answers import place, sig, times, worst_region  # noqa: E402
from formulas import as_image, formula  # noqa: E402
from images import crop, data_uri, heat, jpeg, luminance, pack, png, srgb  # noqa: E402
from measure import INTEGRATORS, REPLICATES, Renderer, machine, measure  # noqa: E402
from variance import evaluate, evaluate_regions  # noqa: E402

HERE = Path(__file__).resolve().parent
TITLES = {
    "area_sampling": ("Still life (area_sampling.xml)",
                      "A vase, a napkin, a bowl of fruit, a cup and two eggs under three area lights: a large cool one "
                      "on the left, a small warm one on the right and a narrow one behind. Each object has three "
                      "shadows; the larger the light, the softer."),
    "phong_plates": ("Lights and Phong plates (phong_plates.xml)",
                     "Four spheres of equal power, from small to large, and three plates of one colour that mirror them "
                     "to the camera; the shiniest is on top."),
}
CROP = (132, 88)


def cells(values, best=None, digits=3):
    """Table cells; `best` is min, max or None."""
    chosen = best(values) if best else None
    return [{"text": sig(v, digits), "best": best is not None and v == chosen} for v in values]


def rows(columns):
    """Columns of cells (in the order of the integrators) to rows with a name."""
    return [{"method": i, "cells": [column[k] for column in columns]} for k, i in enumerate(INTEGRATORS)]


def method_rows(scene):
    m = [scene.methods[i] for i in INTEGRATORS]
    base, base_trimmed = m[0].efficiency, m[0].efficiency_trimmed
    return rows([
        cells([x.seconds for x in m], min), cells([x.samples_per_second / 1e6 for x in m], max),
        cells([x.relative_variance for x in m], min), cells([x.efficiency for x in m], max),
        cells([x.efficiency / base for x in m], max), cells([x.relative_variance_trimmed for x in m], min),
        cells([x.efficiency_trimmed for x in m], max), cells([x.efficiency_trimmed / base_trimmed for x in m], max)])


def time_rows(scene):
    t = [scene.equal_time[i] for i in INTEGRATORS]
    return rows([
        [{"text": str(x.spp), "best": False} for x in t], cells([x.seconds for x in t]),
        cells([x.relative_variance for x in t], min),
        cells([t[0].relative_variance / x.relative_variance for x in t], max),
        cells([x.error_to_reference for x in t], min)])


def check_rows(scene):
    m = [scene.methods[i] for i in INTEGRATORS]
    return rows([
        cells([x.relative_variance for x in m]), cells([x.relative_variance_stderr for x in m]),
        cells([x.error_to_reference for x in m]),
        [{"text": f"{sig(x.mean, 5)} ± {sig(x.mean_error, 2)}"} for x in m]])


def check_words(scene):
    m = [scene.methods[i] for i in INTEGRATORS]
    apart = max(max(x.relative_variance_stderr / x.relative_variance, x.relative_variance / x.relative_variance_stderr)
                for x in m) - 1
    text = f"The renderer's own standard errors and the seeds agree on the variance within {sig(100 * apart, 2)} %. "
    # The average shares its samples with light and direct here, so its differences are smaller than this allows for.
    worst = max(abs(a.mean - b.mean) / math.hypot(a.mean_error, b.mean_error) for a in m for b in m if a is not b)
    if worst < 4:  # six pairs: larger by chance in less than one report in 2000
        return text + (f"The means of the four methods differ by at most {sig(worst, 2)} standard errors, as unbiased "
                       f"estimates of one picture do.")
    return text + (f"<strong>The means of two methods differ by {sig(worst, 2)} standard errors: more than chance "
                   f"explains easily.</strong>")


def strip_words(scene, end):
    """How much of the variance lies in the strip of the image above the plates, with the lights themselves."""
    rows = round(end * scene.reference.shape[0])
    share = {i: v[:rows].sum() / v.sum() for i, v in scene.variance.items()}
    rest = {i: v[rows:].mean() for i, v in scene.variance.items()}
    efficiency = {i: 1 / (rest[i] * scene.methods[i].seconds) for i in INTEGRATORS}
    best = max(efficiency, key=efficiency.get)
    return (f"The camera also sees the lights, above the plates, and at the rim of a small bright light a pixel is "
            f"noisy with every method alike. That strip holds {sig(100 * share['mis'], 2)} % of the variance of <code>mis</code>, "
            f"{sig(100 * share['direct'], 2)} % of that of <code>direct</code> and {sig(100 * share['light'], 2)} % of that "
            f"of <code>light</code>. Without it, <code>{best}</code> is the most efficient: the efficiencies are "
            + ", ".join(f"<code>{i}</code> {sig(efficiency[i] / efficiency['light'], 2)}" for i in INTEGRATORS)
            + " times that of <code>light</code>.")


def in_pdf(text):
    """The answers with their formulas as images."""
    def images(html):
        return re.sub(r'<svg class="formula".*?</svg>', lambda m: as_image(m.group()), html, flags=re.S)

    return dataclasses.replace(text, **{k: images(v) for k, v in vars(text).items() if isinstance(v, str)})


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
    return f"{s['spp']} samples a pixel, {s['seconds_render']:.3g} s"


def sheets(measured, heat_range):
    def pictures(renders, paint):
        return [{"uri": data_uri(jpeg(paint(r)), "jpeg"), "caption": f"{i}: {cost(r)}"} for i, r in renders.items()]

    first = {i: r[0] for i, r in measured.equal_samples.items()}
    return [
        {"title": "Equal samples", "pictures": pictures(first, lambda r: srgb(r.pixels()[0]))},
        {"title": "Equal time", "pictures": pictures(measured.equal_time, lambda r: srgb(r.pixels()[0]))},
        {"title": "Standard error at equal samples", "heat": True,
         "pictures": pictures(first, lambda r: heat(luminance(r.pixels()[1]), *heat_range))},
    ]


def viewer_data(measured, heat_range):
    images, costs = {}, {}
    for i in INTEGRATORS:
        for budget, render in (("samples", measured.equal_samples[i][0]), ("time", measured.equal_time[i])):
            images[f"{i}-{budget}"] = data_uri(pack(*render.pixels()), "png")
            costs[f"{i}-{budget}"] = f"{i}: {cost(render)}"
    images["reference"] = data_uri(pack(*measured.reference.pixels()), "png")
    costs["reference"] = f"reference: mis, {cost(measured.reference)}"
    stats = measured.reference.stats
    colors = (matplotlib.colormaps["inferno"](np.arange(256))[:, :3] * 255).astype(int).ravel().tolist()
    return json.dumps({"width": stats["width"], "height": stats["height"], "heat": heat_range, "colors": colors,
                       "images": images, "costs": costs}, separators=(",", ":"))


def crops(measured, regions):
    """The two worst places: where area sampling and where directional sampling is worst."""
    found = []
    for method in ("light", "direct"):
        region = worst_region(regions, method)
        pictures = []
        renders = {i: r[0] for i, r in measured.equal_samples.items()} | {"reference": measured.reference}
        for i, render in renders.items():
            part = crop(srgb(render.pixels()[0]), region.info["rect"], *CROP).repeat(3, 0).repeat(3, 1)
            variance = f"<br>{sig(region.relative_variance[i])}" if i in INTEGRATORS else ""
            pictures.append({"uri": data_uri(png(Image.fromarray(part)), "png"), "caption": f"<code>{i}</code>{variance}",
                             "alt": f"{i}: {place(region)}"})
        at = place(region)
        found.append({"title": f"<strong>{at[0].upper() + at[1:]}</strong>, the worst place of <code>{method}</code>, "
                               f"with the relative variance of each method", "pictures": pictures})
    return found


def summary(scenes, regions):
    plates = scenes["phong_plates"]
    best = max(INTEGRATORS, key=lambda i: plates.methods[i].efficiency)
    still = scenes["area_sampling"]
    still_best = max(INTEGRATORS, key=lambda i: still.methods[i].efficiency)

    def said(scene, best):
        if best == "light":
            second = max((i for i in INTEGRATORS if i != "light"), key=lambda i: scene.methods[i].efficiency)
            return (f"<code>light</code> is the most efficient, {times(1 / ratio(scene, second))} as efficient as "
                    f"<code>{second}</code>")
        trimmed = max(INTEGRATORS, key=lambda i: scene.methods[i].efficiency_trimmed)
        gain = scene.methods[trimmed].efficiency_trimmed / scene.methods["light"].efficiency_trimmed
        return (f"<code>{best}</code> is the most efficient, {times(ratio(scene, best))} as efficient as <code>light</code>"
                f" (without the worst 0.1 % of pixels: <code>{trimmed}</code>, {times(gain)})")

    def ratio(scene, i):
        return scene.methods[i].efficiency / scene.methods["light"].efficiency

    mis_beats = sum(r.relative_variance["mis"] < r.best_single for r in regions)
    beaten = sum(r.relative_variance["average"] < r.best_single for r in regions)
    return (f"In the still life {said(still, still_best)}. On the Phong plates {said(plates, best)}; averaging the two "
            f"images beats the better of them in {beaten} of {len(regions)} highlights, multiple importance sampling in "
            f"{mis_beats}. (Efficiency is 1 / (relative variance × seconds).)")


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--etendue", required=True, type=Path, help="the renderer")
    arguments.add_argument("--scenes", required=True, type=Path, help="folder with the two scenes (scenes/ex3)")
    arguments.add_argument("--out", required=True, type=Path, help="folder for index.html, report.pdf and the cache")
    arguments.add_argument("--threads", type=int, help="for the renderer (default: all)")
    arguments.add_argument("--quick", action="store_true", help="fewer samples and seeds")
    options = arguments.parse_args()
    if not options.etendue.is_file():
        arguments.error(f"there is no renderer at {options.etendue}: build it first")
    started = time.monotonic()

    def tell(what):
        print(f"[{time.monotonic() - started:5.1f} s] {what}", flush=True)

    renderer = Renderer(options.etendue, options.out / "cache", options.threads)
    measured = {}
    for name in TITLES:
        tell(f"rendering {name}.xml with {', '.join(INTEGRATORS)}")
        measured[name] = measure(renderer, options.scenes / f"{name}.xml", options.quick)
    tell(f"{renderer.made} renders made, {renderer.kept} kept from before; computing variances")
    scenes = {name: evaluate(m) for name, m in measured.items()}
    layout = {name: json.loads((options.scenes / f"{name}.regions.json").read_text()) for name in TITLES}
    places = {name: evaluate_regions(scenes[name], layout[name]["regions"]) for name in TITLES}
    plates = places["phong_plates"]

    tell("preparing pictures")
    shown = []
    for name, (title, about) in TITLES.items():
        m, scene = measured[name], scenes[name]
        heat_range = power_of_ten_range(m)
        shown.append({
            "name": name, "title": title, "about": about, "heat": heat_range, "ticks": ticks(*heat_range),
            "spp": scene.methods["light"].spp, "seeds": len(m.equal_samples["light"]), "rows": method_rows(scene),
            "time_rows": time_rows(scene), "time_mismatch": f"{100 * scene.worst_time_mismatch:.1f} %",
            "is_uneven": scene.worst_time_mismatch > 0.1,
            "check_rows": check_rows(scene), "check_words": check_words(scene),
            "strip_words": strip_words(scene, layout[name]["lights_end"]) if "lights_end" in layout[name] else None,
            "sheets": sheets(m, heat_range), "viewer_json": viewer_data(m, heat_range),
            "region_rows": [{"name": r.info["name"], "what": r.info["what"],
                             "cells": cells([r.relative_variance[i] for i in INTEGRATORS], min)}
                            for r in places[name]] if name == "area_sampling" else None})
    stats = measured["phong_plates"].reference.stats
    seconds = {name: sum(x.stats["seconds_render"] for group in (
        [r for rs in m.equal_samples.values() for r in rs], m.equal_time.values(), [m.reference]) for x in group)
        for name, m in measured.items()}
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), trim_blocks=True,
                                     undefined=jinja2.StrictUndefined)
    context = {
        "css": (HERE / "style.css").read_text(), "js": (HERE / "viewer.js").read_text(), "f": formula,
        "sig": sig, "as_image": as_image,
        "summary": summary(scenes, plates), "quick": options.quick, "date": datetime.date.today().isoformat(),
        "machine": {"model": machine(), "threads": stats["threads"], "isa": stats["isa"],
                    "version": renderer.version()},
        "spp": scenes["phong_plates"].methods["light"].spp, "replicates": REPLICATES,
        "reference_spp": stats["spp"], "integrators": INTEGRATORS, "methods": [*INTEGRATORS, "reference"],
        "scenes": shown, "power": sig(layout["phong_plates"]["lights"][0]["power"]),
        "heat_stops": ", ".join(matplotlib.colors.to_hex(matplotlib.colormaps["inferno"](k / 16)) for k in range(17)),
        "time_plot": plots.time_plot([(TITLES[n][0].split(" (")[0], s) for n, s in scenes.items()]),
        "regions_plot": plots.regions_plot(plates),
        "crops": crops(measured["phong_plates"], plates),
        "answers": answers.answer(scenes["phong_plates"], plates, layout["phong_plates"]),
        "worst_light": worst_region(plates, "light"), "worst_direct": worst_region(plates, "direct"),
        "regions": [{"info": r.info, "v": r.relative_variance, "theory": r.average_from_theory, "single": r.best_single,
                     "best": min(INTEGRATORS, key=r.relative_variance.get)} for r in plates],
        "time_words": time_words(measured, scenes, seconds),
    }
    pdf_context = context | {"pdf": True, "f": lambda name: as_image(formula(name)),
                             "answers": in_pdf(context["answers"])}
    template = environment.get_template("template.html.j2")
    page = options.out / "index.html"
    page.write_text(template.render(context, pdf=False))
    tell(f"{page}: {page.stat().st_size / 1e6:.1f} MB; making the PDF")
    document = options.out / "report.pdf"
    weasyprint.HTML(string=template.render(pdf_context)).write_pdf(document)
    tell(f"{document}: {document.stat().st_size / 1e6:.1f} MB")


def time_words(measured, scenes, seconds):
    parts = []
    for name, m in measured.items():
        s = m.reference.stats
        each = ", ".join(f"<code>{i}</code> {sig(scenes[name].methods[i].seconds)} s" for i in INTEGRATORS)
        title, spp = TITLES[name][0].split(" (")[0], scenes[name].methods["light"].spp
        parts.append(f"{title} ({s['width']} × {s['height']} pixels, {s['triangles']} triangles, {s['lights']} lights): "
                     f"one image at {spp} samples a pixel takes {each}; all renders of the scene for this page took "
                     f"{sig(seconds[name])} s, of which the reference {sig(s['seconds_render'])} s.")
    return "Rendering, on the machine named above. " + " ".join(parts)


if __name__ == "__main__":
    main()
