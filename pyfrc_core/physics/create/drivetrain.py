"""Identify the motors that drive the robot, their sides, and the encoders of each motor.

The inputs are the motors' reactions to the joysticks, and the names in the robot's code. The interpretation follows a
driver's habits: a stick pushed forward drives the robot forward, a stick pushed to the left turns the robot or moves it
to the left.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from .can_devices import CanMotor
from .motors import Motor
from .names import Name
from .sticks import FORWARD_AXES, Axis
from .survey import Encoder, Survey
from .swerve_modules import Module, wheel_pairs


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
    :param duty_cycle: the channels of absolute encoders, by the path of the motor that turns each
    :param track_width: from the left wheels to the right ones in metres, if the robot's code has it
    :param undriven: motors and encoders whose purpose is unknown
    :param assumptions: sentences about assumptions
    """

    drivetrain: Tank | Mecanum | None = None
    modules: list[Module] = field(default_factory=list)
    encoders: dict[str, list[Encoder]] = field(default_factory=dict)
    mechanisms: list[tuple[Motor, Encoder]] = field(default_factory=list)
    can_mechanisms: list[CanMotor] = field(default_factory=list)
    duty_cycle: dict[str, int] = field(default_factory=dict)
    track_width: float | None = None
    undriven: list[Motor | Encoder] = field(default_factory=list)
    assumptions: list[str] = field(default_factory=list)


def find_layout(found: Survey) -> DrivetrainLayout:
    """Identify the parts of the robot, as far as names and joysticks allow."""
    layout = DrivetrainLayout(modules=found.swerve.modules, track_width=found.track_width)
    layout.assumptions += found.swerve.assumptions
    if not wheel_pairs(found.motors) and not any(motor.name.says_swerve for motor in found.motors):
        layout.drivetrain = _Finder(found, layout.assumptions).find()
    _assign_encoders(found, layout)
    return layout


