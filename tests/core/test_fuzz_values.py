"""What fuzz writes for entries that cameras send, shorter values, commands that never finish, and names of sensors."""

from __future__ import annotations

import random
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from loops import for_each

from pyfrc_core.fuzz.inputs.device_names import named
from pyfrc_core.fuzz.inputs.network_values import NetworkRead, NetworkValues, is_setting
from pyfrc_core.fuzz.inputs.values import RobotConstants, can_be, simpler
from pyfrc_core.fuzz.oracle.unfinished_commands import LONG_US, UnfinishedCommands
from pyfrc_core.project.robot_files import RobotFiles


@for_each(
    "entry, type_name, default, value",
    [
        ("limelight/tv", "double", 0.0, 0.0),
        ("limelight/tid", "double", 0.0, -1.0),
        ("limelight/tid", "int", 0, -1),
        ("camera/hasTargets", "boolean", True, False),
        ("camera/name", "string", "a", ""),
        ("camera/botpose", "double[]", [1.0, 2.0], (0.0, 0.0)),
        ("camera/ids", "int[]", (3,), (0,)),
        ("camera/ids", "int[]", None, ()),
        ("camera/pose", "struct:Pose2d", None, (0.0, 0.0, 0.0)),
        ("camera/pose", "struct:Rotation2d", None, (0.0,)),
        ("camera/poses", "struct:Pose2d[]", [1], ()),
    ],
)
def test_what_a_camera_sends_without_a_target(entry: str, type_name: str, default: object, value: object) -> None:
    values = NetworkValues(random.Random(1), RobotConstants())
    found = values.without_target(NetworkRead(f"/{entry}", type_name, default))
    assert (found, type(found)) == (value, type(value))


def drawn(entry: str, type_name: str, before: Any, setting: bool = False, count: int = 400) -> list[Any]:
    values = NetworkValues(random.Random(entry), RobotConstants())
    return [values.draw(NetworkRead(entry, type_name), before, setting) for _ in range(count)]


@for_each(
    "entry, low, high",
    [
        ("/limelight/tx", -29.8, 29.8),
        ("/limelight/ty", -24.85, 24.85),
        ("/limelight/ta", 0, 100),
        ("/camera/targetYaw", -180, 180),
        ("/camera/range", 0, 17),
    ],
)
def test_measured_numbers_have_the_range_of_cameras_with_both_ends(entry: str, low: float, high: float) -> None:
    found = drawn(entry, "double", low)
    assert all(low <= each <= high for each in found)
    assert {low, 0.0, high} <= set(found)
    assert len(set(found)) > 50
    small_steps = [each for each in found if 0 < each - low <= 0.5]
    assert len(small_steps) > 20


def test_other_measured_numbers() -> None:
    assert set(drawn("/limelight/tv", "double", 0.0)) == {0.0, 1.0}
    assert set(drawn("/camera/tagId", "int", 0)) == set(range(1, 33))
    late = [each for each in drawn("/limelight/tl", "double", 0.0) if each > 100]
    assert set(late) == {250.0, 1000.0, 5000.0}
    assert 10 < len(late) < 80
    free = drawn("/camera/other", "double", 4.0)
    assert {0.0, 1.0, -1.0, 5.0, 3.0, -4.0} <= set(free)
    assert max(map(abs, free)) <= 1000
    assert any(each > 10 for each in free)
    assert any(each < -10 for each in free)
    assert all(type(each) is int for each in drawn("/camera/other", "int", 4))


def test_settings_stay_positive_or_become_zero() -> None:
    found = drawn("/SmartDashboard/speed", "double", 2.0, setting=True)
    assert is_setting("/SmartDashboard/speed")
    assert not is_setting("/limelight/tx")
    assert {0.0, 1.0, 2.0, 2.2, 1.8, 4.0, 20.0} == set(found)
    zero = drawn("/SmartDashboard/speed", "double", 0.0, setting=True)
    assert {abs(each) for each in zero} == {1.0, 0.5, 0.1, 2.0, 5.0, 10.0}
    assert sum(each < 0 for each in zero) < sum(each > 0 for each in zero) / 2
    switched = drawn("/SmartDashboard/on", "boolean", False, setting=True)
    assert sum(switched) > len(switched) / 2


