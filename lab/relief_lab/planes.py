"""Drawn pictures, of which every normal and velocity is known: planes without noise of any slope, anywhere in the
view; a plane of which one pixel in a hundred is missing; and a plate that moves before a still wall."""

import functools

import numpy as np
import relief

from .draws import Draws
from .measures import FILLED, Angles, noise_sigma, percent

PLANES = 30
INCIDENCE_COSINE = 0.2588190451025207  # 75 degrees: steeper is hardly seen
HOLE_SHARE, SPOILT_DEG = 0.01, 10.0

RIG = relief.Rig(relief.Camera(512, 424, 365.5, 365.5, 255.5, 211.5), depth_range=(0.5, 4.5),
                 noise=(0.0015, -0.0005, 0.0003))  # a Kinect v2


def rays():
    """(424, 512, 3): a pixel's point at depth 1."""
    c = RIG.depth
    x, y = np.meshgrid((np.arange(c.width) - c.cx) / c.fx, (np.arange(c.height) - c.cy) / c.fy)
    return np.stack((x, y, np.ones_like(x)), axis=-1)


RAYS = rays()
UNIT_RAYS = RAYS / np.linalg.norm(RAYS, axis=-1, keepdims=True)


def plane_depth(n, d):
    """Where rays meet the plane n.p = d; 0 = behind the camera."""
    slope = RAYS @ n
    z = np.where(np.abs(slope) > 1e-4, d / np.where(slope == 0, 1, slope), 0.0)
    return np.maximum(z, 0.0)


def stage(profile):
    return relief.Pipeline(RIG, profile=profile, camera="fixed", render=False, threads=1)


def angles_deg(found, n):
    """Accurate near 0, where the arc cosine is not."""
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(found, n), axis=-1), found @ n))


def on_grid(plane, surface):
    step = surface.scale_factor
    return plane[::step, ::step][:surface.height, :surface.width]


def random_plane(draws):
    """That a random pixel sees at less than 75 degrees, 1 to 3.5 m away there."""
    y, x = divmod(int(draws.uniform() * RIG.depth.width * RIG.depth.height), RIG.depth.width)
    while True:
        n = np.array([draws.normal() for _ in range(3)])
        n /= np.linalg.norm(n)
        if n @ UNIT_RAYS[y, x] < -INCIDENCE_COSINE:
            return n, draws.range(1.0, 3.5) * float(n @ RAYS[y, x])


def planes_figures(profile, draws):
    angles = Angles()
    for _ in range(PLANES):
        n, d = random_plane(draws)
        depth = plane_depth(n, d).astype(np.float32)
        surface = stage(profile).push(depth, time=0.0).surface
        seen = on_grid((depth >= 0.5) & (depth <= 4.5) & (UNIT_RAYS @ n < -INCIDENCE_COSINE), surface)
        found = surface.normals[seen].astype(float)
        has = np.linalg.norm(found, axis=-1) > 0.5
        angles.add(angles_deg(found[has], n))
        angles.missing += int((~has).sum())
    return {"normals_mean_deg": ("planes without noise: normals, mean, deg", angles.mean()),
            "normals_over_30_percent": ("planes without noise: > 30 deg off, %", angles.wrong_percent()),
            "normals_missing_percent": ("planes without noise: missing, %", angles.missing_percent())}


def holes_figures(profile, draws):
    """A wall across the view with holes: what becomes of the pixels beside them and in them."""
    n = np.array((0.0, 0.0, -1.0))
    depth = plane_depth(n, -2.0).astype(np.float32)
    depth[draws.uniforms(depth.size).reshape(depth.shape) < HOLE_SHARE] = 0
    surface = stage(profile).push(depth, time=0.0).surface
    found, valid = surface.normals.astype(float), on_grid(depth, surface) > 0
    has = np.linalg.norm(found, axis=-1) > 0.5
    spoilt = valid & has & (angles_deg(found, n) > SPOILT_DEG)
    invented = ~valid & has & (surface.reason != FILLED)
    return {"holes_lost_percent": ("1 % holes: valid without a normal, %",
                                   percent(int((valid & ~has).sum()), int(valid.sum()))),
            "holes_spoilt_percent": ("1 % holes: valid, > 10 deg off, %", percent(int(spoilt.sum()), int(valid.sum()))),
            "holes_invented_percent": ("1 % holes: unmarked normal in a hole, %",
                                       percent(int(invented.sum()), int((~valid).sum())))}


# ---- a plate of half a metre that moves along its normal, seen with a Kinect's noise ------------------

SPEED, WALL_M = 0.5, 3.2
EMPTY_FRAMES, PLATE_FRAMES = 8, 8  # the last of them is measured
PLATE_NORMAL = np.array((0.4, 0.0, -0.9165151389911680))  # unit, slanted by 24 degrees


def plate_depth(time):
    centre = np.array((0.0, 0.0, 2.0)) + SPEED * time * PLATE_NORMAL
    z = plane_depth(PLATE_NORMAL, float(PLATE_NORMAL @ centre))
    return np.where((np.abs(RAYS[..., :2] * z[..., None]) < 0.25).all(axis=-1), z, 0.0)


@functools.lru_cache(1)
def plate_pictures(seed):
    """The same for all profiles: where the plate is in the last one, and what is seen in each."""
    draws, pictures = Draws(seed), []
    for k in range(EMPTY_FRAMES + PLATE_FRAMES):
        plate = plate_depth((k - EMPTY_FRAMES) / 30.0)
        z = np.where((plate > 0) & (k >= EMPTY_FRAMES), plate, WALL_M)
        z = z + noise_sigma(RIG.noise, z) * draws.normals(z.size).reshape(z.shape)
        pictures.append(z.astype(np.float32))
    return plate, pictures


def plate_figures(profile, seed):
    pipeline = stage(profile)
    plate, pictures = plate_pictures(seed)
    for k, depth in enumerate(pictures):
        surface = pipeline.push(depth, time=k * 0.033333333).surface
    velocity, is_plate = surface.velocity.astype(float), on_grid(plate, surface) > 0
    speed = float((velocity[is_plate] @ PLATE_NORMAL).mean())
    moving = np.any(velocity[~is_plate] != 0, axis=-1)
    return {"plate_speed_error_percent": ("plate at 0.5 m/s: error of its speed, %", 100.0 * abs(speed - SPEED) / SPEED),
            "wall_moving_percent": ("wall behind it, not exactly still, %", percent(int(moving.sum()), len(moving)))}


def run(task):
    for profile in task.profiles:
        if task.section == "planes":
            draws = Draws(task.seed)
            figures = {**planes_figures(profile, draws), **holes_figures(profile, draws)}
        else:
            figures = plate_figures(profile, task.seed)
        for key, (title, value) in figures.items():
            yield task.section, key, title, profile, value
