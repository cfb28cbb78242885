#!/usr/bin/env python3
"""What `import relief` costs: python3 python/measure.py [--build build/release] [--quick]

Prints a table of figures beside their bounds, and ends with 1 when one is over.
"""

import argparse
import gc
import os
import resource
import subprocess
import sys
import time
import tracemalloc

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SOURCE = "synthetic:room"
PLANES = (
    "depth", "normals", "velocity", "thickness", "label", "reason", "foreground",
    "background_depth", "background_normals",
)  # fmt: skip


def import_ms(times):
    """(by the clock, of the processor): best of fresh interpreters."""
    script = (
        "import time; t, c = time.perf_counter(), time.process_time(); import relief; "
        "print(time.perf_counter() - t, time.process_time() - c)"
    )
    runs = []
    for _ in range(times):
        run = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True)
        runs.append([1e3 * float(word) for word in run.stdout.split()])
    return [min(column) for column in zip(*runs)]


def planes_us(relief, times):
    """All planes of one frame as arrays: processor's time, best of five means."""
    with relief.Pipeline(SOURCE, render=False, threads=1) as pipeline:
        surface = pipeline.step().surface
        means = []
        for _ in range(5):
            start = time.process_time()
            for _ in range(times):
                for name in PLANES:
                    getattr(surface, name)
            means.append((time.process_time() - start) / times)
    return 1e6 * min(means)


def python_loop_ms(relief, frames):
    """Processor's time of a frame, its planes, bodies and picture taken as arrays."""
    with relief.Pipeline(SOURCE, camera="fixed", threads=1) as pipeline:
        for i in range(frames):
            if i == 1:  # the first frame warms up, as in loop.c
                start = time.process_time()
            step = pipeline.step()
            surface = step.surface
            for name in PLANES:
                getattr(surface, name)
            step.picture, step.bodies
        return 1e3 * (time.process_time() - start) / (frames - 1)


def loop_percent(relief, build, frames, times):
    """How much more a loop in Python takes than the same in C, each its best."""
    command = [os.path.join(build, "python", "relief_loop"), SOURCE, str(frames)]
    c, python = [], []
    for _ in range(times):
        c.append(float(subprocess.run(command, check=True, capture_output=True).stdout))
        python.append(python_loop_ms(relief, frames))
    print(f"  C {min(c):.3f} ms, Python {min(python):.3f} ms of processor time per frame")
    return 100.0 * (min(python) / min(c) - 1.0)


def resident_kb():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize() // 1024


def turn(relief, camera, depth):
    """A pipeline, a surface and a world, made and dropped."""
    with relief.Pipeline(camera, render=False, hands=True, threads=1) as pipeline:
        pipeline.on_contact(lambda *event: pipeline)
        surface = pipeline.push(depth, time=0).surface
        surface.depth, surface.normals, surface.regions
        world = relief.World()
        world.add("sphere")
        world.advance(0.01, surface)


def leak_kb(relief, times):
    """(of Python's objects, resident): what so many turns leave behind, once warm."""
    import numpy as np

    camera = relief.Camera(80, 60, fx=60, fy=60, cx=39.5, cy=29.5)
    depth = np.full((60, 80), 2000, np.uint16)

    def turns(count, measure):
        turn(relief, camera, depth)
        gc.collect()
        before = measure()
        for _ in range(count):
            turn(relief, camera, depth)
        gc.collect()
        return measure() - before

    turns(20, resident_kb)
    resident = turns(times, resident_kb)
    tracemalloc.start()
    traced = turns(times // 10, lambda: tracemalloc.get_traced_memory()[0])
    tracemalloc.stop()
    return traced / 1024, resident


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", default=os.path.join(ROOT, "build", "release"))
    parser.add_argument("--quick", action="store_true", help="few turns, for a first look")
    options = parser.parse_args()
    folder = os.path.join(os.path.abspath(options.build), "python")
    sys.path.insert(0, folder)
    os.environ["PYTHONPATH"] = folder
    import relief

    few = options.quick
    times = 100 if few else 1000
    traced, resident = leak_kb(relief, times)
    wall, processor = import_ms(3 if few else 9)
    loop = loop_percent(relief, options.build, *((20, 2) if few else (60, 5)))
    rows = [
        (f"left by {times} pipelines, surfaces, worlds: resident, kB", resident, 1024.0),
        (f"the same of {times // 10}: Python's objects, kB", traced, 32.0),
        ("import by the clock, ms", wall, 100.0),
        ("import, processor's time, ms", processor, 100.0),
        ("planes of a frame as arrays, us", planes_us(relief, 500 if few else 5000), 50.0),
        ("loop over C's loop, %", loop, 5.0),
    ]
    over = False
    for name, value, bound in rows:
        over = over or value > bound
        print(f"{name:56} {value:9.1f}  at most {bound:g}{'   OVER' if value > bound else ''}")
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())
