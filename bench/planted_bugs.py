#!/usr/bin/env python3
"""Does `etendue verify` find planted bugs: each of them on the exercise's scenes, and nothing where there is none.
docs/verify.md has the figures.

usage: planted_bugs.py BUILD [--time S] [--only BUG ...]     BUILD: build/release, with its target etendue_planted_kernel
"""
import argparse
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
AREA, PLATES, BALL = (ROOT / "scenes" / f"{name}.xml" for name in ("ex3/area_sampling", "ex3/phong_plates", "coarse_ball"))
# A scene that shows the bug; where there is none, all must be silent.
BUGS = [("none", AREA), ("none", PLATES), ("none", BALL), ("no_light_pmf", AREA), ("pmf_of_another_sampler", AREA),
        ("number_reused", AREA), ("light_never_chosen", AREA), ("tree_blind", AREA), ("points_not_uniform", AREA),
        ("area_of_one_triangle", AREA), ("cosine_twice", AREA), ("cosine_missing", AREA), ("geometric_cosine", BALL),
        ("distance_not_squared", AREA), ("factor_2", AREA), ("one_over_pi_missing", AREA), ("no_shadow_ray", AREA),
        ("shadow_ray_too_short", BALL), ("shadow_ray_too_long", AREA), ("self_shadow", BALL),
        ("samples_not_averaged", AREA), ("technique_density", AREA), ("mis_density_of_one_side", PLATES),
        ("mis_without_pmf", PLATES), ("mis_light_side_in_full", PLATES), ("mis_met_side_in_full", PLATES),
        ("mis_heuristics_mixed", PLATES), ("bsdf_cosine_missing", AREA), ("bsdf_pdf_of_one_lobe", PLATES),
        ("resampling_divided_twice", AREA)]


def run(build, bug, scene, seconds, options):
    """Of one run: its JSON, seconds."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [build / "etendue", "verify", scene, "--isa", "v3", "--quiet", "--json", report, *options]
        if seconds:
            command += ["--time", str(seconds)]
        start = time.monotonic()
        done = subprocess.run(command, capture_output=True, text=True,
                              env={**os.environ, "LD_LIBRARY_PATH": str(build / "planted"), "ETENDUE_PLANTED_BUG": bug})
        taken = time.monotonic() - start
        if done.returncode not in (0, 1):
            raise RuntimeError(f"{bug}: exit code {done.returncode}\n{done.stderr}")
        return json.loads(report.read_text()), taken


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("--time", type=float, default=50)
    parser.add_argument("--only", nargs="*")
    parser.add_argument("options", nargs="*", help="for etendue verify, behind --")
    arguments = parser.parse_args()
    wrong = 0
    for bug, scene in BUGS:
        if arguments.only and bug not in arguments.only:
            continue
        report, taken = run(arguments.build.resolve(), bug, scene, arguments.time, arguments.options)
        odd = [e["name"] for e in report["estimators"] if e["is_odd"]]
        differing = [p for p in report["pairs"] if p["verdict"] == "differ"]
        is_right = bool(differing) == (bug != "none")
        wrong += not is_right
        least = min((p["p_value"] for p in report["pairs"]), default=1)
        print(f"{bug:26} {scene.stem:14} {'ok' if is_right else 'WRONG':6} {taken:5.1f} s  "
              f"{len(differing):2} of {len(report['pairs'])} pairs differ, p {least:.1g}; odd: {', '.join(odd) or '-'}",
              flush=True)
    raise SystemExit(wrong > 0)


if __name__ == "__main__":
    main()
