"""Writes what compare.py has measured into the documentation: report.py MEASURED_FOLDER DOCS_FOLDER.

The part of performance.md between its two marks is replaced, and the images in images/peers.
"""
import json
import sys
from pathlib import Path

import matplotlib
import numpy as np
from PIL import Image

from efficiency import Estimate
from renderers import ADAPTIVE
from scenes import SCENES

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib import ticker  # noqa: E402

BEGIN, END = "<!-- bench/peers/run.sh writes from here -->", "<!-- to here -->"
CROP_PX, GAP_PX = 192, 4
COLOURS = {"Etendue": "#c1440e", "Mitsuba 3": "#1f5fa8", "Cycles": "#3a7d34", "LuxCore": "#7a4fa3"}


def main():
    measured, docs = Path(sys.argv[1]), Path(sys.argv[2])
    results = [json.loads((measured / f"{name}.json").read_text()) for name in SCENES
               if (measured / f"{name}.json").exists()]
    images = docs / "images" / "peers"
    images.mkdir(parents=True, exist_ok=True)
    draw_curves(results, images / "error_against_time.svg")
    draw_images(results, measured, images / "side_by_side.png")
    page = docs / "performance.md"
    text = page.read_text()
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    page.write_text(text[:begin] + "\n" + section(results) + text[end:])


def section(results):
    return "\n".join([*standing(results), "", *table(results), "",
                      "![error against time](images/peers/error_against_time.svg)", "",
                      "At equal samples, 16 a pixel: " + ", ".join(titles(results)) + ", from left to right.", "",
                      "![crops of the images](images/peers/side_by_side.png)", ""])


def titles(results):
    """The renderers, Etendue first."""
    found = {}
    for result in results:
        for rows in result["budgets"].values():
            found.update((row["renderer"], None) for row in rows)
    return list(found)


def compared(result):
    """(samples a pixel, Etendue's row without options, a peer's row) for each pair."""
    for spp, rows in result["budgets"].items():
        for row in rows:
            if row["renderer"] != "Etendue":
                yield int(spp), rows[0], row


def ratio(ours, theirs, key):
    return Estimate(*ours[key]).over(Estimate(*theirs[key]))


def standing(results):
    """Where Etendue is ahead, where a peer is, and where the intervals do not tell, in words."""
    ahead, behind, unclear = [], [], []
    for result in results:
        for spp, ours, theirs in compared(result):
            if theirs["agreement"]["void"]:
                continue
            over = ratio(ours, theirs, "efficiency")
            into = ahead if over.low > 1 else behind if over.high < 1 else unclear
            into.append(f"{result['scene']} at {spp} ({theirs['renderer']}, {figure(over.value)} x)")
    lines = [f"Etendue is more efficient in {len(ahead)} of {len(ahead) + len(behind) + len(unclear)} comparisons."]
    for what, entries in (("A peer is more efficient on", behind), ("Not to be told apart on", unclear)):
        if entries:
            lines.append(f"{what}: {', '.join(entries)}.")
    void = [f"{result['scene']} at {spp}: {theirs['renderer']}, {theirs['agreement']['void']}"
            for result in results for spp, _, theirs in compared(result) if theirs["agreement"]["void"]]
    if void:
        lines.append(f"Void, as the images do not agree: {'; '.join(void)}.")
    machines = sorted({f"{r['machine']['cpu']}, {r['machine']['cores']} thread{'s' * (r['machine']['cores'] > 1)}, "
                       f"{r['machine']['date']}" for r in results})
    lines.append(f"Measured on {'; '.join(machines)}.")
    return lines


def table(results):
    lines = ["| scene | spp | renderer and setting | million samples/s | relative variance × spp | efficiency | "
             "Etendue's over it | robust | with `--adaptive` | robust |", "|---|---|---|---|---|---|---|---|---|---|"]
    for result in results:
        for spp, rows in result["budgets"].items():
            adaptive = [row for row in rows if row["setting"] == ADAPTIVE]
            for row in rows:
                if row["renderer"] == "Etendue" and row is not rows[0] and row not in adaptive:
                    continue
                over = "| | | | |"
                if row["renderer"] != "Etendue":
                    over = "".join(f"| {interval(ratio(ours, row, key))} " if not row["agreement"]["void"] else "| void "
                                   for ours in [rows[0], *adaptive]
                                   for key in ("efficiency", "robust_efficiency")) + "|" + " |" * 2 * (not adaptive)
                lines.append(f"| {result['scene']} | {spp} | {row['renderer']}: {row['setting']} "
                             f"| {figure(row['msamples_per_second'])} | {figure(row['variance_times_spp'][0])} "
                             f"| {figure(row['efficiency'][0])} {over}")
    return lines


def interval(estimate):
    return f"**{figure(estimate.value)}** ({figure(estimate.low)} to {figure(estimate.high)})"


def figure(value):
    """Two digits that count, three from 100 on, without an exponent."""
    return f"{value:.0f}" if value >= 100 else f"{float(f'{value:.2g}'):g}" if value >= 1e-4 else f"{value:.1e}"


def draw_curves(results, path):
    plt.rcParams.update({"svg.hashsalt": "peers", "svg.fonttype": "none", "font.size": 8, "axes.grid": True, "grid.alpha": 0.3})
    columns = min(len(results), 4)
    shape = (-(-len(results) // columns), columns)
    drawing, axes = plt.subplots(*shape, figsize=(2.75 * columns, 2.4 * shape[0]), squeeze=False, layout="constrained")
    for axis in axes.flat[len(results):]:
        axis.axis("off")
    for result, axis in zip(results, axes.flat):
        for renderer, points in result["curves"].items():
            axis.loglog([p["seconds"] for p in points], [100 * np.sqrt(p["relative_variance"]) for p in points], ".-",
                        color=COLOURS[renderer], label=renderer)
        for side in (axis.xaxis, axis.yaxis):
            side.set_major_locator(ticker.LogLocator(subs=(1, 3)))
            side.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
            side.set_minor_formatter(ticker.NullFormatter())
        axis.set_title(result["scene"])
        axis.set_xlabel("seconds")
        axis.set_ylabel("error, % of the mean")
    axes.flat[0].legend()
    drawing.savefig(path, metadata={"Date": None})


def draw_images(results, measured, path):
    """A row for each scene: the middle of each renderer's first image at the fewest samples."""
    names = titles(results)
    step = CROP_PX + GAP_PX
    sheet = np.full((len(results) * step - GAP_PX, len(names) * step - GAP_PX, 3), 255, np.uint8)
    for i, result in enumerate(results):
        rows = next(iter(result["budgets"].values()))
        images = np.load(measured / f"{result['scene']}.npz")
        shown = {}
        for row in rows:
            shown.setdefault(row["renderer"], images[f"{row['renderer']}/{row['setting']}"])
        white = np.percentile(shown["Etendue"], 98)
        for renderer, image in shown.items():
            top, left = ((length - CROP_PX) // 2 for length in image.shape[:2])
            crop = np.clip(image[top:top + CROP_PX, left:left + CROP_PX] / white, 0, 1)
            coded = np.where(crop <= 0.0031308, 12.92 * crop, 1.055 * crop ** (1 / 2.4) - 0.055)
            y, x = i * step, names.index(renderer) * step
            sheet[y:y + CROP_PX, x:x + CROP_PX] = np.rint(255 * coded).astype(np.uint8)
    Image.fromarray(sheet).quantize(256).save(path, optimize=True)  # noise is dear in full colour


if __name__ == "__main__":
    main()
