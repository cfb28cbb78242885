"""What a synthetic room knows, and the surface stage with other settings."""

import numpy as np
import pytest

import relief

ROOM = "synthetic:empty?color=0&noise=0&frames=4"


def test_truth_is_that_of_the_last_frame():
    with relief.open(ROOM) as source:
        frame = next(source)
        truth = source.truth
        seen = frame.depth / frame.units_per_metre
    assert truth["depth"].shape == frame.depth.shape == truth["normals"].shape[:2]
    assert np.median(np.abs(seen - truth["depth"])) < 0.001
    assert not truth["foreground"].any() and truth["poses"] == []


def test_nearest_surface_is_where_the_truth_is():
    with relief.open(ROOM) as source:
        next(source)
        camera, truth = source.rig.depth, source.truth
        z = float(truth["depth"][300, 250])
        point = np.array(((250 - camera.cx) / camera.fx * z, (300 - camera.cy) / camera.fy * z, z))
        normal = truth["normals"][300, 250]
        distance, normals, _, label = source.nearest([point, point + 0.02 * normal])
        assert np.allclose(distance, (0, 0.02), atol=1e-5) and np.allclose(normals, normal, atol=1e-5)
        assert label[0] == truth["label"][300, 250]
        assert np.allclose(source.nearest([point], 0.1)[2], 0)
        assert np.allclose(source.down, (0, 1, 0))
        with pytest.raises(ValueError, match="points"):
            source.nearest([1, 2, 3])


def test_a_camera_projects_what_its_rays_unproject():
    camera = relief.Camera(64, 48, 50, 55, 30, 20)
    pixels = camera.project([(0.2, -0.1, 2.0), (0.0, 0.0, -1.0)])
    assert np.allclose(pixels[0], (35, 17.25)) and np.isnan(pixels[1]).all()


def test_settings_and_scale_change_the_surface():
    with relief.Pipeline(ROOM, render=False, scale=4, settings={"fill": False}) as pipeline:
        surface = pipeline.step().surface
        assert (surface.scale_factor, surface.width) == (4, 128)
        assert not (surface.reason == relief.reason_names.index("filled")).any()
        ray_x, _ = surface.rays
        assert np.allclose(surface.points[..., 0], surface.depth * ray_x)
    with pytest.raises(relief.Error, match="no_such"):
        relief.Pipeline(ROOM, settings={"no_such": 1})
    with pytest.raises(ValueError, match="scale"):
        relief.Pipeline(ROOM, scale=65)


def test_normals_of_a_clean_plane_are_its_normal():
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, 40), np.linspace(-0.4, 0.4, 30))
    n = np.array((0.2, -0.3, -1.0)) / np.linalg.norm((0.2, -0.3, -1.0))
    depth = -2.0 / (n[0] * x + n[1] * y + n[2])
    found = relief.compute_normals(depth, x, y)
    assert np.allclose(found[5:-5, 5:-5], n, atol=1e-3)
