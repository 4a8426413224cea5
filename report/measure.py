"""Runs the renderer and keeps what it made: one render per set of inputs, read again while those are unchanged."""
import hashlib
import json
import os
import re
import resource
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from images import read_exr

INTEGRATORS = ("light", "direct", "average", "mis")
REPLICATES = 8
# Each method has seeds of its own: at one seed, `average` would take the very samples of `light` and `direct`.
FIRST_SEED = {"light": 1, "direct": 101, "average": 201, "mis": 301}
REFERENCE_SEED = 1001


@dataclass(frozen=True)
class Effort:
    """How much is rendered: samples a pixel, seeds, and by how much the pictures are smaller than the scenes say."""
    spp: int
    seeds: int
    reference_spp: int
    convergence_spp: tuple
    shrink: int
    convergence_shrink: int


FULL = Effort(64, 5, 256, (8, 16, 32, 64, 128, 256, 512, 1024), 1, 4)
QUICK = Effort(16, 4, 64, (8, 16, 32, 64), 4, 4)


@dataclass
class Render:
    """One render: its pixels (rgb and the standard error of each channel) and what the renderer said about it, with the
    processor time of the whole program, all threads together, as `processor_seconds`."""
    stats: dict
    exr: Path

    def pixels(self):
        """Two float arrays of height x width x 3: the image and its standard error over replicates."""
        return read_exr(self.exr)


class Progress:
    """Tells how far the renders are and how long the rest takes at the pace so far."""

    def __init__(self, samples):
        self.left, self.done, self.started, self.told = samples, 0, time.monotonic(), 0.0
        self.on_terminal = sys.stdout.isatty()

    def rendered(self, samples, was_kept):
        self.left = max(0, self.left - samples)
        if was_kept:
            return
        self.done += samples
        now = time.monotonic()
        if now - self.told < (0.5 if self.on_terminal else 15):
            return
        self.told = now
        left_s = (now - self.started) * self.left / self.done
        text = f"  {100 * self.done / (self.done + self.left):3.0f} % rendered, about {minutes(left_s)} left"
        print(f"\r{text:<50}" if self.on_terminal else text, end="" if self.on_terminal else "\n", flush=True)

    def finish(self):
        if self.on_terminal and self.done:
            print(f"\r{'':50}\r", end="", flush=True)


def minutes(seconds):
    return f"{round(seconds / 60)} min" if seconds >= 90 else f"{round(seconds)} s"


class Renderer:
    """Calls `etendue render`; `cache` holds its outputs, named by a hash of everything that decides them."""

    def __init__(self, etendue, cache, threads=None):
        self.etendue, self.cache = Path(etendue).resolve(), Path(cache)
        self.threads = threads or len(os.sched_getaffinity(0))
        self.cache.mkdir(parents=True, exist_ok=True)
        # the program and its kernels, one library for each instruction set, built beside it or installed
        folders = (self.etendue.parent / "lib", self.etendue.parent.parent / "lib")
        self.binary = digest([self.etendue, *sorted(f for folder in folders for f in folder.rglob("libetendue*.so"))])
        self.made = self.kept = 0
        self.used = set()
        self.progress = None

    def render(self, scene, integrator, spp, seed):
        if spp % REPLICATES:
            raise ValueError(f"{spp} samples cannot be split into {REPLICATES} replicates")
        options = ["--integrator", integrator, "--sampler", "sobol", "--spp", str(spp), "--replicates",
                   str(REPLICATES), "--replicates-by", "scrambling", "--seed", str(seed), "--threads",
                   str(self.threads)]
        name = hashlib.sha256("\0".join([self.binary, scene_digest(scene), *options]).encode()).hexdigest()[:24]
        exr, stats_file = self.cache / f"{name}.exr", self.cache / f"{name}.json"
        self.used |= {exr, stats_file, Path(scene)}
        stats = json.loads(stats_file.read_text()) if exr.exists() and stats_file.exists() else {}
        was_kept = "processor_seconds" in stats
        if was_kept:
            self.kept += 1
        else:
            before = processor_seconds()
            subprocess.run([self.etendue, "render", scene, "-o", exr, "--stats", stats_file, "--quiet", "--strict",
                            *options], check=True)
            stats = json.loads(stats_file.read_text()) | {"processor_seconds": processor_seconds() - before}
            stats_file.write_text(json.dumps(stats, indent=1))
            self.made += 1
        if self.progress:
            self.progress.rendered(work(stats["width"] * stats["height"], integrator, spp), was_kept)
        return Render(stats, exr)

    def shrunk(self, scene, factor):
        """The scene with a picture of 1/factor of its width and height, as a file in the cache; its meshes stay where
        they are."""
        if factor == 1:
            return Path(scene)
        text = re.sub(r'(<integer name="(?:width|height)" value=")(\d+)', lambda m: f"{m[1]}{int(m[2]) // factor}",
                      Path(scene).read_text())
        text = text.replace('value="meshes/', f'value="{Path(scene).resolve().parent}/meshes/')
        small = self.cache / f"{Path(scene).stem}-{factor}-{scene_digest(scene)[:12]}.xml"
        small.write_text(text)
        return small

    def forget_unused(self):
        """Removes what earlier runs left in the cache and this one did not use."""
        for file in self.cache.iterdir():
            if file not in self.used and file.suffix in (".exr", ".json", ".xml"):
                file.unlink()

    def version(self):
        said = subprocess.run([self.etendue, "--version"], capture_output=True, text=True, check=True)
        return f"Etendue {said.stdout.strip()}"


