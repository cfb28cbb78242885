"""Gravity from the first frame alone, on every clip, with the camera rolled and mirrored."""

import math
import os
import sys

import numpy as np

import relief

from . import clips, fit
from .measures import NAN, percent

RIGHT_DEG = 10.0  # off by no more: bodies lie where they are put
TURNS = 8  # by 0, 90, 180 and 270 degrees, and mirrored before that
TRUTH_GAP_S = 0.05

# Normals of planes found by RANSAC, each looked at in a picture of its inliers; None: groundtruth.txt has it.
CLIPS = (
    ("hands_toys", "hands_toys", 0, (-0.0185, -0.8660, -0.5000)),  # the table
    ("hands_toys", "hands_toys 80", 80, (-0.0185, -0.8660, -0.5000)),
    ("room_still", "room_still", 0, (-0.1177, -0.9730, 0.1988)),  # the ceiling
    ("kinect2_frame", "kinect2_frame", 0, (-0.0184, -0.9990, 0.0400)),  # the desk
    ("azure_frame", "azure_frame", 0, (0.0104, -0.9870, 0.1604)),  # the table
    ("table_hands", "table_hands", 0, (-0.1632, 0.8060, -0.5690)),  # the table
    ("redkitchen", "redkitchen", 0, (0.1145, -0.8750, -0.4705)),  # table, floor
    ("labelled/five_people", "five_people", 0, (0.0061, -0.9965, -0.0836)),  # floor
    ("tum_fr1_rpy", "tum_fr1_rpy 0", 0, None),
    ("tum_fr1_rpy", "tum_fr1_rpy 40", 40, None),
    ("tum_fr1_rpy", "tum_fr1_rpy 80", 80, None),
)


def rotate(q, v):
    """By a unit quaternion (x, y, z, w)."""
    t = 2.0 * np.cross(q[:3], v)
    return v + q[3] * t + np.cross(q[:3], t)


def read_true_up(folder, time):
    """z is up in groundtruth.txt of the TUM RGB-D benchmark: the pose nearest in time."""
    poses = np.loadtxt(os.path.join(folder, "groundtruth.txt"), comments="#")
    gaps = np.abs(poses[:, 0] - time)
    if gaps.min() >= TRUTH_GAP_S:
        return None
    q = poses[np.argmin(gaps), 4:8]
    return rotate(q / np.linalg.norm(q) * (-1, -1, -1, 1), np.array((0.0, 0.0, 1.0)))


def angle_deg(a, b):
    cosine = float(np.dot(a, b)) / (np.linalg.norm(a) * np.linalg.norm(b))
    return math.degrees(math.acos(max(-1.0, min(1.0, cosine))))


class Sums:
    def __init__(self):
        self.tries = self.unsure = 0
        self.right, self.wrong_unsaid = [0, 0], [0, 0]  # Relief, baseline

    def add(self, off, is_sure):
        self.tries += 1
        self.unsure += not is_sure
        for k in (0, 1):
            self.right[k] += off[k] <= RIGHT_DEG
            self.wrong_unsaid[k] += off[k] > RIGHT_DEG and (k == 1 or is_sure)


def off_turned(rig, frame, up, turn):
    """(degrees off by Relief and by the normal of the plane with most points, Relief is sure)"""
    turned = turn % 4, turn >= 4
    rig, frame = clips.turn_rig(rig, *turned), clips.turn_frame(frame, *turned)
    surface = clips.surface_of(rig, frame)
    plane = fit.find_plane(fit.Points(clips.raw_depth(frame), surface.rays, rig.noise))
    found, confidence = surface.find_up()
    real = clips.turn_matrix(*turned) @ up
    is_sure = confidence >= relief.UP_SURE
    return (angle_deg(found, real), angle_deg(plane[0] if plane else (0, -1, 0), real)), is_sure


def row_of(part, key, title, relation, goal, values):
    return {"part": part, "key": key, "title": title, "relation": relation, "goal": goal, "relief": values[0],
            "baseline": values[1], "baseline_name": "normal of the largest plane"}


def run_clip(folder, part, index, up, sums):
    rig, frame = clips.read_single(folder) if "labelled" in folder.split(os.sep) else clips.read_frame(folder, index)
    up = read_true_up(folder, frame.time) if up is None else np.array(up)
    if up is None:
        print("SKIPPED: %s tells no pose of frame %d" % (folder, index), file=sys.stderr)
        return
    offs = []
    for turn in range(TURNS):
        off, is_sure = off_turned(rig, frame, up, turn)
        sums.add(off, is_sure)
        offs.append(off)
    yield row_of(part, "up_off_deg", "up as recorded: off by, deg", "<=", RIGHT_DEG, offs[0])
    yield row_of(part, "up_turned_worst_deg", "  worst of 4 turns, mirrored or not, deg", "<=", RIGHT_DEG,
                 np.max(offs, axis=0).tolist())


def run(task):
    sums = Sums()
    for name, part, index, up in CLIPS:
        folder = os.path.join(task.folder, name)
        if os.path.isdir(folder):
            yield from run_clip(folder, "gravity: " + part, index, up, sums)
    if sums.tries:
        shares = [[percent(count, sums.tries) for count in counts] for counts in (sums.right, sums.wrong_unsaid)]
        yield row_of("gravity", "up_right_percent", "up, all clips and turns: within 10 deg, %", ">=", 100.0, shares[0])
        yield row_of("gravity", "up_wrong_unsaid_percent", "  wrong without a warning, %", "<=", 0.0, shares[1])
        yield row_of("gravity", "up_unsure_percent", "  not sure, and says so, %", "<=", NAN,
                     (percent(sums.unsure, sums.tries), 0.0))
