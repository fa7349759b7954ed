"""Identify the modules of a swerve drive on the vendors' motor controllers."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TypeVar

from ...runtime.robot import RobotRun
from ...wpi import geometry
from .can_devices import CanMotor
from .motors import Motor
from .names import Reached
from .sticks import while_driving_forward

AnyMotor = TypeVar("AnyMotor", bound=Motor)

#: The usual order of the modules, by the signs of their places in front of and to the left of the centre.
_CORNERS = {
    ("front", "left"): (1, 1),
    ("front", "right"): (1, -1),
    ("rear", "left"): (-1, 1),
    ("rear", "right"): (-1, -1),
}
#: Half the distance between two wheels, in metres, if the robot's code does not have it.
_HALF = 0.27


@dataclass(frozen=True)
class WheelModule:
    """A wheel with its two motors.

    :param x: its place in front of the robot's centre, in metres
    :param y: its place to the left of the centre
    :param ahead: what its absolute encoder measures when the wheel points ahead, in turns
    """

    drive: CanMotor
    steer: CanMotor
    x: float
    y: float
    ahead: float = 0.0


@dataclass(frozen=True)
class SwerveSurvey:
    """The modules, and sentences about assumptions."""

    modules: list[WheelModule]
    assumptions: list[str]


def find_swerve(run: RobotRun, motors: list[CanMotor], objects: Iterable[Reached]) -> SwerveSurvey:
    """Return the modules, if there are four. The robot is driven forward to see where the wheels point then."""
    pairs = wheel_pairs(motors)
    if not pairs:
        return SwerveSurvey([], [])
    assumptions: list[str] = []
    modules = _placed(pairs, objects, assumptions)
    return SwerveSurvey(_measured(run, modules, assumptions), assumptions)


def wheel_pairs(motors: list[AnyMotor]) -> list[tuple[AnyMotor, AnyMotor]]:
    """Return the drive motor and the steering motor of each of four wheels; nothing where the names leave a doubt.

    The two motors of a wheel have the same owner, or the same corner in their names. A motor named ``pivot`` that has
    no such partner belongs to another mechanism.
    """
    drive = [motor for motor in motors if motor.name.task == "drive"]
    steer = [motor for motor in motors if motor.name.task == "steer"]
    for part in (_owner, _corner, _number):
        pairs = [(one, other) for one in drive for other in steer if part(one) == part(other)]
        once = all(len({pair[which].path for pair in pairs}) == len(pairs) for which in (0, 1))
        if once and len(pairs) == len(_CORNERS):
            return pairs
    return []


def _owner(motor: Motor) -> object:
    return motor.name.owner


def _number(motor: Motor) -> object:
    return re.findall(r"\d+", motor.name.text)[-1:]


def _corner(motor: Motor) -> object:
    return motor.name.end, motor.name.side


def _placed(
    pairs: list[tuple[CanMotor, CanMotor]], objects: Iterable[Reached], assumptions: list[str]
) -> list[WheelModule]:
    """Return the modules with their places, from the robot's kinematics if it has one."""
    known = next((found for each in objects if (found := geometry.module_places(each.thing))), None)
    if known is None:
        places = [(x * _HALF, y * _HALF) for x, y in _CORNERS.values()]
        assumptions.append(f"It was assumed that the wheels are {2 * _HALF:g} m apart.")
    else:
        places = [(place.x, place.y) for place in known]
    corners = [(drive.name.end, drive.name.side) for drive, _ in pairs]
    by_corner = {(_sign(x), _sign(y)): (x, y) for x, y in places}
    if set(corners) == set(_CORNERS) and len(by_corner) == len(places):
        places = [by_corner[_CORNERS[str(end), str(side)]] for end, side in corners]
    else:
        order = "of the robot's kinematics" if known else "front left, front right, rear left, rear right"
        assumptions.append(f"It was assumed that the modules are in the order {order}.")
    return [WheelModule(drive, steer, x, y) for (drive, steer), (x, y) in zip(pairs, places, strict=True)]


def _sign(value: float) -> int:
    return (value > 0) - (value < 0)


def _measured(run: RobotRun, modules: list[WheelModule], assumptions: list[str]) -> list[WheelModule]:
    """Return the modules with their encoders' values while the robot drives straight ahead."""

    def is_driving() -> bool:
        return all(abs(module.drive.live.speed) > 0.05 for module in modules)

    def look() -> list[float]:
        return [module.steer.live.turns + (0.0 if module.drive.live.speed > 0 else 0.5) for module in modules]

    seen = while_driving_forward(run, is_driving, look)
    if seen is None:
        assumptions.append(
            "No stick drove all four wheels: it was assumed that the wheels point ahead where their encoders measure 0."
        )
        return modules
    # A wheel that is nearly there has not come to rest yet.
    return [replace(module, ahead=round(ahead, 2) % 1) for module, ahead in zip(modules, seen, strict=True)]
