#!/usr/bin/env python3
"""What bench/coverage has printed, as a plot: docs/error_bars.md shows it.

usage: coverage.py OUTPUT.txt -o PLOT.svg
"""
import argparse
import re
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

STYLE = {"svg.fonttype": "path", "svg.hashsalt": "coverage", "font.size": 9, "font.family": "DejaVu Sans",
         "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd",
         "axes.axisbelow": True}
COLORS = {"lit": "C0", "penumbra": "C1", "glossy": "C2", "edge": "C3", "rare event": "C4"}
SETUP = re.compile(r"\w+, \d+ samples, (\d+) replicates by (\w+)")
ROW = re.compile(r"  (lit|penumbra|glossy|edge|rare event) .*trusted +[\d.]+ %: +([\d.]+) \+- *([\d.]+)")


def read(text):
    """{scene: {(by, class): [(replicates, coverage, half-width of it), ...]}}, in per cent."""
    scenes, scene, setup = {}, None, None
    for line in text.splitlines():
        if found := SETUP.match(line):
            setup = int(found[1]), found[2]
        elif (found := ROW.match(line)) and scene:
            rows = scenes.setdefault(scene, {}).setdefault((setup[1], found[1]), [])
            rows.append((setup[0], float(found[2]), float(found[3])))
        elif re.match(r"\S.*, \d+ x \d+", line):
            scene = Path(line.split(",")[0]).stem
    return scenes


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=Path)
    parser.add_argument("-o", "--plot", required=True)
    args = parser.parse_args()
    scenes = read(args.output.read_text())
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, len(scenes), figsize=(3 * len(scenes), 5), sharex=True, sharey=True,
                                    squeeze=False)
        for column, (scene, rows) in enumerate(scenes.items()):
            for row, by in enumerate(("scrambling", "block")):
                axis = axes[row][column]
                axis.axhline(95, color="black", linewidth=0.8)
                curves = [(name, values) for (kind, name), values in rows.items() if kind == by]
                for shift, (name, values) in enumerate(curves):
                    axis.errorbar([2 ** (0.06 * (shift - 2)) * r for r, _, _ in values], [c for _, c, _ in values],
                                  [e for _, _, e in values], color=COLORS[name], marker="o", markersize=3, linewidth=1,
                                  label=name)
                axis.set_xscale("log", base=2)
                axis.set_xticks([4, 8, 16, 32], ["4", "8", "16", "32"])
                axis.set_title(f"{scene}, {by}s", fontsize=9)
                if by == "block":  # where no curve comes low
                    axis.legend(fontsize=7, frameon=False, loc="lower right")
        axes[0][0].set_ylim(90, 100.5)
        for axis in axes[1]:
            axis.set_xlabel("replicates")
        figure.supylabel("intervals that hold the truth, %", fontsize=9)
        figure.tight_layout()
        figure.savefig(args.plot, metadata={"Date": None})


if __name__ == "__main__":
    main()
