"""Whatever is given or done wrongly is an exception that names it, never a crash."""

import gc
import subprocess
import sys
import threading

import numpy as np
import pytest

import relief


def broken_rows():
    buffer = np.zeros(120 * 160 * 2 + 1, np.uint8)
    shifted = buffer[1:].view(np.uint16).reshape(120, 160)
    shifted[:] = 2000
    return shifted


@pytest.mark.parametrize(
    "change",
    [
        lambda a: a[::-1, ::-1][::-1, ::-1],
        lambda a: np.ascontiguousarray(a[:, ::-1])[:, ::-1],
        lambda a: np.ascontiguousarray(a[::-1])[::-1],
        lambda a: np.repeat(np.repeat(a, 2, 0), 2, 1)[::2, ::2],
        lambda a: np.broadcast_to(a[:1], a.shape),
        lambda a: np.asfortranarray(a),
        lambda a: broken_rows(),
        lambda a: np.frombuffer(a.tobytes(), np.uint16).reshape(a.shape),
        lambda a: np.ma.masked_array(a),
        lambda a: a.astype(np.float32) / 1000,
    ],
)
def test_depth_may_lie_in_memory_as_it_likes(camera, floor, change):
    floor[:] = 1500 + np.arange(120)[:, None]
    depth = change(floor)
    with relief.Pipeline(camera, render=False) as a, relief.Pipeline(camera, render=False) as b:
        assert np.allclose(
            a.push(np.array(depth), time=0).surface.depth, b.push(depth, time=0).surface.depth
        )


@pytest.mark.parametrize(
    "depth, error, words",
    [
        (np.zeros((120, 160), ">u2"), TypeError, "depth has dtype >u2"),
        (np.zeros((120, 160), np.int16), TypeError, "depth has dtype int16"),
        (np.zeros((120, 160), bool), TypeError, "depth has dtype bool"),
        (np.zeros((120, 160), object), TypeError, "depth has dtype object"),
        (np.zeros((160, 120), np.uint16), ValueError, r"depth has shape \(160, 120\)"),
        (np.zeros((0, 0), np.uint16), ValueError, "depth has shape"),
        (np.zeros((), np.uint16), ValueError, "depth has shape"),
        (None, TypeError, "depth: use a NumPy array"),
    ],
)
def test_other_depth_is_named(pushed, depth, error, words):
    with pytest.raises(error, match=words):
        pushed.push(depth, time=0)
    assert pushed.push(np.full((120, 160), 2000, np.uint16), time=0).index == 0


def test_wrong_poses_and_times_are_named(pushed, floor):
    for pose in (np.eye(3), np.zeros((4, 4)), "pose", np.full((4, 4), np.inf)):
        with pytest.raises(ValueError, match="pose"):
            pushed.push(floor, time=0, pose=pose)
    for time in (1e300, -1e300, float("inf")):
        with pytest.raises(ValueError, match="time"):
            pushed.push(floor, time=time)


def test_results_are_read_only_and_their_shape_is_theirs(pushed, floor):
    step = pushed.push(floor, time=0)
    for name in ("depth", "normals", "reason", "foreground"):
        array = getattr(step.surface, name)
        with pytest.raises(ValueError, match="read-only"):
            array[:] = 0
        with pytest.raises(ValueError):
            array.flags.writeable = True


