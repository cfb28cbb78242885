"""Recordings written from Python are read again, bit by bit."""

import numpy as np
import pytest

import relief


@pytest.mark.parametrize("name", ["clip.mcap", "clip/"])
def test_a_recording_is_written_while_a_pipeline_runs(tmp_path, name):
    path = f"{tmp_path}/{name}"
    frames = []
    with relief.Pipeline("synthetic:room", render=False, threads=1) as pipeline:
        pipeline.world.add("sphere", radius=0.1, position=(0, 0, 2))
        with relief.Recording(path, pipeline, jpeg_quality=0) as recording:
            for _, step in zip(range(4), pipeline):
                recording.add(step)
                frames.append(step.frame)
            assert recording.frames == 4
    assert recording.frames == 4 and recording.bytes > 1e5
    with relief.open(path) as source:
        again = list(source)
    assert len(again) == 4
    for a, b in zip(frames, again):
        assert np.array_equal(a.depth, b.depth) and np.array_equal(a.color, b.color)
        assert b.time - again[0].time == pytest.approx(a.time - frames[0].time, abs=1e-6)


def test_frames_of_a_source_and_pushed_ones_are_recorded(tmp_path, camera, floor):
    with relief.open("synthetic:room") as source:
        with relief.Recording(tmp_path / "a.mcap", source, depth_codec="png", chunk=0.1) as kept:
            first = next(source)
            kept.add(first)
            kept.add(next(source))
    with relief.open(tmp_path / "a.mcap") as source:
        assert np.array_equal(next(source).depth, first.depth)
    with relief.Pipeline(camera, render=False) as pipeline:
        with relief.Recording(tmp_path / "b.mcap", camera, compression="lz4") as kept:
            for i in range(3):
                kept.add(pipeline.push(floor, time=i / 30))
    with relief.open(tmp_path / "b.mcap") as source:
        assert [np.array_equal(frame.depth, floor) for frame in source] == [True] * 3


@pytest.mark.parametrize(
    "path, more, error, words",
    [
        ("a.txt", {}, relief.InvalidError, "end it in .mcap"),
        ("no/such/folder/a.mcap", {}, relief.FileError, "no/such/folder"),
        ("a.mcap", dict(depth_codec="zip"), ValueError, "depth_codec.*rvl, png"),
        ("a.mcap", dict(compression="gz"), ValueError, "compression.*zstd, lz4"),
        ("a.mcap", dict(jpeg_quality=101), ValueError, "quality|jpeg"),
        ("a.mcap", dict(chunk=0), ValueError, "chunk"),
        (3, {}, TypeError, "path"),
        (b"a.mcap", {}, TypeError, "path"),
        ("a\0.mcap", {}, ValueError, "path"),
    ],
)
def test_a_recording_that_cannot_be_is_named(tmp_path, monkeypatch, camera, path, more, error, words):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error, match=words):
        relief.Recording(path, camera, **more)


def test_wrong_use_of_a_recording_is_named(tmp_path, camera, floor):
    with pytest.raises(TypeError, match="source"):
        relief.Recording(tmp_path / "a.mcap", "synthetic:room")
    with pytest.raises(TypeError, match="source"):
        relief.Recording(tmp_path / "a.mcap", 3)
    recording = relief.Recording(tmp_path / "a.mcap", camera)
    with pytest.raises(TypeError, match="Frame or a Step"):
        recording.add(floor)
    with relief.open("synthetic:room") as source:
        frame = next(source)
    with pytest.raises(ValueError, match=r"depth has shape \(424, 512\): use \(120, 160\)"):
        recording.add(frame)
    with relief.Pipeline("synthetic:room", render=False) as pipeline:
        with pytest.raises(ValueError, match=r"the step's depth has shape \(424, 512\)"):
            recording.add(pipeline.step())
    recording.close()
    recording.close()
    with pytest.raises(ValueError, match="closed"):
        recording.add(frame)


def test_a_step_that_is_over_is_not_recorded(tmp_path, pushed, camera, floor):
    with relief.Recording(tmp_path / "a.mcap", camera) as recording:
        step = pushed.push(floor, time=0)
        pushed.push(floor, time=1 / 30)
        with pytest.raises(RuntimeError, match="over"):
            recording.add(step)


def test_a_full_disk_is_told(camera, floor):
    with pytest.raises(relief.Error):
        with relief.Recording("/dev/full/a.mcap", camera) as recording:
            recording.add(floor)
