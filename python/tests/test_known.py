"""Models of known real things."""

import numpy as np
import pytest

import relief

TIN = [
    ("ltn", (663, 368)),
    ("rtn", (689, 364)),
    ("rbn", (689, 402)),
    ("lbn", (663, 406)),
    ("ltf", (634, 362)),
]


@pytest.fixture
def room():
    with relief.Pipeline("synthetic:room", render=False, threads=1) as made:
        made.step()
        yield made


def test_picked_pixels_give_a_pose(room):
    fit = room.set_known("tin", size=(0.16, 0.16, 0.16), points=TIN)
    assert fit.depth_count >= 3 and fit.pick_rms < 0.03 and fit.pick_rms_px < 5
    assert np.linalg.norm(fit.pose[:3, 3]) < 5
    known = room.known
    assert [(k.name, k.shape) for k in known] == [("tin", "box")]
    assert np.allclose(known[0].pose, fit.pose)
    assert np.allclose(room.set_known("tin", pose=fit.pose).pose, fit.pose)
    assert len(room.known) == 1


def test_a_body_lies_on_a_known_box(pushed, floor):
    pose = np.eye(4)
    pose[:3, 3] = 0, 0, 1.5
    pushed.set_known("table", size=(1, 1, 0.1), pose=pose)
    ball = pushed.world.add("sphere", radius=0.1, position=(0, 0, 1), restitution=0)
    for i in range(60):
        pushed.push(floor, time=i / 30)
    assert ball.position[2] == pytest.approx(1.35, abs=0.02)


def test_points_in_the_world(room):
    model = np.array([(0, 0, 0), (0.1, 0, 0), (0, 0.2, 0), (0, 0, 0.1)])
    shift = np.array((0.3, 0.2, 2.0))
    fit = room.set_known(
        "thing", size=(0.2, 0.2, 0.2), points=[(m, m + shift) for m in model], refine=False
    )
    assert np.allclose(fit.pose[:3, 3], shift, atol=1e-6)
    assert np.allclose(fit.pose[:3, :3], np.eye(3), atol=1e-6)


@pytest.mark.parametrize(
    "more, error, words",
    [
        (dict(), ValueError, "either pose or points"),
        (dict(pose=np.eye(4), points=TIN), ValueError, "either pose or points"),
        (dict(pose=np.eye(3)), ValueError, "pose"),
        (dict(pose=np.full((4, 4), np.nan)), ValueError, "pose"),
        (dict(points=TIN[:2]), ValueError, "three to six"),
        (dict(points=TIN + TIN), ValueError, "three to six"),
        (dict(points=3), TypeError, "points"),
        (dict(points=[1, 2, 3]), TypeError, "points"),
        (dict(points=[("xyz", (1, 2))] * 3), ValueError, "xyz"),
        (dict(points=[("ltn", (1, "a"))] * 3), TypeError, "pixel"),
        (dict(points=[("ltn", (1, 2, 3, 4))] * 3), ValueError, "place"),
        (dict(points=[("ltn", 5)] * 3), TypeError, "place"),
        (dict(points=[("ltn", (9999, 9999))] * 3), ValueError, "table"),
        (dict(pose=np.eye(4), size=(0, 1, 1)), ValueError, "size"),
        (dict(pose=np.eye(4), shape="hull"), ValueError, "shape"),
        (dict(pose=np.eye(4), restitution=7), ValueError, "restitution"),
        (dict(pose=np.eye(4), friction=float("nan")), ValueError, "friction"),
    ],
)
def test_wrong_models_are_named(room, more, error, words):
    with pytest.raises(error, match=words):
        room.set_known("table", **more)
    assert room.known == []


def test_wrong_names_and_moments_are_named(room, camera):
    for name in ("", "x" * 64, "a\0b"):
        with pytest.raises(ValueError, match="name"):
            room.set_known(name, pose=np.eye(4))
    with relief.Pipeline(camera) as early:
        with pytest.raises(ValueError, match="make a step first"):
            early.set_known("tin", points=TIN)
    with relief.Pipeline("synthetic:room", profile="thesis", render=False) as thesis:
        with pytest.raises(relief.InvalidError, match="live"):
            thesis.set_known("tin", pose=np.eye(4))
