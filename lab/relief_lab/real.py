"""Real recordings, each figure beside a baseline of a few lines. Still clips, silhouettes and cameras that move or
stand are in C: lab/eval/real."""

from . import real_fill, real_gravity, real_objects


def run(task):
    for part in (real_objects, real_fill, real_gravity):
        yield from part.run(task)
