#!/usr/bin/python3
"""Runs every test and renders every scene of the Nori family that is there, and compares with the reference images.

The files are not part of the project: they are looked for in ../shared/data, or in $ETENDUE_TEST_DATA. Tests run with
three seeds. Scenes are rendered as they stand. Where a reference image exists, ours has to agree with it (see
image_blocks.py) and be the right way round. Where none exists and the scene has one integrator that another one must
agree with, both are rendered and compared in the same way. Needs NumPy, Pillow and OpenImageIO
(scripts/setup.sh report).
"""
import argparse
import json
import math
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "report"))
from image_blocks import FACTOR_WHITE, compare, is_right_way_round  # noqa: E402
from images import read_exr, srgb  # noqa: E402

# The generation that each course belongs to. --dialect is passed only for files that do not tell themselves.
DIALECTS = [("nori-cornell2012", "nori-2012"), ("nori-acg13", "nori-2012"), ("nori-eth", "nori-eth"),
            ("nori-tuebingen", "nori-eth"), ("nori-", "nori")]
UNTOLD = "nothing in the file tells"  # so begins etendue's reason for taking the default dialect
SEEDS = (0, 1, 2)
REPLICATES = 8
LEAST_SPP = 64
FALSE_ALARMS = 1e-4  # of all images of a run together
FIGURE_WIDTH = 288
FIGURE_Z = 5.0
# Of scenes without a reference: what else must give the same picture.
PARTNERS = {"path": "path_mis", "path_ems": "path_mis", "path_mis": "path_ems", "mipath": "path_ems",
            "path_mats": "path_mis", "light": "mis", "mis": "direct"}


@dataclass
class Explanation:
    """Why a reference is not what its scene says, and what has to agree with it if that is so."""
    scene: str
    why: str
    altered: tuple = ()  # (old text of the scene, new text) ...: a copy so changed agrees
    least_brightness: float = 0.0  # blocks that are brighter agree
    rim_of: float = None  # blocks agree but for those with pixels on both sides of this radiance
    has_twins: bool = False  # a copy whose meshes have each triangle once agrees


EXPLANATIONS = [
    Explanation("nori-eth2015-scenes/pa3/sphere/",
                "The three references agree with each other, but show everything 1 % larger than the file says: the same "
                "scene with a field of view of 39.65 instead of 40 degrees agrees.",
                altered=(('name="fov" value="40"', 'name="fov" value="39.65"'),)),
    Explanation("nori-wjakob-scenes/pa4/motto/motto-diffuse.xml",
                "The lights are coarse spheres (528 triangles) with vertex normals. Nori's light samples take their cosine "
                "by the interpolated normal, ours by that of the triangle, which is what rays that meet the light by "
                "chance see too. Integrated over the meshes, its lights are 0.3 to 0.45 % darker: with lights of 0.9965 of "
                "the radiance the scene agrees.",
                altered=(('value="20, 80, 30"', 'value="19.93, 79.72, 29.895"'),
                         ('value="20, 20, 200"', 'value="19.93, 19.93, 199.3"'))),
    Explanation("nori-eth-scenes/pa3/veach_mi/veach_mats.xml",
                "The lights are spheres of 768 triangles with vertex normals. Nori asks the interpolated normal whether "
                "a light is seen from its front, so that a thin rim of them is black: 0.15 % of their disks, by an "
                "integral over the mesh. Blocks without a rim agree.",
                rim_of=1.2),
    Explanation("nori-zaragoza-scenes/assignment-2/cbox/cbox_ems.xml",
                "Where light arrives at a grazing angle, within 2 cm of the height of the lamp, the reference is up to 18 % "
                "darker. The reference of Nori's own course for the same box (cbox-distributed) is not, and agrees with ours "
                "there too. Blocks in which radiance is above 0.05 (the picture's mean is 0.33) agree.",
                least_brightness=0.05),
    Explanation("nori-acg13-phong/phong-path.xml",
                "sphere.obj, of which both lights are made, has each of its 4900 triangles twice. Light samples find both, "
                "rays that meet the light by chance one of them: light samples are twice as bright. With each triangle "
                "once the integrators agree.",
                has_twins=True),
]


