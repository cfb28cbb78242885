"""Measures on planes made here: each counts what it should."""

import math
import unittest
from types import SimpleNamespace

import numpy as np
import relief

from relief_lab import clips, collisions, fit, measures, planes, real_fill, real_objects, solid
from relief_lab.draws import Draws
from relief_lab.points import Points

OK, FILLED = measures.OK, measures.FILLED


def surface(width, height, scale=1, **planes_given):
    names = {"foreground": (np.uint8, 0), "reason": (np.uint8, OK), "depth": (np.float32, 2)}
    made = {name: np.full((height, width), value, kind) for name, (kind, value) in names.items()}
    normals = np.zeros((height, width, 3), np.float32)
    normals[..., 2] = -1
    return SimpleNamespace(width=width, height=height, scale_factor=scale, is_background_known=True, normals=normals,
                           **{**made, **planes_given})


def truth_of(width, height, depth=2.0):
    normals = np.zeros((height, width, 3), np.float32)
    normals[..., 2] = -1
    return {"depth": np.full((height, width), depth, np.float32), "normals": normals,
            "foreground": np.zeros((height, width), np.uint8), "poses": []}


def view(s, truth, band=None, is_first=True, time=0.0):
    rig = SimpleNamespace(depth_range=(0.5, 4.5), noise=(0.001, 0.0, 0.001))
    band = np.zeros(truth["depth"].shape, bool) if band is None else band
    return measures.View(s, truth, truth["depth"], band, rig, time, is_first)


class Shares(unittest.TestCase):
    def test_reason_codes_are_reliefs(self):
        self.assertEqual((relief.reason_names[OK], relief.reason_names[FILLED]), ("ok", "filled"))

    def test_nothing_measured_is_no_figure(self):
        self.assertTrue(math.isnan(measures.percent(0, 0)))
        self.assertTrue(math.isnan(measures.Angles().mean()) and math.isnan(measures.Angles().median()))

    def test_angles_give_mean_median_and_shares(self):
        a = measures.Angles()
        a.add(np.array([1.0, 2.0, 3.0, 50.0]))
        a.missing = 1
        self.assertEqual((a.mean(), a.wrong_percent(), a.missing_percent()), (14.0, 25.0, 20.0))
        self.assertAlmostEqual(a.median(), 2.005)
        self.assertEqual(a.within_percent(10.0), 75.0)


