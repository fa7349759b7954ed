"""Drivers' habits in fuzzed matches: they press what the robot asks for, hold, tap twice, and press together."""

from __future__ import annotations

import random
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import wpilib
from loops import for_each
from wpilib.event import EventLoop

from pyfrc_core.fuzz.inputs.asked_controls import watch_controls
from pyfrc_core.fuzz.inputs.joystick_generator import JoystickGenerator
from pyfrc_core.fuzz.inputs.match_plan import SHORT, haste_of
from pyfrc_core.fuzz.inputs.values import Input, Value
from pyfrc_core.runtime.clock import PACKET_US

ASKED = ("joysticks[0].buttons[3]", "joysticks[0].buttons[9]", "joysticks[1].buttons[2]", "joysticks[0].axes[5]")


def controls() -> Iterator[Input]:
    for port in (0, 1):
        device = f"joysticks[{port}]"
        yield from (Input(f"{device}.axes[{axis}]", "axis", device) for axis in range(6))
        yield from (Input(f"{device}.buttons[{button}]", "button", device) for button in range(1, 11))
        yield Input(f"{device}.povs[0]", "pov", device)


def matches(seed: int, asked: tuple[str, ...] = ASKED, haste: float = 1.0) -> list[tuple[float, dict[str, Value]]]:
    """The writes of the drivers in ten minutes: the time in seconds, and the values."""
    generator = JoystickGenerator(random.Random(seed), asked, haste=haste)
    generator.set_controls(controls(), [0, 1])
    found = []
    for now_us in range(0, 600_000_000, PACKET_US):
        if now_us >= generator.next_us:
            writes: dict[str, Value] = {}
            generator.write(now_us, writes)
            found.append((now_us / 1e6, writes))
    return found


def presses(button: str, seed: int = 1) -> list[tuple[float, float]]:
    """When a button is pressed, and when it is let go."""
    changes = [(at, writes[button]) for at, writes in matches(seed) if button in writes]
    return [(start, end) for (start, pressed), (end, _) in pairwise(changes) if pressed]


def test_controls_that_the_robot_asks_for_are_used_most() -> None:
    pressed = [target for _, writes in matches(1) for target, value in writes.items() if ".buttons" in target and value]
    assert sum(target in ASKED for target in pressed) > 0.4 * len(pressed)
    assert {f"joysticks[0].buttons[{number}]" for number in range(1, 11)} < set(pressed)


def test_thumbs_roll_around_povs() -> None:
    pov = "joysticks[0].povs[0]"
    changes = [(at, writes[pov]) for at, writes in matches(1) if pov in writes]
    rolled = [
        (before, after)
        for (at, before), (then, after) in pairwise(changes)
        if then - at < 0.1 and before != -1 != after and (after - before) % 360 in (45, 315)
    ]
    assert {after for _, after in rolled} == {0, 45, 90, 135, 180, 225, 270, 315}


def test_buttons_are_held_for_seconds() -> None:
    held = [end - start for start, end in presses(ASKED[0])]
    assert sum(seconds > 2 for seconds in held) > 10
    assert any(seconds > 4 for seconds in held)


def test_drivers_in_haste_press_about_twice_as_often() -> None:
    usual, hasty = (
        sum(value is True for _, writes in matches(1, haste=haste) for value in writes.values()) for haste in (1.0, 2.0)
    )
    assert 1.6 * usual < hasty < 2.4 * usual


def test_drivers_are_in_haste_in_some_short_matches_only() -> None:
    assert {haste_of(f"fuzz 1 {number}{SHORT}") for number in range(20)} == {1.0, 2.0}
    assert {haste_of(f"fuzz 1 {number}") for number in range(20)} == {1.0}


def test_sticks_are_pushed_into_corners() -> None:
    held: dict[str, Value] = {}
    corners = set()
    for _, writes in matches(1):
        held |= writes
        sticks = [
            (held.get(f"joysticks[0].axes[{axis}]"), held.get(f"joysticks[0].axes[{axis + 1}]")) for axis in (0, 4)
        ]
        corners |= {(index, *stick) for index, stick in enumerate(sticks)}
    assert {(index, x, y) for index in (0, 1) for x in (-1.0, 1.0) for y in (-1.0, 1.0)} <= corners


@for_each(
    "joystick, call, target",
    [
        (wpilib.XboxController, lambda stick: stick.getLeftBumper(), "buttons[5]"),
        (wpilib.XboxController, lambda stick: stick.getAButtonPressed(), "buttons[1]"),
        (wpilib.XboxController, lambda stick: stick.getLeftTriggerAxis(), "axes[2]"),
        (wpilib.XboxController, lambda stick: stick.rightTrigger(EventLoop()), "axes[3]"),
        (wpilib.XboxController, lambda stick: stick.start(EventLoop()), "buttons[8]"),
        (wpilib.XboxController, lambda stick: stick.getRawAxis(axis=4), "axes[4]"),
        (wpilib.XboxController, lambda stick: stick.getPOV(), "povs[0]"),
        (wpilib.XboxController, lambda stick: stick.POVUp(EventLoop()), "povs[0]"),
        (wpilib.PS4Controller, lambda stick: stick.getL2Axis(), "axes[3]"),
        (wpilib.PS4Controller, lambda stick: stick.getL2Button(), "buttons[7]"),
        (wpilib.StadiaController, lambda stick: stick.getLeftTriggerButton(), "buttons[13]"),
        (wpilib.Joystick, lambda stick: stick.getTrigger(), "buttons[1]"),
        (wpilib.Joystick, lambda stick: stick.getTopPressed(), "buttons[2]"),
        (wpilib.Joystick, lambda stick: stick.getTwist(), "axes[2]"),
        (wpilib.Joystick, lambda stick: stick.getRawButtonReleased(7), "buttons[7]"),
        (wpilib.Joystick, lambda stick: wpilib.DriverStation.getStickButton(2, 6), "buttons[6]"),
    ],
)
def test_what_counts_as_asking(joystick: Any, call: Any, target: str) -> None:
    with watch_controls() as asked:
        call(joystick(2))
    assert list(asked.targets) == [f"joysticks[2].{target}"]
    call(joystick(1))
    assert len(asked.targets) == 1