@dataclass
class Row:
    """A line of the table."""
    file: str
    dialect: str = ""
    result: str = ""
    figures: str = ""
    is_good: bool = False
    why: str = ""
    figure: Path = None


class Program:
    def __init__(self, path, threads):
        self.path, self.threads = path, threads

    def run(self, command, *arguments):
        """Exit code and what it said about errors."""
        done = subprocess.run([self.path, command, *map(str, arguments), "--threads", str(self.threads), "--quiet"],
                              capture_output=True, text=True)
        return done.returncode, done.stderr.strip()


def dialect_of(file):
    return next(dialect for prefix, dialect in DIALECTS if file.parts[0].startswith(prefix))


def find_files(data):
    """Test files and scenes, relative to data, by the root element that each has."""
    tests, scenes = [], []
    for path in sorted(data.glob("nori-*/**/*.xml")):
        text = re.sub(r"<!--.*?-->", "", path.read_text(errors="replace"), flags=re.S)
        root = re.search(r"<(scene|test)\b", text)
        if root:
            (tests if root[1] == "test" else scenes).append(path.relative_to(data))
    return tests, scenes


def reference_of(data, scene):
    """The reference image, and its samples a pixel where its name tells them."""
    for folder in ("ref", "references"):
        for above in scene.parents:
            for image in sorted((data / above / folder).glob("*.exr")):
                match = re.fullmatch(re.escape(scene.stem) + r"(?:_(\d+)spp)?", image.stem)
                if match:
                    return image, int(match[1]) if match[1] else None
    return None, None


def check_tests(program, data, file, folder):
    row = Row(str(file), dialect_of(file))
    least, total, problems, failed_seeds = 1.0, 0, [], 0
    for seed in SEEDS:
        report = folder / "tests.json"
        report.unlink(missing_ok=True)
        code, said = program.run("test", data / file, "--seed", seed, "--json", report, "--dialect", row.dialect)
        if code not in (0, 1) or not report.exists():
            row.result = "not run"
            row.figures = said.splitlines()[0] if said else f"exit code {code}"
            return row
        cases = json.loads(report.read_text())
        total += len(cases)
        failed_seeds += any(not case["passed"] for case in cases)
        problems += [f"seed {seed}, case {case['case']}" for case in cases if not case["passed"]]
        least = min([least] + [case["p_value"] for case in cases if case["p_value"] is not None])
    # The files judge at a level of 1 %, so that one seed in a hundred fails where nothing is wrong; two of three fail
    # in one file of 3000.
    row.is_good = failed_seeds <= 1 and total > 0
    row.result = "passes" if not problems else f"{'passes' if row.is_good else 'FAILS'} but for {'; '.join(problems)}"
    row.figures = f"{total // len(SEEDS)} cases x {len(SEEDS)} seeds, least p {least:.2g}"
    return row


def render(program, data, scene, output, spp, dialect=None, integrator=None, seed=0, is_reused=False):
    """The stats of a render, after which `output` is there. Raises RuntimeError with what the program said."""
    stats = output.with_suffix(".json")
    if not (is_reused and output.exists() and stats.exists() and json.loads(stats.read_text())["spp"] == spp):
        arguments = ["--dialect", dialect] if dialect else []
        arguments += ["--integrator", integrator] if integrator else []
        code, said = program.run("render", data / scene, "-o", output, "--sampler", "independent", "--spp", spp,
                                 "--replicates", min(REPLICATES, spp), "--seed", seed, "--stats", stats, *arguments)
        if code != 0:
            raise RuntimeError(said.splitlines()[0] if said else f"exit code {code}")
    return json.loads(stats.read_text())


def told_dialect(program, data, scene, folder):
    """(dialect to pass or None, what decided): by one render of 1 sample."""
    stats = render(program, data, scene, folder / "probe.exr", 1)
    wanted = dialect_of(scene)
    if not stats["dialect_reason"].startswith(UNTOLD):
        if stats["dialect"] != wanted:
            raise RuntimeError(f"read as {stats['dialect']}, but its course is of {wanted}")
        return None, stats["dialect_reason"].split(":")[0].replace("<", "&lt;")
    return (None, "default") if stats["dialect"] == wanted else (wanted, "`--dialect`")


