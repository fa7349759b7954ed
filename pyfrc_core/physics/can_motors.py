"""Motors on CAN motor controllers, with their gears and load.

The vendors' own simulations decide the voltage: they know the control mode, close the loop and limit the current. For
that they need the motor's speed and position, which `Mechanism` computes. So a velocity or position set-point is never
taken for a power.

Angles are in turns and speeds in turns per second, of the shaft behind the gears. Positive is the direction in which
the motor turns with a positive output, as the robot's code sees it: inverted motors and sensors need no minus sign.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Protocol

from ..wpi import devices, motors, sparks

#: REV's control modes that need no sensor: duty cycle and voltage.
_OPEN_LOOP = (0, 2)
_CLOSED_LOOP_STEPS = 5

#: How often a CTRE device is asked for its settings: on a busy machine, an answer may be late.
_ATTEMPTS = 5


class Controller(Protocol):
    """A motor controller with its motor and gears."""

    motor: motors.DCMotor
    gearing: float

    def steps(self) -> int:
        """Return how many times in 20 ms it needs its sensors."""

    def output(self) -> float:
        """Return the applied output, from -1 to 1."""

    def measure(self, turns: float, speed: float, tm_diff: float) -> None:
        """Set the sensors of the controller.

        :param turns: the angle of the shaft behind the gears
        :param speed: its speed in turns per second
        :param tm_diff: the time since the last call, in seconds
        """


class Spark:
    """A REV SPARK MAX or SPARK Flex. It drives its relative, absolute and alternate or external encoder.

    A real one closes its loop every millisecond. With one step for each 20 ms, usual gains make a wheel swing.

    :param spark: the robot's `rev.SparkMax` or `rev.SparkFlex`, which is configured already
    :param motor: the motors on it and on its followers
    :param gearing: turns of the motor for one turn of the shaft behind the gears, which has the absolute encoder
    :param zero: what the absolute encoder measures where the simulation begins, in turns
    """

    def __init__(self, spark: Any, motor: motors.DCMotor, gearing: float = 1.0, *, zero: float = 0.0) -> None:
        self.motor, self.gearing, self.zero = motor, gearing, zero
        closes_on = sparks.closes_on(spark)
        # REV's simulation takes the speed of the sensor that closes the loop for that of the motor: with a sensor
        # behind the gears, it needs a motor with gears. It refers to the motor without keeping it.
        self._model = motor if closes_on == "relative" else motors.with_gears(motor, gearing)
        self._sim = sparks.SparkSim(spark, self._model)
        encoders = self._sim.encoders
        self._relative, self._absolute = encoders["relative"], encoders["absolute"]
        #: The sensor that `iterate` moves, and the turns of each sensor for one turn of the shaft.
        self._feedback = encoders[closes_on]
        self._sensors = ((self._relative, gearing), (encoders["second"], 1.0))
        self._mode = devices.sim_integer(sparks.device_of(spark), "Control Mode")
        self._set_absolute(0.0, 0.0)

    def steps(self) -> int:
        """Return how many times in 20 ms it needs its sensors."""
        return 1 if self._mode() in _OPEN_LOOP else _CLOSED_LOOP_STEPS

    def output(self) -> float:
        """Return the applied output, from -1 to 1."""
        return float(self._sim.output())

    def measure(self, turns: float, speed: float, tm_diff: float) -> None:
        """Set the sensors, and let REV's simulation compute the next output."""
        sensor_speed = speed * self.gearing if self._feedback is self._relative else speed
        volts = devices.battery_voltage()
        # REV's loop has a position of its own, which follows neither what is set below nor the robot's setPosition().
        self._sim.set_position(self._feedback.position())
        self._sim.iterate(sensor_speed * 60 * self._feedback.velocity_factor(), volts, tm_diff)
        for sensor, ratio in self._sensors:
            if sensor is not self._feedback:
                # This adds to the position, so that it stays relative to what the robot's code has set.
                converted = speed * ratio * 60 * sensor.velocity_factor()
                sensor.iterate(converted, tm_diff)
                sensor.set_velocity(converted)
        self._set_absolute(turns, speed)

    def _set_absolute(self, turns: float, speed: float) -> None:
        self._absolute.set_position((turns + self.zero) % 1 * self._absolute.position_factor())
        self._absolute.set_velocity(speed * 60 * self._absolute.velocity_factor())


