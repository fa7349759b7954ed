"""`pyfrc.physics.can_motors.Talon`: what its sensors and those of a CANcoder get, in which direction."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from skips import missing_python, require
from wpimath.system.plant import DCMotor

if missing := missing_python():
    require("sensors of CTRE's motor controllers", missing)

from phoenix6.signals import InvertedValue, SensorDirectionValue
from phoenix6.sim import ChassisReference

from pyfrc_core.physics import can_motors
from pyfrc_core.physics.can_motors import Talon, read_settings


class Device:
    """A CTRE device with these settings, which it reports at the second time, and a log of what its sensors get."""

    def __init__(self, fails: int = 1, **settings: Any) -> None:
        self.log: list[tuple[str, float]] = []
        self.sim_state: Any = SimpleNamespace(motor_voltage=6.0, orientation=None)
        for name in ("supply_voltage", "raw_rotor_position", "rotor_velocity", "raw_position", "velocity"):
            setattr(self.sim_state, f"set_{name}", lambda value, name=name: self.log.append((name, value)))
        self.asked = 0

        def refresh(found: object) -> Any:
            self.asked += 1
            if self.asked > fails:
                vars(found).update(settings)
            return SimpleNamespace(is_ok=lambda: self.asked > fails)

        self.configurator = SimpleNamespace(refresh=refresh)


@pytest.fixture(autouse=True)
def _battery(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(can_motors.devices, "battery_voltage", lambda: 12.5)


def test_the_rotor_turns_faster_than_the_shaft_and_the_cancoder_with_it() -> None:
    talon = Device(inverted=InvertedValue.CLOCKWISE_POSITIVE)
    cancoder = Device(sensor_direction=SensorDirectionValue.COUNTER_CLOCKWISE_POSITIVE, magnet_offset=0.25)
    made = Talon(talon, DCMotor.krakenX60(1), 4.0, cancoder, zero=0.5)
    assert (talon.sim_state.orientation, cancoder.sim_state.orientation) == (
        ChassisReference.CLOCKWISE_POSITIVE,
        ChassisReference.COUNTER_CLOCKWISE_POSITIVE,
    )
    assert (made.steps(), made.output(), made.gearing) == (1, 6.0 / 12.5, 4.0)
    start = [("supply_voltage", 12.5), ("raw_rotor_position", 0.0), ("rotor_velocity", 0.0)]
    assert talon.log == start
    assert cancoder.log == [("supply_voltage", 12.5), ("raw_position", 0.25), ("velocity", 0.0)]
    talon.log.clear()
    cancoder.log.clear()
    made.measure(1.5, 2.0, 0.02)
    assert talon.log == [("supply_voltage", 12.5), ("raw_rotor_position", 6.0), ("rotor_velocity", 8.0)]
    assert cancoder.log == [("supply_voltage", 12.5), ("raw_position", 1.75), ("velocity", 2.0)]


def test_without_a_cancoder_and_with_the_other_directions() -> None:
    talon = Device(inverted=InvertedValue.COUNTER_CLOCKWISE_POSITIVE)
    Talon(talon, DCMotor.krakenX60(1)).measure(1.0, 3.0, 0.02)
    assert talon.sim_state.orientation == ChassisReference.COUNTER_CLOCKWISE_POSITIVE
    assert talon.log[-2:] == [("raw_rotor_position", 1.0), ("rotor_velocity", 3.0)]
    cancoder = Device(sensor_direction=SensorDirectionValue.CLOCKWISE_POSITIVE, magnet_offset=0.0)
    Talon(Device(inverted=InvertedValue.CLOCKWISE_POSITIVE), DCMotor.krakenX60(1), 1.0, cancoder)
    assert cancoder.sim_state.orientation == ChassisReference.CLOCKWISE_POSITIVE


def test_a_battery_without_voltage_does_not_divide_by_zero(monkeypatch: pytest.MonkeyPatch) -> None:
    made = Talon(Device(inverted=InvertedValue.CLOCKWISE_POSITIVE), DCMotor.krakenX60(1))
    monkeypatch.setattr(can_motors.devices, "battery_voltage", lambda: 0.0)
    assert made.output() == 0.5


def test_settings_that_come_late_are_asked_for_again_but_not_for_ever() -> None:
    class Settings:
        gain = 0

    device = Device(fails=4, gain=7)
    assert read_settings(device, Settings).gain == 7
    assert device.asked == 5
    device = Device(fails=9, gain=7)
    assert read_settings(device, Settings).gain == 0
    assert device.asked == 5
