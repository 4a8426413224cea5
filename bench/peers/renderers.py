"""The renderers that are compared: what a scene file of each is called, what settings it has, and how it is run."""
import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import OpenEXR

HERE = Path(__file__).resolve().parent
ADAPTIVE = "adaptive"  # a setting of Etendue


@dataclass(frozen=True)
class Run:
    """One image and the time that rendering took, loading apart."""
    image: np.ndarray
    seconds: float  # one thread: processor time; several: by the clock


class Etendue:
    """The program, one process an image. A setting is a list of options."""
    title = "Etendue"

    def __init__(self, program, cores, folder):
        self.program, self.cores, self.folder = program, cores, folder

    def settings(self, scene):
        """First without any option but the integrator; then with samples shared among the pixels; then the textbook's
        methods, which are no default."""
        info = subprocess.run([self.program, "info", "--json"], check=True, capture_output=True, text=True).stdout
        known = [integrator["name"] for integrator in json.loads(info)["integrators"]]
        names = ("path", "path_mis") if scene.is_by_paths else ("direct_light", "light", "mis")
        methods = {name: ["--integrator", name] for name in names if name in known}
        adaptive = {ADAPTIVE: [*methods[names[0]], "--adaptive"]}
        return {names[0]: methods[names[0]], **adaptive, **methods}

    def render(self, name, setting, seed, spp):
        image, stats = self.folder / "image.exr", self.folder / "stats.json"
        command = [self.program, "render", str(self.folder / f"{name}.etendue.xml"), *setting, "--spp", str(spp),
                   "--seed", str(seed), "--threads", str(len(self.cores)), "--quiet", "-o", str(image), "--stats",
                   str(stats)]
        started = time.perf_counter()
        process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL,
                                   preexec_fn=lambda: os.sched_setaffinity(0, self.cores))
        said = process.stderr.read().decode()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall = time.perf_counter() - started
        if process.returncode != 0:
            raise RuntimeError(f"{' '.join(command)}:\n{said}")
        told = json.loads(stats.read_text())
        pilots = [told[pilot]["pilot_seconds"] for pilot in ("light_budget", "adaptive") if pilot in told]
        seconds = told["seconds_render"] + sum(pilots)
        if len(self.cores) == 1:  # Without the time for which other programs had the core.
            seconds *= min(1.0, (usage.ru_utime + usage.ru_stime) / wall)
        return Run(read_exr(image), seconds)

    def close(self):
        pass


class Peer:
    """A worker process that keeps its scene and its compiled code. A setting is what the worker takes."""

    def __init__(self, cores, folder):
        self.cores, self.folder = cores, folder
        self.process = subprocess.Popen([sys.executable, str(HERE / f"{self.key}_worker.py"), str(len(cores))],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                        preexec_fn=lambda: os.sched_setaffinity(0, cores))

    def render(self, name, setting, seed, spp):
        to = self.folder / f"{self.key}.npy"
        job = {"scene": str(self.folder / f"{name}.{self.file_ending}"), "setting": setting, "seed": seed,
               "spp": spp, "to": str(to)}
        print(json.dumps(job), file=self.process.stdin, flush=True)
        answer = self.process.stdout.readline()
        if not answer:
            raise RuntimeError(f"{self.title} ended at {job}")
        return Run(np.load(to), json.loads(answer)["seconds" if len(self.cores) == 1 else "wall_seconds"])

    def close(self):
        self.process.stdin.close()
        self.process.wait()


class Mitsuba(Peer):
    title, key, file_ending = "Mitsuba 3", "mitsuba", "mitsuba.xml"

    def axes(self, scene):
        """What is tried, axis by axis, the first of each to start with."""
        if scene.is_by_paths:
            technique = {f"roulette from bounce {depth}": {"type": "path", "max_depth": -1, "rr_depth": depth}
                         for depth in (5, 3, 10)}
        else:
            technique = {f"{lights} light + {bsdf} BSDF samples":
                         {"type": "direct", "emitter_samples": lights, "bsdf_samples": bsdf}
                         for lights, bsdf in ((1, 1), (1, 0), (4, 0), (4, 1), (2, 2), (4, 4))}
        axes = {"technique": technique, "sampler": {name: {"sampler": name} for name in
                                                    ("multijitter", "stratified", "ldsampler", "independent")}}
        if sum(thing.radiance is not None for thing in scene.objects) > 1:
            axes["lights"] = {f"lights by {how}": {"lights": how} for how in ("power", "uniform")}
        return axes


class Cycles(Peer):
    title, key, file_ending = "Cycles", "cycles", "cycles"

    def axes(self, scene):
        return {"lights": {"light tree": {"light_tree": True}, "no light tree": {"light_tree": False}},
                "sampler": {"Sobol": {"sampling_pattern": "TABULATED_SOBOL"},
                            "blue noise": {"sampling_pattern": "BLUE_NOISE"}}}


PEERS = {peer.key: peer for peer in (Mitsuba, Cycles)}


def read_exr(path):
    """R, G and B as height x width x 3."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = file.channels()
        return np.stack([channels[name].pixels for name in "RGB"], axis=-1)
