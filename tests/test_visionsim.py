"""`VisionSim`: what the camera sees, and when the robot hears of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pyfrc.physics.visionsim import VisionSim, VisionSimTarget

Pose = tuple[float, float, float]

STEP = 0.02
ORIGIN: Pose = (0.0, 0.0, 0.0)
#: Straight ahead of a robot at the origin, to be seen from its west.
AHEAD = VisionSimTarget(10, 0, 90, 270)


def camera(*targets: VisionSimTarget, fov: float = 60, start: float = 0, end: float = 100, **more: Any) -> VisionSim:
    return VisionSim(list(targets), fov, start, end, **more)


def sees(vision: VisionSim, pose: Pose) -> bool:
    vision.compute(0, *pose)
    return vision.get_immediate_distance() is not None


def run(vision: VisionSim, times: Sequence[float], pose: Pose = ORIGIN) -> dict[float, Any]:
    """What arrived, by the time of the call that answered it."""
    answers = {now: vision.compute(now, *pose) for now in times}
    return {now: answer for now, answer in answers.items() if answer is not None}


def seconds(count: int, step: float = STEP) -> list[float]:
    return [number * step for number in range(count)]


# -- as documented -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("start", "end", "visible_from"),
    [
        (0, 90, {"east", "south-east", "south"}),  # the documentation's own example
        (90, 180, {"south", "south-west", "west"}),
        (90, 270, {"south", "south-west", "west", "north-west", "north"}),
        (270, 90, {"north", "north-east", "east", "south-east", "south"}),
        (315, 45, {"north-east", "east", "south-east"}),
        (-45, 45, {"north-east", "east", "south-east"}),
        (180, 180, {"west"}),
        (0, 360, {"north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"}),
        (180, 540, {"north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"}),
    ],
)
def test_a_target_is_seen_from_its_view_angles_clockwise_from_east(
    start: float, end: float, visible_from: set[str]
) -> None:
    places = {
        "east": (1, 0), "south-east": (1, 1), "south": (0, 1), "south-west": (-1, 1),
        "west": (-1, 0), "north-west": (-1, -1), "north": (0, -1), "north-east": (1, -1),
    }  # fmt: skip
    seen_from = set()
    for name, (x, y) in places.items():
        looking_at_it = math.atan2(-y, -x)
        if sees(camera(VisionSimTarget(20, 10, start, end)), (20 + x, 10 + y, looking_at_it)):
            seen_from.add(name)
    assert seen_from == visible_from


def test_the_field_of_view_is_half_to_each_side_and_turns_are_counted_off() -> None:
    for turns in (-5, 0, 1, 12):
        for degrees, visible in (
            (0, True),
            (29.99, True),
            (-29.99, True),
            (30.01, False),
            (-30.01, False),
            (180, False),
        ):
            assert sees(camera(AHEAD), (0, 0, math.radians(degrees) + turns * math.tau)) is visible


def test_several_targets_come_with_the_least_offset_first() -> None:
    targets = [VisionSimTarget(10, y, 90, 270) for y in (-2, 1, 0, 40)]
    vision = camera(*targets)
    answer = run(vision, seconds(5))[0.06]
    assert [round(offset, 1) for _, _, offset, _ in answer] == [0.0, 5.7, -11.3]
    assert vision.get_immediate_distance() == 10


# -- frames ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("frequency", "lag", "captured", "arrived"),
    [
        (15, 0.05, [0.02, 0.1, 0.18, 0.26], [0.08, 0.16, 0.24, 0.32]),
        (30, 0.05, [0.02, 0.06, 0.1, 0.14], [0.08, 0.12, 0.16, 0.2]),
        (15, 0.3, [0.02, 0.1, 0.18, 0.26], [0.34, 0.4, 0.5, 0.56]),
    ],
)
def test_frames_are_taken_and_arrive_as_in_2019(
    frequency: float, lag: float, captured: list[float], arrived: list[float]
) -> None:
    vision = camera(AHEAD, data_frequency=frequency, data_lag=lag)
    assert vision.update_period == 1 / frequency
    frames = run(vision, seconds(60)[1:])
    assert [frame[0][1] for frame in frames.values()][:4] == pytest.approx(captured)
    assert list(frames)[:4] == pytest.approx(arrived)


def test_the_update_period_can_be_changed() -> None:
    vision = camera(AHEAD)
    vision.update_period = 0.35
    assert [frame[0][1] for frame in run(vision, seconds(40)).values()] == pytest.approx([0, 0.36, 0.72])


def test_a_frame_shows_what_was_in_view_when_it_was_taken() -> None:
    vision = camera(AHEAD, data_lag=0.1)
    answers = [vision.compute(now, 0, 0, 0.0 if now < 0.03 else math.pi) for now in seconds(11)]
    assert [answer for answer in answers if answer is not None] == [
        [(1, 0.0, 0.0, 10.0)],
        [(0, 0.08, math.inf, 0)],
    ]


def test_disabling_loses_what_was_under_way_and_keeps_the_period() -> None:
    vision = camera(AHEAD)
    vision.compute(0, *ORIGIN)
    vision.dont_compute()
    arrived = run(vision, [0.04 + time for time in seconds(6)])
    assert list(arrived) == pytest.approx([0.14])
    assert arrived.popitem()[1] == [(1, 0.08, 0.0, 10.0)]


@given(
    steps=st.lists(st.floats(0.001, 0.5), min_size=1, max_size=40),
    frequency=st.floats(1, 60),
    lag=st.floats(0, 1),
    places=st.lists(st.tuples(st.floats(-20, 20), st.floats(-20, 20)), max_size=5),
    fov=st.floats(1, 360),
    pose=st.tuples(st.floats(-20, 20), st.floats(-20, 20), st.floats(-20, 20)),
)
def test_every_frame_keeps_its_promises(
    steps: list[float], frequency: float, lag: float, places: list[tuple[float, float]], fov: float, pose: Pose
) -> None:
    targets = [VisionSimTarget(x, y, 0, 360) for x, y in places]
    vision = camera(*targets, fov=fov, start=1, end=30, data_frequency=frequency, data_lag=lag)
    now, captures, calls = 0.0, [], []
    for step in steps:
        now += step
        calls.append(now)
        frame = vision.compute(now, *pose)
        if frame is None:
            continue
        assert frame
        captures.append(frame[0][1])
        assert {capture for _, capture, _, _ in frame} == {captures[-1]}
        assert captures[-1] in calls
        assert captures[-1] + lag <= now + 1e-5
        offsets = [abs(offset) for _, _, offset, _ in frame]
        assert offsets == sorted(offsets)
        if frame[0][0] == 0:
            assert frame == [(0, captures[-1], math.inf, 0)]
            continue
        for found, _, offset, distance in frame:
            assert found == 1
            assert abs(offset) <= fov / 2
            assert 1 <= distance <= 30
            # Going that far in that direction leads to a target.
            x = pose[0] + distance * math.cos(pose[2] + math.radians(offset))
            y = pose[1] + distance * math.sin(pose[2] + math.radians(offset))
            assert any(math.hypot(x - place[0], y - place[1]) < 1e-6 for place in places)
    assert captures == sorted(set(captures))
    assert len(captures) <= (calls[-1] - calls[0]) * frequency + 1 + 1e-3


# -- drawing -----------------------------------------------------------------------------------------------------


def test_the_physics_controller_is_told_of_targets_when_those_in_view_change() -> None:
    class Controller:
        def draw_vision_targets(self, targets: Any, seen: Any) -> None:
            drawn.append((targets, seen))

    drawn: list[Any] = []
    other = VisionSimTarget(10, 1, 90, 270)
    vision = camera(AHEAD, other, physics_controller=Controller())
    everything = (AHEAD, other)
    assert drawn == [(everything, ())]
    for now in seconds(10):
        vision.compute(now, 0, now, 0)
    assert drawn[1:] == [(everything, everything)]
    vision.compute(0.2, 0, 0, math.radians(-27))
    vision.compute(0.22, 0, 0, math.pi)
    vision.compute(0.24, 0, 0, 0)
    vision.dont_compute()
    vision.dont_compute()
    assert [seen for _, seen in drawn[2:]] == [(AHEAD,), (), everything, ()]


# -- what cannot be ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: VisionSimTarget(None, 0, 0, 360), "^x = None"),  # type: ignore[arg-type]
        (lambda: VisionSimTarget(0, 0, 0, math.nan), "^view_angle_end = nan"),
        (lambda: VisionSim([(10, 0)], 60, 0, 10), r"^targets: \(10, 0\) is not a target"),  # type: ignore[list-item]
        (lambda: camera(AHEAD, fov=0), "^camera_fov = 0"),
        (lambda: camera(AHEAD, start=-1), "^view_dst_start = -1"),
        (lambda: camera(AHEAD, start=5, end=4), "^view_dst_end = 4 is below view_dst_start = 5"),
        (lambda: camera(AHEAD, data_frequency=0), "^data_frequency = 0"),
        (lambda: camera(AHEAD, data_lag=-0.1), "^data_lag = -0.1"),
        (lambda: camera(AHEAD).compute(0, 0, math.nan, 0), "^x, y, angle = 0, nan, 0"),
    ],
)
def test_what_cannot_be_is_named(call: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()
