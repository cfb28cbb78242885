"""Hands and what is called when they do something."""

import gc
import weakref

import numpy as np
import pytest

import relief


@pytest.fixture(scope="module")
def seen():
    """The last of 100 steps with a hand and a mitten, and all events up to then."""
    events = []
    with relief.Pipeline("synthetic:hands?gesture=pinch", hands=True, render=False) as pipeline:
        pipeline.on_hand(events.append)
        listed = []
        for _, step in zip(range(100), pipeline):
            listed += step.hand_events
        yield step, events, listed


def test_hands_have_palm_tips_and_gesture(seen):
    step = seen[0]
    sure = [hand for hand in step.hands if hand.is_sure]
    assert {hand.side for hand in sure} == {"left"}  # the other is a mitten
    for hand in sure:
        assert 0.5 <= hand.confidence <= 1 and hand.age > 0.5
        assert hand.palm.shape == (3,) and 0.5 < hand.palm[2] < 2
        assert hand.tips.ndim == 2 and hand.tips.shape[1] == 3 and len(hand.tips) <= 5
        assert np.all(np.linalg.norm(hand.tips - hand.palm, axis=1) < 0.25)
        assert np.dot(hand.normal, hand.palm) < 0
        for unit in (hand.normal, hand.direction, hand.arm_direction, hand.point_direction):
            assert np.linalg.norm(unit) == pytest.approx(1)
        assert hand.gesture in ("open", "fist", "pinch", "point", "none")
        assert 0.02 < hand.palm_radius < 0.08 and hand.holding is None
        assert hand.pinch_width is None or hand.pinch_width >= 0


def test_a_hand_s_pixels_are_where_its_palm_is(seen):
    step = seen[0]
    owner, surface = step.hand_owner, step.surface
    assert owner.shape == (surface.height, surface.width) and owner.dtype == np.uint8
    assert owner.max() <= len(step.hands)
    for i, hand in enumerate(step.hands):
        points = surface.points[owner == i + 1]
        assert len(points) > 100
        assert np.linalg.norm(points - hand.palm, axis=1).min() < 0.02


def test_the_function_sees_every_event_once(seen):
    step, events, listed = seen
    assert len(events) == len(listed) > 0
    for a, b in zip(events, listed):
        assert (a.kind, a.hand) == (b.kind, b.hand)
        assert np.array_equal(a.position, b.position)
        assert np.linalg.norm(a.direction) == pytest.approx(1)


def test_hands_are_looked_for_when_asked(pushed, floor):
    step = pushed.push(floor, time=0)
    assert step.hands is None and step.hand_owner is None and step.hand_events == []
    pushed.set_hands(True)
    step = pushed.push(floor, time=1 / 30)
    assert step.hands == [] and step.times_ms["hands"] > 0
    pushed.set_hands(False)
    assert pushed.push(floor, time=2 / 30).hands is None


def fall(pipeline, floor, frames=40):
    pipeline.world.add("sphere", radius=0.1, position=(0, 0, 1.5), name="ball")
    for i in range(frames):
        pipeline.push(floor, time=i / 30)


def test_a_function_for_contacts(pushed, floor):
    told = []
    pushed.on_contact(lambda *event: told.append(event))
    fall(pushed, floor)
    assert told[0] == ("begin", "ball", "background")
    pushed.on_contact(None)
    before = len(told)
    pushed.world.bodies[0].remove()
    pushed.push(floor, time=2)
    assert len(told) == before


def test_what_a_function_raises_comes_out_and_harms_nothing(pushed, floor):
    def fail(kind, body, other):
        raise KeyError(body)

    pushed.on_contact(fail)
    with pytest.raises(KeyError, match="ball"):
        fall(pushed, floor)
    pushed.on_contact(None)
    step = pushed.push(floor, time=5)
    assert step.index > 5 and step.bodies[0].position[2] < 2


def test_a_function_may_use_its_pipeline(pushed, floor):
    def answer(kind, body, other):
        if len(pushed.world.bodies) < 3:
            pushed.world.add("box", position=(1, 0, 1))

    pushed.on_contact(answer)
    fall(pushed, floor)
    assert len(pushed.world.bodies) > 1


def test_a_function_that_holds_its_pipeline_is_collected(camera):
    class Holder:
        pass

    holder = Holder()
    holder.pipeline = relief.Pipeline(camera, render=False)
    holder.pipeline.on_contact(lambda *event: holder.pipeline)
    holder.pipeline.on_hand(holder.pipeline.close)
    gone = weakref.ref(holder)
    del holder
    gc.collect()
    assert gone() is None


@pytest.mark.parametrize("name", ["on_contact", "on_hand"])
def test_what_is_no_function_is_named(pushed, name):
    with pytest.raises(TypeError, match=name):
        getattr(pushed, name)(3)
