"""Missing points and wrong normals per frame in the four cases of thesis section 5.1.2, table 5.1.

a, b: frames without a moving object; c, d: frames with one. a, c: the whole scene; b, d: its centre, 77.59 % of a
64 x 53 grid."""

import numpy as np
import relief

from .measures import NAN, OK, dot, percent

MOVING_SHARE = 0.003  # a frame has a moving object when this share of its points is foreground: fewer is noise
WRONG_COSINE = 0.86602540378443864676  # 30 degrees
REASONS = len(relief.reason_names)
PUBLISHED = {"a": 165.468, "b": 15.548, "c": 188.573, "d": 57.113}


class Counts:
    def __init__(self):
        self.frames = self.points = self.true_points = self.bad_normals = 0
        self.reasons = np.zeros(REASONS, np.int64)  # sums over frames

    def mean_reasons(self):
        return self.reasons / max(self.frames, 1)

    def missing(self):
        """Mean number of points per frame that the sensor did not deliver."""
        return float(self.mean_reasons().sum() - self.mean_reasons()[OK]) if self.frames else 0.0

    def missing_percent(self):
        return 100.0 * self.missing() / self.points if self.points else 0.0

    def estimated_percent(self):
        """The thesis's estimate of wrong normals: each missing point spoils its four neighbours."""
        return min(4.0 * self.missing_percent(), 100.0)

    def counted_percent(self):
        return percent(self.bad_normals, self.true_points)


class Points:
    def __init__(self):
        self.width = self.height = 0
        self.cases = {name: Counts() for name in "abcd"}

    def _centre(self):
        x, y = (self.width * 4 + 32) // 64, (self.height * 3 + 26) // 53
        return np.s_[y:self.height - y, x:self.width - x]

    def add(self, surface, truth=None):
        """Frames of a background that is still being learnt are left out."""
        if not surface.is_background_known:
            return
        self.width, self.height = surface.width, surface.height
        moving = np.count_nonzero(surface.foreground) > MOVING_SHARE * self.width * self.height
        for name, area in zip("cd" if moving else "ab", (np.s_[:, :], self._centre())):
            counts, reasons = self.cases[name], surface.reason[area]
            counts.frames += 1
            counts.points = reasons.size
            counts.reasons += np.bincount(reasons.ravel(), minlength=REASONS)
            if truth is not None:
                step = np.s_[::surface.scale_factor, ::surface.scale_factor]
                whole = np.s_[:self.height, :self.width]
                has = truth["depth"][step][whole][area] > 0
                cosine = dot(surface.normals[area], truth["normals"][step][whole][area])
                counts.true_points += int(has.sum())
                counts.bad_normals += int((has & ~(cosine >= WRONG_COSINE)).sum())  # a missing normal is 0

    def published(self, name):
        """What table 5.1 has of a 64 x 53 grid; NAN of any other."""
        return PUBLISHED[name] if (self.width, self.height) == (64, 53) else NAN

    def off_percent(self, name):
        counts = self.cases[name]
        return 100.0 * (counts.missing() / self.published(name) - 1.0) if counts.frames else NAN


TITLES = {"a": "whole scene, nobody", "b": "centre, nobody", "c": "whole scene, visitor", "d": "centre, visitor"}


def run(task):
    """Section simulator: is the simulated sensor the thesis's? Its missing points belong to the frames, not to a
    profile: both columns have them."""
    points = Points()
    with relief.Pipeline("synthetic:thesis?color=0&seed=%d" % task.seed, profile="thesis", camera="fixed", render=False,
                         threads=1) as pipeline:
        for step in pipeline:
            points.add(step.surface)
    for profile in task.profiles:
        for name, counts in points.cases.items():
            whole = "3392" if name in "ac" else "2632"
            yield ("simulator", "table_%s_off_percent" % name, "table 5.1 %s, %s: off by, %%" % (name, TITLES[name]),
                   profile, abs(points.off_percent(name)))
            yield ("simulator", "table_%s_missing" % name, "  missing points, of " + whole, profile, counts.missing())