def sample_count(data, scene):
    """What the file's sampler says."""
    text = re.sub(r"<!--.*?-->", "", (data / scene).read_text(errors="replace"), flags=re.S)
    match = re.search(r'name="sampleCount"\s+value="(\d+)"', text)
    return int(match[1]) if match else 1


def rounded_up(spp):
    return math.ceil(spp / REPLICATES) * REPLICATES


def check_scene(program, data, scene, folder, arguments, level):
    row = Row(str(scene), dialect_of(scene))
    reference, reference_spp = reference_of(data, scene)
    reference_spp = reference_spp or sample_count(data, scene)
    stem = "_".join(scene.with_suffix("").parts)
    try:
        dialect, reason = told_dialect(program, data, scene, folder)
        row.dialect = f"{row.dialect} ({reason})"
        spp = rounded_up(max(LEAST_SPP, arguments.effort * reference_spp) if reference else arguments.spp)
        ours_path = folder / f"{stem}.exr"
        stats = render(program, data, scene, ours_path, spp, dialect, is_reused=arguments.reuse)
        if stats["invalid_samples"]:
            raise RuntimeError(f"{stats['invalid_samples']} invalid samples")
        ours, stderr = read_exr(ours_path)
        if not np.isfinite(ours).all() or not ours.any():
            raise RuntimeError("not finite, or black")
        partner = PARTNERS.get(stats["integrator"])
        if reference:
            other = read_rgb(reference)
            if other.shape != ours.shape:
                raise RuntimeError(f"the reference has {other.shape[1]} x {other.shape[0]} pixels")
            share = spp / reference_spp
            found = compare(ours, stderr, spp, other, share, level)
            against = f"reference ({reference_spp} spp)"
            variance = stderr.astype(np.float64) ** 2 * (1 + share)
            is_upright = is_right_way_round(ours.astype(np.float64), variance, other)
            explanation = next((e for e in EXPLANATIONS if row.file.startswith(e.scene)), None)
            if explanation and not is_agreed(found):
                row.why = explanation.why
                explained, explained_stderr = ours, stderr
                if explanation.altered:
                    path = folder / f"{stem}.altered.exr"
                    render(program, data, altered_copy(data / scene, explanation, folder), path, spp, dialect,
                           is_reused=arguments.reuse)
                    explained, explained_stderr = read_exr(path)
                after = compare(explained, explained_stderr, spp, other, share, level,
                                least_brightness=explanation.least_brightness, rim_of=explanation.rim_of)
        elif partner:
            other_path = folder / f"{stem}.{partner}.exr"
            render(program, data, scene, other_path, spp, dialect, partner, seed=1, is_reused=arguments.reuse)
            other, other_stderr = read_exr(other_path)
            both = np.sqrt(stderr ** 2 + other_stderr ** 2)
            is_upright = True
            found = compare(ours, both, spp, other, 0.0, level, FACTOR_WHITE)
            explanation = next((e for e in EXPLANATIONS if row.file.startswith(e.scene)), None)
            if explanation and not is_agreed(found):
                row.why = explanation.why
                copy = altered_copy(data / scene, explanation, folder)
                pair = []
                for seed, name in enumerate((stats["integrator"], partner)):
                    path = folder / f"{stem}.altered.{name}.exr"
                    render(program, data, copy, path, spp, dialect, name, seed, arguments.reuse)
                    pair += read_exr(path)
                after = compare(pair[0], np.sqrt(pair[1] ** 2 + pair[3] ** 2), spp, pair[2], 0.0, level, FACTOR_WHITE)
            against = f"`{partner}`"
        else:
            row.result, row.is_good = "renders; nothing to compare with", True
            row.figures = f"{spp} spp"
            return row
    except RuntimeError as problem:
        row.result, row.figures = "FAILS", str(problem)
        return row
    row.is_good = is_agreed(found)
    row.result = f"agrees with {against}" if row.is_good else f"DISAGREES with {against}"
    row.figures = f"{figures_of(found)}; {spp} spp"
    if row.why:
        row.is_good = is_agreed(after)
        row.result = f"{'differs, explained' if row.is_good else 'DISAGREES, NOT as explained'}: {against}"
        row.figures += f". As explained: {figures_of(after)}"
    if not is_upright:
        row.result, row.is_good = "MIRRORED", False
    row.figure = folder / f"{stem}.png"
    save_figure(row.figure, ours, found.z_map)
    return row


