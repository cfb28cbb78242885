"""The package as its users meet it: frames, surfaces, bodies, and every mistake with its answer."""

import gc
import json
import os
import threading

import numpy as np
import pytest

import relief

ROOT = os.environ["RELIEF_ROOT"]
CUBES = os.path.join(ROOT, "scenes", "two_cubes.json")


@pytest.fixture
def pipeline():
    with relief.Pipeline("synthetic:room", scene=CUBES, threads=1) as made:
        yield made


def floor(millimetres=2000):
    return np.full((120, 160), millimetres, np.uint16)


def pushed(**more):
    camera = relief.Camera(160, 120, fx=120, fy=120, cx=79.5, cy=59.5)
    return relief.Pipeline(camera, gravity=(0, 0, 9.81), threads=1, **more)


def test_a_source_gives_frames_that_may_be_kept():
    with relief.open("synthetic:room") as source:
        frames = [frame for frame, _ in zip(source, range(3))]
        assert (source.rig.depth.width, source.rig.depth.height) == (512, 424)
        assert source.frame_count == 300
    assert [frame.sequence for frame in frames] == [0, 1, 2]
    assert frames[0].depth.dtype == np.uint16 and frames[0].depth.shape == (424, 512)
    assert frames[0].color.shape[2] == 4
    assert not np.array_equal(frames[0].depth, frames[2].depth)  # noise


def test_a_source_starts_again_and_seeks():
    with relief.open("synthetic:room") as source:
        first = next(source).depth
        source.seek(2)
        assert next(source).sequence == 2
        source.restart()
        assert np.array_equal(next(source).depth, first)


def test_planes_agree_with_each_other(pipeline):
    for _, step in zip(range(5), pipeline):
        pass
    surface = step.surface
    assert surface.depth.shape == (surface.height, surface.width)
    assert np.array_equal(surface.points[..., 2], surface.depth)
    length = np.linalg.norm(surface.normals, axis=2)
    assert np.all((abs(length - 1) < 1e-5) | (length == 0))
    toward = np.einsum("hwc,hwc->hw", surface.normals, surface.points)
    assert toward.max() <= 0
    assert set(np.unique(surface.reason)) <= set(range(len(relief.reason_names)))
    up, confidence = surface.find_up()
    assert confidence > 0.7 and up[1] < -0.9


def test_arrays_are_views_and_outlive_the_pipeline(pipeline):
    step = pipeline.step()
    depth = step.surface.depth
    assert not depth.flags.owndata and not depth.flags.writeable
    assert np.shares_memory(depth, step.surface.depth)
    mean = depth.mean()
    pipeline.close()
    assert depth.mean() == mean


def test_a_step_is_over_when_the_next_one_is_made(pipeline):
    step = pipeline.step()
    pipeline.step()
    with pytest.raises(RuntimeError, match="over"):
        step.surface


def test_no_restart_under_an_array(pipeline):
    step = pipeline.step()
    depth = step.surface.depth
    with pytest.raises(BufferError, match="1 arrays"):
        pipeline.restart()
    del depth
    pipeline.restart()
    assert pipeline.step().index == 0


def test_the_same_frames_give_the_same_bodies():
    with relief.open("synthetic:room") as source:
        frames = [frame for frame, _ in zip(source, range(40))]
        rig = source.rig
    with relief.Pipeline("synthetic:room", scene=CUBES) as a, relief.Pipeline(
        rig, scene=CUBES, threads=1
    ) as b:
        for frame in frames:
            asked = a.step()
            given = b.push(frame.depth, frame.color, time=frame.time)
        assert np.array_equal(asked.bodies[0].pose, given.bodies[0].pose)
        assert np.array_equal(asked.picture, given.picture)


def test_a_ball_falls_on_pushed_depth():
    with pushed(render=False) as p:
        ball = p.world.add("sphere", radius=0.1, position=(0, 0, 1), restitution=0.2)
        touched = []
        for i in range(90):
            step = p.push(floor(), time=i / 30)
            touched += [event for event in step.events if event[0] == "begin"]
        assert ball.position[2] == pytest.approx(1.9, abs=0.01)
        assert touched[0][2] == "background"
        assert step.picture is None
        assert p.world.cast_ray((0, 0, 0), (0, 0, 1), 5)[1] == pytest.approx(1.8, abs=0.01)


def list_cameras(folder, *cameras):
    path = folder / "stage.json"
    path.write_text(json.dumps({"cameras": cameras}))
    return path


