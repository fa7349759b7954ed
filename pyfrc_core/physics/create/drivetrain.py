"""Identify the motors that drive the robot, their sides, and the encoders of each motor.

Names in the robot's code say on which side a motor is, and its reaction to a stick that is pushed forward says with
which sign it drives forward. Motors whose names do not say their side are left to the user: which side reacts to which
stick is a habit of drivers, and no fact about the robot.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .can_devices import CanMotor
from .motors import Motor
from .names import DeviceName
from .sticks import FORWARD_AXES, Responses
from .survey import Encoder, Survey
from .swerve_modules import WheelModule, wheel_pairs


@dataclass(frozen=True)
class MotorGroup:
    """Motors that are geared together, and do the same.

    :param motors: the motors
    :param forward: the sign of their output when the robot drives forward
    """

    motors: list[Motor]
    forward: int


@dataclass(frozen=True)
class Tank:
    """A tank drive: a group of motors on each side."""

    left: MotorGroup
    right: MotorGroup

    @property
    def motors(self) -> list[Motor]:
        return [*self.left.motors, *self.right.motors]


@dataclass(frozen=True)
class Mecanum:
    """A mecanum drive: four wheels with their own motors, by corner: ``front_left`` and so on."""

    wheels: dict[str, MotorGroup]

    @property
    def motors(self) -> list[Motor]:
        return [motor for wheel in self.wheels.values() for motor in wheel.motors]


#: The corners in the order in which pyfrc's drivetrains take their motors.
CORNERS = ("front_left", "rear_left", "front_right", "rear_right")


@dataclass
class DrivetrainLayout:
    """The identified parts of the robot.

    :param drivetrain: a drivetrain whose motors can be identified
    :param modules: those of a swerve drive on vendors' motor controllers, whose simulations show what both motors do
    :param encoders: the encoders of the wheels, by side or corner
    :param mechanisms: the other motors with an encoder, each with its encoder
    :param can_mechanisms: the other motors on vendors' motor controllers, which have encoders of their own
    :param track_width: from the left wheels to the right ones in metres, if the robot's code has it
    :param undriven: motors and encoders whose purpose is unknown
    :param assumptions: sentences about assumptions
    """

    drivetrain: Tank | Mecanum | None = None
    modules: list[WheelModule] = field(default_factory=list)
    encoders: dict[str, list[Encoder]] = field(default_factory=dict)
    mechanisms: list[tuple[Motor, Encoder]] = field(default_factory=list)
    can_mechanisms: list[CanMotor] = field(default_factory=list)
    track_width: float | None = None
    undriven: list[Motor | Encoder] = field(default_factory=list)
    assumptions: list[str] = field(default_factory=list)


def find_layout(found: Survey) -> DrivetrainLayout:
    """Identify the parts of the robot, as far as names and joysticks allow."""
    layout = DrivetrainLayout(modules=found.swerve.modules, track_width=found.track_width)
    layout.assumptions += found.swerve.assumptions
    if not wheel_pairs(found.motors) and not any(motor.name.says_swerve for motor in found.motors):
        layout.drivetrain = _find_drivetrain(found, layout.assumptions)
    _assign_encoders(found, layout)
    return layout


def _find_drivetrain(found: Survey, assumptions: list[str]) -> Tank | Mecanum | None:
    """Find motors that are named after the sides or corners of a drivetrain, and nothing else."""
    motors = [motor for motor in found.motors if motor.name.is_plain and motor.name.side]
    corners = {corner: [motor for motor in motors if _corner(motor) == corner] for corner in CORNERS}
    left = [motor for motor in motors if motor.name.side == "left"]
    right = [motor for motor in motors if motor.name.side == "right"]
    is_mecanum = len(set(map(len, corners.values()))) == 1 and sum(map(len, corners.values())) == len(motors)
    if len(left) != len(right) or not left:
        return None
    signs = _forward_signs(motors, found.responses, assumptions)
    if is_mecanum and _moves_sideways(left, signs, found.responses):
        return Mecanum({corner: _group(group, signs) for corner, group in corners.items()})
    return Tank(_group(left, signs), _group(right, signs))


def _corner(motor: Motor) -> str:
    return f"{motor.name.end}_{motor.name.side}"


def _forward_signs(motors: list[Motor], responses: Responses, assumptions: list[str]) -> dict[str, int]:
    """Return the sign of each motor's output when the robot drives forward, by the motor's path."""
    forward: dict[str, float] = {}
    for axis, reactions in responses.items():
        if axis[1] in FORWARD_AXES:
            forward = reactions | forward  # the first stick that moves a motor counts
    if unmoved := [motor for motor in motors if motor.path not in forward]:
        assumptions.append(
            f"No stick drove {', '.join(map(str, unmoved))} forward: it was assumed that an output of 1 is forward, or "
            "-1 for motors that the robot's code inverts."
        )
    return {motor.path: _sign(forward.get(motor.path, -1.0 if motor.inverted else 1.0)) for motor in motors}


def _moves_sideways(side: list[Motor], signs: Mapping[str, int], responses: Responses) -> bool:
    """Return whether a stick turns the wheels of one side against each other, as only a mecanum drive does."""
    ways = (
        {_sign(reactions.get(motor.path, 0.0)) * signs[motor.path] for motor in side}
        for reactions in responses.values()
    )
    return any({-1, 1} <= each for each in ways)


def _group(motors: list[Motor], signs: Mapping[str, int]) -> MotorGroup:
    return MotorGroup(motors, signs[motors[0].path])


def _sign(value: float) -> int:
    return (value > 0) - (value < 0)


# -- encoders ----------------------------------------------------------------------------------------------------


def _assign_encoders(found: Survey, layout: DrivetrainLayout) -> None:
    driving: list[Motor] = list(layout.drivetrain.motors) if layout.drivetrain else []
    driving += [motor for module in layout.modules for motor in (module.drive, module.steer)]
    others = [motor for motor in found.motors if motor not in driving]
    free = list(found.encoders)

    def pair(motor: Motor, encoder: Encoder) -> None:
        layout.mechanisms.append((motor, encoder))
        others.remove(motor)
        free.remove(encoder)

    for encoder in found.encoders:
        purpose = encoder.name.purpose
        fitting = [motor for motor in others if purpose & motor.name.purpose]
        if fitting:
            pair(max(fitting, key=lambda motor: _likeness(motor.name, encoder.name)), encoder)
    if layout.drivetrain is not None:
        plain = [encoder for encoder in free if not encoder.name.purpose]
        for encoder in _wheel_encoders(layout, plain or [encoder for encoder in free if encoder.name.side]):
            free.remove(encoder)
    # One motor and one encoder belong together regardless of their names, unless both have a purpose, such as lift and
    # turret.
    single = layout.drivetrain is None and len(others) == len(free) == 1
    if single and not (others[0].name.purpose and free[0].name.purpose):
        pair(others[0], free[0])
    layout.can_mechanisms = [motor for motor in others if isinstance(motor, CanMotor)]
    layout.undriven = [*(motor for motor in others if not isinstance(motor, CanMotor)), *free]


def _likeness(motor: DeviceName, encoder: DeviceName) -> tuple[int, bool, bool, bool]:
    """Return a sort key: the greater, the more likely they belong together."""
    return (
        len(motor.purpose & encoder.purpose),
        motor.owner == encoder.owner,
        motor.side == encoder.side,
        motor.end == encoder.end,
    )


def _wheel_encoders(layout: DrivetrainLayout, candidates: list[Encoder]) -> list[Encoder]:
    """Assign the drivetrain's encoders by their names, or else in the order of their channels; return them."""
    corners = isinstance(layout.drivetrain, Mecanum)
    wheels = list(CORNERS) if corners else ["left", "right"]
    by_name: dict[str, list[Encoder]] = {}
    for encoder in candidates:
        parts = (encoder.name.end, encoder.name.side) if corners else (encoder.name.side,)
        if all(parts):
            by_name.setdefault("_".join(map(str, parts)), []).append(encoder)
    if not by_name:
        by_name = {wheel: [encoder] for wheel, encoder in zip(wheels, candidates, strict=False)}
        taken = [wheel.replace("_", " ") for wheel in by_name]
        if len(taken) == 1:
            layout.assumptions.append(f"The encoder was assigned to the {taken[0]} {'wheel' if corners else 'side'}.")
        elif taken:
            layout.assumptions.append(f"The encoders were assigned in the order {', '.join(taken)}.")
    layout.encoders = {wheel: by_name[wheel] for wheel in wheels if wheel in by_name}
    return [encoder for encoders in layout.encoders.values() for encoder in encoders]
