"""Measures of what is behind, in motion and gone: thickness, velocity, phantoms."""

import numpy as np

from .measures import NAN, dot, is_zero, percent

CLOSE_M = 0.05
GUESS_M = 0.15  # RLF_BACKGROUND_GUESS_M
COLUMN, PERSON, BOOK, THING = 4, 12, 13, 32  # rlf_synthetic_label
UNLIKE = ("child's head", "coat", "skirt", "backpack")  # parts of who is no adult in plain clothes


class Exit:
    """Depth at which rays leave a thing: |found - true|."""

    def __init__(self):
        self.count = self.close = 0
        self.sum_m = 0.0

    def add(self, error):
        error = np.abs(error.astype(float))
        self.count += len(error)
        self.close += int((error <= CLOSE_M).sum())
        self.sum_m += float(error.sum())

    def mean_cm(self):
        return 100.0 * self.sum_m / self.count if self.count else NAN

    def close_percent(self):
        return percent(self.close, self.count)


class Speed:
    """Errors relative to the true speed."""

    BINS = 4000  # of 0.1 %

    def __init__(self):
        self.bins = np.zeros(self.BINS, np.int64)
        self.sum, self.count = 0.0, 0

    def add(self, error, speed):
        share = error / speed
        self.bins += np.bincount(np.minimum(share * 1000.0, self.BINS - 1).astype(np.int64), minlength=self.BINS)
        self.sum += float(share.sum())
        self.count += len(share)

    def median_percent(self):
        return (np.argmax(2 * np.cumsum(self.bins) >= self.count) + 0.5) * 0.1 if self.count else NAN

    def mean_percent(self):
        return 100.0 * self.sum / self.count if self.count else NAN


class Phantoms:
    """Background pixels that moved away: how many are still reported where the thing was."""

    def __init__(self):
        self.background = self.age = None
        self.seen, self.left = {3: 0, 30: 0}, {3: 0, 30: 0}  # so many frames after

    def add(self, v):
        now = v.on_grid(v.truth["background_depth"])
        if self.background is None:
            self.age = np.zeros(now.shape, np.int32)
        else:
            gone = now > self.background + np.float32(CLOSE_M)
            age = np.where(gone, 1, np.where(self.age > 0, self.age + 1, 0))
            self.age = np.where(v.real_foreground, 0, age)  # what a person hides cannot be known
        self.background = now.copy()
        found = v.surface.background_depth
        left = (found > 0) & (found < now - np.float32(CLOSE_M))
        for frames in self.seen:
            old = self.age == frames + 1
            self.seen[frames] += int(old.sum())
            self.left[frames] += int((old & left).sum())

    def percent(self, frames):
        return percent(self.left[frames], self.seen[frames])


class Solid:
    FAST, SWIFT, STILL = 0.2, 1.5, 1e-4  # m/s

    def __init__(self):
        self.body, self.book, self.unlike, self.standing = Exit(), Exit(), Exit(), Exit()
        self.known = self.still = self.still_zero = 0
        self.normal, self.full, self.swift = Speed(), Speed(), Speed()
        self.phantoms = Phantoms()

    def add(self, v):
        self.phantoms.add(v)
        self._add_velocity(v)
        self._add_standing(v)
        self._add_moving(v)

    def _add_velocity(self, v):
        real, found = v.on_grid(v.truth["velocity"]), v.surface.velocity
        still = np.sqrt(dot(real, real)) < self.STILL
        self.still += int(still.sum())
        self.still_zero += int((still & is_zero(found)).sum())
        chosen = v.real_foreground & (v.surface.foreground != 0)
        real, found, normal = (a[chosen].astype(float) for a in (real, found, v.real_normals))
        error, speed = found - real, np.sqrt(dot(real, real))
        along, off = np.abs(dot(real, normal)), np.abs(dot(error, normal))
        fast = along * along > self.FAST * self.FAST
        self.normal.add(off[fast], along[fast])
        length = np.sqrt(dot(error, error))
        for sums, least in ((self.full, self.FAST), (self.swift, self.SWIFT)):
            sums.add(length[speed > least], speed[speed > least])

    def _add_standing(self, v):
        """Where the background shows a thing: what bodies take for its back."""
        if not v.is_known:
            return
        label = v.on_grid(v.truth["label"])
        is_furniture = ((label > COLUMN) & (label < PERSON)) | (label >= THING)
        front = v.surface.background_depth.astype(float)
        chosen = ~v.real_foreground & is_furniture & (np.abs(front - v.real) <= CLOSE_M)
        thickness = v.surface.background_thickness[chosen].astype(float)
        is_known = thickness > 0
        back = v.real[chosen] + v.on_grid(v.truth["thickness"])[chosen]
        self.standing.add(front[chosen] + np.where(is_known, thickness, GUESS_M) - back)
        self.known += int(is_known.sum())

    def _add_moving(self, v):
        chosen = v.real_foreground & (v.surface.foreground != 0) & (v.depth > 0)
        label = v.on_grid(v.truth["label"])[chosen]
        back = v.real[chosen] + v.on_grid(v.truth["thickness"])[chosen]
        error = v.depth[chosen] + v.surface.thickness[chosen] - back
        self.book.add(error[label == BOOK])
        self.body.add(error[label != BOOK])
        unlike = [number for name, number, _ in v.truth["poses"] if number < THING and name in UNLIKE]
        self.unlike.add(error[np.isin(label, unlike)])

    def figures(self):
        return {"exit_mean_cm": self.body.mean_cm(), "exit_within_5_cm_percent": self.body.close_percent(),
                "unlike_exit_mean_cm": self.unlike.mean_cm(), "book_exit_mean_cm": self.book.mean_cm(),
                "standing_exit_mean_cm": self.standing.mean_cm(),
                "standing_within_5_cm_percent": self.standing.close_percent(),
                "standing_known_percent": percent(self.known, self.standing.count),
                "speed_median_percent": self.normal.median_percent(), "speed_mean_percent": self.normal.mean_percent(),
                "velocity_median_percent": self.full.median_percent(),
                "velocity_swift_mean_percent": self.swift.mean_percent(),
                "still_zero_percent": percent(self.still_zero, self.still),
                "background_phantoms_soon_percent": self.phantoms.percent(3),
                "background_phantoms_late_percent": self.phantoms.percent(30)}
