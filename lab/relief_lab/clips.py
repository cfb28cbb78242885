"""Pieces of real recordings: frames that can be turned, edited and shown to the surface stage."""

import os
from types import SimpleNamespace

import numpy as np
import relief

PASS_S = 0.033333333  # between passes


def read_single(folder):
    """(rig, one frame) of depth.png and color.png of a Kinect v1, millimetres."""
    camera = relief.Camera(640, 480, 525, 525, 319.5, 239.5)
    rig = relief.Rig(camera, camera, np.eye(4), (0.1, 8.0), (0.0008, 0.0, 0.0012))  # as of any folder
    frame = SimpleNamespace(depth=relief.read_png(os.path.join(folder, "depth.png")),
                            color=relief.read_picture(os.path.join(folder, "color.png")), time=0.0,
                            units_per_metre=1000.0)
    return rig, frame


def read_frame(folder, index):
    with relief.open(folder) as source:
        for number, frame in enumerate(source):
            if number == index:
                return source.rig, frame
    raise IndexError("%s: has no frame %d" % (folder, index))


def raw_depth(frame):
    """As it came, metres; 0 = missing."""
    return (frame.depth / frame.units_per_metre).astype(np.float32)


def surface_of(rig, frame, passes=1):
    """That of profile live, after the frame was shown so many times."""
    pipeline = relief.Pipeline(rig, camera="fixed", render=False, threads=1)
    for k in range(passes):
        step = pipeline.push(frame.depth, frame.color, time=frame.time + k * PASS_S,
                             units_per_metre=frame.units_per_metre)
    return step.surface


# ---- the scene as a camera sees it that is rolled: mirrored first if asked for, then clockwise ---------


def turn_matrix(quarters, is_mirrored):
    quarter = np.array(((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    return np.linalg.matrix_power(quarter, quarters) @ np.diag((-1.0 if is_mirrored else 1.0, 1.0, 1.0))


def turn_camera(c, quarters, is_mirrored):
    """The tangential part of the distortion turns with the picture: p1 and p2."""
    width, height, fx, fy, cx, cy, d = c.width, c.height, c.fx, c.fy, c.cx, c.cy, list(c.distortion)
    count = len(d)
    d += [0.0] * 4
    if is_mirrored:
        cx, d[3] = width - 1 - cx, -d[3]
    for _ in range(quarters):
        width, height, fx, fy, cx, cy, d[2], d[3] = height, width, fy, fx, height - 1 - cy, cx, d[3], -d[2]
    return relief.Camera(width, height, fx, fy, cx, cy, c.distortion_model, d[:count])


def turn_picture(picture, quarters, is_mirrored):
    return np.ascontiguousarray(np.rot90(picture[:, ::-1] if is_mirrored else picture, -quarters))


def turn_rig(rig, quarters, is_mirrored):
    color = rig.color and turn_camera(rig.color, quarters, is_mirrored)
    whole = np.eye(4)
    whole[:3, :3] = turn_matrix(quarters, is_mirrored)
    return relief.Rig(turn_camera(rig.depth, quarters, is_mirrored), color, whole @ rig.color_from_depth @ whole.T,
                      rig.depth_range, rig.noise)


def turn_frame(frame, quarters, is_mirrored):
    color = None if frame.color is None else turn_picture(frame.color, quarters, is_mirrored)
    return SimpleNamespace(depth=turn_picture(frame.depth, quarters, is_mirrored), color=color, time=frame.time,
                           units_per_metre=frame.units_per_metre)
