"""Silhouettes of people by GrabCut (Rother, Kolmogorov, Blake 2004), seeded by depth.

A person is what stands higher than 4 cm over the table's plane, or beyond the table and nearer than
`far_m`. What is seen so, less its rim, is surely he; what is far from it surely is not. Colour
decides the rest. Every mask was looked at beside its picture; those that are wrong are not listed.
"""
import json
import os
import sys

import cv2
import numpy as np

# Boxes are x0, y0, x1, y1. "unjudged": where toys move or colour does not tell him from what is
# behind him; "things": what stands there all the time.
CLIPS = {
    "hands_toys": {
        "frames": list(range(112, 360, 8)),
        "first": list(range(80, 90)),
        "up": (-0.0185, -0.8660, -0.5000),
        "far_m": 1.35,
        "unjudged": [(64, 72, 152, 160), (140, 32, 236, 176), (226, 96, 320, 176),
                     (160, 160, 320, 240)],
        "things": [(0, 60, 80, 240), (0, 172, 320, 240), (286, 108, 320, 240), (0, 0, 110, 56)],
    },
    "table_hands": {
        "frames": list(range(20, 100, 4)),
        "first": list(range(0, 10)),
        "up": (-0.163, 0.806, -0.570),
        "far_m": 1.25,
        "unjudged": [(0, 0, 640, 228), (0, 0, 140, 360), (280, 0, 640, 360)],
        "things": [(0, 0, 640, 120), (0, 0, 150, 360), (440, 120, 640, 360), (256, 120, 430, 190)],
    },
}


def files(clip, name):
    with open(os.path.join(clip, name), encoding="ascii") as lines:
        return [os.path.join(clip, line.split()[1]) for line in lines
                if line.strip() and line[0] != "#"]


def rays(camera, shape):
    v, u = np.indices(shape, dtype=float)
    return np.dstack([(u - camera["cx"]) / camera["fx"], (v - camera["cy"]) / camera["fy"],
                      np.ones(shape)])


def in_boxes(boxes, shape):
    mask = np.zeros(shape, bool)
    for x0, y0, x1, y1 in boxes:
        mask[y0:y1, x0:x1] = True
    return mask


def table_offset(points, up, seen):
    """The most frequent height: the table's."""
    heights = (points @ up)[seen]
    counts, edges = np.histogram(heights, bins=np.arange(-2, 2, 0.01))
    return edges[counts.argmax()] + 0.005


def grow(mask, pixels):
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * pixels + 1, 2 * pixels + 1))
    return cv2.dilate(mask.astype(np.uint8), kernel) > 0


def near_things(clip, camera, rule, path):
    """What depth shows to be neither table nor room, and where depth shows the room."""
    depth = cv2.imread(path, cv2.IMREAD_UNCHANGED) / camera["units_per_metre"]
    points = rays(camera, depth.shape) * depth[:, :, None]
    up = np.array(rule["up"])
    seen = (depth > 0) & (depth < rule["far_m"])
    height = points @ up - rule.setdefault("offset", table_offset(points, up, seen))
    near = seen & (np.abs(height) > 0.04)
    return near, depth > rule["far_m"]


def cut(color, near, room, things):
    person = near & ~things
    parts, labels, stats, _ = cv2.connectedComponentsWithStats(person.astype(np.uint8))
    for part in range(1, parts):
        if stats[part, cv2.CC_STAT_AREA] < 0.002 * person.size:
            person[labels == part] = False
    mask = np.full(near.shape, cv2.GC_PR_BGD, np.uint8)
    mask[person] = cv2.GC_PR_FGD
    mask[~grow(~person, 4)] = cv2.GC_FGD
    # Without depth (a rim, a shadow) colour alone decides, farther from what was seen.
    mask[~grow(person, 26) | (room & ~grow(person, 7))] = cv2.GC_BGD
    mask[things & ~grow(person, 3)] = cv2.GC_BGD
    cv2.setRNGSeed(1)
    cv2.grabCut(color, mask, None, np.zeros((1, 65)), np.zeros((1, 65)), 6, cv2.GC_INIT_WITH_MASK)
    found = ((mask == cv2.GC_FGD) | (mask == cv2.GC_PR_FGD)).astype(np.uint8)
    found = cv2.morphologyEx(found, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    parts, labels, stats, _ = cv2.connectedComponentsWithStats(found)
    for part in range(1, parts):
        if stats[part, cv2.CC_STAT_AREA] < 0.002 * found.size:
            found[labels == part] = 0
    return found > 0


def main(clip, out):
    clip = clip.rstrip("/")
    name = os.path.basename(clip)
    if name not in CLIPS:
        sys.exit(f"script/silhouettes: no rule for '{name}': use one of {', '.join(CLIPS)}")
    rule = CLIPS[name]
    with open(os.path.join(clip, "camera.json"), encoding="utf-8") as file:
        camera = json.load(file)["depth"]
    depths, colors = files(clip, "depth.txt"), files(clip, "rgb.txt")
    folder = os.path.join(out, name)
    os.makedirs(os.path.join(folder, "look"), exist_ok=True)
    unjudged = in_boxes(rule["unjudged"], (camera["height"], camera["width"]))
    things = in_boxes(rule["things"], unjudged.shape)
    first = np.zeros(unjudged.shape, bool)
    for i in rule["first"] + rule["frames"]:
        color = cv2.imread(colors[i])
        near, room = near_things(clip, camera, rule, depths[i])
        person = cut(color, near, room, things)
        if i in rule["first"]:
            first |= person
            continue
        mask = np.where(unjudged, 128, np.where(person, 255, 0)).astype(np.uint8)
        cv2.imwrite(os.path.join(folder, f"{i:06d}.png"), mask)
        edge = grow(person, 1) & ~person
        shown = color.copy()
        shown[edge & ~unjudged] = (0, 0, 255)
        shown[unjudged] = shown[unjudged] // 2
        cv2.imwrite(os.path.join(folder, "look", f"{i:06d}.png"), np.hstack([color, shown]))
    cv2.imwrite(os.path.join(folder, "first.png"), first.astype(np.uint8) * 255)
    print(f"{len(rule['frames'])} masks in {folder}")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