FRONT = {"source": "synthetic:room?color=0&frames=16&noise=0"}
BACK = {"source": FRONT["source"] + "&path=opposite", "position": [0, 0, 5], "orientation": [0, 1, 0, 0]}


def test_a_ball_meets_what_only_the_second_camera_sees(tmp_path):
    """The floor 1.2 m ahead of the first camera, below its view; nothing is guessed there."""
    scene = tmp_path / "open.json"
    scene.write_text('{"gravity": [0, 9.81, 0], "border": "open"}')
    heights = []
    for cameras in ([FRONT], [FRONT, BACK]):
        with relief.Pipeline(list_cameras(tmp_path, *cameras), scene=scene, render=False, threads=1) as both:
            ball = both.world.add("sphere", radius=0.05, position=(0, 1.0, 1.2), restitution=0.0)
            for _ in both:
                pass
            heights.append(ball.position[1])
    assert heights[0] > 1.4
    assert heights[1] == pytest.approx(1.25, abs=0.01)


def test_a_list_of_cameras_that_cannot_be_opened_is_named(tmp_path):
    with pytest.raises(relief.Error, match="nowhere"):
        relief.Pipeline(list_cameras(tmp_path, FRONT, {"source": "nowhere"}), threads=1)
    with pytest.raises(relief.Error, match="colour is no key"):
        relief.Pipeline(list_cameras(tmp_path, {**FRONT, "colour": 1}), threads=1)


def test_metres_and_millimetres_are_the_same():
    with pushed(render=False) as a, pushed(render=False) as b:
        first = a.push(floor(), time=0).surface.depth
        second = b.push(floor().astype(np.float32) / 1000, time=0).surface.depth
        assert np.allclose(first, second)


def test_rows_may_lie_apart_in_memory():
    wide = np.zeros((120, 200), np.uint16)
    wide[:, 20:180] = floor()
    with pushed(render=False) as p:
        assert np.array_equal(
            p.push(wide[:, 20:180], time=0).surface.depth > 0, floor() > 0
        )
        p.push(np.asfortranarray(floor()), time=1 / 30)
        locked = floor()
        locked.flags.writeable = False
        p.push(locked, time=2 / 30)


@pytest.mark.parametrize(
    "depth, error, words",
    [
        (floor().astype(np.float64), TypeError, "depth has dtype float64: use uint16"),
        (floor()[:60], ValueError, r"depth has shape \(60, 160\): use \(120, 160\)"),
        (floor()[..., None], ValueError, "depth has shape"),
        ([[1, 2]], TypeError, "depth: use a NumPy array"),
    ],
)
def test_wrong_depth_is_named(depth, error, words):
    with pushed() as p, pytest.raises(error, match=words):
        p.push(depth, time=0)


def test_wrong_colour_and_times_are_named():
    with pushed() as p:
        with pytest.raises(ValueError, match="color"):
            p.push(floor(), np.zeros((120, 160, 3), np.uint8), time=0)
        with pytest.raises(ValueError, match="time"):
            p.push(floor(), time=float("nan"))
        with pytest.raises(ValueError, match="units"):
            p.push(floor(), time=0, units_per_metre=0)
        with pytest.raises(ValueError, match="push its frames"):
            next(p)
    camera = relief.Camera(160, 120, fx=120, fy=120, cx=79.5, cy=59.5)
    with relief.Pipeline(relief.Rig(camera, camera)) as p:
        with pytest.raises(TypeError, match="color has dtype float64"):
            p.push(floor(), np.zeros((120, 160, 3)), time=0)
        with pytest.raises(ValueError, match="color has shape"):
            p.push(floor(), np.zeros((120, 160, 2), np.uint8), time=0)
        rgb = np.full((120, 160, 3), 100, np.uint8)
        picture = p.push(floor(), rgb, time=0).picture
        assert picture.shape == (120, 160, 4) and abs(int(picture[60, 80, 0]) - 100) < 3


def test_what_cannot_be_opened_is_named():
    with pytest.raises(relief.Error, match="roomm"):
        relief.open("synthetic:roomm")
    with pytest.raises(relief.FileError):
        relief.open("/there/is/nothing")
    with pytest.raises(relief.Error, match="no_scene"):
        relief.Pipeline("synthetic:room", scene="no_scene.json")
    with pytest.raises(ValueError, match="profile.*live, thesis"):
        relief.Pipeline("synthetic:room", profile="fast")
    with pytest.raises(ValueError, match="fx"):
        relief.Camera(160, 120, fx=0, fy=120, cx=80, cy=60)


