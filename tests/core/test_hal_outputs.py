"""Outputs of a disabled robot, the modes, and what values may be."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

import hal
import pytest
import wpilib
from hal import simulation as hs
from loops import for_each
from wpilib import simulation as sim
from wpilib.interfaces import MotorController

from pyfrc_core.errors import UsageError
from pyfrc_core.hal import HalData
from pyfrc_core.hal.kinds import BOOL, FLOAT, ValueKind, choice, number, text, whole
from pyfrc_core.hal.output_gate import OutputGate
from pyfrc_core.wpi import station

OUTPUT, BOTH = hal.SimDevice.Direction.kOutput, hal.SimDevice.Direction.kBidir


@pytest.fixture
def gate() -> Generator[OutputGate]:
    """Of a robot that is disabled."""
    station.reset_driver_station()
    yield OutputGate()
    hs.resetDriverStationData()


def test_channels_are_off_within_and_as_set_after(gate: OutputGate) -> None:
    motor, servo = wpilib.PWMSparkMax(16), wpilib.Servo(15)
    relay = wpilib.Relay(3)
    valve = wpilib.Solenoid(5, wpilib.PneumaticsModuleType.CTREPCM, 7)
    motor.set(0.5)
    servo.set(0.9)
    relay.set(wpilib.Relay.Value.kReverse)
    valve.set(True)
    pwm, other = sim.PWMSim(16), sim.PWMSim(15)
    pulse, servos = pwm.getPulseMicrosecond(), other.getPulseMicrosecond()

    def state() -> list[object]:
        return [pwm.getSpeed(), pwm.getPulseMicrosecond(), other.getPulseMicrosecond(), *relays(), valve.get()]

    def relays() -> list[bool]:
        return [sim.RelaySim(3).getForward(), sim.RelaySim(3).getReverse()]

    before = state()
    assert before == [pytest.approx(0.5, abs=0.01), pulse, servos, False, True, True]
    with gate.closed_while_disabled():
        assert state() == [0.0, 1500, servos, False, False, False]
        with gate.closed_while_disabled():  # once is enough
            assert state() == [0.0, 1500, servos, False, False, False]
        assert pwm.getSpeed() == 0.0
    assert state() == before
    with gate.closed_while_disabled():
        motor.set(-1.0)  # what is written meanwhile stays
        sim.RelaySim(3).setForward(True)
    assert state()[0] == -1.0
    assert relays() == [True, True]
    station.set_mode(enabled=True)
    with gate.closed_while_disabled():
        assert state()[0] == -1.0
    hs.setDriverStationEStop(True)
    with gate.closed_while_disabled():
        assert state()[0] == 0.0
    hs.setDriverStationEStop(False)
    hs.setDriverStationDsAttached(False)
    with gate.closed_while_disabled():
        assert state()[0] == 0.0
    # A device that is made later is found.
    hub = wpilib.Solenoid(9, wpilib.PneumaticsModuleType.REVPH, 15)
    hub.set(True)
    with gate.closed_while_disabled():
        assert hub.get() is False
    assert hub.get() is True


def test_can_motor_controllers_are_known_by_their_names(gate: OutputGate) -> None:
    names = {
        "SPARK MAX [50]": {"Applied Output": True, "Velocity": True, "Bus Voltage": False, "Setpoint": True},
        "CANMotor:Talon FX (v6)[51]": {"dutyCycle": True, "motorVoltage": True, "supplyVoltage": False},
        "Talon encoder[52]": {"speed": False, "value": False},
        "Something[53]": {"throttle": True, "power": False, "Setpoint": True},
    }
    devices = {name: hal.SimDevice(name) for name in names}
    values = {(n, v): devices[n].createDouble(v, OUTPUT, 0.5) for n, its in names.items() for v in its}
    count = devices["SPARK MAX [50]"].createInt("output", OUTPUT, 3)
    sensor = devices["CANMotor:Talon FX (v6)[51]"].createDouble("velocity", BOTH, 0.5)
    with gate.closed_while_disabled():
        off = {key: value.get() == 0 for key, value in values.items()}
        assert (count.get(), sensor.get()) == (0, 0.5)
    assert off == {(name, value): wanted for name, its in names.items() for value, wanted in its.items()}
    assert {value.get() for value in values.values()} == {0.5}
    assert count.get() == 3
    with gate.closed_while_disabled():
        values["SPARK MAX [50]", "Applied Output"].set(0.25)
    assert values["SPARK MAX [50]", "Applied Output"].get() == 0.25


@pytest.mark.parametrize(
    ("mode", "is_position"), [(0, False), (1, False), (2, False), (3, True), (4, False), (5, True)]
)
def test_a_setpoint_may_be_a_position(mode: int, is_position: bool, gate: OutputGate) -> None:
    device = hal.SimDevice(f"SPARK MAX [{54 + mode}]")
    device.createInt("Control Mode", OUTPUT, mode)
    setpoint = device.createDouble("Setpoint", OUTPUT, 2.5)
    with gate.closed_while_disabled():
        assert setpoint.get() == (2.5 if mode in (3, 5) else 0)
    assert setpoint.get() == 2.5


def test_a_mode_with_words(gate: OutputGate) -> None:
    device = hal.SimDevice("Motor [60]")
    mode = device.createEnum("Control Mode", OUTPUT, ["Percent", "Position", "MotionMagic"], 0)
    setpoint = device.createDouble("Setpoint", OUTPUT, 2.5)
    seen = []
    for option in range(3):
        mode.set(option)
        with gate.closed_while_disabled():
            seen.append(setpoint.get())
    assert seen == [0, 2.5, 2.5]


def test_motor_controllers_that_remember_what_they_were_given(gate: OutputGate) -> None:
    class Vendors(MotorController):
        def get(self) -> float:
            return 0.75

    class Derived(Vendors):
        pass

    with gate.closed_while_disabled():
        assert (Vendors().get(), Derived().get()) == (0.0, 0.0)
    assert (Vendors().get(), Derived().get()) == (0.75, 0.75)


# -- modes -------------------------------------------------------------------------------------------------------------


def test_modes_by_name() -> None:
    station.reset_driver_station()
    assert station.mode_name() == station.get_mode() == "disabled"
    for name in station.MODES:
        station.set_mode_named(name)
        assert station.mode_name() == name
        assert station.get_mode() == name.partition(" ")[0]
        assert station.is_enabled() is (not name.startswith("disabled"))
    with pytest.raises(UsageError, match="there is no mode 'Teleop'"):
        station.set_mode_named("Teleop")
    station.set_mode_named("teleop")
    hs.setDriverStationEStop(True)
    assert (station.is_enabled(), station.is_stopped()) == (False, True)
    station.reset_driver_station()
    assert (station.is_enabled(), station.is_stopped(), station.is_attached()) == (False, False, True)


def test_the_driver_station_at_first() -> None:
    station.set_mode(enabled=True)
    station.unplug(2)
    station.reset_driver_station()
    tree = HalData(defaults=False)
    assert (tree["alliance_station"], tree["event"]["name"]) == ("red1", "sim-event")
    assert [stick.counts() for stick in tree["joysticks"]] == [(12, 12, 1)] * 6
    stick = tree["joysticks"][5]
    stick["axes"][11], stick["buttons"][12], stick["povs"][0] = 0.5, True, 90
    station.plug_in(5)
    assert (list(stick["axes"]), any(stick["buttons"]), stick["povs"][0]) == ([0.0] * 12, False, -1)
    station.set_match_time(12.5)
    station.set_game_message("LRL")
    assert (tree["time"]["remaining"], tree["event"]["game_specific_message"]) == (12.5, "LRL")
    station.reset_driver_station()


# -- kinds -------------------------------------------------------------------------------------------------------------

STATION = choice({"unknown": 0, "Red": 1})


@for_each(
    "kind, refused, error, message",
    [
        (FLOAT, True, TypeError, "x: expected a number, not True (bool)"),
        (FLOAT, "1", TypeError, "x: expected a number, not '1' (str)"),
        (number(-1, 1), 1.001, ValueError, "x: expected a number from -1 to 1, not 1.001 (float)"),
        (number(-1, 1), float("nan"), ValueError, "x: expected a number from -1 to 1, not nan (float)"),
        (whole(0, 5), 6, ValueError, "x: expected a whole number from 0 to 5, not 6 (int)"),
        (whole(0, 5), -1, ValueError, "x: expected a whole number from 0 to 5, not -1 (int)"),
        (whole(0, 5), 0.5, ValueError, "x: expected a whole number from 0 to 5, not 0.5 (float)"),
        (whole(0, 5), False, TypeError, "x: expected a whole number from 0 to 5, not False (bool)"),
        (BOOL, "off", TypeError, "x: expected True or False, not 'off' (str)"),
        (BOOL, 2, ValueError, "x: expected True or False, not 2 (int)"),
        (text(3), "abcd", ValueError, "x: expected a text of at most 3 bytes, not 'abcd' (str)"),
        (text(3), "éé", ValueError, "x: expected a text of at most 3 bytes, not 'éé' (str)"),
        (text(3), "a\0", ValueError, "x: expected a text of at most 3 bytes, not 'a\\x00' (str)"),
        (text(3), 3, TypeError, "x: expected a text of at most 3 bytes, not 3 (int)"),
        (STATION, "blue", ValueError, "x: expected one of 'unknown' (0), 'Red' (1), not 'blue' (str)"),
        (STATION, 2, ValueError, "x: expected one of 'unknown' (0), 'Red' (1), not 2 (int)"),
        (BOOL, "x" * 100, TypeError, f"x: expected True or False, not '{'x' * 56}... (str)"),
    ],
)
def test_values_that_are_refused(kind: ValueKind, refused: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error) as caught:
        kind.check(refused, "x")
    assert str(caught.value) == message
