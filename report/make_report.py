#!/usr/bin/python3
"""Renders the scenes of exercise 3 with every method and writes index.html, report.pdf and the same as readme.pdf.

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
import weasyprint  # noqa: E402

import answers  # noqa: E402
import plots  # noqa: E402
from answers import best_of_both_sentence, worst_place  # noqa: E402
from formulas import as_image, formula  # noqa: E402
from measure import (FIRST_SEED, FULL, INTEGRATORS, QUICK, REFERENCE_SEED, REPLICATES, Progress, Renderer,  # noqa: E402
                     machine, measure, minutes, planned_work)
from pictures import crops, figure, power_of_ten_range, sheets, ticks, viewer_data  # noqa: E402
from tables import check_rows, check_words, lights_words, method_rows, place_rows, slope_rows  # noqa: E402
from variance import BUDGETS, evaluate  # noqa: E402
from words import sig  # noqa: E402

HERE = Path(__file__).resolve().parent
TITLES = {
    "area_sampling": ("Still life",
                      "A vase, a napkin, a bowl of fruit, a cup and two eggs under three area lights: a large cool one "
                      "on the left, a small warm one on the right and a narrow one behind. Each object has three "
                      "shadows; the larger the light, the softer."),
    "phong_plates": ("Lights and Phong plates",
                     "Four spheres of equal power, from small to large, and three plates of one colour that mirror "
                     "them "
                     "to the camera; the shiniest is on top."),
}


def in_pdf(answer):
    """The answers with their formulas as images."""
    def images(html):
        return re.sub(r'<svg class="formula".*?</svg>', lambda m: as_image(m.group()), html, flags=re.S)

    return dataclasses.replace(answer, **{k: images(v) for k, v in vars(answer).items() if isinstance(v, str)})


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--etendue", required=True, type=Path, help="the renderer")
    arguments.add_argument("--scenes", required=True, type=Path, help="folder with the two scenes (scenes/ex3)")
    arguments.add_argument("--out", required=True, type=Path, help="folder for the page, the PDFs and the cache")
    arguments.add_argument("--threads", type=int, help="for the renderer (default: all)")
    arguments.add_argument("--quick", action="store_true", help="fewer samples and seeds, smaller pictures")
    options = arguments.parse_args()
    if not options.etendue.is_file():
        arguments.error(f"there is no renderer at {options.etendue}: build it first")
    started = time.monotonic()

    def tell(what):
        print(f"[{time.monotonic() - started:5.1f} s] {what}", flush=True)

    effort = QUICK if options.quick else FULL
    renderer = Renderer(options.etendue, options.out / "cache", options.threads)
    scene_files = {name: options.scenes / f"{name}.xml" for name in TITLES}
    renderer.progress = Progress(sum(planned_work(effort, picture_size(file)) for file in scene_files.values()))
    measured = {}
    for name, file in scene_files.items():
        tell(f"rendering {file.name} with {', '.join(INTEGRATORS)}")
        measured[name] = measure(renderer, file, effort)
    renderer.progress.finish()
    renderer.forget_unused()
    tell(f"{renderer.made} renders made, {renderer.kept} kept from before; computing variances")
    layout = {name: json.loads((options.scenes / f"{name}.regions.json").read_text()) for name in TITLES}
    scenes = {name: evaluate(m, layout[name]) for name, m in measured.items()}

    tell("preparing pictures")
    context = context_of(measured, scenes, layout, effort) | {
        "css": (HERE / "style.css").read_text(), "js": (HERE / "viewer.js").read_text(), "quick": options.quick,
        "version": renderer.version(), "pdf": False}
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), trim_blocks=True,
                                     undefined=jinja2.StrictUndefined)
    template = environment.get_template("template.html.j2")
    page = options.out / "index.html"
    page.write_text(template.render(context))
    tell(f"{page}: {page.stat().st_size / 1e6:.1f} MB; making the PDF, about {minutes(30)}")
    pdf = weasyprint.HTML(string=template.render(context | {
        "pdf": True, "f": lambda name: as_image(formula(name)), "answers": in_pdf(context["answers"])})).write_pdf()
    for file in ("report.pdf", "readme.pdf"):  # the exercise's name for what is handed in, beside our own
        (options.out / file).write_bytes(pdf)
    tell(f"{options.out / 'report.pdf'}, the same as readme.pdf: {len(pdf) / 1e6:.1f} MB")


def picture_size(file):
    """Pixels of a scene's picture."""
    text = file.read_text()
    return math.prod(int(re.search(rf'name="{side}" value="(\d+)"', text)[1]) for side in ("width", "height"))


