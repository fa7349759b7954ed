"""Find the vendors' motor controllers on the CAN bus, and let them move while the joysticks are tested.

The robot's objects are needed, not only the SimDevices, since the vendors' simulations take these objects.
"""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Iterable
from dataclasses import KW_ONLY, dataclass, field
from typing import Any

from ...hal import HalData
from ...runtime.clock import PACKET_US
from ...wpi import motors, sparks
from ..can_motors import Controller, Mechanism, Spark, Talon, read_settings
from .motors import Motor
from .names import DeviceName, Reached

#: The gearing and the moment of inertia at the motor of what moves while the joysticks are tested.
_TRIAL_GEARING, _TRIAL_INERTIA = 20.0, 2e-4

_PACKAGES = ("rev", "phoenix6")

#: The classes of motor controllers, and for each the class in `can_motors`.
_CONTROLLERS = {"SparkMax": "Spark", "SparkFlex": "Spark", "TalonFX": "Talon"}


@dataclass(frozen=True)
class CanMotor(Motor):
    """A motor on a vendor's controller, which the robot's code holds at a place that Python code can name.

    :param vendor: the class for it in `can_motors`
    :param expression: Python code for the robot's object
    :param model: the name of its motor in `DCMotor`
    :param count: the number of motors, with those of the followers
    :param factor: what its own encoder measures in one turn of the motor
    :param cancoder: Python code for the CANcoder behind the gears; empty if there is none
    :param live: what moves while the joysticks are tested
    """

    _: KW_ONLY
    vendor: str
    expression: str
    model: str
    count: int
    factor: float
    cancoder: str
    live: Mechanism = field(compare=False, repr=False)

    def output(self, hal_data: HalData) -> float:
        """Return the applied output, whatever the control mode."""
        return self.live.output()


@dataclass
class CanDevices:
    """The vendors' devices of a robot.

    :param motors: the motor controllers except followers
    :param devices: the names of the SimDevices that belong to them, or their beginning
    """

    motors: list[CanMotor] = field(default_factory=list)
    devices: list[str] = field(default_factory=list)

    @property
    def in_real_time(self) -> bool:
        return any(motor.vendor == "Talon" for motor in self.motors)

    def owns(self, device: str) -> bool:
        """Return whether a SimDevice is one of these devices, or a sensor of one."""
        return any(device == own or device.startswith((f"{own} ", f"{own}/")) for own in self.devices)

    def update(self, now: float) -> None:
        """Move all motors for one packet."""
        for motor in self.motors:
            motor.live.update(PACKET_US / 1_000_000)
        if self.in_real_time:  # phoenix6's devices do not follow robot time
            time.sleep(PACKET_US / 1_000_000)


def find_can_devices(objects: Iterable[Reached]) -> CanDevices:
    """Return the devices that the robot's code holds."""
    found = CanDevices()
    things = [
        (DeviceName(path), thing, expression) for path, thing, expression in objects if expression and _kind(thing)
    ]
    cancoders = [entry for entry in things if _kind(entry[1]) == "CANcoder"]
    controllers = [entry for entry in things if _kind(entry[1]) != "CANcoder"]
    followers = Counter(_place_of_leader(thing) for _, thing, _ in controllers)
    for name, thing, expression in controllers:
        found.devices += _parts(thing)
        if _place_of_leader(thing) is None:
            found.motors.append(_motor(name, thing, expression, 1 + followers[_place(thing)], cancoders))
    found.devices += [f"CANEncoder:CANcoder (v6)[{thing.device_id}]" for _, thing, _ in cancoders]
    return found


def _kind(thing: object) -> str:
    """Return the class of a vendor's device; a team's own class may be derived from it."""
    if isinstance(thing, type):
        return ""
    for base in type(thing).__mro__:
        if base.__module__.partition(".")[0] in _PACKAGES and base.__name__ in (*_CONTROLLERS, "CANcoder"):
            return base.__name__
    return ""


def _is_spark(thing: object) -> bool:
    return _CONTROLLERS.get(_kind(thing)) == "Spark"


def _place(thing: Any) -> tuple[str, object]:
    """Return the vendor and number of a motor controller."""
    return ("Spark", sparks.key_of(thing)) if _is_spark(thing) else ("Talon", int(thing.device_id))


def _place_of_leader(thing: Any) -> tuple[str, object] | None:
    """Return the vendor and number of the motor controller that this one follows; None if it does not follow."""
    if _is_spark(thing):
        key = sparks.leader_of(thing)
        return None if key is None else ("Spark", key)
    leader = getattr(thing.control_request, "leader_id", None)
    return None if leader is None else ("Talon", leader)


def _device(thing: Any) -> str:
    """Return the name of the SimDevice of a motor controller."""
    return sparks.device_of(thing) if _is_spark(thing) else f"CANMotor:Talon FX (v6)[{thing.device_id}]"


def _parts(thing: Any) -> list[str]:
    own = _device(thing)
    return [own, *(own.replace("CANMotor", other) for other in ("CANEncoder", "CANDIO") if not _is_spark(thing))]


def _motor(
    name: DeviceName, thing: Any, expression: str, count: int, cancoders: list[tuple[DeviceName, Any, str]]
) -> CanMotor:
    """Return the motor with what the robot has configured, and with what moves while the joysticks are tested.

    :param count: the number of motors, with those of the followers
    """
    vendor, (model, make) = _CONTROLLERS[_kind(thing)], motors.usual_motor(_kind(thing))
    if vendor == "Spark":
        factor = sparks.factor_of(thing)
        controller: Controller = Spark(thing, make(count), _TRIAL_GEARING)
        encoder = ""
    else:
        from phoenix6.configs import FeedbackConfigs

        feedback = read_settings(thing, FeedbackConfigs)
        ratio = feedback.sensor_to_mechanism_ratio * feedback.rotor_to_sensor_ratio
        factor = 1 / ratio if ratio else 1.0
        chosen = next(
            (each for each in cancoders if each[1].device_id == feedback.feedback_remote_sensor_id), None
        ) or _beside(name, cancoders)
        controller = Talon(thing, make(count), 1 / factor if chosen else _TRIAL_GEARING, chosen[1] if chosen else None)
        encoder = chosen[2] if chosen else ""
    return CanMotor(
        name,
        device=_device(thing),
        vendor=vendor,
        expression=expression,
        model=model,
        count=count,
        factor=factor,
        cancoder=encoder,
        live=Mechanism(controller, _TRIAL_INERTIA * controller.gearing**2),
    )


def _beside(name: DeviceName, cancoders: list[tuple[DeviceName, object, str]]) -> tuple[DeviceName, Any, str] | None:
    """Return the only CANcoder of the same part of the robot, for a motor that could turn it."""
    beside = [each for each in cancoders if each[0].owner == name.owner]
    return beside[0] if len(beside) == 1 and name.task != "drive" else None


def known_gearing(motor: CanMotor, low: float, high: float, *units: float, only_round: bool = False) -> float | None:
    """Return the gearing that makes the encoder's conversion factor one of these units, if it is plausible.

    :param low: the least gearing
    :param high: the greatest
    :param units: what the encoder could measure in one turn behind the gears, the likeliest first
    :param only_round: whether only a gearing of at most two decimals is plausible
    """
    if math.isclose(motor.factor, 1.0) or motor.factor <= 0:
        return None
    fitting = [ratio for unit in units if low <= (ratio := unit / motor.factor) <= high]
    round_ones = [ratio for ratio in fitting if math.isclose(ratio * 100, round(ratio * 100), rel_tol=1e-6)]
    return next(iter(round_ones if only_round else [*round_ones, *fitting]), None)
