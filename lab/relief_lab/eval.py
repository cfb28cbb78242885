"""relief-lab eval: every accuracy figure, both profiles side by side, against its goal and its bound."""

import argparse
import concurrent.futures
import math
import multiprocessing
import os
import signal
import sys
import threading

from . import report, sections
from .table import PROFILES, Table, read_bounds
from .words import Parser, check_file, file_name, number_within, usage, write_file

SEEDS_MAX = report.SEEDS_MAX
PICTURE_FRAMES = 100  # of section picture by itself
ORACLES = {"sensed": "velocity thickness depth normals background".split(),
           "picture": "depth background camera pixels".split()}

HELP = """usage: relief-lab eval [OPTIONS]

Measures accuracy where the truth is known, for both profiles: mean over the seeds with
its 95 % confidence interval, beside the goal. Exit status 1 when a figure of profile
live is outside its bound.

  --scene NAME      only this one, with every figure:
{names}
  --random          the same as --scene random
  --rooms N         drawn at random: seeds 1, 3, 5, ... of N rooms, default 20
  --bounded         only scenes and sections with bounds: no rooms, no start
  --without NAME    leave that scene or section out
  --tune            seeds 2, 4, 6, ... instead: for tuning, never reported
  --normals DIR     clean depth with true normals: folders of depth.bin, normal.png and
                    params.txt (lab/measuring.md); only this unless --scene is given
  --chessboards DIR left*.jpg and right*.jpg of a 9x6 board (OpenCV's 13 pairs); only this
                    unless --scene is given
  --real DIR        real recordings, each figure beside a simple baseline; only this
                    unless --scene is given; skipped where there is no DIR
  --silhouettes DIR what script/silhouettes made; default out/silhouettes
  --seeds N         seeds 1..N of noise and throws, default 3
  --frames N        frames per scene, default as long as its story
  --profile NAME    live, thesis or both (default)
  --set NAME=VALUE  a setting of the surface (see `relief list settings`) in place of the
                    profiles', in the scenes (not in the sections)
  --oracle LIST     what of the surface is the truth: in section sensed velocity,
                    thickness, depth, normals, background, or all; in section picture
                    depth, background, camera (depth as the colour camera sees it), pixels
                    (each a body's or not, as its middle is); only profile live
  --threads N       processes, default 0 = one per processor
  --json FILE       everything: seeds, values, means, intervals, goals, bounds

examples:
  relief-lab eval
  relief-lab eval --scene chair --seeds 10 --json chair.json
  relief-lab eval --normals path/to/frames
  relief-lab eval --real path/to/clips --json real.json
"""


def section_name(text):
    if text not in sections.ALL:
        raise argparse.ArgumentTypeError("'%s': is not one of them: there are %s" % (text, ", ".join(sections.ALL)))
    return text


def profile_list(text):
    if text not in ("live", "thesis", "both"):
        raise argparse.ArgumentTypeError("'%s': use live, thesis or both" % text)
    return PROFILES if text == "both" else (text,)


def parse(words):
    names = "\n".join("                      %-11s %s" % item for item in sections.ALL.items())
    p = Parser("eval", HELP.format(names=names))
    for name in ("--random", "--bounded", "--tune"):
        p.add_argument(name, action="store_true")
    p.add_argument("--scene", type=section_name)
    p.add_argument("--without", type=section_name)
    p.add_argument("--rooms", type=number_within(1, SEEDS_MAX), default=20)
    p.add_argument("--seeds", type=number_within(1, SEEDS_MAX), default=3)
    p.add_argument("--frames", type=number_within(20, 100000), default=0)
    p.add_argument("--threads", type=number_within(0, 64), default=0)
    p.add_argument("--profile", type=profile_list, default=PROFILES)
    p.add_argument("--json", type=file_name(".json"))
    p.add_argument("--silhouettes", default="out/silhouettes")
    p.add_argument("--set", action="append", default=[])
    for name in ("--normals", "--chessboards", "--real", "--oracle"):
        p.add_argument(name)
    o = p.parse(words)
    o.scene = "random" if o.random else o.scene
    check(o)
    return o


def check(o):
    known = ORACLES.get(o.scene, [])
    parts = known if o.oracle == "all" else (o.oracle or "").split(",") if o.oracle else []
    if o.oracle and (not parts or any(part not in known for part in parts)):
        usage("eval", "--oracle is for --scene " + " and ".join("%s (%s)" % (k, ", ".join(v)) for k, v in ORACLES.items()))
    if o.set:
        sections.check_settings(o.set)
    check_file("eval", o.json)


