"""A test that runs each opmode of a robot, to check that its code does not crash. WPILib has opmodes from 2027 on."""

from __future__ import annotations

from typing import Any

from ..season import CURRENT
from ..test_support.controller import TestController
from ..test_support.fake_time import FakeTime
from ..wpi.opmodes import OpmodeOfTests

#: How long it is disabled before and after, in seconds.
_DISABLED_SECONDS = 0.5


def test_opmode(control: TestController, fake_time: FakeTime, robot: Any, opmode: OpmodeOfTests) -> None:
    """Run an opmode as long as autonomous mode lasts, disabled before and after."""
    __tracebackhide__ = True
    with control.run_robot():
        control.step_timing(seconds=_DISABLED_SECONDS, opmode=opmode, enabled=False)
        control.step_timing(seconds=CURRENT.match.autonomous, opmode=opmode, enabled=True)
        control.step_timing(seconds=_DISABLED_SECONDS, opmode=opmode, enabled=False)
