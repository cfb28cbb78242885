"""Which way is up, by floors, tables and walls of each frame by itself; and with the camera turned."""

import bisect
import math
import os

import numpy as np
import relief

from .rooms import raw_depth
from .sections import Failed

SURE = 0.7  # RLF_UP_SURE
WRONG_DEG = 10.0  # bodies roll off a table that is taken to lean so much
TRUTH_GAP_S = 0.02  # a frame farther than this from every pose has none
NEAR_Z = 0.94  # cos 20 degrees: the truth's world has z up

# name: swaps x and y, then mirrors x, mirrors y
TURNS = {
    "as it is": (False, False, False),
    "by 90 degrees": (True, True, False),
    "by 180 degrees": (False, True, True),
    "by 270 degrees": (True, False, True),
    "mirrored": (False, True, False),
    "mirrored, by 90 degrees": (True, True, True),
    "mirrored, by 180 degrees": (False, False, True),
    "mirrored, by 270 degrees": (True, False, False),
}


def turned_rig(rig, turn):
    """Tangential distortion (p1, p2) follows its axes: p2 is that of x."""
    swaps, mirrors_x, mirrors_y = turn
    c = rig.depth
    width, height, fx, fy, cx, cy, d = c.width, c.height, c.fx, c.fy, c.cx, c.cy, list(c.distortion)
    d += [0.0] * (8 - len(d))
    if swaps:
        width, height, fx, fy, cx, cy, d[2], d[3] = height, width, fy, fx, cy, cx, d[3], d[2]
    if mirrors_x:
        cx, d[3] = width - 1 - cx, -d[3]
    if mirrors_y:
        cy, d[2] = height - 1 - cy, -d[2]
    camera = relief.Camera(width, height, fx, fy, cx, cy, c.distortion_model, d[:len(c.distortion)])
    return relief.Rig(camera, depth_range=rig.depth_range, noise=rig.noise)


def turned_depth(depth, turn):
    out = depth.T if turn[0] else depth
    out = out[:, ::-1] if turn[1] else out
    return np.ascontiguousarray(out[::-1] if turn[2] else out, np.float32)


def unturned(v, turn):
    x, y, z = -v[0] if turn[1] else v[0], -v[1] if turn[2] else v[1], v[2]
    return np.array((y, x, z) if turn[0] else (x, y, z))


def rotate(q, v):
    """By a unit quaternion (x, y, z, w)."""
    t = 2.0 * np.cross(q[:3], v)
    return v + q[3] * t + np.cross(q[:3], t)


def degrees_between(a, b):
    return math.degrees(math.acos(max(-1.0, min(1.0, float(np.dot(a, b))))))


def percentile(values, percent):
    values = sorted(values)
    return values[int(percent / 100.0 * (len(values) - 1) + 0.5)] if values else 0.0


class Truth:
    """What the simulator knows, or groundtruth.txt says of a frame; its world's up is z, or what the first frame
    says."""

    def __init__(self, name, source):
        self.down = source.down if name.startswith("synthetic:") else None
        self.times, self.poses, self.world_up = [], [], None
        path = os.path.join(name, "groundtruth.txt")
        if os.path.isfile(path):
            self._read(path)

    def _read(self, path):
        with open(path, encoding="utf-8") as file:
            for number, line in enumerate(file, 1):
                if line.startswith("#") or not line.strip():
                    continue
                try:
                    time, _, _, _, *q = map(float, line.split()[:8])
                    q = np.array(q) / np.linalg.norm(q)
                    rotate(q, np.zeros(3))
                except (ValueError, IndexError) as error:
                    raise Failed("relief-lab measure: %s:%d: needs eight numbers: time, position, quaternion"
                                 % (path, number)) from error
                self.times.append(time)
                self.poses.append(q)

    def up(self, time, found):
        if self.down is not None:
            return -self.down
        i = bisect.bisect(self.times, time)
        near = [k for k in (i - 1, i) if 0 <= k < len(self.times) and abs(self.times[k] - time) < TRUTH_GAP_S]
        if not near:
            return None
        q = self.poses[min(near, key=lambda k: abs(self.times[k] - time))]
        if self.world_up is None:
            up = rotate(q, found)
            self.world_up = np.array((0.0, 0.0, 1.0)) if up[2] > NEAR_Z else up
        return rotate(q * (-1, -1, -1, 1), self.world_up)


class Tally:
    """Answers for one turn, turned back."""

    def __init__(self):
        self.frames = self.sure = self.wrong = self.wrong_sure = self.other = self.other_sure = 0
        self.confidence, self.down, self.roll, self.error, self.off = [], [], [], [], []

    def add(self, up, confidence, real, first):
        is_sure = confidence >= SURE
        self.frames += 1
        self.sure += is_sure
        self.confidence.append(confidence)
        self.down.append(math.degrees(math.atan2(-up[2], -up[1])))
        self.roll.append(math.degrees(math.atan2(up[0], -up[1])))
        if real is not None:
            self.error.append(degrees_between(up, real))
            self.wrong += self.error[-1] > WRONG_DEG
            self.wrong_sure += self.error[-1] > WRONG_DEG and is_sure
        if first is not None:
            self.off.append(degrees_between(up, first))
            self.other += self.off[-1] > WRONG_DEG
            self.other_sure += self.off[-1] > WRONG_DEG and is_sure

    def print(self, name):
        print("%s: sure of up in %d of %d %s (confidence %.2f, median)" % (
            name, self.sure, self.frames, "frame" if self.frames == 1 else "frames", percentile(self.confidence, 50)))
        down, roll = (round(percentile(v, 50), 1) + 0.0 for v in (self.down, self.roll))  # no minus before a zero
        print("the camera looks down by %.1f degrees and is rolled by %.1f (medians)" % (down, roll))
        if self.error:
            print("off the truth by %.1f degrees (median; %.1f at the 95th percentile); by more than 10: %d, of them "
                  "sure %d" % (percentile(self.error, 50), percentile(self.error, 95), self.wrong, self.wrong_sure))

    def print_turned(self, name):
        print("  %-25s sure %d of %d, confidence %.2f; off the unturned answer by %.1f degrees, by more than 10: %d, "
              "of them sure %d" % (name, self.sure, self.frames, percentile(self.confidence, 50),
                                   percentile(self.off, 50), self.other, self.other_sure))


def read_frames(source, frames, turn, truth, first):
    """Each frame by itself: the camera may move."""
    tally, rig, is_first = Tally(), turned_rig(source.rig, turn), not first
    for frame in source:
        pipeline = relief.Pipeline(rig, camera="fixed", render=False, threads=1)
        step = pipeline.push(turned_depth(raw_depth(frame), turn), time=frame.time)
        up, confidence = step.surface.find_up()
        up = unturned(up, turn)
        if is_first:
            first.append(up)
        known = first[tally.frames] if tally.frames < len(first) else None
        tally.add(up, confidence, truth.up(frame.time, up), known)
        if tally.frames == frames:
            break
    return tally


def run(name, frames, is_turned):
    first = []
    with relief.open(name) as source:
        truth = Truth(name, source)
        tally = read_frames(source, frames, TURNS["as it is"], truth, first)
        if not tally.frames:
            raise Failed("relief-lab measure: %s: has no frames" % name)
        tally.print(name)
        for turn in list(TURNS)[1:] if is_turned else ():
            source.restart()
            read_frames(source, frames, TURNS[turn], truth, first).print_turned(turn)
