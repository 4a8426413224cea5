#!/usr/bin/env python3
"""What weights of light samples and BSDF samples are worth beside those by power: the table of docs/light_sampling.md.

usage: weights.py ETENDUE SCENE.xml... [--integrators mis,direct_light] [--weights compensated,optimal] [--spp 16]
                  [--seeds 4]

For each scene and integrator the variance between seeds, its mean over pixels, and the efficiency, 1 over variance
times processor time, both over those of power. The time is of one thread, least of the seeds, pilots counted and the
reading of the scene not; the ways take turns, so that what else the machine does meets all of them.
"""
import argparse
import json
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "report"))
from images import luminance, read_exr  # noqa: E402


def processor_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def render(program, scene, integrator, weights, spp, seed):
    """The luminances, and the seconds that pilots and rendering took."""
    with tempfile.TemporaryDirectory() as folder:
        image, stats = Path(folder) / "image.exr", Path(folder) / "stats.json"
        before = processor_seconds()
        subprocess.run([program, "render", scene, "--integrator", integrator, "--weights", weights, "--spp", str(spp),
                        "--seed", str(seed), "--threads", "1", "--quiet", "-o", image, "--stats", stats], check=True)
        told = json.loads(stats.read_text())
        seconds = processor_seconds() - before - told["seconds_load"] - told["seconds_build"]
        return luminance(read_exr(image)[0].astype(float)), seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("scenes", nargs="+", type=Path)
    parser.add_argument("--integrators", default="mis,direct_light")
    parser.add_argument("--weights", default="compensated,optimal")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--seeds", type=int, default=4)
    options = parser.parse_args()
    ways = ["power", *options.weights.split(",")]
    print("| scene | integrator | " + " | ".join(f"{way}: variance | efficiency" for way in ways[1:]) + " |")
    print("|---" * (2 + 2 * len(ways[1:])) + "|")
    for scene in options.scenes:
        for integrator in options.integrators.split(","):
            images, seconds = {way: [] for way in ways}, {way: [] for way in ways}
            for seed in range(options.seeds):
                for way in ways:
                    image, took = render(options.program, scene, integrator, way, options.spp, seed)
                    images[way].append(image)
                    seconds[way].append(took)
            variance = {way: np.stack(images[way]).var(axis=0, ddof=1).mean() for way in ways}
            cells = []
            for way in ways[1:]:
                noise = variance[way] / variance["power"]
                cells += [f"{noise:.3f}", f"{min(seconds['power']) / min(seconds[way]) / noise:.2f}"]
            print(f"| {scene.name.split('.')[0]} | {integrator} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
