"""Test the robot with random inputs, to find combinations of controls that your tests do not cover.

The random numbers start from the run's seed. The shortest script of a failure is saved as an input script, and ``pyfrc
replay`` repeats the failure.
"""

from __future__ import annotations

from typing import Any

from ..hal import HalData
from ..test_support.controller import TestController
from ..test_support.fake_time import FakeTime

__all__ = ["test_fuzz"]


def test_fuzz(hal_data: HalData, control: TestController, fake_time: FakeTime, robot: Any) -> None:
    """Run through a whole match with random inputs."""
    __tracebackhide__ = True
    from .fuzz_match import play_match

    play_match(control, fake_time, robot)
