#!/usr/bin/env python3
"""How well `etendue course check` tells what is wrong: prints a line a hand-in and the counts of docs/course.md.

usage: course_check.py ETENDUE planted|pairs|variants|unlisted|seeds [--probe-seed N] [--count N] [--seed N]

planted   each mistake of tests/course/mistakes.json alone
pairs     random pairs of them
variants  right integrators written in other ways, tests/course/variants.json
seeds     the right one with --count other seeds and probes: how often it fails
unlisted  wrong in ways that the check does not know, tests/course/unlisted.json
"""

import argparse
import json
import pathlib
import random
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / "tests" / "course"


def edited(edits):
    """The right solution with pieces of its text replaced; None where two edits want the same piece."""
    text = (FOLDER / "light_integrator.cpp").read_text()
    for old, new in edits:
        if text.count(old) != 1:
            return None
        text = text.replace(old, new)
    return text


def checked(options, source, seed, probe_seed):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "light_integrator.cpp").write_text(source)
        found = folder / "found.json"
        done = subprocess.run([options.etendue, "course", "check", name, "--no-scenes", "--json", found, "--seed", str(seed),
                               "--probe-seed", str(probe_seed), "--seconds", "1200"], capture_output=True, text=True)
        if not found.exists():
            raise SystemExit(done.stdout + done.stderr)
        return json.loads(found.read_text())


def classes(result):
    return [one["class"] for one in result.get("diagnosis", {}).get("findings", [])]


def told(result):
    """What was found, for the reader."""
    if "diagnosis" not in result:
        return f"{result['outcome']}: {result['why']} {result.get('compiler', '')}"
    names = [f"{one['class']} {one['name']} ({one['how']})" for one in result["diagnosis"]["findings"]]
    if result["diagnosis"]["is_unknown"]:
        names.append("unknown")
    return f"{result['outcome']}: {'; '.join(names)}"


def planted(options, mistakes):
    caught = first = two = 0
    for i, mistake in enumerate(mistakes):
        result = checked(options, edited(mistake["edits"]), options.seed + i, options.probe_seed + i)
        found = classes(result)
        caught += result["outcome"] == "wrong"
        first += found[:1] == [mistake["class"]]
        two += mistake["class"] in found[:2]
        print(f"{mistake['class']:2} {mistake['name']:34} {told(result)}", flush=True)
    print(f"caught {caught}, named first {first}, within the first two {two} of {len(mistakes)}")


def pairs(options, mistakes):
    numbers = random.Random(options.seed)
    caught = named = both = done = 0
    while done < options.count:
        a, b = numbers.sample(mistakes, 2)
        source = edited(a["edits"] + b["edits"])
        if source is None:
            continue
        done += 1
        result = checked(options, source, options.seed + done, options.probe_seed + done)
        found = classes(result)
        is_named = [one["class"] in found for one in (a, b)]
        caught += result["outcome"] == "wrong"
        named += any(is_named)
        both += all(is_named)
        print(f"{a['class']:2} + {b['class']:2} {'' if any(is_named) else 'NOT NAMED '}{told(result)}", flush=True)
    print(f"caught {caught}, one named {named}, both named {both} of {done}")


def listed(options, ways):
    for i, way in enumerate(ways):
        result = checked(options, edited(way["edits"]), options.seed + i, options.probe_seed + i)
        print(f"{way['name']:34} {told(result)}", flush=True)


def seeds(options):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "light_integrator.cpp").write_text(edited([]))
        subprocess.run([options.etendue, "course", "build", name], check=True, capture_output=True)
        failed = 0
        for i in range(options.count):
            subprocess.run([options.etendue, "course", "probe", folder / "build/liblight_integrator.so", name, "--seed",
                            str(options.seed + i), "--probe-seed", str(options.probe_seed + i)], check=True)
            result = json.loads((folder / "check.json").read_text())
            failed += not result["is_right"]
            if not result["is_right"]:
                print(i, [one for one in result["properties"] if one["verdict"] != "right"], flush=True)
            elif i % 50 == 49:
                print(f"{failed} of {i + 1} failed", flush=True)
        print(f"{failed} of {options.count} failed")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("etendue")
    parser.add_argument("what", choices=["planted", "pairs", "variants", "unlisted", "seeds"])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--probe-seed", type=int, default=1001)
    parser.add_argument("--count", type=int, default=40)
    options = parser.parse_args()
    mistakes = json.loads((FOLDER / "mistakes.json").read_text())
    if options.what == "planted":
        planted(options, mistakes)
    elif options.what == "pairs":
        pairs(options, mistakes)
    elif options.what == "seeds":
        seeds(options)
    else:
        listed(options, json.loads((FOLDER / f"{options.what}.json").read_text()))


if __name__ == "__main__":
    main()