def processor_seconds():
    """Processor time of all finished child processes so far, user and system."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def digest(files):
    total = hashlib.sha256()
    for file in files:
        total.update(Path(file).read_bytes())
    return total.hexdigest()


def scene_digest(scene):
    """The scene file and every mesh beside it."""
    return digest([scene, *sorted((Path(scene).parent / "meshes").glob("*.obj"))])


def work(pixels, integrator, spp):
    """Roughly how long a render takes: those that take a light sample and a BSDF sample count twice."""
    return pixels * spp * (2 if integrator in ("average", "mis") else 1)


def planned_work(effort, pixels):
    """That of all renders of one scene."""
    of_all = sum(work(1, i, 1) for i in INTEGRATORS)
    equal = effort.spp * effort.seeds * (of_all + 2 * work(1, "mis", 1))
    convergence = of_all * sum(effort.convergence_spp) / effort.convergence_shrink ** 2
    return pixels * ((equal + work(1, "mis", effort.reference_spp)) / effort.shrink ** 2 + convergence)


@dataclass
class Measured:
    """All renders of one scene."""
    scene: Path
    equal_samples: dict  # integrator -> renders, one for each seed
    equal_time: dict     # the same
    convergence: dict    # integrator -> renders of a smaller picture, from few samples to many
    reference: Render

    def all_renders(self):
        for group in (self.equal_samples, self.convergence):
            for renders in group.values():
                yield from renders
        for integrator, renders in self.equal_time.items():
            if renders is not self.equal_samples[integrator]:
                yield from renders
        yield self.reference


def measure(renderer, scene, effort):
    """Equal samples: several seeds a method. Equal time: as many samples as fit into the processor time that the
    slowest method needs for equal samples, from the pace of the equal-sample renders; the slowest itself keeps
    those renders. Seed after seed all methods take turns, so that a slow minute of the machine hits them alike."""
    picture = renderer.shrunk(scene, effort.shrink)

    def all_seeds(spp):
        renders = {i: [] for i in spp}
        for seed in range(effort.seeds):
            for i in spp:
                renders[i].append(renderer.render(picture, i, spp[i], FIRST_SEED[i] + seed))
        return renders

    equal_samples = all_seeds({i: effort.spp for i in INTEGRATORS})
    seconds = {i: statistics.fmean(r.stats["processor_seconds"] for r in equal_samples[i]) for i in INTEGRATORS}
    target = max(seconds.values())
    fitting = {i: max(1, round(target / seconds[i] * effort.spp / REPLICATES)) * REPLICATES for i in INTEGRATORS}
    equal_time = all_seeds({i: spp for i, spp in fitting.items() if spp != effort.spp})
    small = renderer.shrunk(scene, effort.convergence_shrink)
    convergence = {i: [renderer.render(small, i, spp, FIRST_SEED[i]) for spp in effort.convergence_spp]
                   for i in INTEGRATORS}
    return Measured(scene, equal_samples, {i: equal_time.get(i, equal_samples[i]) for i in INTEGRATORS}, convergence,
                    renderer.render(picture, "mis", effort.reference_spp, REFERENCE_SEED))


def machine():
    """The processor, without the name of the computer."""
    model = next((line.split(":", 1)[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines()
                  if line.startswith("model name")), "unknown processor")
    return model