@pytest.mark.parametrize(
    "make, error, words",
    [
        (lambda c: relief.Pipeline(3), TypeError, "source"),
        (lambda c: relief.Pipeline(None), TypeError, "source"),
        (lambda c: relief.Pipeline(c, scene=3), TypeError, "scene"),
        (lambda c: relief.Pipeline(c, threads=-1), ValueError, "threads"),
        (lambda c: relief.Pipeline(c, threads=1000), ValueError, "threads"),
        (lambda c: relief.Pipeline(c, camera="flying"), ValueError, "camera.*fixed, moving"),
        (lambda c: relief.Pipeline(c, poses="mine"), ValueError, "poses.*tracked"),
        (lambda c: relief.Pipeline(c, gravity=(0, 1)), ValueError, "gravity"),
        (lambda c: relief.World(threads=-1), ValueError, "threads"),
        (lambda c: relief.World(gravity="down"), ValueError, "gravity"),
        (lambda c: relief.World().add(mass="heavy"), TypeError, "mass"),
        (lambda c: relief.World().add(name=3), TypeError, "name"),
        (lambda c: relief.World().add(friction=float("nan")), ValueError, "friction"),
        (lambda c: relief.World().add(color=(1, 2)), ValueError, "color"),
        (lambda c: relief.World().cast_ray((0, 0, 0), (0, 0, 0), 1), ValueError, "direction"),
        (lambda c: relief.World().cast_ray((0, 0, 0), (0, 0, 1), -1), ValueError, "length"),
        (lambda c: relief.Rig(c, color=3), TypeError, "color"),
        (lambda c: relief.Rig(c, noise=(1, 2)), ValueError, "noise"),
        (lambda c: relief.Rig(c, depth_range=(3, 1)), ValueError, "depth_range"),
        (lambda c: relief.Rig(c, color_from_depth=np.zeros((4, 4))), ValueError, "color_from_depth"),
        (lambda c: relief.open(3), TypeError, "source"),
        (lambda c: relief.open("synthetic:room", threads=-2), ValueError, "threads"),
        (lambda c: relief.open("synthetic:\0room"), ValueError, "source"),
        (lambda c: relief.Step(), TypeError, "Step"),
        (lambda c: relief.Surface(), TypeError, "Surface"),
    ],
)
def test_wrong_arguments_are_named(camera, make, error, words):
    with pytest.raises(error, match=words):
        make(camera)


def test_a_step_s_frame_is_over_when_its_source_goes_on():
    with relief.open("synthetic:room") as source, relief.Pipeline(source, render=False) as p:
        step = p.step()
        kept = step.frame.depth
        next(source)
        with pytest.raises(RuntimeError, match="source has given another"):
            step.frame
        assert kept.max() > 0 and step.surface.depth.max() > 0
        step = p.step()
        source.close()
        with pytest.raises(ValueError, match="source is closed"):
            step.frame


def test_a_pushed_frame_is_there_as_long_as_its_step(pushed, floor):
    step = pushed.push(floor.copy(), time=0)
    gc.collect()
    rubbish = [np.full((120, 160), 7, np.uint16) for _ in range(50)]
    assert np.array_equal(step.frame.depth, floor) and len(rubbish) == 50


def test_a_surface_is_over_when_the_next_step_is_made(pushed, floor):
    surface = pushed.push(floor, time=0).surface
    pushed.push(floor, time=1 / 30)
    with pytest.raises(RuntimeError, match="over"):
        surface.depth
    with pytest.raises(RuntimeError, match="over"):
        relief.World().advance(0.1, surface)


def test_a_pushed_pipeline_has_nothing_to_start_again(pushed, floor):
    with pytest.raises(ValueError, match="no source"):
        pushed.restart()


def test_a_body_belongs_to_its_world():
    one, two = relief.World(), relief.World()
    a, b = one.add("sphere"), two.add("sphere")
    assert a != b and a == one.bodies[0] and hash(a) == hash(one.bodies[0])
    a.remove()
    assert b.is_alive and not a.is_alive and len(two.bodies) == 1
    for use in (lambda: a.position, lambda: a.set(velocity=(0, 0, 0)), lambda: a.apply_impulse((1, 0, 0))):
        with pytest.raises(ValueError, match="gone"):
            use()
    a.remove()
    new = one.add("sphere")
    assert new.is_alive and not a.is_alive and new != a


def test_a_body_outlives_the_name_of_its_world():
    body = relief.World(gravity=(0, 0, 0)).add("sphere", position=(1, 2, 3))
    gc.collect()
    assert body.position == pytest.approx((1, 2, 3))


