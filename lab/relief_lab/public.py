"""Rendered depth with true normals, as published with 3F2N (Fan et al. 2021) and D2NT (Feng et al. 2023): a folder
per frame with
  depth.bin   float32, little endian, 640 x 480, any unit; exactly 1 = nothing there
  normal.png  16-bit colour, n = 1 - 2 png / 65535
  params.txt  fx fy u0 v0 [scale], pixels counted from 1
The error is acos |n.n_gt|, as there: 0 to 90 degrees.

Then each frame as a camera sees it that stands still: is what is curved sharper after a while? It is put at 1.5 m
and given the noise of two kinds of sensor: time of flight, independent in each pixel and frame, and structured
light, alike in neighbours, half of it the same in every frame, in steps. Beside the stage stands what anybody would
write: the mean of the frames so far and a plane through 5x5 pixels of inverse depth. Only pixels that the stage
gives a normal count."""

import os

import numpy as np
import relief

from .draws import Draws
from .measures import Angles, dot, noise_sigma
from .sections import Failed

WIDTH, HEIGHT = 640, 480
NOTHING = 1.0


class Frame:
    def __init__(self, folder):
        self.depth = self._read_depth(os.path.join(folder, "depth.bin"))
        self._read_camera(os.path.join(folder, "params.txt"))
        png = relief.read_png(os.path.join(folder, "normal.png"))
        if png.shape != (HEIGHT, WIDTH, 3):
            raise Failed("relief-lab eval: %s/normal.png: is not %d x %d" % (folder, WIDTH, HEIGHT))
        normals = 1.0 - 2.0 * png / 65535.0
        self.normals = normals / np.linalg.norm(normals, axis=-1, keepdims=True)

    @staticmethod
    def _read_depth(path):
        try:
            depth = np.fromfile(path, "<f4")
        except OSError as error:
            raise Failed("relief-lab eval: %s: cannot be read; check the folder" % path) from error
        if depth.size != WIDTH * HEIGHT or os.path.getsize(path) != 4 * depth.size:
            raise Failed("relief-lab eval: %s: is not %d x %d float32" % (path, WIDTH, HEIGHT))
        depth[depth == NOTHING] = 0
        return depth.reshape(HEIGHT, WIDTH)

    def _read_camera(self, path):
        try:
            with open(path, encoding="utf-8") as file:
                fx, fy, u0, v0 = map(float, file.read().split()[:4])
        except (OSError, ValueError) as error:
            raise Failed("relief-lab eval: %s: must hold the numbers fx fy u0 v0" % path) from error
        self.camera = relief.Camera(WIDTH, HEIGHT, fx, fy, u0 - 1.0, v0 - 1.0)
        x, y = np.meshgrid((np.arange(WIDTH) - (u0 - 1.0)) / fx, (np.arange(HEIGHT) - (v0 - 1.0)) / fy)
        self.ray_x, self.ray_y = x.astype(np.float32), y.astype(np.float32)

    def error_deg(self, pixels, normals):
        """Of normals (N, 3) at a mask's pixels."""
        return np.degrees(np.arccos(np.minimum(np.abs(dot(normals, self.normals[pixels])), 1.0)))


def clean_figures(frame, profile):
    method = "inverse_depth" if profile == "live" else "thesis"
    found = relief.compute_normals(frame.depth, frame.ray_x, frame.ray_y, method)
    there = frame.depth > 0
    has = there & (dot(found, found) > 0.25)
    angles = Angles()
    angles.missing = int((there & ~has).sum())
    angles.add(frame.error_deg(has, found[has]))
    titles = ("normals, mean, deg", "normals, median, deg", "normals > 30 deg off, %", "normals missing, %")
    keys = ("normals_mean_deg", "normals_median_deg", "normals_over_30_percent", "normals_missing_percent")
    values = angles.figures("normals")
    return [(key, "clean depth: " + title, values[key]) for key, title in zip(keys, titles)]


# ---- seen with noise for two seconds ------------------------------------------------------------------

MEASURED, PITCH, REACH = (0, 10, 60), 4, 2
DISTANCE_M = 1.5
STEPS_M = 348.0  # shift of the pattern at 1 m: 8 x 75 mm x 580 pixels, a Kinect v1
SHIFT_SIGMA = 0.35  # steps
HALF = 0.70710678
ONE_SURFACE = np.float32(0.04)  # share of the depth, for the plain planes
SENSORS = (("flight", "still, time of flight", (0.0, 0.0, 0.0015)),
           ("steps", "still, structured light", (0.0008, 0.0, 0.0012)))


def smooth_noise(draws):
    """Standard normal numbers every PITCH pixels, interpolated; 1.5 makes up for what that averages."""
    rows, columns = HEIGHT // PITCH + 1, WIDTH // PITCH + 1
    knot = draws.normals(rows * columns).reshape(rows, columns).astype(np.float32)
    y, x = np.divmod(np.arange(HEIGHT), PITCH)[0][:, None], np.divmod(np.arange(WIDTH), PITCH)[0][None]
    fy = ((np.arange(HEIGHT) % PITCH).astype(np.float32) / np.float32(PITCH))[:, None]
    fx = ((np.arange(WIDTH) % PITCH).astype(np.float32) / np.float32(PITCH))[None]
    above = knot[y, x] + (knot[y, x + 1] - knot[y, x]) * fx
    below = knot[y + 1, x] + (knot[y + 1, x + 1] - knot[y + 1, x]) * fx
    return np.float32(1.5) * (above + (below - above) * fy)


