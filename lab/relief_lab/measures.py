"""What a surface is worth, frame by frame beside the truth: depth, normals, foreground, what is behind and gone.

A `View` holds a frame's planes on the surface's grid. Each measure adds views, and gives its figures by key.
"""

import math

import numpy as np

OK, FILLED = 0, 7  # of relief.reason_names
NAN = math.nan


def percent(part, whole):
    """NAN when there was nothing to measure: a figure without samples is not a figure of 0."""
    return 100.0 * part / whole if whole > 0 else NAN


def dot(a, b):
    """Of float32 vectors, in double as C does."""
    return (a[..., 0].astype(float) * b[..., 0] + a[..., 1].astype(float) * b[..., 1]
            + a[..., 2].astype(float) * b[..., 2])


def degrees_of(cosine):
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))


def is_zero(vectors):
    return (vectors[..., 0] == 0) & (vectors[..., 1] == 0) & (vectors[..., 2] == 0)


def noise_sigma(noise, z):
    return np.maximum(noise[0] + z * (noise[1] + z * noise[2]), 0.0003)


class View:
    """One frame: the surface `s` with its planes, the truth on the same grid, and the raw depth."""

    def __init__(self, surface, truth, raw, band, rig, time, is_first):
        self.surface, self.truth, self.rig, self.time, self.is_first = surface, truth, rig, time, is_first
        self.scale = surface.scale_factor
        self.depth, self.normals, self.reason = surface.depth, surface.normals, surface.reason
        self.is_known = surface.is_background_known
        self.real = self.on_grid(truth["depth"])
        self.real_normals = self.on_grid(truth["normals"])
        self.real_foreground = self.on_grid(truth["foreground"]) != 0
        self.raw, self.band = self.on_grid(raw), self.on_grid(band)
        low, high = rig.depth_range
        self.in_range = (self.real >= low) & (self.real <= high)
        self.has_normal = ~is_zero(self.normals)
        self.degrees = degrees_of(dot(self.normals, self.real_normals))  # of no meaning without a normal

    def on_grid(self, plane):
        """A plane of the depth camera at the surface's pixels."""
        height, width = self.surface.height, self.surface.width
        return plane[::self.scale, ::self.scale][:height, :width]


class Angles:
    BINS = 18000  # of 0.01 degrees
    WRONG_DEG = 30.0

    def __init__(self):
        self.bins = np.zeros(self.BINS, np.int64)
        self.sum, self.count, self.wrong, self.missing = 0.0, 0, 0, 0

    def add(self, degrees):
        bins = np.minimum((degrees * self.BINS / 180.0).astype(np.int32), self.BINS - 1)
        self.bins += np.bincount(bins, minlength=self.BINS)
        self.sum += float(degrees.sum())
        self.count += len(degrees)
        self.wrong += int((degrees > self.WRONG_DEG).sum())

    def mean(self):
        return self.sum / self.count if self.count else NAN

    def median(self):
        return (np.argmax(2 * np.cumsum(self.bins) >= self.count) + 0.5) * 180.0 / self.BINS if self.count else NAN

    def wrong_percent(self):
        return percent(self.wrong, self.count)

    def missing_percent(self):
        return percent(self.missing, self.count + self.missing)

    def within_percent(self, degrees):
        return percent(int(self.bins[:int(degrees * self.BINS / 180.0)].sum()), self.count)

    def figures(self, name):
        return {name + "_median_deg": self.median(), name + "_mean_deg": self.mean(),
                name + "_over_30_percent": self.wrong_percent(), name + "_missing_percent": self.missing_percent()}


# ---- depth -------------------------------------------------------------------------------------------

FLYING_M = np.float32(0.04)


class DepthErrors:
    """Mixed pixels are counted; so are those that show the other side of an edge, which is a matter of where the
    edge lies: neither takes part in the RMS error."""

    def __init__(self):
        self.pixels = self.missing = self.flying = self.other_side = self.count = 0
        self.square_sum = 0.0

    def add(self, v, plane, pixels):
        """Flat indices of pixels of the surface's grid."""
        z, real = plane[pixels], v.real.ravel()[pixels]
        has = z > 0
        error = z.astype(float) - real
        near = has & (np.abs(error) < float(FLYING_M))
        far = np.flatnonzero(has & ~near)
        self.pixels += len(z)
        self.missing += len(z) - int(np.count_nonzero(has))
        self.count += int(np.count_nonzero(near))
        self.other_side += len(far)
        self.square_sum += float(np.square(error[near]).sum())
        self.flying += int(np.count_nonzero(self._least(v, z[far], pixels[far]) > FLYING_M))

    @staticmethod
    def _least(v, z, pixels):
        """The smallest distance from the true depths of the 3x3 pixels about each."""
        y, x = np.divmod(pixels, v.real.shape[1])
        real = v.truth["depth"]
        ny = np.clip(y * v.scale + np.arange(-1, 2)[:, None, None], 0, real.shape[0] - 1)
        nx = np.clip(x * v.scale + np.arange(-1, 2)[None, :, None], 0, real.shape[1] - 1)
        return np.abs(z - real[ny, nx]).min(axis=(0, 1))

    def rms_mm(self):
        return 1000.0 * math.sqrt(self.square_sum / self.count) if self.count else NAN

    def flying_percent(self):
        return percent(self.flying, self.pixels - self.missing)

    def other_side_percent(self):
        return percent(self.other_side, self.pixels - self.missing)


