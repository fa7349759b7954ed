"""REV's SPARK MAX and SPARK Flex, with REV's simulation of them. REV's library is imported when it is needed."""

from __future__ import annotations

from typing import Any, Literal

from . import motors

#: An encoder of a SPARK: that of its motor, an absolute one, and an alternate or external one.
Encoder = Literal["relative", "absolute", "second"]


def key_of(spark: Any) -> object:
    """Return what tells a SPARK from others: its number on the bus."""
    return int(spark.getDeviceId())


def leader_of(spark: Any) -> object | None:
    """Return the `key_of` the SPARK that this one follows; None if it does not follow."""
    return int(spark.configAccessor.getFollowerModeLeaderId()) or None


def device_of(spark: Any) -> str:
    """Return the name of its SimDevice."""
    return f"SPARK {'Flex' if _is_flex(spark) else 'MAX'} [{spark.getDeviceId()}]"


def factor_of(spark: Any) -> float:
    """Return what the motor's encoder measures in one turn."""
    return float(spark.configAccessor.encoder.getPositionConversionFactor())


def closes_on(spark: Any) -> Encoder:
    """Return the encoder with which it closes its loop."""
    import rev

    sensor = spark.configAccessor.closedLoop.getFeedbackSensor()
    if sensor == rev.FeedbackSensor.kAbsoluteEncoder:
        return "absolute"
    return "second" if sensor == rev.FeedbackSensor.kAlternateOrExternalEncoder else "relative"


def _is_flex(spark: Any) -> bool:
    import rev

    return isinstance(spark, rev.SparkFlex)


class EncoderSim:
    """The simulation of an encoder, in the units of the robot's code: turns and rpm times a factor each."""

    def __init__(self, sim: Any) -> None:
        self._sim = sim
        self.position = sim.getPosition
        self.set_position = sim.setPosition
        self.set_velocity = sim.setVelocity
        self.iterate = sim.iterate

    def position_factor(self) -> float:
        """Return what the encoder measures in one turn."""
        return float(self._sim.getPositionConversionFactor())

    def velocity_factor(self) -> float:
        """Return what the encoder measures at one turn a minute."""
        return float(self._sim.getVelocityConversionFactor())


class SparkSim:
    """The simulation of a SPARK.

    :param motor: is referred to without being kept
    """

    def __init__(self, spark: Any, motor: motors.DCMotor) -> None:
        import rev

        make: Any = rev.SparkFlexSim if _is_flex(spark) else rev.SparkMaxSim
        sim = make(spark, motor)
        second = sim.getExternalEncoderSim() if _is_flex(spark) else sim.getAlternateEncoderSim()
        self.encoders: dict[Encoder, EncoderSim] = {
            "relative": EncoderSim(sim.getRelativeEncoderSim()),
            "absolute": EncoderSim(sim.getAbsoluteEncoderSim()),
            "second": EncoderSim(second),
        }
        self.output = sim.getAppliedOutput
        self.set_position = sim.setPosition
        self.iterate = sim.iterate
