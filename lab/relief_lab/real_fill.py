"""Filled pixels of real clips, left out on purpose: what a still camera sees beside depth steps is hidden in every
frame, and what is filled in is compared with it."""

import math
import os

import numpy as np
import relief

from .measures import NAN, percent

BAND = 3  # pixels hidden beside a step
GAP = 12  # a step may have that many pixels without depth
JUMP = np.float32(0.04)  # share of the nearer depth
WRONG_M = np.float32(0.04)  # the other side of the step
FRAMES = 40
CLIPS = (("hands_toys", "hands_toys, still 0-39"), ("room_still", "room_still, 12 frames"))


def read_clip(folder, count):
    """(rig, frames with arrays of their own)"""
    frames = []
    with relief.open(folder) as source:
        for frame in source:
            frames.append(frame)
            if len(frames) == count:
                break
        return source.rig, frames


def mean_depth(frames):
    """Of the frames with depth; 0 where fewer than eight of ten have any."""
    depth = np.stack([f.depth for f in frames]).astype(np.int64)
    seen = (depth > 0).sum(axis=0)
    steady = 10 * seen >= 8 * len(frames)
    mean = depth.sum(axis=0) / np.maximum(seen, 1) / frames[0].units_per_metre
    return np.where(steady, mean, 0.0).astype(np.float32)


def mark_steps(mean, mark, is_far):
    """Steps along the rows, over gaps: BAND pixels from a step on, as far as they are one surface."""
    for line, marks in zip(mean, mark):
        at = np.flatnonzero(line > 0)
        before, here = at[:-1], at[1:]
        z, other = line[here], line[before]
        jump = (here - before <= GAP) & (np.abs(z - other) > JUMP * np.minimum(z, other))
        is_here = z > other if is_far else z < other
        for start, step in zip(np.where(is_here, here, before)[jump], np.where(is_here, 1, -1)[jump]):
            for i in range(start, start + BAND * step, step):
                if not (0 <= i < len(line) and line[i] > 0 and abs(line[i] - line[start]) <= JUMP * line[start]):
                    break
                marks[i] = True


def from_neighbours(raw, is_far):
    """The next pixel with depth to the left and to the right; of the two the farther for the far side, the nearer
    for the near side: a baseline that knows which side it is."""
    columns = np.broadcast_to(np.arange(raw.shape[1]), raw.shape)
    left = np.maximum.accumulate(np.where(raw > 0, columns, -1), axis=1)
    right = np.minimum.accumulate(np.where(raw > 0, columns, raw.shape[1])[:, ::-1], axis=1)[:, ::-1]
    a, b = (np.take_along_axis(raw, np.clip(k, 0, raw.shape[1] - 1), axis=1) for k in (left, right))
    a, b = np.where(left < 0, 0, a), np.where(right == raw.shape[1], 0, b)
    both = np.maximum(a, b) if is_far else np.minimum(a, b)
    return np.where((a > 0) & (b > 0), both, np.maximum(a, b))


def figures(found, real):
    """(median, RMSE in mm, wrong and missing in percent) of the hidden pixels."""
    off = np.abs(found - real)[found > 0]
    rmse = 1000.0 * math.sqrt(float(np.square(off.astype(float)).sum()) / len(off)) if len(off) else NAN
    median = 1000.0 * float(np.sort(off)[len(off) // 2]) if len(off) else NAN
    return median, rmse, percent(int((off > WRONG_M).sum()), len(real)), percent(len(real) - len(off), len(real))


def run_side(folder, part, is_far):
    rig, frames = read_clip(folder, FRAMES)
    mean = mean_depth(frames)
    hidden = np.zeros(mean.shape, bool)
    mark_steps(mean, hidden, is_far)
    mark_steps(mean.T, hidden.T, is_far)
    pipeline = relief.Pipeline(rig, camera="fixed", render=False, threads=1)
    for frame in frames:
        depth = np.where(hidden, 0, frame.depth).astype(np.uint16)
        step = pipeline.push(depth, frame.color, time=frame.time, units_per_metre=frame.units_per_metre)
    raw = (depth / frame.units_per_metre).astype(np.float32)
    ours = figures(step.surface.depth[hidden], mean[hidden])
    plain = figures(from_neighbours(raw, is_far)[hidden], mean[hidden])
    side = "far" if is_far else "near"
    titles = ("hidden, %s side of steps: filled, median, mm" % side, "  RMSE, mm", "  wrong by > 4 cm, % of the hidden",
              "  not filled, %")
    keys = ("median_mm", "rmse_mm", "wrong_percent", "missing_percent")
    for key, title, relief_value, baseline in zip(keys, titles, ours, plain):
        yield {"part": part, "key": "fill_%s_%s" % (side, key), "title": title, "relation": "<=", "goal": NAN,
               "relief": relief_value, "baseline": baseline,
               "baseline_name": "left or right neighbour, the %s" % ("farther" if is_far else "nearer")}


def run(task):
    for name, part in CLIPS:
        folder = os.path.join(task.folder, name)
        for is_far in (True, False) if os.path.isdir(folder) else ():
            yield from run_side(folder, part, is_far)
