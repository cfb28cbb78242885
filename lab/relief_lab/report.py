"""Goal, bound, mean with its confidence interval, and the thesis beside it."""

import json
import math

from .table import NEVER, PROFILES, read_bounds, statistics

SEEDS_MAX = 64

MORE_IS_BETTER = {
    "foreground_f", "foreground_f_valid", "foreground_precision", "foreground_recall", "exit_within_5_cm_percent",
    "standing_within_5_cm_percent", "standing_known_percent", "still_zero_percent", "bounces",
    "bounces_right_percent", "bounces_within_10_percent", "behind_bounced_percent", "edge_bounced_percent"}

# Where each column finds a headline figure: title, key, scene of the old room, its key there (None: the same).
HEADLINES = (
    ("depth at rest: RMSE, mm", "depth_still_rmse_mm", "room", None),
    ("normals, interior: mean, deg", "normals_interior_mean_deg", "room", None),
    ("normals, interior: > 30 deg off, %", "normals_interior_over_30_percent", "room", None),
    ("normals, edge band: > 30 deg off, %", "normals_band_over_30_percent", "room", None),
    ("  of the surface that depth shows, %", "normals_band_shown_over_30_percent", "room", None),
    ("foreground: F", "foreground_f", "room", None),
    ("room behind what moves: > 4 cm off, %", "behind_off_percent", "room", None),
    ("thickness of people: exit error, cm", "exit_mean_cm", "room", None),
    ("bounces within 10 deg of a true direction, %", "bounces_right_percent", "room", None),
    ("bounces where nothing real is, %", "bounces_phantom_percent", "room", None),
    ("THROW: tunnelled, % (old room: of 334 throws)", "throw_tunnelled_percent", "sensed", "throw_tunnelled"),
    ("BEHIND: through a person's back, %", "behind_passed_percent", "sensed", None),
    ("EDGE: through, %", "edge_passed_percent", "sensed", None),
    ("LIFT from rest: right, % (old room: of 12)", "lift_percent", "sensed", "lift_count"),
    ("SWIPE from rest: right, % (old room: of 12)", "swipe_percent", "sensed", "swipe_count"),
    ("CARRY from rest: right, % (old room: of 3)", "carry_percent", "sensed", "carry_stayed"),
    ("outline of a person: off by, px", "person_mean_px", "picture", None),
    ("objects on tables: IoU of the best region", "object_iou", "room", None),
    ("up within 10 deg, any roll, %", "up_right_percent", "room", None),
)

# What real clips tell of them: their key there, the key here, the title.
REAL_HEADLINES = (
    ("normals_plane_deg", "normals_interior_mean_deg", "normals on large planes, deg"),
    ("normals_plane_over_30_percent", "normals_interior_over_30_percent", "  over 30 deg, %"),
    ("foreground_f", "foreground_f", "foreground: F"),
    ("matte_outline_mean_px", "person_mean_px", "outline of a person: off by, px"),
    ("object_iou", "object_iou", "objects on tables: IoU of the best region"),
    ("up_right_percent", "up_right_percent", "up within 10 deg, any roll, %"),
)


def number(value, form="%.4g"):
    return "-" if math.isnan(value) else form % value


def spread(values):
    mean, half, count = statistics(values)
    if count == 0:
        return "-"
    if mean >= NEVER / SEEDS_MAX:
        return "never"
    return "%.4g" % mean if math.isnan(half) else "%.4g +-%-7.2g" % (mean, half)


def limit(bound, value):
    return "" if bound is None or math.isnan(value) else "%s %.4g" % (bound.relation, value)