class Talon:
    """A CTRE Talon FX of phoenix6, which may have a CANcoder behind the gears. It closes its loop in real time.

    :param talon: the robot's `phoenix6.hardware.TalonFX`, which is configured already
    :param motor: the motors on it and on its followers
    :param gearing: turns of the motor for one turn of the shaft behind the gears, which has the CANcoder
    :param cancoder: the robot's `phoenix6.hardware.CANcoder`
    :param zero: what the CANcoder measures where the simulation begins, in turns
    """

    def __init__(
        self, talon: Any, motor: motors.DCMotor, gearing: float = 1.0, cancoder: Any = None, *, zero: float = 0.0
    ) -> None:
        from phoenix6 import configs
        from phoenix6.signals import InvertedValue, SensorDirectionValue
        from phoenix6.sim import ChassisReference

        self.motor, self.gearing = motor, gearing
        self._state, self._encoder = talon.sim_state, None
        sides = {
            True: ChassisReference.CLOCKWISE_POSITIVE,
            False: ChassisReference.COUNTER_CLOCKWISE_POSITIVE,
        }
        settings = read_settings(talon, configs.MotorOutputConfigs)
        # With the robot's own orientation, a positive voltage turns the rotor in the robot's positive direction.
        self._state.orientation = sides[settings.inverted == InvertedValue.CLOCKWISE_POSITIVE]
        if cancoder is not None:
            magnet = read_settings(cancoder, configs.MagnetSensorConfigs)
            self._encoder = cancoder.sim_state
            self._encoder.orientation = sides[magnet.sensor_direction == SensorDirectionValue.CLOCKWISE_POSITIVE]
            # The CANcoder itself adds its offset to the position of the magnet.
            self._zero = zero - magnet.magnet_offset
        self.measure(0.0, 0.0, 0.0)

    def steps(self) -> int:
        """Return how many times in 20 ms it needs its sensors."""
        return 1

    def output(self) -> float:
        """Return the applied output, from -1 to 1."""
        return float(self._state.motor_voltage) / (devices.battery_voltage() or 12.0)

    def measure(self, turns: float, speed: float, tm_diff: float) -> None:
        """Set the sensors."""
        volts = devices.battery_voltage()
        self._state.set_supply_voltage(volts)
        self._state.set_raw_rotor_position(turns * self.gearing)
        self._state.set_rotor_velocity(speed * self.gearing)
        if self._encoder is not None:
            self._encoder.set_supply_voltage(volts)
            self._encoder.set_raw_position(turns + self._zero)
            self._encoder.set_velocity(speed)


def read_settings(device: Any, kind: Callable[[], Any]) -> Any:
    """Return the settings of one kind, a class in `phoenix6.configs`, that a device has."""
    settings = kind()
    for _ in range(_ATTEMPTS):
        if device.configurator.refresh(settings).is_ok():
            break
    return settings


class Mechanism:
    """A motor controller whose motor turns a load, between end stops if there are any. Gravity is left out.

    :param controller: a `Spark` or a `Talon`
    :param inertia: the moment of inertia of the load behind the gears, in kg m²
    :param low: the lower end stop in turns from where the simulation begins; None if there is none
    :param high: the upper one
    """

    def __init__(
        self, controller: Controller, inertia: float, low: float | None = None, high: float | None = None
    ) -> None:
        self._controller = controller
        self._low = -math.inf if low is None else low
        self._high = math.inf if high is None else high
        motor, gearing = motors.data_of(controller.motor), controller.gearing
        #: The speed for each volt in turns per second, and the time to 63 % of it in seconds.
        self._speed_per_volt = motor.kv / gearing / math.tau
        self._time_constant = inertia * motor.resistance * motor.kv / (gearing**2 * motor.kt)
        #: The angle of the shaft behind the gears in turns, and its speed in turns per second.
        self.turns = self.speed = 0.0

    def output(self) -> float:
        """Return the applied output, from -1 to 1."""
        return self._controller.output()

    def update(self, tm_diff: float) -> None:
        """Move for `tm_diff` seconds, and set the controller's sensors."""
        steps = self._controller.steps()
        for _ in range(steps):
            self._step(tm_diff / steps)

    def _step(self, tm_diff: float) -> None:
        if tm_diff <= 0:
            return
        before = self.turns
        final = self.output() * devices.battery_voltage() * self._speed_per_volt
        # The solution of a motor's differential equation for a constant voltage.
        away = self.speed - final
        decay = -math.expm1(-tm_diff / self._time_constant)
        self.turns += final * tm_diff + away * self._time_constant * decay
        self.speed -= away * decay
        stopped = min(max(self.turns, self._low), self._high)
        if stopped != self.turns:
            self.turns, self.speed = stopped, 0.0
        # The mean speed, since SPARKs add up the speed to a position.
        self._controller.measure(self.turns, (self.turns - before) / tm_diff, tm_diff)