def panels(scenes):
    """What the convergence plot shows: both images, and the two worst places of the plates."""
    plates = scenes["phong_plates"]
    found = [(TITLES[name][0], scene.convergence["image"]) for name, scene in scenes.items()]
    for method in ("light", "direct"):
        place = worst_place(plates.places, method)
        found.append((f"{place.info['plate']} plate under light {place.info['light']}",
                      plates.convergence[place.info["plate"], place.info["light"]]))
    return found


def context_of(measured, scenes, layout, effort):
    """All that the template shows, for page and PDF alike."""
    shown = []
    for name, (title, about) in TITLES.items():
        m, scene = measured[name], scenes[name]
        heat_range = power_of_ten_range(m)
        shown.append({
            "name": name, "title": title, "about": about, "heat": heat_range, "ticks": ticks(*heat_range),
            "rows": {budget: method_rows(scene, budget) for budget in BUDGETS},
            "time_mismatch": f"{100 * scene.worst_time_mismatch:.1f} %", "is_uneven": scene.worst_time_mismatch > 0.15,
            "check_rows": check_rows(scene), "check_words": check_words(scene),
            "lights_words": lights_words(scene) if scene.lights_end else None,
            "sheets": sheets(m, heat_range), "viewer_json": viewer_data(m, heat_range),
            "place_rows": place_rows(scene) if name == "area_sampling" else None})
    plates = scenes["phong_plates"]
    stats = measured["phong_plates"].reference.stats
    convergence = panels(scenes)
    return {
        "f": formula, "sig": sig, "as_image": as_image, "date": datetime.date.today().isoformat(),
        "machine": {"model": machine(), "threads": stats["threads"], "isa": stats["isa"]},
        "effort": effort, "replicates": REPLICATES, "integrators": INTEGRATORS, "methods": [*INTEGRATORS, "reference"],
        "seeds": {i: (FIRST_SEED[i], FIRST_SEED[i] + effort.seeds - 1) for i in INTEGRATORS},
        "reference_seed": REFERENCE_SEED, "scenes": shown,
        "power": sig(layout["phong_plates"]["lights"][0]["power"]),
        "heat_stops": ", ".join(matplotlib.colors.to_hex(matplotlib.colormaps["inferno"](k / 16)) for k in range(17)),
        "figure": figure(measured["phong_plates"], plates), "sentence": best_of_both_sentence(plates),
        "convergence_plot": plots.convergence_plot(convergence), "slope_rows": slope_rows(convergence),
        "slope_titles": [title for title, _ in convergence], "regions_plot": plots.regions_plot(plates.places),
        "crops": crops(measured["phong_plates"], plates),
        "answers": answers.answer(plates, layout["phong_plates"], effort.seeds),
        "worst": {i: worst_place(plates.places, i) for i in ("light", "direct")},
        "time_words": time_words(measured, effort),
    }


def time_words(measured, effort):
    parts = []
    for name, m in measured.items():
        s = m.reference.stats
        each = ", ".join(f"<code>{i}</code> {sig(m.equal_samples[i][0].stats['seconds_render'])} s"
                         for i in INTEGRATORS)
        seconds = sum(r.stats["seconds_render"] for r in m.all_renders())
        parts.append(f"{TITLES[name][0]} ({s['width']} × {s['height']} pixels, {s['triangles']} triangles, "
                     f"{s['lights']} "
                     f"lights): one image at {effort.spp} samples a pixel takes {each}; all renders of the scene for "
                     f"this "
                     f"page took {sig(seconds)} s, of which the reference {sig(s['seconds_render'])} s.")
    return " ".join(parts)


if __name__ == "__main__":
    main()