class Depth:
    """Pixels whose truth has not changed for a second, and pixels whose truth is new in this frame (all of the
    first frame's): what one frame alone must give."""

    STILL_S = 1.0

    def __init__(self):
        self.groups = {name: {kind: DepthErrors() for kind in ("raw", "seen", "filled")} for name in ("still", "moving")}
        self.last = self.since = None

    def add(self, v):
        if self.last is None:
            self.last, self.since = np.zeros_like(v.real), np.zeros(v.real.shape, np.int64)
        now = round(v.time * 1e9)
        changed = v.is_first | (v.real != self.last)
        self.since[changed] = now
        self.last = v.real.copy()
        still = now - self.since >= round(self.STILL_S * 1e9)
        filled, raw, depth = v.reason == FILLED, v.raw.ravel(), v.depth.ravel()
        for name, chosen in (("still", still), ("moving", changed & ~still)):
            group, chosen = self.groups[name], chosen & v.in_range
            group["raw"].add(v, raw, np.flatnonzero(chosen))
            group["seen"].add(v, depth, np.flatnonzero(chosen & ~filled))
            group["filled"].add(v, depth, np.flatnonzero(chosen & filled))

    def figures(self):
        out = {}
        for name, g in self.groups.items():
            raw, seen, filled = g["raw"], g["seen"], g["filled"]
            pixels = seen.pixels + filled.pixels
            values = {"rmse_mm": seen.rms_mm(), "raw_rmse_mm": raw.rms_mm(), "flying_percent": seen.flying_percent(),
                      "raw_flying_percent": raw.flying_percent(), "missing_percent": percent(seen.missing, pixels),
                      "raw_missing_percent": percent(raw.missing, raw.pixels),
                      "filled_percent": percent(filled.pixels, pixels), "filled_rmse_mm": filled.rms_mm(),
                      "filled_wrong_percent": filled.other_side_percent()}
            out.update({"depth_%s_%s" % (name, key): value for key, value in values.items()})
        return out


# ---- normals -----------------------------------------------------------------------------------------

BAND_PIXELS = 6
JUMP_SHARE = np.float32(0.04)


def _dilated(mask):
    """By BAND_PIXELS up and down: unions that double in height."""
    height = len(mask)
    out = np.zeros((height + 2 * BAND_PIXELS, mask.shape[1]), bool)
    out[:height] = mask
    for step in (1, 2, 4, 2 * BAND_PIXELS - 7):
        out[step:] |= out[:-step].copy()
    return out[BAND_PIXELS:BAND_PIXELS + height]


def mark_band(depth):
    """Pixels within 6 of a jump: neighbours whose depths differ by more than 4 % of the nearer."""
    jumps = np.zeros(depth.shape, bool)
    for axis in (0, 1):
        a, b = (depth[:-1], depth[1:]) if axis == 0 else (depth[:, :-1], depth[:, 1:])
        near = np.minimum(a, b)
        jump = (near > 0) & (np.abs(a - b) > JUMP_SHARE * near)
        if axis == 0:
            jumps[:-1] |= jump
            jumps[1:] |= jump
        else:
            jumps[:, :-1] |= jump
            jumps[:, 1:] |= jump
    return _dilated(_dilated(np.ascontiguousarray(jumps.T)).T)