@for_each(
    "kind, value, shorter",
    [
        ("entry", 0.125, [0.0, 1.0, 0.1]),
        ("entry", -2.75, [0.0, 1.0, -1.0, -3.0, -2.8]),
        ("entry", (1.25, "a", 12), [(), (1.25,), (0.0, "a", 0)]),
        ("entry", 12, [0, 1]),
        ("entry", True, []),
        ("entry", "text", []),
        ("switch", True, []),
        ("axis", "x", []),
    ],
)
def test_values_that_are_shorter_to_read(kind: Any, value: Any, shorter: list[object]) -> None:
    found = list(simpler(kind, value))
    if kind == "entry" and isinstance(value, float):
        assert set(found) <= {*shorter, *(round(value, digits) for digits in (0, 1, 2))}
        assert found[: len(shorter) - 2] == shorter[: len(shorter) - 2]
        assert all(len(repr(each)) < len(repr(value)) for each in found)
    else:
        assert found == shorter


def test_which_values_an_input_can_have() -> None:
    possible = [("pov", 90), ("pov", -1), ("choice", "a"), ("entry", "x"), ("entry", (1,)), ("number", 1.5)]
    possible += [("switch", True), ("axis", 1), ("axis", -1.0), ("count", 3)]
    impossible = [("pov", 91), ("choice", "b"), ("entry", [1]), ("number", 1), ("switch", 1), ("axis", True)]
    impossible += [("axis", 1.01), ("axis", "x"), ("count", 3.5)]
    for pairs, expected in ((possible, True), (impossible, False)):
        assert [can_be(kind, value, ("a",)) for kind, value in pairs] == [expected] * len(pairs)  # type: ignore[arg-type]


def test_the_name_of_a_sensor_is_that_in_the_robots_code() -> None:
    names = {"dio[1]": "arm.limit on DIO 1", "encoder[0]": "left", 'CAN["navX"]': "gyro"}
    found = {
        "dio[1].value": "arm.limit on DIO 1",
        "encoder[0].count": "left count",
        'CAN["navX"]["Yaw"]': "gyro Yaw",
        "dio[10].value": "dio[10].value",
        "dio[1]x": "dio[1]x",
    }
    assert {target: named(target, names) for target in found} == found


class Aim:
    """A command with an end condition of its own."""

    def isFinished(self) -> bool:
        return self.done  # type: ignore[attr-defined,no-any-return]


class Never:
    """A command that is made to run for ever."""

    def isFinished(self) -> bool:
        return False


def test_commands_that_have_never_finished(monkeypatch: pytest.MonkeyPatch) -> None:
    from pyfrc_core.fuzz.oracle import unfinished_commands as module

    clock: Any = SimpleNamespace(now_us=0)
    running: list[Any] = []
    watchers: list[Any] = []
    monkeypatch.setattr(
        module,
        "commands",
        SimpleNamespace(
            scheduled_commands=lambda: running,
            watch_commands=lambda *calls: watchers.extend(calls),
            is_default=lambda command: command is default,
        ),
    )
    default, first, second, never = Aim(), Aim(), Aim(), Never()
    watched = UnfinishedCommands(clock, RobotFiles(Path(__file__).parent))
    watched.begin()
    assert (watched.watching, watchers) == (False, [])
    running += [first, never, default]
    watched.begin()
    assert watched.watching
    on_begin, on_finish, on_interrupt = watchers
    name = f"{Path(__file__).name}:{Aim.isFinished.__code__.co_firstlineno}: Aim.isFinished()"
    on_begin(second)
    clock.now_us = LONG_US - 1
    on_interrupt(second)
    on_finish(second)
    assert (watched.longest, watched.finished) == ({}, set())
    clock.now_us = LONG_US + 1
    watched.end()
    assert watched.longest == {name: LONG_US + 1}
    on_begin(first)
    clock.now_us += LONG_US
    watched.end()
    assert watched.longest == {name: LONG_US + 1}
    on_begin(second)
    on_finish(second)
    assert watched.finished == {name}