def test_everything_after_close_is_told(camera, floor):
    pipeline = relief.Pipeline(camera, hands=True)
    step = pipeline.push(floor, time=0)
    surface, world = step.surface, pipeline.world
    body = world.add("sphere")
    pipeline.close()
    uses = [
        lambda: pipeline.push(floor, time=1),
        lambda: pipeline.set_hands(True),
        lambda: pipeline.set_known("a", pose=np.eye(4)),
        lambda: pipeline.known,
        lambda: pipeline.on_hand(print),
        lambda: pipeline.set_view("depth"),
        lambda: surface.points,
        lambda: surface.find_up(),
        lambda: body.set(velocity=(0, 0, 0)),
        lambda: body.remove(),
        lambda: world.add("box"),
        lambda: world.cast_ray((0, 0, 0), (0, 0, 1), 1),
        lambda: relief.World().advance(0.1, surface),
        lambda: relief.Recording("a.mcap", pipeline),
    ] + [lambda name=name: getattr(step, name) for name in dir(step) if not name.startswith("_")]
    for use in uses:
        with pytest.raises(ValueError, match="closed"):
            use()


def run(pipeline, steps, out):
    out.append([step.bodies[0].pose for _, step in zip(range(steps), pipeline)][-1])


def test_pipelines_in_threads_of_their_own_agree():
    outs = []
    pipelines = [relief.Pipeline("synthetic:room", render=False, threads=1) for _ in range(3)]
    for pipeline in pipelines:
        pipeline.world.add("sphere", radius=0.1, position=(0, 0, 2))
    threads = [threading.Thread(target=run, args=(p, 8, outs)) for p in pipelines]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(outs) == 3 and np.array_equal(outs[0], outs[1]) and np.array_equal(outs[1], outs[2])


def test_readers_and_a_writer_in_one_pipeline_are_told(camera, floor):
    told, wrong, stop = [], [], threading.Event()
    with relief.Pipeline(camera, render=False) as pipeline:
        body = pipeline.world.add("sphere")

        def read():
            while not stop.is_set():
                try:
                    body.position, pipeline.world.contacts, pipeline.known, pipeline.world.add("box")
                except relief.CapacityError:
                    pass  # the world is full
                except RuntimeError as error:
                    told.append("thread" in str(error))
                except Exception as error:  # noqa: BLE001
                    wrong.append(error)

        readers = [threading.Thread(target=read) for _ in range(2)]
        for reader in readers:
            reader.start()
        for i in range(60):
            try:
                pipeline.push(floor, time=i / 30)
            except RuntimeError as error:
                told.append("thread" in str(error))
        stop.set()
        for reader in readers:
            reader.join()
    assert all(told) and not wrong


def test_a_log_function_on_other_threads_does_not_lock(tmp_path):
    """Opening, closing and stepping wait for threads that log; the log needs the interpreter."""
    script = (
        "import relief, sys\n"
        "relief.set_log(lambda level, line: print(line))\n"
        "for i in range(3):\n"
        "    with relief.Pipeline('synthetic:room', threads=4, hands=True) as p:\n"
        "        p.step(); p.restart(); p.step()\n"
        "relief.set_log(lambda level, line: relief.set_log(None))\n"
        "p = relief.Pipeline('synthetic:room'); s = p.step(); a = s.surface.depth\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True, timeout=120, cwd=tmp_path)


def test_a_step_allocates_nothing(camera, floor):
    with relief.Pipeline(camera, render=False) as pipeline:
        for i in range(20):
            pipeline.push(floor, time=i / 30)
        before = relief.allocation_count()
        for i in range(20, 60):
            pipeline.push(floor, time=i / 30).surface.depth
        assert relief.allocation_count() == before > 0


def test_arrays_stay_readable_whatever_is_shown_next():
    kept = []
    with relief.Pipeline("synthetic:room?color=96x54", hands=True, threads=1) as pipeline:
        for name in relief.view_names:
            pipeline.set_view(name)
            step = pipeline.step()
            kept += [step.picture, step.hand_owner, step.surface.depth]
        pipeline.set_hands(False)
        pipeline.step()
    sums = [int(array.sum()) for array in kept if array is not None]
    assert len(sums) >= 2 * len(relief.view_names) and max(sums) > 0
