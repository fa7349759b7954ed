"""Short scripts with which shrinking begins, and what makes a script less likely on a field than another."""

from __future__ import annotations

from typing import Any

from pyfrc_core.fuzz.inputs.match_plan import MatchEvent, without_restarts
from pyfrc_core.fuzz.shrink.starts import (
    ScriptWrite,
    moments_held_in_autonomous,
    starts_of,
    transitions_without_pause,
    without_overwritten,
)
from pyfrc_core.runtime.scripts.targets import MATCH_TIME, MODE, RESTART

AXIS, BUTTON, PLUGGED, INPUT = "joysticks[0].axes[1]", "joysticks[0].buttons[2]", "joysticks[0].plugged", "dio[1].value"


def script(*writes: tuple[float, str, Any]) -> list[ScriptWrite]:
    """Return a script of these writes, each with its time in packets."""
    return [ScriptWrite(round(at * 20_000), target, value, n) for n, (at, target, value) in enumerate(writes)]


def test_short_scripts_have_the_last_values_and_what_came_last() -> None:
    writes = script(
        (1, MODE, "autonomous"),
        (2, MATCH_TIME, 15.0),
        (10, INPUT, True),
        (50, MODE, "teleop"),
        (60, AXIS, 0.5),
        (119, BUTTON, True),
    )
    found = [
        (round(each.end_us / 20_000), [(write.at_us / 20_000, write.target, write.value) for write in each.writes])
        for each in starts_of(writes, 120 * 20_000)
    ]
    teleop, modes = (1, MODE, "teleop"), [(1, MODE, "autonomous"), (3, MODE, "teleop")]
    stick, switch = (1, AXIS, 0.5), (1, INPUT, True)
    assert found == [
        # The mode, and the joystick that was moved last.
        (57, [teleop, stick, (6, BUTTON, True)]),
        (152, [(1, MODE, "autonomous"), (32, MODE, "teleop"), (42, AXIS, 0.5), (101, BUTTON, True)]),
        # All values, with the last mode or the changes of mode.
        (53, [(1, MATCH_TIME, 12.66), switch, teleop, stick, (2, BUTTON, True)]),
        (57, [(1, MATCH_TIME, 12.66), switch, stick, *modes, (6, BUTTON, True)]),
        (57, [(1, MATCH_TIME, 12.74), switch, teleop, stick, (6, BUTTON, True)]),
        (77, [(1, MATCH_TIME, 13.14), switch, teleop, stick, (26, BUTTON, True)]),
        (81, [(1, MATCH_TIME, 13.14), switch, stick, *modes, (30, BUTTON, True)]),
    ]
    assert starts_of(writes, 20_000) == []


def test_of_the_writes_to_an_input_at_one_moment_the_last_counts() -> None:
    kept = without_overwritten(script((1, AXIS, 0.5), (1, INPUT, True), (1, AXIS, 1.0), (2, AXIS, 0.5)))
    assert [write.number for write in kept] == [1, 2, 3]


def test_modes_follow_each_other_without_a_pause() -> None:
    modes = "autonomous", "teleop", "teleop", "disabled", "teleop", "test", "disabled autonomous", "autonomous"
    assert transitions_without_pause(script(*((n, MODE, mode) for n, mode in enumerate(modes)), (9, AXIS, 1))) == 2


def test_controls_that_are_held_in_autonomous() -> None:
    begin = [(1, MODE, "autonomous"), (2, AXIS, 0.5), (3, INPUT, True)]
    assert moments_held_in_autonomous(script(*begin)) == 2
    assert moments_held_in_autonomous(script(*begin, (4, AXIS, 0.0), (5, INPUT, False))) == 2
    assert moments_held_in_autonomous(script(*begin, (4, BUTTON, True), (5, AXIS, 0), (5, INPUT, False))) == 4
    assert moments_held_in_autonomous(script(*begin, (4, PLUGGED, False), (5, INPUT, False))) == 2
    assert moments_held_in_autonomous(script(*begin, (4, MODE, "teleop"), (5, INPUT, False))) == 2
    assert moments_held_in_autonomous(script((1, AXIS, 1.0), (2, MODE, "teleop"))) == 0


def test_a_program_that_cannot_be_started_again_is_not() -> None:
    events = without_restarts([MatchEvent(0, {MODE: "teleop", RESTART: True}), MatchEvent(20_000, {RESTART: True})])
    assert [event.writes for event in events] == [{MODE: "teleop"}, {}]
