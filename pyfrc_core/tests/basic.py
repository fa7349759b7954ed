"""Tests that run almost any robot through its modes, to check that its code does not crash.

They do not check that the robot does what you want: write your own tests for that.
"""

from __future__ import annotations

from typing import Any

from ..season import CURRENT
from ..test_support.controller import TestController
from ..test_support.fake_time import FakeTime

# How long each mode runs, in seconds.
_AUTONOMOUS_SECONDS = CURRENT.match.autonomous
_OTHER_SECONDS = 5.0


def _run_for(control: TestController, seconds: float) -> None:
    """Run the robot for this long after its `robotInit`."""
    __tracebackhide__ = True
    began = 0.0

    def on_step(now: float) -> bool:
        nonlocal began
        if control.robot_is_starting:
            began = now
        return now - began < seconds

    control.run_test(on_step)


# First, since it takes the longest and the others run in parallel.
def test_practice(control: TestController, fake_time: FakeTime, robot: Any) -> None:
    """Run through a whole practice match.

    The field sends the first of the `game_specific_messages` in ``sim/config.json``, if there are any;
    `test_autonomous` runs with each of them.
    """
    __tracebackhide__ = True
    messages = control.project.game_specific_messages if control.project is not None else ()
    control.game_specific_message = next(iter(messages), None)
    control.set_practice_match()
    control.run_test()


def test_autonomous(control: TestController, fake_time: FakeTime, robot: Any, gamedata: str) -> None:
    """Run autonomous mode, once for each message that the field may send."""
    __tracebackhide__ = True
    control.game_specific_message = gamedata
    control.set_autonomous(enabled=True)
    _run_for(control, _AUTONOMOUS_SECONDS)


def test_disabled(control: TestController, fake_time: FakeTime, robot: Any) -> None:
    """Run disabled mode."""
    __tracebackhide__ = True
    control.set_autonomous(enabled=False)
    _run_for(control, _OTHER_SECONDS)


def test_operator_control(control: TestController, fake_time: FakeTime, robot: Any) -> None:
    """Run operator control mode."""
    __tracebackhide__ = True
    control.set_operator_control(enabled=True)
    _run_for(control, _OTHER_SECONDS)