class Normals:
    """Samples inside surfaces, and within 6 pixels of a depth jump; of these, those that are not filled, and all
    against the true surface that the pixel's own depth shows."""

    SHOWN_PIXELS, SHOWN_SIGMAS, SHOWN_SHARE = 4, 3.0, 0.02

    def __init__(self):
        self.interior, self.band, self.seen, self.shown = Angles(), Angles(), Angles(), Angles()
        reach = self.SHOWN_PIXELS
        offsets = [(dx * dx + dy * dy, dy, dx) for dy in range(-reach, reach + 1) for dx in range(-reach, reach + 1)]
        self.offsets = sorted(offsets, key=lambda o: o[0])  # of equally near ones the first in rows

    def add(self, v):
        found, degrees = v.has_normal, v.degrees
        is_ok = v.reason == OK
        band, inside = v.in_range & v.band, v.in_range & ~v.band
        self.interior.missing += int((inside & ~found).sum())
        self.band.missing += int((band & ~found).sum())
        self.seen.missing += int((band & ~found & is_ok).sum())
        self.interior.add(degrees[inside & found])
        self.band.add(degrees[band & found])
        self.seen.add(degrees[band & found & is_ok])
        self._add_shown(v, band & found)

    def _add_shown(self, v, pixels):
        """Stereo spreads what is near over the pixels beside it."""
        y, x = np.nonzero(pixels)
        depth = v.depth[y, x].astype(float)
        normals = v.normals[y, x]
        most = np.maximum(self.SHOWN_SHARE * depth, self.SHOWN_SIGMAS * noise_sigma(v.rig.noise, depth))
        ty, tx = y * v.scale, x * v.scale
        best_y, best_x = ty.copy(), tx.copy()
        real = v.truth["depth"]
        left = np.arange(len(y))
        for _, dy, dx in self.offsets:
            ny, nx = ty[left] + dy, tx[left] + dx
            inside = (ny >= 0) & (nx >= 0) & (ny < real.shape[0]) & (nx < real.shape[1])
            z = real[np.where(inside, ny, 0), np.where(inside, nx, 0)]
            is_shown = inside & (z > 0) & (np.abs(depth[left] - z) <= most[left])
            best_y[left[is_shown]], best_x[left[is_shown]] = ny[is_shown], nx[is_shown]
            left = left[~is_shown]
        self.shown.add(degrees_of(dot(normals, v.truth["normals"][best_y, best_x])))

    def figures(self):
        return {**self.interior.figures("normals_interior"), **self.band.figures("normals_band"),
                **self.seen.figures("normals_band_seen"),
                "normals_band_shown_over_30_percent": self.shown.wrong_percent()}


class Distance:
    """Sums per half metre of true distance, without pixels at depth edges."""

    BINS, FIRST_M, GROSS_M = 8, np.float32(0.5), 0.04

    def __init__(self):
        self.raw, self.found, self.angle = (np.zeros((2, self.BINS)) for _ in range(3))

    def _add(self, sums, bins, values):
        sums[0] += np.bincount(bins, values, self.BINS)
        sums[1] += np.bincount(bins, minlength=self.BINS)

    def add(self, v):
        bins = ((v.real - self.FIRST_M) * np.float32(2.0)).astype(np.int32)
        pixels = np.flatnonzero(~v.band & (v.real >= self.FIRST_M) & (bins < self.BINS))
        bins, real = bins.ravel()[pixels], v.real.ravel()[pixels]
        for sums, plane in ((self.raw, v.raw), (self.found, v.depth)):
            z = plane.ravel()[pixels]
            error = z.astype(float) - real
            good = (z > 0) & (np.abs(error) < self.GROSS_M)
            self._add(sums, bins[good], np.square(error[good]))
        has = v.has_normal.ravel()[pixels]  # they are unit vectors
        self._add(self.angle, bins[has], v.degrees.ravel()[pixels][has])

    def figures(self):
        out = {}
        for k in range(self.BINS):
            name = "distance_%.1f_m_" % (0.5 + 0.5 * k)
            for key, sums in (("raw_rmse_mm", self.raw), ("rmse_mm", self.found)):
                out[name + key] = 1000.0 * math.sqrt(sums[0, k] / sums[1, k]) if sums[1, k] else NAN
            out[name + "normal_mean_deg"] = self.angle[0, k] / self.angle[1, k] if self.angle[1, k] else NAN
        return out


class Centre:
    """The thesis's own experiment: the centre (56 x 47 of 64 x 53 points) of its grid of every 8th pixel, in
    frames that show something moving. Finer grids are sampled at the same pixels."""

    STEP, MARGIN_X, MARGIN_Y, MOVING_SHARE = 8, 4, 3, 0.003
    WRONG_COSINE = 0.86602540378443864676

    def __init__(self):
        self.points = self.wrong = self.missing = 0

    def add(self, v):
        moving = v.truth["foreground"]
        if not v.is_known or self.STEP % v.scale or not np.count_nonzero(moving) > self.MOVING_SHARE * moving.size:
            return
        height, width = moving.shape[0] // self.STEP, moving.shape[1] // self.STEP
        rows, columns = slice(self.MARGIN_Y, height - self.MARGIN_Y), slice(self.MARGIN_X, width - self.MARGIN_X)
        ratio = self.STEP // v.scale
        found = v.normals[::ratio, ::ratio][rows, columns]
        real = v.real_normals[::ratio, ::ratio][rows, columns]
        chosen = v.in_range[::ratio, ::ratio][rows, columns]
        missing = is_zero(found)
        self.points += int(chosen.sum())
        self.missing += int((chosen & missing).sum())
        self.wrong += int((chosen & ~missing & ~(dot(found, real) >= self.WRONG_COSINE)).sum())

    def figures(self):
        return {"centre_bad_percent": percent(self.wrong + self.missing, self.points),
                "centre_missing_percent": percent(self.missing, self.points)}


