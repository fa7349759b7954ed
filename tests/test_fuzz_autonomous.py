"""The driver station sends no joystick data in autonomous: what a driver presses there, `pyfrc fuzz` does not press."""

from __future__ import annotations

import random

from pyfrc_core.fuzz.campaign.describe import story_of
from pyfrc_core.fuzz.inputs.joystick_generator import JoystickGenerator
from pyfrc_core.fuzz.inputs.values import Input, Value
from pyfrc_core.fuzz.oracle.failure import FuzzFailure
from pyfrc_core.fuzz.shrink.starts import ScriptWrite, moments_held_in_autonomous
from pyfrc_core.runtime.scripts.script import InputScript, Step


def test_a_story_names_what_is_held_at_its_end_and_straight_ahead() -> None:
    held = {"joysticks[0].axes[1]": -1.0, "joysticks[0].povs[0]": 0, "joysticks[0].axes[2]": 0.0}
    script = InputScript((Step(20_000, held), Step(1_000_000, {"joysticks[0].buttons[2]": True})), 1_040_000)
    story = story_of(script, FuzzFailure("KeyError", "robot.py:3", "f", "robot.py:3: KeyError: 3"))
    assert "button 2 pressed while axis 1 at -1 and POV 0" in " ".join(story)


def test_nothing_is_held_while_the_driver_station_sends_nothing() -> None:
    for seed in range(20):
        sticks = JoystickGenerator(random.Random(seed))
        names = [("buttons[1]", "button"), ("povs[0]", "pov"), ("axes[0]", "axis")]
        sticks.set_controls([Input(f"joysticks[0].{name}", kind, "joysticks[0]") for name, kind in names], [0])
        held: dict[str, Value] = {}
        for now_us in range(0, 8_000_000, 20_000):
            sends = not 2_000_000 <= now_us < 6_000_000
            sticks.set_sent(sends, now_us)
            if now_us >= sticks.next_us:
                sticks.write(now_us, held)
            assert sends or set(held.values()) <= {0, -1}
        assert held


def test_moments_in_autonomous_with_a_control_held() -> None:
    writes = [
        (20_000, "joysticks[0].buttons[1]", True),
        (40_000, "mode", "autonomous"),
        (60_000, "dio[0].value", False),
        (80_000, "joysticks[0].plugged", False),
        (100_000, "joysticks[0].axes[1]", 0.5),
        (120_000, "joysticks[0].axes[1]", 0.0),
        (140_000, "joysticks[0].povs[0]", 0),
        (160_000, "mode", "teleop"),
        (180_000, "dio[0].value", True),
    ]
    found = [ScriptWrite(at_us, target, value, index) for index, (at_us, target, value) in enumerate(writes)]
    assert moments_held_in_autonomous(found) == 4  # at 40, 60, 100 and 140 ms