class Report:
    """is_whole: every frame of each scene was measured, so a bound without a sample is not kept."""

    def __init__(self, table, is_whole):
        self.table, self.is_whole, self.bounds = table, is_whole, read_bounds()

    def _is_outside(self, verdict):
        return verdict == "OUTSIDE" or (verdict == "no sample" and self.is_whole)

    def _mark(self, row, bound):
        if bound is None or not row.values["live"]:
            return ""
        verdict = bound.judge(row.mean())
        if verdict == "OUTSIDE" or (verdict == "no sample" and self.is_whole and not math.isnan(bound.bound)):
            return "OUTSIDE"
        return "SHORT of the goal" if verdict == "bound" and not math.isnan(bound.goal) else verdict

    def count(self):
        """(figures with a bound, those outside it)"""
        judged = [self.bounds[name].judge(row.mean()) for name, row in self.table.rows.items()
                  if name in self.bounds and not math.isnan(self.bounds[name].bound) and row.values["live"]]
        return len(judged), sum(map(self._is_outside, judged))

    def print(self, has_all):
        print("%-56s %10s  %-18s %-18s %10s" % ("figure: mean over seeds +- 95 % confidence", "goal", "live", "thesis",
                                                "bound"))
        scene = None
        for name, row in self.table.rows.items():
            bound = self.bounds.get(name)
            if not has_all and bound is None:
                continue
            if row.scene != scene:
                print(row.scene)
                scene = row.scene
            print("  %-54s %10s  %-18s %-18s %10s %s" % (
                row.title, limit(bound, bound.goal if bound else 0), spread(row.values["live"]),
                spread(row.values["thesis"]), limit(bound, bound.bound if bound else 0), self._mark(row, bound)))

    def figures(self):
        """The rows as the JSON file has them."""
        return [self._figure(row, self.bounds.get(name)) for name, row in self.table.rows.items()]

    def _figure(self, row, bound):
        out = {"scene": row.scene, "key": row.key, "title": row.title.lstrip(" ")}
        for profile in PROFILES:
            if row.values[profile]:
                mean, half, _ = statistics(row.values[profile])
                out[profile] = {"mean": mean, "ci95": half, "values": row.values[profile]}
        if bound is not None:
            verdict = bound.judge(row.mean())
            out.update(relation=bound.relation, goal=bound.goal, bound=bound.bound, published=bound.thesis,
                       others=bound.others, verdict=verdict, ok=not self._is_outside(verdict))
        return out


def print_random(table, section, seeds, is_tuning):
    """Mean, interval and the worst room of every figure of rooms drawn at random."""
    rows = [row for row in table.rows.values()
            if row.scene == section and any(not math.isnan(v) for v in row.values["live"])]
    if not rows:
        return
    print("%s: %d rooms drawn at random, %s seeds, profile live" % (section, len(rows[0].values["live"]),
                                                                    "even" if is_tuning else "odd"))
    print("  %-54s %10s %10s %12s  %s" % ("figure", "mean", "+- 95 %", "worst", "seed"))
    for row in rows:
        mean, half, _ = statistics(row.values["live"])
        is_more = row.key in MORE_IS_BETTER or row.key.startswith(("lift", "swipe", "carry"))
        known = [i for i, v in enumerate(row.values["live"]) if not math.isnan(v)]
        worst = (min if is_more else max)(known, key=row.values["live"].__getitem__)
        print("  %-54s %10.4g %10.2g %12.4g  %d" % (row.title, mean, half, row.values["live"][worst], seeds[worst]))


def print_columns(table):
    """Headline figures of the old room, the random rooms and real clips side by side."""
    print("%-54s %12s %12s %12s" % ("in short, profile live", "old room", "random rooms", "real"))
    for title, key, scene, old_key in HEADLINES:
        cells = (table.mean(scene, old_key or key), table.mean("random", key), table.mean("real", key))
        print("  %-52s %12s %12s %12s" % (title, *map(number, cells)))


# ---- real recordings: rows of part, key, title, relation, goal, relief, baseline, baseline_name --------


def add_real_headlines(table, real):
    for key, other_key, title in REAL_HEADLINES:
        for row in real:
            if row["key"] == key and not math.isnan(row["relief"]):
                table.add("real", other_key, title, "live", row["relief"])


def real_verdict(row):
    if math.isnan(row["goal"]) or math.isnan(row["relief"]):
        return ""
    is_met = row["relief"] <= row["goal"] if row["relation"] == "<=" else row["relief"] >= row["goal"]
    return "goal" if is_met else "SHORT of the goal"


def print_real(real):
    if real:
        print("%-58s %9s  %-9s %-9s " % ("real recordings", "goal", "Relief", "baseline"))
    part = ""
    for row in real:
        if row["part"] != part:
            part = row["part"]
            print(part)
        goal = "" if math.isnan(row["goal"]) else "%s %s" % (row["relation"], number(row["goal"]))
        words = "; ".join(filter(None, (row["baseline_name"], real_verdict(row))))
        print("  %-56s %9s  %-9s %-9s %s" % (row["title"], goal, number(row["relief"]), number(row["baseline"]),
                                             words))


def without_nan(value):
    """JSON has no word for what was not measured: null."""
    if isinstance(value, dict):
        return {key: without_nan(v) for key, v in value.items()}
    if isinstance(value, list):
        return [without_nan(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def json_text(data):
    return json.dumps(without_nan(data), indent=2) + "\n"
