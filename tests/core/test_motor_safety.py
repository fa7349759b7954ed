"""Motor safety: when it is checked, and that WPILib's own thread has no part in it."""

from __future__ import annotations

import time
from collections.abc import Generator

import hal
import pytest
import wpilib
from hal.simulation import setDriverStationDsAttached, setDriverStationEnabled

from pyfrc_core.runtime.time.motor_safety import MotorSafetyCheck
from pyfrc_core.wpi import station, timing, watchdogs


@pytest.fixture(autouse=True)
def _driver_station() -> Generator[None]:
    timing.stop_and_zero()
    station.reset_driver_station()
    yield
    station.reset_driver_station()
    station.deliver_packet()
    timing.run_freely()


def checks(monkeypatch: pytest.MonkeyPatch, packets: str) -> list[int]:
    """Deliver packets, ``e`` enabled, ``d`` disabled, ``l`` lost, and return the numbers of those with a check."""
    checked: list[int] = []
    number = 0
    monkeypatch.setattr(wpilib.MotorSafety, "checkMotors", lambda: checked.append(number))
    check = MotorSafetyCheck()
    for number, packet in enumerate(packets, 1):
        setDriverStationEnabled(packet in "el")
        setDriverStationDsAttached(packet in "ed")
        check.on_packet(number * 0.02)
    return checked


@pytest.mark.parametrize(
    ("packets", "checked"),
    [
        ("eeeeeeeeeeee", [4, 8, 12]),
        ("deeeeeeeee", [4, 8]),  # a robot that was just enabled has three packets to feed its motors
        ("dddeeeeeee", [6, 10]),
        ("eeedeeeeeee", [7, 11]),
        ("eelleeeeeee", [7, 11]),
        ("dddddddd", []),
        ("llllllll", []),
    ],
)
def test_motors_are_checked_with_every_fourth_packet_while_the_robot_is_enabled(
    packets: str, checked: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert checks(monkeypatch, packets) == checked


def test_a_motor_that_is_not_fed_stops_in_robot_time_and_not_by_wpilibs_thread() -> None:
    check = MotorSafetyCheck()
    motor = wpilib.PWMSparkMax(17)
    motor.setSafetyEnabled(True)
    motor.setExpiration(0.1)
    setDriverStationEnabled(True)
    station.deliver_packet()
    hal.refreshDSData()
    check.on_packet(0.0)
    motor.set(0.5)
    timing.step_us(60_000)
    for _ in range(3):
        check.on_packet(0.06)
    assert motor.get() == 0.5
    timing.step_us(60_000)  # 0.12 s of robot time without a new value
    for _ in range(12):  # which WPILib's own thread would see three times
        station.deliver_packet()
        time.sleep(0.002)
    assert motor.get() == 0.5
    for _ in range(4):
        check.on_packet(0.12)
    assert motor.get() == 0.0


def test_the_thread_is_unsubscribed_from_packets_by_each_check_that_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    removed: list[int] = []
    monkeypatch.setattr(hal, "removeNewDataEventHandle", removed.append)
    MotorSafetyCheck()
    MotorSafetyCheck()
    assert removed == [watchdogs.motor_safety_event()] * 2  # a process has one such thread
