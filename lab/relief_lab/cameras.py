"""Two cameras that face each other: how thick is the person between them? Grains fly at the person from both sides
and stop where the surface stops them; how far they are from the true surface then is the error of each side."""

import json
import os
import tempfile

import numpy as np
import relief

from .measures import percent

GRAIN_M, SPEED = 0.01, 0.3  # radius; m/s
STANDS_S, FRAMES = 4.5, 270  # the person of scene "book" stands from 4.1 to 9.2 s
PERSON = 12  # rlf_synthetic_label
PERSON_X, PERSON_Z, START_M = -0.2, 2.95, 0.6  # of the person; the grains start so far from there
ACROSS, DOWN = np.arange(-0.18, 0.181, 0.03), np.arange(-0.15, 0.46, 0.03)
INSIDE_M = 0.04  # a line's deepest point is so deep: by the outline no camera sees a side
BACK_VIEW = {"position": [0, 0, 5], "orientation": [0, 1, 0, 0]}  # of path=opposite


def _cameras(folder, seed, count):
    """The path of a list of the first `count` cameras."""
    name = "synthetic:book?color=64x36&frames=%d&seed=" % FRAMES
    both = [{"source": name + str(seed)}, {"source": "%s%d&path=opposite" % (name, seed + 10), **BACK_VIEW}]
    path = os.path.join(folder, "cameras_%d.json" % count)
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"cameras": both[:count]}, file)
    return path, both[0]["source"]


def _throw(world):
    """Grains before and behind the person, which fly along z; by name."""
    grains = {}
    for side in (-1, 1):
        for i, x in enumerate(ACROSS):
            for k, y in enumerate(DOWN):
                name = "%d,%d,%d" % (side, i, k)
                grains[name] = world.add("sphere", radius=GRAIN_M, mass=0.001, restitution=0.0, name=name,
                                         position=(PERSON_X + x, y, PERSON_Z + side * START_M),
                                         velocity=(0, 0, -side * SPEED), collides_with_bodies=False)
    return grains


def _touches(path):
    """Where each grain was at its first touch, by (side, column, row)."""
    touches, grains = {}, None
    with relief.Pipeline(path, gravity=(0, 0, 0), camera="fixed", render=False, threads=1) as pipeline:
        for step in pipeline:
            if grains is None and step.time >= STANDS_S:
                grains = _throw(pipeline.world)
            for name in {contact.body for contact in step.contacts} & set(grains or ()):
                key = tuple(int(word) for word in name.split(","))
                touches[key] = np.array(grains.pop(name).position)
    return touches


def _gaps(touches, truth):
    """Signed distance of each grain's skin from the true person when it touched; only of those that met the person."""
    keys = list(touches)
    distance, _, _, label = truth.nearest(np.array([touches[key] for key in keys]), STANDS_S)
    return {key: d - GRAIN_M for key, d, kind in zip(keys, distance, label) if kind == PERSON}


def _lines(truth):
    """(column, row) of the lines along z that pass through the middle of the person and of nothing else: there each
    camera sees its side."""
    depth = np.arange(PERSON_Z - START_M, PERSON_Z + START_M, 0.01)
    for i, x in enumerate(ACROSS):
        for k, y in enumerate(DOWN):
            points = np.column_stack((np.full_like(depth, PERSON_X + x), np.full_like(depth, y), depth))
            distance, _, _, label = truth.nearest(points, STANDS_S)
            if distance.min() < -INSIDE_M and np.all(label[distance < 2 * GRAIN_M] == PERSON):
                yield i, k


def figures(path, name):
    with relief.open(name) as truth:
        gaps = _gaps(_touches(path), truth)
        lines = list(_lines(truth))
    both = np.array([(gaps[-1, *line], gaps[1, *line]) for line in lines
                     if (-1, *line) in gaps and (1, *line) in gaps])
    error = 100.0 * np.abs(both.sum(axis=1))
    return {"thickness_error_cm": float(error.mean()), "thickness_p95_cm": float(np.percentile(error, 95)),
            "back_error_cm": float(100.0 * np.abs(both[:, 1]).mean()), "lines": len(lines),
            "lines_without_percent": percent(len(lines) - len(both), len(lines))}


TITLES = {"thickness_error_cm": "thickness of a person, %s: mean error, cm",
          "thickness_p95_cm": "thickness of a person, %s: 95 % are below, cm",
          "back_error_cm": "back of a person, %s: mean error, cm",
          "lines": "lines through a person, %s",
          "lines_without_percent": "lines through a person, %s: a side is not met, %"}


def _loop_ms(folder, seed, count):
    """Median of a frame's surfaces and physics by `count` cameras of one view."""
    path = os.path.join(folder, "loop_%d.json" % count)
    view = "synthetic:book?color=0&frames=45&seed=%d"
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"cameras": [{"source": view % (seed + k)} for k in range(count)]}, file)
    with relief.Pipeline(path, render=False, threads=1) as pipeline:
        times = [step.times_ms["surface"] + step.times_ms["physics"] for step in pipeline]
    return float(np.median(times[15:]))


def loop_figures(folder, seed):
    """What more cameras cost; only in one run, for the machine's load changes."""
    one = _loop_ms(folder, seed, 1)
    for count in (2, 4):
        yield "loop_of_%d" % count, "frame loop of %d cameras, times that of one" % count, _loop_ms(folder, seed, count) / one


def run(task):
    for profile in task.profiles:
        if profile != "live":
            continue  # the thesis has one camera
        with tempfile.TemporaryDirectory() as folder:
            for count, words in ((1, "one camera"), (2, "two cameras")):
                found = figures(*_cameras(folder, task.seed, count))
                for key, title in TITLES.items():
                    yield task.section, "%s_of_%d" % (key, count), title.replace("%s", words), profile, found[key]
            for key, title, value in loop_figures(folder, task.seed):
                yield task.section, key, title, profile, value
