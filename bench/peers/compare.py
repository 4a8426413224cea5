"""Renders each scene with Etendue and its peers in turn and keeps what it measures, a JSON file a scene.

Each renderer takes the same seeds; first the settings of a peer are tried, then the best of them is measured in turn
with Etendue, image by image.
"""
import argparse
import datetime
import json
import os
import platform
from pathlib import Path

import numpy as np

from efficiency import agreement, efficiency, luminance, mean_of, relative_variance
from renderers import PEERS, Etendue
from scene_files import write_scene
from scenes import SCENES

BUDGETS_SPP = (16, 64)
CURVE_SPP = (4, 16, 64)  # of the error against time
SWEEP_SEEDS, SWEEP_FIRST_SEED, SWEEP_SHRINK = 3, 5000, 2
SWEEP_SUFFIX = "_small"
FINALISTS = 3
SECOND_LOOK_SEEDS, SECOND_LOOK_FIRST_SEED = 32, 9000


def main():
    options = read_options()
    cores = {int(core) for core in options.cores.split(",")}
    if max(os.getloadavg()) > 0.5:
        print(f"note: the machine is not idle (load {os.getloadavg()[0]:.1f})")
    for name in options.scenes:
        scene = SCENES[name]()
        folder = options.out / "work"
        write_scene(scene, folder, options.size)
        write_scene(scene, folder, options.size // SWEEP_SHRINK, SWEEP_SUFFIX)
        ours = Etendue(options.etendue, cores, folder)
        peers = [PEERS[key](cores, folder) for key in options.peers]
        try:
            result = measure(scene, ours, peers, options)
        finally:
            for peer in peers:
                peer.close()
        result["machine"] = {"cores": len(cores), "cpu": cpu_name(), "date": datetime.date.today().isoformat()}
        result["size_px"] = options.size
        (options.out / f"{name}.json").write_text(json.dumps(result, indent=1) + "\n")
        tell(result)


def read_options():
    parser = argparse.ArgumentParser(description="Measure Etendue beside other renderers.")
    parser.add_argument("--scenes", default=",".join(SCENES), help="by comma [all]")
    parser.add_argument("--peers", default=",".join(PEERS), help=f"by comma, of {', '.join(PEERS)} [all]")
    parser.add_argument("--etendue", required=True, help="the program")
    parser.add_argument("--out", type=Path, required=True, help="folder for what is measured")
    parser.add_argument("--seeds", type=int, default=6, help="images of each renderer, 6 to 10 [6]")
    parser.add_argument("--size", type=int, default=512, help="pixels each way [512]")
    parser.add_argument("--cores", default=str(max(os.sched_getaffinity(0))), help="to run on, by comma [the last]")
    parser.add_argument("--quick", action="store_true", help="128 x 128 pixels, 6 seeds, 16 samples a pixel")
    options = parser.parse_args()
    options.scenes, options.peers = options.scenes.split(","), options.peers.split(",")
    for name, known in [(n, SCENES) for n in options.scenes] + [(n, PEERS) for n in options.peers]:
        if name not in known:
            parser.error(f"unknown '{name}'; known: {', '.join(known)}")
    if not 6 <= options.seeds <= 10:
        parser.error("--seeds: 6 to 10")
    options.budgets = BUDGETS_SPP
    if options.quick:
        options.size, options.seeds, options.budgets = 128, 6, BUDGETS_SPP[:1]
    return options


def cpu_name():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def measure(scene, ours, peers, options):
    """Everything that is kept of a scene."""
    result = {"scene": scene.name, "about": scene.about, "budgets": {}, "curves": {}}
    best = {peer: sweep(scene, peer, options.budgets) for peer in peers}
    images = options.out / f"{scene.name}.npz"
    for spp in options.budgets:
        entries = [(ours, name, setting) for name, setting in ours.settings(scene).items()]
        entries += [(peer, *best[peer][spp]) for peer in peers]
        runs = in_turn(scene, entries, spp, range(1, options.seeds + 1))
        stacks = [luminance([run.image for run in mine]) for mine in runs]
        rows = []
        for (renderer, name, _), mine, stack in zip(entries, runs, stacks):
            rows.append(row(renderer, name, spp, stack, [run.seconds for run in mine]))
        # The first of Etendue's is held against each peer, and its own others against it.
        for index in range(1, len(rows)):
            agreed = agreement(stacks[0], stacks[index])
            seeds = options.seeds
            if agreed.what_differs():
                agreed, seeds = second_look(scene, entries[0], entries[index], spp), SECOND_LOOK_SEEDS
            rows[index]["agreement"] = {"seeds": seeds, "ratio": agreed.ratio, "worst_z": agreed.worst_z,
                                        "z_limit": agreed.z_limit, "void": agreed.what_differs()}
        result["budgets"][str(spp)] = rows
        if spp == options.budgets[0]:
            np.savez_compressed(images, **{rows[i]["renderer"] + "/" + rows[i]["setting"]: runs[i][0].image
                                           for i in range(len(rows))})
    entries = [(ours, *list(ours.settings(scene).items())[0])]
    entries += [(peer, *best[peer][options.budgets[-1]]) for peer in peers]
    for spp in CURVE_SPP[:1 if options.quick else None]:
        known = {(r["renderer"], r["setting"]): r for r in result["budgets"].get(str(spp), [])}
        for entry in entries:
            point = known.get((entry[0].title, entry[1]))
            if point is None:
                mine = in_turn(scene, [entry], spp, range(1, options.seeds + 1))[0]
                point = row(entry[0], entry[1], spp, luminance([run.image for run in mine]),
                            [run.seconds for run in mine])
            result["curves"].setdefault(entry[0].title, []).append(
                {"seconds": point["seconds"][0], "relative_variance": point["variance_times_spp"][0] / spp})
    return result


def sweep(scene, peer, budgets):
    """The best setting for each number of samples a pixel, as name and keys: one axis after the other with the fewest
    samples, then the finalists again with more. All on a smaller picture."""
    axes = peer.axes(scene)
    chosen = {axis: next(iter(choices)) for axis, choices in axes.items()}
    tried = {}

    def score(names, spp):
        setting = {key: value for axis, name in names.items() for key, value in axes[axis][name].items()}
        title = ", ".join(names.values())
        seeds = range(SWEEP_FIRST_SEED, SWEEP_FIRST_SEED + SWEEP_SEEDS)
        runs = [peer.render(scene.name + SWEEP_SUFFIX, setting, seed, spp) for seed in seeds]
        variance = relative_variance(luminance([run.image for run in runs]))
        return efficiency(variance, [run.seconds for run in runs]).value, title, setting

    for axis, choices in axes.items():
        for name in choices:
            names = {**chosen, axis: name}
            if tuple(names.values()) not in tried:
                tried[tuple(names.values())] = score(names, budgets[0])
        chosen = dict(zip(axes, max(tried, key=lambda key: tried[key][0])))
    order = sorted(tried, key=lambda key: -tried[key][0])
    best = {budgets[0]: tried[order[0]][1:]}
    for spp in budgets[1:]:
        best[spp] = max((score(dict(zip(axes, key)), spp) for key in order[:FINALISTS]), key=lambda s: s[0])[1:]
    return best


def in_turn(scene, entries, spp, seeds):
    """A list of runs for each of (renderer, name, setting), rendered seed by seed in turn."""
    runs = [[] for _ in entries]
    for seed in seeds:
        for (renderer, _, setting), mine in zip(entries, runs):
            mine.append(renderer.render(scene.name, setting, seed, spp))
    return runs


def second_look(scene, entry, other, spp):
    """Whether two agree by fresh images alone, so many that the spread of rare bright samples shows."""
    seeds = range(SECOND_LOOK_FIRST_SEED, SECOND_LOOK_FIRST_SEED + SECOND_LOOK_SEEDS)
    return agreement(*([luminance(run.image) for run in mine] for mine in in_turn(scene, [entry, other], spp, seeds)))


def row(renderer, name, spp, stack, seconds):
    variance, robust = relative_variance(stack), relative_variance(stack, is_robust=True)
    return {"renderer": renderer.title, "setting": name, "spp": spp,
            "msamples_per_second": stack[0].size * spp / 1e6 / mean_of(seconds).value,
            "seconds": numbers(mean_of(seconds)), "variance_times_spp": numbers(variance, spp),
            "efficiency": numbers(efficiency(variance, seconds)),
            "robust_efficiency": numbers(efficiency(robust, seconds))}


def numbers(estimate, scale=1):
    """Value, standard error of its logarithm, degrees of freedom."""
    return [estimate.value * scale, estimate.log_error, estimate.degrees]


def tell(result):
    for spp, rows in result["budgets"].items():
        for r in rows:
            void = r.get("agreement", {}).get("void", "")
            print(f"{result['scene']:20} {spp:>3} spp  {r['renderer'] + ' ' + r['setting']:70} "
                  f"{r['msamples_per_second']:7.2f} Ms/s  variance x spp {r['variance_times_spp'][0]:10.4g}  "
                  f"efficiency {r['efficiency'][0]:10.4g}  robust {r['robust_efficiency'][0]:10.4g}"
                  f"{'  VOID: ' + void if void else ''}", flush=True)


if __name__ == "__main__":
    main()