class Watch:
    """A frame at DISTANCE_M, and what a sensor has seen of it so far."""

    def __init__(self, frame, kind, noise):
        self.frame, self.kind, self.noise, self.draws = frame, kind, noise, Draws(1)
        count = int((frame.depth > 0).sum())
        total = float(np.cumsum(frame.depth, dtype=np.float64)[-1])
        self.real = np.float32(DISTANCE_M * count / total if count else 1.0) * frame.depth
        self.mean = np.zeros_like(self.real)
        self.always = smooth_noise(self.draws)

    def see(self, number):
        z = self.real.astype(float)
        there, seen = z > 0, np.zeros_like(self.real)
        if self.kind == "steps":
            error = HALF * (self.always + smooth_noise(self.draws)).astype(float)
            steps = np.trunc(STEPS_M / z[there] + SHIFT_SIGMA * error[there] + 0.5)
            seen[there] = STEPS_M / np.maximum(steps, 1.0)
        else:
            near = z[there]
            seen[there] = near + noise_sigma(self.noise, near) * self.draws.normals(len(near))
        self.mean += (seen - self.mean) / np.float32(number + 1)
        return seen

    def plain_normals(self, y, x):
        """Of the plane w = a + b x + c y of inverse depth through the pixels about each."""
        z, ray_x, ray_y = self.mean[y, x], self.frame.ray_x, self.frame.ray_y
        sums = np.zeros((9, len(z)))
        for dy in range(-REACH, REACH + 1):
            for dx in range(-REACH, REACH + 1):
                k = (y + dy, x + dx)
                other = self.mean[k]
                near = np.abs(other - z) < ONE_SURFACE * z
                u, v = (np.where(near, (r[k] - r[y, x]).astype(float), 0.0) for r in (ray_x, ray_y))
                w = np.where(near, 1.0 / np.where(near, other, 1.0).astype(float), 0.0)
                for total, term in zip(sums, (near, u, v, w, u * u, u * v, v * v, u * w, v * w)):
                    total += term
        n, sx, sy, sw, xx, xy, yy, xw, yw = sums
        xx, xy, yy = xx - sx * sx / n, xy - sx * sy / n, yy - sy * sy / n
        xw, yw = xw - sx * sw / n, yw - sy * sw / n
        det = xx * yy - xy * xy
        b, c = (xw * yy - yw * xy) / det, (yw * xx - xw * xy) / det
        a = (sw - b * sx - c * sy) / n - b * ray_x[y, x] - c * ray_y[y, x]
        out = np.stack((-b, -c, -a), axis=-1)
        return out / np.linalg.norm(out, axis=-1, keepdims=True)

    def errors(self, normals):
        """(mean of the stage's, of the plain ones, share without a normal in percent)"""
        inside = np.zeros(self.real.shape, bool)
        inside[REACH:HEIGHT - REACH, REACH:WIDTH - REACH] = True
        pixels = np.nonzero(inside & (self.real > 0))
        found = normals[pixels].astype(float)
        with np.errstate(divide="ignore", invalid="ignore"):
            plain = self.plain_normals(*pixels)
        has = (dot(found, found) > 0.25) & (dot(plain, plain) > 0.25)
        pixels = tuple(p[has] for p in pixels)
        means = (float(self.frame.error_deg(pixels, n[has]).mean()) for n in (found, plain))
        return *means, 100.0 * float((~has).sum()) / len(has)


def still_figures(frame):
    for kind, title, noise in SENSORS:
        watch = Watch(frame, kind, noise)
        pipeline = relief.Pipeline(relief.Rig(frame.camera, depth_range=(0.4, 4.5), noise=noise), camera="fixed",
                                   render=False, threads=1)
        for number in range(MEASURED[-1] + 1):
            surface = pipeline.push(watch.see(number), time=number * 0.033333333).surface
            if number not in MEASURED:
                continue
            mean, plain, missing = watch.errors(surface.normals)
            what = ", frame 0: normals, mean, deg" if number == 0 else ", frame %d" % number
            yield "still_%s_%d_deg" % (kind, number), title + what, mean
            yield ("still_%s_plain_%d_deg" % (kind, number),
                   "  mean of frames + 5x5 plane, %s%d" % ("frame " if number == 0 else "", number), plain)
        yield "still_%s_missing_percent" % kind, title + ": without a normal, %", missing


def run(task):
    name, frame = os.path.basename(task.folder), Frame(task.folder)
    for profile in task.profiles:
        yield from ((name, key, title, profile, value) for key, title, value in clean_figures(frame, profile))
    if "live" in task.profiles:
        yield from ((name, key, title, "live", value) for key, title, value in still_figures(frame))
