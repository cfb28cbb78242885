"""Things on tables as regions of their own, against hand-made labels. Each frame is shown PASSES times, so that the
background is there and what is averaged over time settles."""

import os

import numpy as np
import relief

from . import clips, fit
from .measures import NAN

PASSES = 8
ABOVE_M = 0.01  # over the plane a thing begins
STEP = 0.02  # share of the depth: neighbours of one thing
BASELINE = "table plane by RANSAC, components above"


def things_above(depth, surface, noise):
    """The plane with most points, and what is connected above it."""
    points = fit.Points(depth, surface.rays, noise)
    n, d = fit.find_plane(points)
    above = (depth > 0) & ((points.xyz @ n - d).reshape(depth.shape) > ABOVE_M)
    return fit.components(depth, above, STEP)


def best_iou(object_pixels, labels):
    """Of the regions > 0 with what is labelled."""
    size, areas = int(object_pixels.sum()), np.bincount(labels.ravel())
    both = np.bincount(labels[object_pixels], minlength=len(areas))
    shares = both[1:] / np.maximum(size + areas[1:] - both[1:], 1)
    return float(shares.max()) if len(shares) else 0.0


def ious_of(folder):
    """[(Relief's, the baseline's)] of each object. Grey levels 1-9 are the table, 20-29 the first object's surfaces,
    30-39 the second's ..."""
    rig, frame = clips.read_single(folder)
    truth = relief.read_picture(os.path.join(folder, "label.png"))[..., 0] // 10
    surface = clips.surface_of(rig, frame, PASSES)
    ours = np.where(surface.label != 0, surface.label, surface.background_label)
    ours = np.unique(np.append(ours.ravel(), 0), return_inverse=True)[1][:-1].reshape(truth.shape)
    plain = things_above(clips.raw_depth(frame), surface, rig.noise)
    return [(best_iou(truth == k, ours), best_iou(truth == k, plain)) for k in range(2, 26) if (truth == k).any()]


def run(task):
    parent, ious = os.path.join(task.folder, "labelled"), []
    for name in sorted(os.listdir(parent)) if os.path.isdir(parent) else ():
        folder = os.path.join(parent, name)
        if not name.startswith(".") and os.path.isfile(os.path.join(folder, "label.png")):
            ious += ious_of(folder)
    if ious:
        ious = np.array(ious)
        rows = (("object_iou", "objects on labelled tables: mean IoU of the best region", 0.72, ious.mean(axis=0)),
                ("object_found_percent", "  with an IoU of .5 or more, %", NAN, 100.0 * (ious >= 0.5).mean(axis=0)))
        for key, title, goal, (ours, plain) in rows:
            yield {"part": "objects", "key": key, "title": title, "relation": ">=", "goal": goal, "relief": float(ours),
                   "baseline": float(plain), "baseline_name": BASELINE}