class _Finder:
    """Finds the drivetrain, from the surest evidence to the least sure."""

    def __init__(self, found: Survey, assumptions: list[str]) -> None:
        self._motors = {motor.path: motor for motor in found.motors}
        self._responses = {
            axis: {path: reaction for path, reaction in reactions.items() if path in self._motors}
            for axis, reactions in found.responses.items()
        }
        self._assumptions = assumptions
        self._contradicted = False

    def find(self) -> Tank | Mecanum | None:
        return self._by_forward_and_turn() or self._by_two_sticks() or self._by_names()

    def _by_forward_and_turn(self) -> Tank | Mecanum | None:
        """Find motors that all react to one axis, and some of them in reverse to another one."""
        for forward in self._forward_axes():
            reactions = self._responses[forward]
            signs = {path: _sign(reaction) for path, reaction in reactions.items()}
            patterns: dict[Axis, dict[str, int]] = {}
            for axis, others in self._responses.items():
                pattern = {path: _sign(others.get(path, 0.0)) * sign for path, sign in signs.items()}
                if others.keys() == reactions.keys() and len(set(pattern.values())) == 2:
                    patterns.setdefault(axis, pattern)
            if patterns:
                wheels = self._mecanum(signs, patterns)
                if wheels is not None:
                    return wheels
                # Turning left, the left side goes backward.
                tank = self._tank(min(patterns.values(), key=self._misfit), signs)
                if tank is not None:
                    return tank
        return None

    def _forward_axes(self) -> list[Axis]:
        return [axis for axis in self._responses if axis[1] in FORWARD_AXES and len(self._responses[axis]) > 1]

    def _mecanum(self, signs: Mapping[str, int], patterns: Mapping[Axis, Mapping[str, int]]) -> Mecanum | None:
        distinct: list[Mapping[str, int]] = []
        for pattern in patterns.values():
            if sum(pattern.values()) == 0 and not any(
                pattern == other or _opposite(pattern, other) for other in distinct
            ):
                distinct.append(pattern)
        if len(distinct) < 2:
            return None
        # On nearly all robots, the first of the two axes, a stick's x, moves it sideways. Names have priority.
        sideways, turn = distinct[:2]
        if self._misfit(sideways) < self._misfit(turn):
            sideways, turn = turn, sideways
        # With followers, each wheel has several motors, the same number on all four.
        wheels: dict[tuple[int, int], list[str]] = {}
        for path in signs:
            wheels.setdefault((sideways[path], turn[path]), []).append(path)
        if len(set(map(len, wheels.values()))) > 1:
            return None
        corners = {}
        for (aside, around), paths in wheels.items():
            side = _agreed({self._motors[path].name.side for path in paths}) or ("left" if around < 0 else "right")
            # To move left, the front left and the rear right wheel go backward.
            front = (aside < 0) == (side == "left")
            end = _agreed({self._motors[path].name.end for path in paths}) or ("front" if front else "rear")
            corners[f"{end}_{side}"] = paths
        if corners.keys() != set(CORNERS):
            return None
        if not all(self._motors[path].name.side for path in signs):
            self._assumptions.append(
                "It was assumed that the robot turns left and moves left with sticks pushed to the left."
            )
        return Mecanum({corner: self._side(paths, signs) for corner, paths in sorted(corners.items())})

    def _tank(self, turn: Mapping[str, int], signs: Mapping[str, int]) -> Tank | None:
        """Return two sides; the motors' names have priority over their reaction to the turning stick."""
        left = [path for path, sign in turn.items() if sign < 0]
        right = [path for path, sign in turn.items() if sign > 0]
        misnamed = self._misnamed(turn)
        if self._misfit(turn):
            if not self._contradicted:
                fewer = misnamed if self._misfit(turn) == len(misnamed) else self._named(turn) - misnamed
                motors = ", ".join(str(self._motors[path]) for path in turn if path in fewer)
                self._assumptions.append(
                    "The stick that turns the robot moves these motors as if they were on the opposite side of "
                    f"their names, unlike the others: {motors}. Their names or their channels may be "
                    "mixed up, or several drivetrains use that stick."
                )
            self._contradicted = True
            return None
        if misnamed:
            left, right = right, left
            self._assumptions.append(
                "According to their names, the motors turn the robot right when the stick is pushed to the left: a "
                "sign in its code is probably wrong (in WPILib, counter-clockwise turns are positive)."
            )
        elif not all(self._motors[path].name.side for path in signs):
            self._assumptions.append("It was assumed that the robot turns left with the stick pushed to the left.")
        return Tank(self._side(left, signs), self._side(right, signs))

    def _named(self, turn: Mapping[str, int]) -> set[str]:
        return {path for path in turn if self._motors[path].name.side is not None}

    def _misnamed(self, turn: Mapping[str, int]) -> set[str]:
        """Return the motors whose names contradict the side that a turn to the left puts them on."""
        return {path for path in self._named(turn) if (self._motors[path].name.side == "left") != (turn[path] < 0)}

    def _misfit(self, turn: Mapping[str, int]) -> int:
        """Return how many motors' names contradict the others'; 0 if all agree, or all contradict."""
        wrong = len(self._misnamed(turn))
        return min(wrong, len(self._named(turn)) - wrong)

    def _by_two_sticks(self) -> Tank | None:
        """Find two sides that react to a stick each."""
        groups: list[tuple[Axis, dict[str, float]]] = []
        for axis, reactions in self._responses.items():
            moved = {path for _, group in groups for path in group}
            if axis[1] in FORWARD_AXES and reactions and not moved & reactions.keys():
                groups.append((axis, reactions))
        named: dict[str | None, dict[str, float]] = {}
        for _, reactions in groups:
            sides = {self._motors[path].name.side for path in reactions}
            plain = all(self._motors[path].name.is_plain for path in reactions)
            if len(sides) == 1 and plain:
                named.setdefault(sides.pop(), reactions)
        if named.keys() >= {"left", "right"}:
            left, right = named["left"], named["right"]
        else:
            nameless = [group for _, group in groups if not any(self._motors[path].name.purpose for path in group)]
            nameless = [group for group in nameless if not any(self._motors[path].name.side for path in group)]
            if len(nameless) < 2 or len(nameless[0]) != len(nameless[1]):
                return None
            left, right = nameless[:2]
            self._assumptions.append("It was assumed that the first of the two sticks drives the left side.")
        signs = {path: _sign(reaction) for path, reaction in (left | right).items()}
        return Tank(self._side(left, signs), self._side(right, signs))

    def _by_names(self) -> Tank | None:
        """Find motors that are named after the two sides, and nothing else."""
        drive = {path: motor for path, motor in self._motors.items() if motor.name.is_plain and motor.name.side}
        left = [path for path, motor in drive.items() if motor.name.side == "left"]
        right = [path for path in drive if path not in left]
        if not left or len(left) != len(right):
            return None
        forward = next((self._responses[axis] for axis in self._forward_axes()), {})
        signs = {path: _sign(forward.get(path, -1.0 if motor.inverted else 1.0)) for path, motor in drive.items()}
        if self._contradicted:
            self._assumptions.append("The motors' sides were derived from their names.")
        elif not drive.keys() <= forward.keys():
            self._assumptions.append(
                "No stick moved the motors like a drivetrain: their sides were derived from their names, and it was "
                "assumed that an output of 1 is forward, or -1 for motors that the robot's code inverts."
            )
        else:
            self._assumptions.append("No stick turned the robot: the motors' sides were derived from their names.")
        return Tank(self._side(left, signs), self._side(right, signs))

    def _side(self, paths: Iterable[str], signs: Mapping[str, int]) -> MotorGroup:
        motors = [motor for path, motor in self._motors.items() if path in set(paths)]
        return MotorGroup(motors, signs[motors[0].path])


def _agreed(names: set[str | None]) -> str | None:
    """Return the common word in the names of motors that are geared together; None if they differ."""
    words = names - {None}
    return words.pop() if len(words) == 1 else None


def _sign(value: float) -> int:
    return (value > 0) - (value < 0)


def _opposite(one: Mapping[str, int], other: Mapping[str, int]) -> bool:
    return all(one[path] == -other[path] for path in one)


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
    _assign_duty_cycle(found, layout)
    layout.undriven = [*(motor for motor in others if not isinstance(motor, CanMotor)), *free]


def _assign_duty_cycle(found: Survey, layout: DrivetrainLayout) -> None:
    for name, channel in found.duty_cycle:
        fitting = [motor for motor in layout.can_mechanisms if name.purpose & motor.name.purpose]
        if fitting:
            turning = max(fitting, key=lambda motor: _likeness(motor.name, name))
            layout.duty_cycle.setdefault(turning.path, channel)
        if not fitting or layout.duty_cycle[turning.path] != channel:
            found.others.append(f"digital channel {channel} ({name})")


def _likeness(motor: Name, encoder: Name) -> tuple[int, bool, bool, bool]:
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
