"""REV's SPARK MAX and SPARK Flex, with REV's simulation of them. REV's library is imported when it is needed."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Literal

from . import motors

#: An encoder of a SPARK: that of its motor, an absolute one, and an alternate or external one.
Encoder = Literal["relative", "absolute", "second"]


def key_of(spark: Any) -> object:
    """Return what tells a SPARK from others: its bus, and its number there."""
    return int(spark.get_can_port()), int(spark.get_device_id())


def leader_of(spark: Any) -> object | None:
    """Return the `key_of` the SPARK that this one follows, on the same bus; None if it does not follow."""
    leader = int(spark.config_accessor.get_follower_mode_leader_id())
    return (int(spark.get_can_port()), leader) if leader else None


def device_of(spark: Any) -> str:
    """Return the name of its SimDevice."""
    return f"SPARK {'Flex' if _is_flex(spark) else 'MAX'} [{int(spark.get_can_port())},{spark.get_device_id()}]"


def factor_of(spark: Any) -> float:
    """Return what the motor's encoder measures in one turn. REV's library of 2027 has no other unit."""
    return 1.0


def closes_on(spark: Any) -> Encoder:
    """Return the encoder with which it closes its loop."""
    rev = _library()
    sensor = spark.config_accessor.closed_loop.get_feedback_sensor()
    if sensor == rev.FeedbackSensor.ABSOLUTE_ENCODER:
        return "absolute"
    return "second" if sensor == rev.FeedbackSensor.ALTERNATE_OR_EXTERNAL_ENCODER else "relative"


def _library() -> Any:
    # Not as a statement: it is not installed where types are checked.
    return import_module("rev")


def _is_flex(spark: Any) -> bool:
    rev = _library()
    return isinstance(spark, rev.SparkFlex)


class EncoderSim:
    """The simulation of an encoder, in turns and rpm."""

    def __init__(self, sim: Any) -> None:
        self.position = sim.get_position
        self.set_position = sim.set_position
        self.set_velocity = sim.set_velocity
        self.iterate = sim.iterate

    def position_factor(self) -> float:
        """Return what the encoder measures in one turn."""
        return 1.0

    def velocity_factor(self) -> float:
        """Return what the encoder measures at one turn a minute."""
        return 1.0


class SparkSim:
    """The simulation of a SPARK.

    :param motor: is referred to without being kept
    """

    def __init__(self, spark: Any, motor: motors.DCMotor) -> None:
        rev = _library()
        make: Any = rev.SparkFlexSim if _is_flex(spark) else rev.SparkMaxSim
        sim = make(spark, motor)
        second = sim.get_external_encoder_sim() if _is_flex(spark) else sim.get_alternate_encoder_sim()
        self.encoders: dict[Encoder, EncoderSim] = {
            "relative": EncoderSim(sim.get_relative_encoder_sim()),
            "absolute": EncoderSim(sim.get_absolute_encoder_sim()),
            "second": EncoderSim(second),
        }
        self.output = sim.get_applied_output
        self.set_position = sim.set_position
        self.iterate = sim.iterate
