"""What the laboratory counts and what it says about it, on input made here."""

import csv
import json
import math
import os
import unittest

from relief_lab import report, sections
from relief_lab.table import LAB, Bound, Table, read_bounds, read_titles, statistics

NAN = math.nan


def bound(goal, limit, relation="<="):
    return Bound({"relation": relation, "goal": goal, "bound": limit, "thesis": "", "others": ""})


class Statistics(unittest.TestCase):
    def test_interval_is_students(self):
        mean, half, count = statistics([1.0, 2.0, NAN, 3.0])
        self.assertEqual((mean, count), (2.0, 3))
        self.assertAlmostEqual(half, 4.303 / math.sqrt(3.0))
        self.assertTrue(math.isnan(statistics([5.0])[1]) and math.isnan(statistics([NAN])[0]))

    def test_many_values_have_the_normal_quantile(self):
        _, half, _ = statistics([-1.0, 1.0] * 500)
        self.assertAlmostEqual(half * math.sqrt(999.0), 1.9625, places=3)


class Bounds(unittest.TestCase):
    def test_means_are_judged_by_goal_and_bound(self):
        self.assertEqual([bound("1", "2").judge(v) for v in (1.0, 1.5, 2.5, NAN)],
                         ["goal", "bound", "OUTSIDE", "no sample"])
        self.assertEqual([bound("", "2", ">=").judge(v) for v in (2.0, 1.9)], ["bound", "OUTSIDE"])
        self.assertEqual(bound("1", "").judge(9.0), "bound")

    def test_bounds_belong_to_figures(self):
        titles = read_titles()
        for (scene, key), b in read_bounds().items():
            self.assertIn(b.relation, ("<=", ">="))
            if scene in sections.SCENES:
                self.assertIn(key, titles)
            if not math.isnan(b.goal) and not math.isnan(b.bound):  # no bound is tighter than its goal
                self.assertTrue(b.goal <= b.bound if b.relation == "<=" else b.goal >= b.bound, key)

    def test_no_figure_has_two_bounds(self):
        with open(os.path.join(LAB, "bounds.csv"), encoding="utf-8", newline="") as file:
            self.assertEqual(len(list(csv.DictReader(file))), len(read_bounds()))


class Reports(unittest.TestCase):
    def make(self, value, is_whole=True):
        table = Table()
        table.add("room", "foreground_f", "  F", "live", value)
        table.add("room", "bounces", "bounces", "thesis", 3)
        return report.Report(table, is_whole)

    def test_a_figure_outside_its_bound_is_counted(self):
        self.assertEqual(self.make(0.99).count(), (1, 0))
        self.assertEqual(self.make(0.5).count(), (1, 1))

    def test_a_bounded_figure_needs_a_sample(self):
        self.assertEqual(self.make(NAN).count(), (1, 1))
        self.assertEqual(self.make(NAN, is_whole=False).count(), (1, 0))

    def test_json_has_the_figure_and_null_for_what_is_not(self):
        first, second = json.loads(report.json_text({"figures": self.make(NAN).figures()}))["figures"]
        self.assertEqual((first["title"], first["ok"], first["live"]["mean"]), ("F", False, None))
        self.assertEqual(second["thesis"]["values"], [3.0])
        self.assertNotIn("live", second)


if __name__ == "__main__":
    unittest.main()
