"""Renders with Mitsuba 3 what it is told on standard input, one JSON object a line; answers likewise.

{"scene": FILE, "setting": {...}, "seed": N, "spp": N, "to": FILE.npy} gives {"seconds": processor time of this process,
"wall_seconds": by the clock}. Loading and the first render of a setting, which compiles, are not counted.
"""
import json
import sys
import time

import numpy as np

import drjit as dr
import mitsuba as mi

mi.set_variant("llvm_ad_rgb")
THREADS = int(sys.argv[1])


def load(path, setting):
    # With one thread, loading a texture would wait for a second for ever.
    dr.set_thread_count(2)
    scene = mi.load_file(path, sampler=setting["sampler"])
    dr.set_thread_count(THREADS)
    if setting.get("lights") == "uniform":
        params = mi.traverse(scene)
        for key in params.keys():
            if key.endswith("sampling_weight"):
                params[key] = 1.0
        params.update()
    keys = {key: setting[key] for key in setting if key not in ("sampler", "lights")}
    return scene, mi.load_dict(keys)


def render(scene, integrator, seed, spp):
    image = mi.render(scene, integrator=integrator, seed=seed, spp=spp)
    dr.eval(image)
    dr.sync_thread()
    return image


def main():
    loaded, warm = None, set()
    for line in sys.stdin:
        job = json.loads(line)
        wanted = json.dumps([job["scene"], job["setting"]])
        if loaded != wanted:
            loaded, (scene, integrator) = wanted, load(job["scene"], job["setting"])
            warm.clear()
        if job["spp"] not in warm:
            render(scene, integrator, 10_000, job["spp"])
            warm.add(job["spp"])
        wall, processor = time.perf_counter(), time.process_time()
        image = render(scene, integrator, job["seed"], job["spp"])
        answer = {"seconds": time.process_time() - processor, "wall_seconds": time.perf_counter() - wall}
        np.save(job["to"], np.array(image)[..., :3])
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