def is_agreed(found):
    return max(found.max_z, abs(found.global_z)) <= found.limit_z


def figures_of(found):
    return (f"max abs z {found.max_z:.2f} (expected {found.expected_max_z:.1f}, limit {found.limit_z:.1f}), "
            f"rms z {found.rms_z:.2f}, whole picture {100 * found.global_difference:+.3f} % (z {found.global_z:+.1f}), "
            f"noise ratio {found.noise_ratio:.2f}, p {found.p_value:.2g}")


def without_twins(obj):
    """An OBJ file less the faces whose corners are where those of an earlier face are."""
    vertices, known, lines = [], set(), []
    for line in obj.splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(tuple(words[1:4]))
        if words[:1] == ["f"]:
            face = frozenset(vertices[int(corner.split("/")[0]) - 1] for corner in words[1:])
            if face in known:
                continue
            known.add(face)
        lines.append(line)
    return "\n".join(lines) + "\n"


def altered_copy(path, explanation, folder):
    """A copy of the scene in which the explanation's texts are changed; its files are found where they are."""
    text = path.read_text()
    for old, new in explanation.altered:
        if old not in text:
            raise RuntimeError(f"has no {old}, which its explanation changes")
        text = text.replace(old, new)
    meshes = folder.resolve() if explanation.has_twins else path.parent.resolve()
    for mesh in set(re.findall(r'name="filename" value="([^"]*[.]obj)"', text)) if explanation.has_twins else ():
        (meshes / mesh).write_text(without_twins((path.parent / mesh).read_text()))
    text = re.sub(r'(name="filename" value=")', lambda m: f"{m[1]}{meshes}/", text)
    copy = (folder / f"altered_{path.name}").resolve()
    copy.write_text(text)
    return copy


def read_rgb(path):
    import OpenImageIO as oiio
    file = oiio.ImageInput.open(str(path))
    if not file:
        raise RuntimeError(f"{path}: {oiio.geterror()}")
    names = list(file.spec().channelnames)
    pixels = np.asarray(file.read_image(oiio.FLOAT))[..., [names.index(n) for n in "RGB"]]
    file.close()
    return pixels


def z_colors(z):
    """White at 0, red where ours is brighter, blue where it is darker, by the channel of the largest |z|."""
    worst = np.take_along_axis(z, np.abs(z).argmax(axis=2)[..., None], axis=2)[..., 0]
    x = np.clip(worst / FIGURE_Z, -1, 1)
    return np.rint(255 * np.stack([1 + np.minimum(x, 0), 1 - np.abs(x), 1 - np.maximum(x, 0)], axis=2)).astype(np.uint8)


def save_figure(path, ours, z):
    """Ours and the map of z, side by side."""
    size = (FIGURE_WIDTH, round(FIGURE_WIDTH * ours.shape[0] / ours.shape[1]))
    figure = Image.new("RGB", (2 * size[0] + 4, size[1]), "white")
    figure.paste(Image.fromarray(srgb(ours)).resize(size, Image.BOX), (0, 0))
    figure.paste(Image.fromarray(z_colors(z)).resize(size, Image.NEAREST), (size[0] + 4, 0))
    figure.quantize(128).save(path, optimize=True)


PAGE = """# The Nori family, file by file

The tests and scenes of courses that use a renderer of the Nori family, run as they stand. This page is
written by `scripts/check_nori_family.py --write docs/nori.md`, which anybody who has the files can run again; it ends
with 1 where something disagrees. The files themselves, and the reference images, belong to their authors and are not
part of the project.

Dialects are those of `docs/scene_format.md`: in brackets, what told it. Where it says `--dialect`, the file itself tells
nothing, and its course was named on the command line.

## Tests

`etendue test` with seeds {seeds}, at the level that each file asks for. Least p: of all cases and seeds, each by itself.

| file | dialect | result | figures |
|---|---|---|---|
{tests}

## Scenes

Means of 16 x 16 pixels are compared with the reference image, channel by channel, and the whole picture too; both
noises are estimated, and the limit of abs z is such that one run in {runs} would tell of a disagreement where there is none
(`scripts/image_blocks.py` says how and why). "Expected": the median of the largest abs z of as many blocks. "rms z" is 1
where the noise is well estimated, below where edges make the estimate too large. "Noise ratio" is the reference's noise,
by its own scatter, in units of what our samples predict for its number of samples; far above 1 it was sampled in another
way than ours. Where there is no reference, the same scene by another integrator that must agree stands in.
{effort}

| file | dialect | result | figures |
|---|---|---|---|
{scenes}

## Differences, and why

{why}

## Pictures

Ours, and the map of z: white at 0, red where ours is brighter, blue where it is darker; full colour at 5.

{figures}
"""


