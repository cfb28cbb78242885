"""What was measured: rows by scene and key, each with a value per profile and seed; and their bounds."""

import csv
import math
import os

LAB = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PROFILES = ("live", "thesis")
NEVER = 1e9  # frames or seconds of what did not happen

# Two-sided 95 % quantiles of Student's t for 1 to 30 degrees of freedom.
QUANTILES = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145,
             2.131, 2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048,
             2.045, 2.042)


def statistics(values):
    """(mean, half width of the 95 % interval, count) of the values that are numbers."""
    known = [v for v in values if not math.isnan(v)]
    if not known:
        return math.nan, math.nan, 0
    mean = sum(known) / len(known)
    if len(known) < 2:
        return mean, math.nan, len(known)
    freedom = len(known) - 1
    t = QUANTILES[freedom - 1] if freedom <= 30 else 1.960 + 2.5 / freedom  # within 0.002
    square_sum = sum((v - mean) ** 2 for v in known)
    return mean, t * math.sqrt(square_sum / freedom / len(known)), len(known)


def number_in(text):
    return float(text) if text else math.nan


class Bound:
    """A goal (NAN = none), and what the mean over seeds must keep (NAN = a goal only)."""

    def __init__(self, row):
        self.relation = row["relation"]
        self.goal, self.bound = number_in(row["goal"]), number_in(row["bound"])
        self.thesis, self.others = row["thesis"], row["others"]

    def _holds(self, limit, value):
        return value <= limit if self.relation == "<=" else value >= limit

    def judge(self, mean):
        if math.isnan(mean):
            return "no sample"
        if not math.isnan(self.goal) and self._holds(self.goal, mean):
            return "goal"
        return "bound" if math.isnan(self.bound) or self._holds(self.bound, mean) else "OUTSIDE"


def read_bounds():
    with open(os.path.join(LAB, "bounds.csv"), encoding="utf-8", newline="") as file:
        return {(row["scene"], row["key"]): Bound(row) for row in csv.DictReader(file)}


def read_titles():
    """Titles of the figures of a synthetic scene by their keys, in the order of the report."""
    with open(os.path.join(LAB, "figures.csv"), encoding="utf-8", newline="") as file:
        return {row["key"]: row["title"] for row in csv.DictReader(file)}


class Row:
    def __init__(self, scene, key, title):
        self.scene, self.key, self.title = scene, key, title
        self.values = {profile: [] for profile in PROFILES}

    def mean(self, profile="live"):
        return statistics(self.values[profile])[0]


class Table:
    """Rows in the order in which they came."""

    def __init__(self):
        self.rows = {}

    def add(self, scene, key, title, profile, value):
        row = self.rows.setdefault((scene, key), Row(scene, key, title))
        row.values[profile].append(float(value))

    def merge(self, rows):
        """Adds (scene, key, title, profile, value) of another process."""
        for row in rows:
            self.add(*row)

    def find(self, scene, key):
        return self.rows.get((scene, key))

    def mean(self, scene, key):
        row = self.find(scene, key)
        return row.mean() if row else math.nan