def is_wanted(o, name, bounds):
    if o.scene:
        return o.scene == name
    has_files = o.normals or o.real or o.chessboards
    has_bounds = any(scene == name and not math.isnan(b.bound) for (scene, _), b in bounds.items())
    return not has_files and name != o.without and (has_bounds or not o.bounded)


def frame_folders(folder):
    """Of rendered depth with true normals."""
    try:
        names = sorted(n for n in os.listdir(folder) if not n.startswith("."))
    except OSError as error:
        raise sections.Failed("relief-lab eval: %s: is not a folder that can be read" % folder) from error
    paths = [p for p in (os.path.join(folder, n) for n in names) if os.path.isdir(p)]
    if not paths:
        raise sections.Failed("relief-lab eval: %s: holds no folders with depth.bin, normal.png and params.txt" % folder)
    return paths


def room_seeds(o):
    """Even seeds are for tuning, odd ones are reported."""
    return [2 * i + (2 if o.tune else 1) for i in range(o.rooms)]


def tasks_of(o):
    """In the order of the report."""
    bounds, out = read_bounds(), []
    more = {"frames": o.frames, "settings": tuple(o.set)}
    for name in (*sections.SCENES, *sections.OTHERS):
        if is_wanted(o, name, bounds):
            own = dict(more)
            if name == o.scene == "picture":
                own.update(is_whole=True, frames=o.frames or PICTURE_FRAMES)
            out += [sections.Task(name, seed, o.profile, oracle=o.oracle, **own) for seed in range(1, o.seeds + 1)]
    room = o.scene if o.scene in sections.RANDOM else "random"
    if is_wanted(o, room, bounds) and not o.bounded:
        out += [sections.Task(room, seed, ("live",), **more) for seed in room_seeds(o)]
    if o.normals:
        out += [sections.Task("normals", 1, o.profile, folder=folder) for folder in frame_folders(o.normals)]
    if o.chessboards:
        out.append(sections.Task("chessboards", 1, o.profile, folder=o.chessboards))
    if o.real and os.path.isdir(o.real):
        out.append(sections.Task("real", 1, ("live",), folder=o.real, silhouettes=o.silhouettes))
    elif o.real:
        print("real clips: SKIPPED, there is no folder %s" % o.real)
    return out


IS_ENDING = threading.Event()  # of this process


def end_process(*_):
    """Ends the program that runs; tasks that come after it do nothing."""
    IS_ENDING.set()
    sys.exit(1)


def start_process():
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, end_process)


def run_task(task):
    if IS_ENDING.is_set():
        return [], [], "ended"
    try:
        return *sections.run(task), None
    except Exception as error:  # what a process cannot hand over whole
        return [], [], str(error) or type(error).__name__


def run_all(tasks, threads):
    """Rows and real rows, in the order of the tasks; the last ones, which are the longest, begin first."""
    table, real = Table(), []
    if not tasks:
        return table, real
    count = min(threads or os.cpu_count() or 1, len(tasks))
    executor = concurrent.futures.ProcessPoolExecutor(count, initializer=start_process)
    pending = [executor.submit(run_task, task) for task in reversed(tasks)]
    try:
        for task, future in zip(tasks, reversed(pending)):
            rows, more, error = future.result()
            if error:
                raise sections.Failed(error)
            table.merge(rows)
            real += more
            print("%s, seed %d done" % (task.section, task.seed), file=sys.stderr)
    except BaseException:
        for process in multiprocessing.active_children():
            process.terminate()  # which ends the program that it runs
            process.join(1)
            process.kill()
        raise
    executor.shutdown()
    return table, real


def show(o, table, real, out):
    judged, outside = out.count()
    if judged or not o.real:
        out.print(o.scene is not None and o.scene not in sections.RANDOM)
    if o.real:
        report.print_real(real)
    print("%d figures with a bound, %d outside it" % (judged, outside))
    report.print_random(table, o.scene if o.scene in sections.RANDOM else "random", room_seeds(o), o.tune)
    report.print_columns(table)
    return outside


def main(words):
    o = parse(words)
    table, real = run_all(tasks_of(o), o.threads)
    report.add_real_headlines(table, real)
    out = report.Report(table, is_whole=o.frames == 0)
    outside = show(o, table, real, out)
    if o.json:
        data = {"machine": sections.machine(), "seeds": list(range(1, o.seeds + 1)), "outside": outside,
                "figures": out.figures()}
        write_file("eval", o.json, report.json_text({**data, "real": real} if o.real else data))
    return 1 if outside else 0