def write_page(path, rows, test_count, arguments):
    images = path.parent / "images" / "nori"
    images.mkdir(parents=True, exist_ok=True)

    def table(some):
        return "\n".join(f"| `{r.file}` | {r.dialect} | {r.result} | {r.figures} |" for r in some)

    reasons = {}
    for row in rows:
        if row.why:
            reasons.setdefault(row.why, []).append(f"`{row.file}`")
    shown = [row for row in rows if row.figure]
    for row in shown:
        shutil.copyfile(row.figure, images / row.figure.name)
    path.write_text(PAGE.format(
        seeds=", ".join(map(str, SEEDS)), runs=f"{1 / FALSE_ALARMS:,.0f}", tests=table(rows[:test_count]),
        effort=f"Our samples for each one of the reference: {arguments.effort:g}, at least {LEAST_SPP} a pixel.",
        scenes=table(rows[test_count:]),
        why="\n".join(f"- {', '.join(files)}: {why}" for why, files in reasons.items()) or "None.",
        figures="\n\n".join(f"`{r.file}`\n\n![{r.file}](images/nori/{r.figure.name})" for r in shown)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--etendue", default=ROOT / "build/release/etendue", help="the program [build/release/etendue]")
    parser.add_argument("--data", type=Path, default=os.environ.get("ETENDUE_TEST_DATA", ROOT.parent / "shared/data"))
    parser.add_argument("--only", metavar="PATTERN", default="", help="files whose path this regular expression fits")
    parser.add_argument("--effort", type=float, default=4, help="our samples for each one of the reference [4]")
    parser.add_argument("--spp", type=int, default=16, help="samples of scenes without a reference [16]")
    parser.add_argument("--threads", type=int, default=0, help="0: all cores [0]")
    parser.add_argument("--out", type=Path, default=ROOT / "out/nori", help="where renders are put [out/nori]")
    parser.add_argument("--reuse", action="store_true", help="take renders that are there from an earlier run")
    parser.add_argument("--write", metavar="FILE.md", type=Path, help="write the table, and figures beside it")
    arguments = parser.parse_args()
    data = Path(arguments.data)
    if not data.is_dir():
        print(f"SKIPPED: no folder {data}; set ETENDUE_TEST_DATA to where the files of the Nori family are")
        return 0
    tests, scenes = ([f for f in files if re.search(arguments.only, str(f))] for files in find_files(data))
    if not tests and not scenes:
        print(f"no file fits '{arguments.only}' in {data}", file=sys.stderr)
        return 2
    arguments.out.mkdir(parents=True, exist_ok=True)
    program = Program(Path(arguments.etendue).resolve(), arguments.threads)
    level = 1 - (1 - FALSE_ALARMS) ** (1 / max(len(scenes), 1))
    rows = []
    for number, file in enumerate(tests + scenes, 1):
        start = time.monotonic()
        if file in tests:
            row = check_tests(program, data, file, arguments.out)
        else:
            row = check_scene(program, data, file, arguments.out, arguments, level)
        rows.append(row)
        print(f"[{number}/{len(tests) + len(scenes)}] {'ok ' if row.is_good else 'BAD'} {row.file}: {row.result}; "
              f"{row.figures} ({time.monotonic() - start:.0f} s)", flush=True)
    if arguments.write:
        write_page(arguments.write, rows, len(tests), arguments)
    bad = [row for row in rows if not row.is_good]
    print(f"{len(rows) - len(bad)} of {len(rows)} files good")
    return 1 if bad else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        sys.exit(3)
