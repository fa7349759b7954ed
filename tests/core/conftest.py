"""A clock with threads, and a robot's run, each for one test in this process."""

from __future__ import annotations

from collections.abc import Generator

import hal
import pytest
import wpilib.simulation

from pyfrc_core.runtime.patches.notifier import PeriodicThread
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.runtime.threads import cooperative
from pyfrc_core.wpi import station, timing

from .timeline import Timeline


@pytest.fixture
def _unreported_start(monkeypatch: pytest.MonkeyPatch) -> None:
    """Do not report to the HAL that a program has started: it cannot forget that, and other tests expect none."""
    monkeypatch.setattr(hal, "observeUserProgramStarting", lambda: None)


@pytest.fixture
def timeline(_unreported_start: None) -> Generator[Timeline]:
    """A clock at 0, and its threads; this thread drives it."""
    timeline = Timeline()
    cooperative.scope.threads = PeriodicThread.threads = timeline.threads
    try:
        yield timeline
    finally:
        try:
            timeline.threads.end()
        finally:
            cooperative.scope.threads = PeriodicThread.threads = None
            timeline.clock.forget()
            timing.run_freely()


@pytest.fixture
def run(_unreported_start: None) -> Generator[RobotRun]:
    """A run that is open, with no robot yet."""
    run = RobotRun()
    run.open()
    try:
        yield run
    finally:
        run.close()
        station.reset_driver_station()
        wpilib.simulation.RoboRioSim.resetData()  # the battery's voltage