# ---- foreground --------------------------------------------------------------------------------------


class Confusion:
    def __init__(self):
        self.hits = self.false = self.lost = self.rest = 0

    def add(self, found, real):
        self.hits += int((found & real).sum())
        self.false += int((found & ~real).sum())
        self.lost += int((~found & real).sum())
        self.rest += int((~found & ~real).sum())

    @staticmethod
    def share(part, rest):
        return part / (part + rest) if part + rest > 0 else 1.0

    def precision(self):
        return self.share(self.hits, self.false)

    def recall(self):
        return self.share(self.hits, self.lost)

    def f(self):
        return self.share(2 * self.hits, self.false + self.lost)


class Foreground:
    """On all pixels, and where the sensor gave a depth."""

    def __init__(self):
        self.all, self.valid = Confusion(), Confusion()

    def add(self, v):
        if v.is_known:
            found, is_ok = v.surface.foreground != 0, v.reason == OK
            self.all.add(found, v.real_foreground)
            self.valid.add(found[is_ok], v.real_foreground[is_ok])

    def figures(self):
        is_there = self.all.hits + self.all.lost > 0
        values = (self.all.precision(), self.all.recall(), self.all.f(), self.valid.f())
        keys = ("foreground_precision", "foreground_recall", "foreground_f", "foreground_f_valid")
        out = {key: value if is_there else NAN for key, value in zip(keys, values)}
        out["foreground_false_percent"] = percent(self.all.false, self.all.false + self.all.rest)
        return out


class Behind:
    """What is known of the room where somebody hides it, against the room without its foreground."""

    OFF_M = 0.04

    def __init__(self, source):
        self.source, self.angles = source, Angles()
        self.pixels = self.missing = self.off = self.count = 0
        self.square_sum = 0.0
        self.asked = self.normals = None

    def _real_normals(self, v, y, x, z):
        """The nearest surface to a point of the room is the room's: the simulator is asked once, as long as nothing
        is moved there."""
        if self.asked is None:
            self.asked = np.zeros(v.real.shape, np.float32)
            self.normals = np.zeros((*v.real.shape, 3), np.float32)
        new = self.asked[y, x] != z
        ny, nx, nz = y[new], x[new], z[new].astype(float)
        ray_x, ray_y = v.surface.rays
        points = np.stack((nz * ray_x[ny, nx], nz * ray_y[ny, nx], nz), axis=-1)
        self.normals[ny, nx] = self.source.nearest(points)[1]
        self.asked[ny, nx] = z[new]
        return self.normals[y, x]

    def add(self, v):
        if not v.is_known:
            return
        real = v.on_grid(v.truth["background_depth"])
        low, high = v.rig.depth_range
        y, x = np.nonzero(v.real_foreground & (real >= low) & (real <= high))
        found = v.surface.background_depth[y, x]
        self.pixels += len(y)
        has = found > 0
        self.missing += int((~has).sum())
        y, x, real = y[has], x[has], real[y[has], x[has]]
        error = found[has].astype(float) - real
        good = np.abs(error) <= self.OFF_M
        self.off += int((~good).sum())
        self.square_sum += float((error[good] ** 2).sum())
        self.count += int(good.sum())
        y, x, real = y[good], x[good], real[good]
        normals = v.surface.background_normals[y, x]
        known = dot(normals, normals) > 0
        self.angles.missing += int((~known).sum())
        truth = self._real_normals(v, y[known], x[known], real[known])
        self.angles.add(degrees_of(dot(normals[known], truth)))

    def figures(self):
        return {"behind_missing_percent": percent(self.missing, self.pixels),
                "behind_off_percent": percent(self.off, self.pixels - self.missing),
                "behind_rmse_mm": 1000.0 * math.sqrt(self.square_sum / self.count) if self.count else NAN,
                "behind_normals_mean_deg": self.angles.mean(),
                "behind_normals_over_30_percent": self.angles.wrong_percent()}
