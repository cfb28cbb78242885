"""A synthetic scene with one seed: both profiles on the very same frames, and every measure."""

import os
import tempfile

import numpy as np
import relief

from . import collisions, measures, solid
from .table import read_titles

THROWN_BODIES = 60

# scene: frames (30 a second), source, options of it, another person with every seed
STORIES = {
    "room": (210, "room", "", False),
    "empty": (60, "empty", "", False),
    "thesis": (150, "thesis", "", False),
    "chair": (165, "chair", "", False),
    "book": (230, "book", "", False),
    "hand": (120, "hand", "", False),
    "steps": (120, "room", "&noise=steps", False),
    "people": (210, "room", "", True),
    "random": (200, "random", "&color=640x360", False),
}


class Lane:
    """One profile's pipeline. Its frames are pushed, so that all profiles see the same one and it is simulated once."""

    def __init__(self, profile, source, scene, settings):
        self.profile, self.source = profile, source
        self.pipeline = relief.Pipeline(source.rig, scene=scene, profile=profile, camera="fixed", render=False,
                                        threads=1, settings=settings)
        self.bounces = collisions.Collisions(source)
        self.of_surface = (measures.Depth(), measures.Normals(), measures.Centre(), measures.Foreground(),
                           solid.Solid(), measures.Behind(source), measures.Distance())

    def add(self, frame, truth, raw, band):
        step = self.pipeline.push(frame.depth, frame.color, time=frame.time, units_per_metre=frame.units_per_metre)
        view = measures.View(step.surface, truth, raw, band, self.source.rig, frame.time, frame.sequence == 0)
        for measure in self.of_surface:
            measure.add(view)
        self.bounces.add(step, self.pipeline.world.time)

    def figures(self):
        out = {}
        for measure in (*self.of_surface, self.bounces):
            out.update(measure.figures())
        return out


def raw_depth(frame):
    """The frame's depth as it came, metres; <= 0 = missing."""
    if frame.depth.dtype == np.float32:
        return frame.depth
    return (frame.depth / frame.units_per_metre).astype(np.float32)


def settings_from(texts):
    return dict(text.split("=", 1) for text in texts)


def run(task):
    frames, scene, options, has_others = STORIES[task.section]
    frames = task.frames or frames
    name = "synthetic:%s?seed=%d&frames=%d&person=%d%s" % (scene, task.seed, frames, task.seed + 1 if has_others else 1,
                                                          options)
    titles = read_titles()
    with tempfile.TemporaryDirectory() as folder, relief.open(name) as source:
        thrown = collisions.scene_of(task.seed, THROWN_BODIES)
        if scene == "random":
            collisions.turn_scene(thrown, source)
        path = os.path.join(folder, "thrown.json")
        collisions.write_scene(path, thrown)
        lanes = [Lane(profile, source, path, settings_from(task.settings)) for profile in task.profiles]
        for frame in source:
            truth = source.truth
            raw, band = raw_depth(frame), measures.mark_band(truth["depth"])
            for lane in lanes:
                lane.add(frame, truth, raw, band)
        for lane in lanes:
            figures = lane.figures()
            yield from ((task.section, key, title, lane.profile, figures[key]) for key, title in titles.items())
