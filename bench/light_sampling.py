#!/usr/bin/env python3
"""The variance that each way to sample lights leaves, as a plot and as a table: docs/light_sampling.md shows both.

usage: light_sampling.py ETENDUE SCENE.xml... -o PLOT.svg [--spp 16] [--seeds 4]

Of direct light: the mean over pixels of the variance between seeds, over the square of the mean luminance, times the
samples a pixel. A scene is called by its file's name up to the first point. Prints the table, with the seconds of
rendering in brackets: those of one run each, on the threads that there are.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

sys.path.append(str(Path(__file__).resolve().parents[1] / "report"))
from images import luminance, read_exr  # noqa: E402

# What a row is called, and its options.
WAYS = {
    "light": ["--integrator", "light"],
    "mis": ["--integrator", "mis"],
    "mis, weights by power": ["--integrator", "mis", "--weights", "power"],
    "mis, lights by power": ["--integrator", "mis", "--light-sampler", "power"],
    "mis, light tree": ["--integrator", "mis", "--light-sampler", "tree"],
    "mis, light tree, points by auto": ["--integrator", "mis", "--light-sampler", "tree", "--technique", "auto"],
    "the same, 4 candidates": ["--integrator", "mis", "--light-sampler", "tree", "--technique", "auto",
                               "--candidates", "4"],
    "direct_light, 1 shadow ray": ["--integrator", "direct_light", "--shadow-rays", "1"],
    "direct_light": ["--integrator", "direct_light"],
}
STYLE = {"svg.fonttype": "path", "svg.hashsalt": "light sampling", "font.size": 9, "font.family": "DejaVu Sans",
         "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd",
         "axes.axisbelow": True}
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#7f7f7f", "#e69f00")
MARKS = "os^Dvp"


def measure(program, scene, way, spp, seeds):
    """Relative variance times samples, and the mean seconds of a render."""
    images, seconds = [], []
    with tempfile.TemporaryDirectory() as folder:
        image, stats = Path(folder) / "image.exr", Path(folder) / "stats.json"
        for seed in range(seeds):
            subprocess.run([program, "render", scene, *way, "--sampler", "sobol", "--spp", str(spp), "--seed",
                            str(seed), "--quiet", "-o", image, "--stats", stats], check=True)
            images.append(luminance(read_exr(image)[0].astype(float)))
            seconds.append(json.loads(stats.read_text())["seconds_render"])
    stack = np.stack(images)
    return spp * stack.var(axis=0, ddof=1).mean() / stack.mean() ** 2, np.mean(seconds)


def plot(measured, scenes, spp, file):
    """One row a way, one mark a scene."""
    with matplotlib.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(7.6, 0.36 * len(WAYS) + 1), layout="constrained")
        for scene, color, mark in zip(scenes, COLORS, MARKS):
            axes.plot([measured[scene, way][0] for way in WAYS], range(len(WAYS)), mark, color=color, markersize=5,
                      label=scene.replace("_", " "))
        axes.set_yticks(range(len(WAYS)), WAYS)
        axes.invert_yaxis()
        axes.set_xscale("log")
        axes.set_xlabel(f"relative variance × samples, {spp} samples a pixel")
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(scenes), frameon=False,
                    handletextpad=0.1, columnspacing=1.0)
        figure.savefig(file, metadata={"Date": None, "Creator": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("scenes", nargs="+", type=Path)
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--seeds", type=int, default=4)
    options = parser.parse_args()
    if len(options.scenes) > len(MARKS):
        parser.error(f"at most {len(MARKS)} scenes")
    scenes = {file.name.split(".")[0]: file for file in options.scenes}
    measured = {(scene, name): measure(options.program, file, way, options.spp, options.seeds)
                for scene, file in scenes.items() for name, way in WAYS.items()}
    plot(measured, scenes, options.spp, options.output)
    print("|".join(["", " ", *(f" `{scene}` " for scene in scenes), ""]))
    print("|---" * (len(scenes) + 1) + "|")
    for way in WAYS:
        print("|".join(["", f" {way} ", *(" {:.2g} ({:.2f} s) ".format(*measured[s, way]) for s in scenes), ""]))


if __name__ == "__main__":
    main()
