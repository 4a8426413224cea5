#!/usr/bin/python3
"""Do two builds of etendue make the same images, bit for bit? Shows that a refactoring changed none.

Renders small copies of the scenes of this project, and of the Nori scenes where they are, with both programs and equal
options: this project's by every integrator and sampler, the others as they stand and by a few integrators, all with one
lane and with the most.
Prints a table; ends with 1 where any two differ, with 2 where nothing could be compared. Needs NumPy and OpenImageIO
(scripts/setup.sh report).
"""
import argparse
import itertools
import os
import re
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

ROOT = Path(__file__).resolve().parent.parent
INTEGRATORS = ("light", "direct", "average", "mis", "every_light", "whitted", "path_ems", "path_mats", "path_mis",
               "normals", "av", "ao", "material")
INTEGRATORS_OF_OTHERS = ("light", "mis", "every_light", "path_mis")
OWN = "(own)"  # what the scene file says
ISAS = ("scalar", "widest")
WIDTH_PX = 64  # blocks of many pixels
# A pixel of more samples than a block holds; few pixels, so that it takes no longer.
DEEP_SPP, DEEP_WIDTH_PX = 2080, 4


@dataclass(frozen=True)
class Case:
    scene: Path
    integrator: str
    sampler: str
    isa: str
    spp: int
    width_px: int = WIDTH_PX

    def __str__(self):
        return f"{self.scene.stem:20} {self.integrator:12} {self.sampler:12} {self.isa:7} {self.spp:5}"


def cases_of(scene, spp, replicates):
    if scene.is_relative_to(ROOT):
        yield from (Case(scene, *rest, spp) for rest in itertools.product(INTEGRATORS + (OWN,),
                                                                           ("sobol", "independent"), ISAS))
        yield from (Case(scene, OWN, "sobol", isa, DEEP_SPP // replicates * replicates, DEEP_WIDTH_PX) for isa in ISAS)
    else:
        yield from (Case(scene, integrator, "sobol", isa, spp)
                    for integrator, isa in itertools.product(INTEGRATORS_OF_OTHERS + (OWN,), ISAS))


def find_scenes(data):
    nori = (f for f in sorted(data.glob("nori-*/**/*.xml")) if "<scene" in f.read_text(errors="replace"))
    stand_alone = (f for f in nori if "<test" not in f.read_text(errors="replace"))
    return [*sorted((ROOT / "scenes").glob("*.xml")), *sorted((ROOT / "scenes/ex3").glob("*.xml")),
            ROOT / "scenes/tests/every_kind.xml", *stand_alone]


def small_copy(case, folder, number):
    """The scene at the case's width; its files are found where they are."""
    text = case.scene.read_text(errors="replace")
    text = re.sub(r'(name="filename"\s+value=")', lambda m: f"{m[1]}{case.scene.parent.resolve()}/", text)
    sizes = {k: re.search(rf'<integer name="{k}"\s+value="(\d+)"', text) for k in ("width", "height")}
    if all(sizes.values()):
        width, height = (int(m[1]) for m in sizes.values())
        for name, size in (("width", case.width_px), ("height", max(1, round(case.width_px * height / width)))):
            text = re.sub(rf'(<integer name="{name}"\s+value=")\d+', rf"\g<1>{size}", text)
    copy = folder / f"{number}_{case.scene.name}"
    copy.write_text(text)
    return copy


def render(program, case, scene, output, replicates, extra):
    """The pixels by the names of their channels, or the first line of what the program said."""
    options = ["--spp", str(case.spp), "--replicates", str(replicates), "--sampler", case.sampler, "--threads", "1",
               *(["--integrator", case.integrator] if case.integrator != OWN else []),
               *(["--isa", case.isa] if case.isa != "widest" else [])]
    done = subprocess.run([program, "render", scene, "-o", output, "--quiet", *options, *extra], capture_output=True,
                          text=True)
    if done.returncode != 0:
        return f"exit code {done.returncode}: {(done.stderr.splitlines() or [''])[0]}"
    file = oiio.ImageInput.open(str(output))
    pixels = np.asarray(file.read_image(oiio.FLOAT), dtype=np.float32)
    names = file.spec().channelnames
    file.close()
    return {name: pixels[..., c] for c, name in enumerate(names)}


def comparison(before, after):
    """(whether equal, what to say). Channels that only one of the images has are not compared."""
    if isinstance(before, str) or isinstance(after, str):
        if before == after:
            return True, f"both refuse: {before}"
        return False, "; then ".join(side if isinstance(side, str) else "renders" for side in (before, after))
    a, b = (np.stack([image[n] for n in sorted(before.keys() & after.keys())], axis=-1) for image in (before, after))
    if a.shape != b.shape:
        return False, f"{a.shape[1]} x {a.shape[0]} pixels, then {b.shape[1]} x {b.shape[0]}"
    is_other = a.view(np.uint32) != b.view(np.uint32)
    differing = is_other.any(axis=-1)
    if not differing.any():
        return True, "same bits"
    a, b = a[is_other].astype(np.float64), b[is_other].astype(np.float64)
    with np.errstate(invalid="ignore"):
        relative = np.abs(a - b) / np.maximum(np.maximum(np.abs(a), np.abs(b)), np.finfo(np.float32).tiny)
    means = [np.mean([image[c] for c in "RGB"], dtype=np.float64) for image in (before, after)]
    return False, (f"{differing.sum()} of {differing.size} pixels differ, largest relative difference "
                   f"{relative.max():.2g}; mean {means[0]:.6g}, then {means[1]:.6g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=Path, help="a program etendue")
    parser.add_argument("after", type=Path, help="the other")
    parser.add_argument("--before-args", type=shlex.split, default=[], metavar="ARGS", help="more options of before")
    parser.add_argument("--after-args", type=shlex.split, default=[], metavar="ARGS", help="more options of after")
    parser.add_argument("--only", default="", metavar="REGEX", help="cases whose path, or line of the table, fits")
    parser.add_argument("--spp", type=int, default=8, help="samples a pixel [8]")
    parser.add_argument("--replicates", type=int, default=4, help="of which the samples are parts [4]")
    parser.add_argument("--data", type=Path, default=os.environ.get("ETENDUE_TEST_DATA", ROOT.parent / "shared/data"))
    arguments = parser.parse_args()

    cases = [case for scene in find_scenes(Path(arguments.data))
             for case in cases_of(scene, arguments.spp, arguments.replicates)
             if re.search(arguments.only, f"{case.scene} {case}")]
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        def compare(number):
            scene = small_copy(cases[number], Path(name), number)
            sides = ((arguments.before, arguments.before_args), (arguments.after, arguments.after_args))
            return comparison(*(render(program.resolve(), cases[number], scene, Path(name) / f"{number}_{side}.exr",
                                       arguments.replicates, extra) for side, (program, extra) in enumerate(sides)))

        differing = refused = 0
        for case, (is_equal, said) in zip(cases, pool.map(compare, range(len(cases)))):
            differing += not is_equal
            refused += said.startswith("both refuse")
            print(f"{case}  {said}", flush=True)
    print(f"{len(cases)} cases: {len(cases) - differing - refused} equal to the bit, {differing} differ, "
          f"{refused} refused by both")
    return 1 if differing else 2 if refused == len(cases) else 0


if __name__ == "__main__":
    sys.exit(main())
