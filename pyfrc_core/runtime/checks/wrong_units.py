"""Find numbers in a wrong unit: degrees for radians, and percent for a motor's power from -1 to 1."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator

from ...explain.other_season import in_2027
from ...explain.places import last_name
from ...season.spelling import normalized
from .kinds import Kinds
from .sources import CodeWarning, SourceFile

#: Functions of wpilib and of geometry that return degrees.
_DEGREES = frozenset({"getangle", "getyaw", "degrees", "getpov"})
#: The last argument, by the name of what is called and the number of arguments, is an angle in radians.
_ANGLES = frozenset({("sin", 1), ("cos", 1), ("tan", 1), ("Rotation2d", 1), ("Pose2d", 3), ("Transform2d", 3)})
_POWER = frozenset({"set", "setthrottle", "arcadedrive", "tankdrive", "curvaturedrive", "drivecartesian"})


def find_wrong_units(kinds: Kinds) -> Iterator[CodeWarning]:
    for source in kinds.robot:
        for call in (each for each in source.all(ast.Call) if each.args):
            called = kinds.called(call, source)
            module = str(getattr(called, "__module__", ""))
            if (getattr(called, "__name__", ""), len(call.args)) in _ANGLES and module.startswith(("math", "wpimath")):
                yield from _of_angle(call, source)
            elif normalized(last_name(call.func)) in _POWER and kinds.is_library(call, source):
                yield from _of_power(call, kinds, source)


def _of_angle(call: ast.Call, source: SourceFile) -> Iterator[CodeWarning]:
    angle, name = call.args[-1], last_name(call.func)
    number, written = _number(angle), ast.unparse(angle)
    is_degrees = isinstance(angle, ast.Call) and normalized(last_name(angle.func)) in _DEGREES
    if is_degrees or (isinstance(number, int) and abs(number) > 2 * math.pi):
        turned = f"Rotation2d.{in_2027('fromDegrees')}({written})"
        right = f"math.radians({written})" if name in ("sin", "cos", "tan") else turned
        takes = "radians" if name in ("sin", "cos", "tan", "Rotation2d") else "a Rotation2d or radians"
        right = right if name == "Rotation2d" else ast.unparse(call).replace(written, right)
        yield source.warning(call, f"{name}() takes {takes}, and {written} is a number in degrees", f"Write {right}")


def _of_power(call: ast.Call, kinds: Kinds, source: SourceFile) -> Iterator[CodeWarning]:
    bases = {each.__name__ for each in getattr(kinds.owner(call, source), "__mro__", ())}
    numbers = [number for each in call.args if (number := _number(each)) is not None and abs(number) > 1]
    if numbers and bases & {"MotorController", "RobotDriveBase", "SparkBase"}:
        text = f"{ast.unparse(call)}: power is from -1 to 1, so {numbers[0]} is full power"
        yield source.warning(call, text, f"If it is in percent, write {numbers[0] / 100:g}")


def _number(expression: ast.expr) -> float | int | None:
    try:
        value = ast.literal_eval(expression)
    except ValueError:
        return None
    return value if isinstance(value, (int, float)) and not isinstance(value, bool) else None