class Surfaces(unittest.TestCase):
    def test_band_is_six_pixels_on_both_sides_of_a_jump(self):
        depth = np.full((30, 40), 2.0, np.float32)
        depth[:, 20:] = 3.0
        band = measures.mark_band(depth)
        self.assertTrue(band[:, 13:27].all() and not band[:, :13].any() and not band[:, 27:].any())

    def test_other_sides_are_counted_and_not_in_the_rms(self):
        depth = np.full((10, 10), 2.0, np.float32)
        depth[0, 0], depth[0, 1], depth[0, 2] = 2.01, 2.5, 0.0
        truth = truth_of(10, 10)
        truth["depth"][0, 0:1] = 2.0
        d = measures.Depth()
        d.add(view(surface(10, 10, depth=depth), truth))
        seen = d.groups["moving"]["seen"]
        self.assertEqual((seen.pixels, seen.missing, seen.other_side, seen.flying), (100, 1, 1, 1))
        self.assertAlmostEqual(seen.rms_mm(), 1000.0 * math.sqrt(0.01 ** 2 / 98), places=3)

    def test_a_pixel_beside_its_edge_is_not_flying(self):
        truth = truth_of(10, 10)
        truth["depth"][:, 5:] = 3.0
        depth = truth["depth"].copy()
        depth[4, 5] = 2.0
        d = measures.Depth()
        d.add(view(surface(10, 10, depth=depth), truth))
        seen = d.groups["moving"]["seen"]
        self.assertEqual((seen.other_side, seen.flying), (1, 0))

    def test_decimated_normals_meet_the_right_truth(self):
        truth = truth_of(32, 16)
        truth["normals"][::2, ::2] = (1, 0, 0)
        s = surface(16, 8, scale=2)
        s.normals[...] = (1, 0, 0)
        n = measures.Normals()
        n.add(view(s, truth))
        self.assertEqual((n.interior.count, n.interior.mean()), (128, 0.0))

    def test_foreground_counts_hits_and_misses(self):
        truth = truth_of(10, 10)
        truth["foreground"][0, :4] = 1
        s = surface(10, 10)
        s.foreground[0, 1:6] = 1
        f = measures.Foreground()
        f.add(view(s, truth))
        self.assertEqual((f.all.hits, f.all.false, f.all.lost, f.all.rest), (3, 2, 1, 94))
        self.assertAlmostEqual(f.figures()["foreground_f"], 6 / 9)

    def test_centre_is_the_thesis_grid_for_every_scale(self):
        for scale in (1, 2, 4, 8):
            truth = truth_of(512, 424)
            truth["foreground"][:50] = 1
            s = surface(512 // scale, 424 // scale, scale)
            s.normals[0] = 0
            c = measures.Centre()
            c.add(view(s, truth))
            self.assertEqual((c.points, c.wrong, c.missing), (56 * 47, 0, 0))

    def test_missing_points_fall_into_the_four_cases(self):
        p, s = Points(), surface(64, 53)
        s.reason[0, 0], s.reason[26, 32] = 3, 3
        p.add(s)
        s.foreground[:10] = 1
        p.add(s)
        self.assertEqual([p.cases[c].missing() for c in "abcd"], [2.0, 1.0, 2.0, 1.0])
        self.assertEqual([p.cases[c].points for c in "abcd"], [3392, 2632, 3392, 2632])

    def test_phantoms_are_looked_for_after_three_frames(self):
        p, truth = solid.Phantoms(), truth_of(4, 4)
        s = surface(4, 4, background_depth=np.full((4, 4), 2.0, np.float32))
        for k in range(6):
            truth["background_depth"] = np.full((4, 4), 2.0 if k < 2 else 3.0, np.float32)
            p.add(view(s, truth))
        self.assertEqual((p.seen[3], p.left[3], p.seen[30]), (16, 16, 0))


class Bounces(unittest.TestCase):
    def setUp(self):
        self.source = relief.open("synthetic:empty?noise=0&color=0&frames=1&seed=1")
        next(self.source)

    def test_scene_is_the_same_for_a_seed(self):
        self.assertEqual(collisions.scene_of(3, 5), collisions.scene_of(3, 5))
        self.assertNotEqual(collisions.scene_of(3, 5), collisions.scene_of(4, 5))

    def test_every_direction_between_the_faces_of_an_edge_is_right(self):
        left, top = 0.59, 0.565  # of the table's top
        for x, nx, ny, wanted in ((0, -1, -1, "right"), (0, -1, -3, "right"), (0, 0, -1, "right"),
                                  (0, 1, -1, "unexplained"), (0.005, -1, -1, "right"), (0.02, -1, -1, "near"),
                                  (0.10, -1, -1, "unexplained"), (0.10, -0.15, -1, "right"), (0.10, -0.2, -1, "near")):
            b = collisions.Collisions(self.source)
            b.judge(np.array((left + x, top, 2.57)), np.array((nx, ny, 0.0)) / math.hypot(nx, ny))
            found = "right" if b.right else "unexplained" if b.unexplained else "near"
            self.assertEqual((found, b.phantom), (wanted, 0), (x, nx, ny))

    def test_bounces_are_measured_where_they_are(self):
        truth, c = self.source.truth, self.source.rig.depth
        y, x = c.height - 20, c.width // 2
        z = float(truth["depth"][y, x])
        point = np.array(((x - c.cx) / c.fx * z, (y - c.cy) / c.fy * z, z))
        normal = truth["normals"][y, x].astype(float)
        b = collisions.Collisions(self.source)
        b.judge(point, normal)
        b.judge(point + 0.03 * normal, normal)
        b.judge(point + 0.3 * normal, normal)
        self.assertEqual((b.bounces, b.phantom, b.right, b.angles.count), (3, 1, 2, 2))
        self.assertAlmostEqual(b.figures()["bounces_off_mm"], 15.0, places=1)
        b.judge(point, np.array((0.0, 0.0, -1.0)))
        self.assertEqual((b.angles.wrong, b.right), (1, 2))


class Draw(unittest.TestCase):
    def test_many_numbers_are_those_one_after_the_other(self):
        many, single = Draws(7), Draws(7)
        self.assertEqual(list(many.normals(3000)), [single.normal() for _ in range(3000)])
        self.assertEqual(many.uniform(), single.uniform())


class Real(unittest.TestCase):
    def test_planes_and_components_are_found(self):
        up_vector = np.array((0.1, -0.8, -0.6)) / np.linalg.norm((0.1, -0.8, -0.6))
        x, y = np.meshgrid((np.arange(120) - 60) / 100.0, (np.arange(100) - 50) / 100.0 + 0.6)
        depth = -1.0 / (up_vector[0] * x + up_vector[1] * y + up_vector[2])
        things = np.zeros(depth.shape, bool)
        things[40:60] = np.arange(120) // 20 % 2 == 1
        depth = np.where(things, 0.8 * depth, depth).astype(np.float32)
        n, d = fit.find_plane(fit.Points(depth, (x.astype(np.float32), y.astype(np.float32)), (0.001, 0, 0)))
        self.assertTrue(n @ up_vector > 0.999999 and abs(d + 1.0) < 1e-3)
        self.assertEqual(fit.components(depth, things, 0.02).max(), 3)

    def test_best_region_is_found(self):
        truth, labels = np.array((2, 2, 2, 2, 3, 3, 0, 0)), np.array((1, 1, 1, 2, 2, 2, 2, 0))
        self.assertEqual([real_objects.best_iou(truth == k, labels) for k in (2, 3)], [0.75, 0.5])

    def test_a_point_seen_by_the_turned_camera_is_the_turned_point(self):
        camera = relief.Camera(640, 480, 520, 530, 318, 255, "plumb_bob", (0.26, -0.95, -0.005, 0.0026, 1.16))
        point = np.array((0.2, 0.15, 1.0))
        u, v = camera.project([point])[0]
        picture = np.zeros((480, 640), np.uint16)
        picture[round(v), round(u)] = 1
        for turn in range(8):
            turned = turn % 4, turn >= 4
            pixel = clips.turn_camera(camera, *turned).project([clips.turn_matrix(*turned) @ point])[0]
            y, x = np.argwhere(clips.turn_picture(picture, *turned))[0]
            self.assertTrue(np.all(np.abs(pixel - (x, y)) <= 0.5 + 1e-9), turn)

    def test_three_pixels_beside_a_step_are_hidden(self):
        mean = np.full((1, 20), 2.0, np.float32)
        mean[0, 10:] = 3.0
        for is_far, hidden in ((True, (10, 11, 12)), (False, (7, 8, 9))):
            mark = np.zeros(mean.shape, bool)
            real_fill.mark_steps(mean, mark, is_far)
            self.assertEqual(tuple(np.flatnonzero(mark)), hidden)


if __name__ == "__main__":
    unittest.main()