def test_bodies_answer_for_themselves():
    world = relief.World(gravity=(0, 0, 0))
    body = world.add("box", size=(0.1, 0.2, 0.3), position=(1, 2, 3), name="crate")
    assert (body.name, body.shape, body.is_alive) == ("crate", "box", True)
    body.apply_impulse((0.1, 0, 0))
    assert body.velocity[0] == pytest.approx(1.0)
    world.advance(0.5)
    assert body.position == pytest.approx([1.5, 2, 3])
    pose = np.eye(4)
    pose[:3, 3] = 7
    body.set(pose, velocity=(0, 0, 0))
    assert np.allclose(body.pose, pose)
    body.remove()
    assert not body.is_alive
    with pytest.raises(ValueError, match="gone"):
        body.position


def test_a_world_of_ones_own_meets_the_real_surface():
    worlds = [relief.World(gravity=(0, 0, g)) for g in (9.81, 1.62)]
    balls = [world.add("sphere", radius=0.1, position=(0, 0, 1)) for world in worlds]
    with pushed(render=False) as p:
        for i in range(20):
            step = p.push(floor(), time=i / 30)
            for world in worlds:
                world.advance(1 / 30, step.surface)
        with pytest.raises(ValueError, match="steps advance it"):
            p.world.advance(0.1)
        surface = step.surface
    assert balls[0].position[2] > balls[1].position[2] > 1
    assert balls[0].position[2] < 1.91
    with pytest.raises(ValueError, match="closed"):
        worlds[0].advance(0.1, surface)
    with pytest.raises(TypeError, match="Surface"):
        worlds[0].advance(0.1, 3)
    with pytest.raises(ValueError, match="dt"):
        worlds[0].advance(2)


@pytest.mark.parametrize(
    "more, words",
    [
        (dict(size=(0, 1, 1)), "size"),
        (dict(mass=-1), "mass"),
        (dict(position=(0, 0)), "position"),
        (dict(position=(0, 0, float("inf"))), "position"),
        (dict(pose=np.ones((4, 4))), "pose"),
        (dict(pose=np.diag([1, 1, -1, 1])), "pose"),
        (dict(shape="cone"), "box, sphere"),
        (dict(name="x" * 70), "name"),
    ],
)
def test_wrong_bodies_are_named(more, words):
    with pytest.raises(ValueError, match=words):
        relief.World().add(**more)


def test_an_unknown_word_of_a_body_is_named():
    with pytest.raises(TypeError, match="colour"):
        relief.World().add(colour=(1, 0, 0))


def test_use_after_close_is_told(pipeline):
    step = pipeline.step()
    world = pipeline.world
    body = world.bodies[0]
    pipeline.close()
    for use in (
        pipeline.step,
        lambda: step.surface,
        lambda: world.bodies,
        lambda: body.position,
        pipeline.restart,
    ):
        with pytest.raises(ValueError, match="closed"):
            use()
    pipeline.close()
    source = relief.open("synthetic:room")
    source.close()
    with pytest.raises(ValueError, match="closed"):
        next(source)


def test_a_pipeline_notices_that_its_source_was_closed():
    source = relief.open("synthetic:room")
    with relief.Pipeline(source) as p:
        p.step()
        source.close()
        with pytest.raises(ValueError, match="source is closed"):
            p.step()


def test_two_threads_in_one_pipeline_do_no_harm(pipeline):
    outcomes = []

    def run():
        for _ in range(20):
            try:
                pipeline.step()
                outcomes.append("step")
            except RuntimeError as error:
                assert "thread" in str(error)
                outcomes.append("told")

    threads = [threading.Thread(target=run) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert outcomes.count("step") >= 20


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_an_exception_in_a_log_function_harms_nothing():
    def fail(level, line):
        raise KeyError(line)

    relief.set_log(fail)
    try:
        with pushed() as p:
            p.push(floor(60000), time=0)  # 60 m away: a warning
    finally:
        relief.set_log(None)
    with pytest.raises(TypeError, match="set_log"):
        relief.set_log(3)


def test_nothing_is_left_behind():
    def memory():
        with open("/proc/self/statm") as f:
            return int(f.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def turn():
        with pushed(render=False) as p:
            p.push(floor(), time=0).surface.depth
        relief.World().add()

    for _ in range(30):
        turn()
    gc.collect()
    before = memory()
    for _ in range(100):
        turn()
    gc.collect()
    assert memory() - before < 4e6
