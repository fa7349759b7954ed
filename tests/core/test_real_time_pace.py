"""A run with devices that a vendor simulates in real time waits before a packet that comes too early."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

import pytest
import wpilib

from pyfrc_core.config.settings import Settings, TestSettings
from pyfrc_core.runtime.clock import PACKET
from pyfrc_core.runtime.real_time_pace import RealTimePace
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.wpi import station

#: Twice as fast as real time: 10 ms of it for each packet.
TWICE = Settings(test=TestSettings(real_time_speed=2))


class RealTime:
    """Real time, in milliseconds: it passes in `sleep`, and where a test lets it pass."""

    def __init__(self) -> None:
        self.now = 1000.0
        self.slept: list[float] = []

    def clock(self) -> float:
        """Return it in seconds."""
        return self.now / 1000

    def sleep(self, seconds: float) -> None:
        """Let it pass, and note it."""
        self.slept.append(round(seconds * 1000, 3))
        self.now += seconds * 1000


def slept(run: RobotRun, milliseconds: float, *lasting: float) -> list[float]:
    """Run a robot for some packets, of which some take their time. Return how long each packet was waited for."""
    real = RealTime()
    RealTimePace(run, TWICE, real.clock, real.sleep)
    run.construct(wpilib.TimedRobot)
    station.set_mode(enabled=True)
    if hardware := sys.modules.get("phoenix6.hardware"):
        hardware.TalonFX().set_control(PositionVoltage())
    for number, took in enumerate(lasting, 1):

        def pass_time(took: float = took) -> None:
            real.now += took

        run.clock.at(number * 20_000, PACKET + 1, pass_time)
    run.start()
    run.run_until(round(milliseconds * 1000))
    return real.slept


class PositionVoltage:
    """A request for which the motor's controller closes a loop."""


class TalonFX:
    """A motor."""

    def set_control(self, request: object) -> None:
        """Do nothing."""


@pytest.fixture
def _phoenix(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "phoenix6", ModuleType("phoenix6"))
    hardware: Any = ModuleType("phoenix6.hardware")
    hardware.TalonFX = TalonFX
    monkeypatch.setitem(sys.modules, "phoenix6.hardware", hardware)


@pytest.mark.usefixtures("_phoenix")
def test_each_packet_takes_its_share_of_real_time(run: RobotRun) -> None:
    """The first begins at once."""
    assert slept(run, 100) == [10, 10, 10, 10]


@pytest.mark.usefixtures("_phoenix")
def test_the_rest_of_a_packet_counts_and_a_long_one_leaves_nothing_to_catch_up_on(run: RobotRun) -> None:
    """Devices need the time of each packet, whatever those before it took."""
    assert slept(run, 120, 4, 50, 0, 9) == [6, 10, 1, 10]


def test_other_robots_wait_for_nothing(run: RobotRun, monkeypatch: pytest.MonkeyPatch) -> None:
    """As without the library."""
    for name in ("phoenix6", "phoenix6.hardware"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    assert slept(run, 100) == []
