"""Runs the renderer and keeps what it made: one render per set of inputs, read again while those are unchanged."""
import hashlib
import json
import os
import statistics
import subprocess
from dataclasses import dataclass
from pathlib import Path

from images import read_exr

INTEGRATORS = ("light", "direct", "average", "mis")
REPLICATES = 8


@dataclass
class Render:
    """One render: its pixels (rgb and the standard error of each channel) and what the renderer said about it."""
    stats: dict
    exr: Path

    def pixels(self):
        """Two float arrays of height x width x 3: the image and its standard error over replicates."""
        return read_exr(self.exr)


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

    def render(self, scene, integrator, spp, seed, replicates=REPLICATES):
        if spp % replicates:
            raise ValueError(f"{spp} samples cannot be split into {replicates} replicates")
        options = ["--integrator", integrator, "--sampler", "sobol", "--spp", str(spp), "--replicates",
                   str(replicates), "--replicates-by", "scrambling", "--seed", str(seed), "--threads", str(self.threads)]
        name = hashlib.sha256("\0".join([self.binary, scene_digest(scene), *options]).encode()).hexdigest()[:24]
        exr, stats = self.cache / f"{name}.exr", self.cache / f"{name}.json"
        if exr.exists() and stats.exists():
            self.kept += 1
        else:
            subprocess.run([self.etendue, "render", scene, "-o", exr, "--stats", stats, "--quiet", "--strict",
                            *options], check=True)
            self.made += 1
        return Render(json.loads(stats.read_text()), exr)

    def version(self):
        said = subprocess.run([self.etendue, "--version"], capture_output=True, text=True, check=True)
        return f"Etendue {said.stdout.strip()}"


def digest(files):
    total = hashlib.sha256()
    for file in files:
        total.update(Path(file).read_bytes())
    return total.hexdigest()


def scene_digest(scene):
    """The scene file and every mesh beside it."""
    return digest([scene, *sorted((Path(scene).parent / "meshes").glob("*.obj"))])


@dataclass
class Measured:
    """All renders of one scene."""
    scene: Path
    equal_samples: dict  # integrator -> list of renders, one per seed
    equal_time: dict     # integrator -> one render
    reference: Render

    def seconds(self, integrator):
        """Median render time at equal samples."""
        return statistics.median(r.stats["seconds_render"] for r in self.equal_samples[integrator])


def measure(renderer, scene, quick):
    """Equal samples: several seeds. Equal time: as many samples as fit into the time that the slowest method needs
    for equal samples, found from the pace of the equal-sample renders and corrected where the time is still off."""
    spp, seeds, reference_spp = (16, 3, 64) if quick else (64, 3, 256)
    samples = {i: [renderer.render(scene, i, spp, seed) for seed in range(1, seeds + 1)] for i in INTEGRATORS}
    measured = Measured(scene, samples, {}, renderer.render(scene, "mis", reference_spp, 1000))
    target = max(measured.seconds(i) for i in INTEGRATORS)
    for i in INTEGRATORS:
        pace = measured.seconds(i) / spp
        tried = []
        for _ in range(3):
            wanted = max(1, round(target / pace / REPLICATES)) * REPLICATES
            tried.append(renderer.render(scene, i, wanted, 501))
            seconds = tried[-1].stats["seconds_render"]
            if abs(seconds / target - 1) < 0.05:
                break
            pace = seconds / wanted
        measured.equal_time[i] = min(tried, key=lambda r: abs(r.stats["seconds_render"] / target - 1))
    return measured


def machine():
    """The processor, without the name of the computer."""
    model = next((line.split(":", 1)[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines()
                  if line.startswith("model name")), "unknown processor")
    return model
