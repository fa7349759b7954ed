"""Find numbers in a wrong unit: degrees for radians, and percent for a motor's power from -1 to 1."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterator

from ...explain.places import last_name
from ...season.spelling import normalized
from .code_warning import CodeWarning
from .kinds import Kinds
from .sources import Source

#: Functions of wpilib and of geometry that return degrees.
_DEGREES = frozenset({"getangle", "getyaw", "degrees", "getpov"})
#: The parameters of a form of a function, in its documentation.
_FORM = re.compile(r"^(?:\d+\. )?\w+\((.*)\) -> ", re.MULTILINE)
_POWER = frozenset({"set", "setthrottle", "arcadedrive", "tankdrive", "curvaturedrive", "drivecartesian"})


def find_wrong_units(kinds: Kinds) -> Iterator[CodeWarning]:
    for source in (each for each in kinds.sources if not each.is_test):
        for call in (each for each in ast.walk(source.tree) if isinstance(each, ast.Call) and each.args):
            name, called = last_name(call.func), kinds.called(call, source)
            if called in (math.sin, math.cos, math.tan):
                yield from _of_angle(call.args[0], call, source)
            elif normalized(name) not in _POWER:
                for at in _rotations(called, len(call.args)):
                    yield from _of_angle(call.args[at], call, source)
            elif kinds.is_library(call, source) and hasattr(called, "__doc__"):
                yield from _of_power(call, kinds, source)


def _rotations(called: object, count: int) -> list[int]:
    """Return which parameters of a library's function are angles: WPILib takes a number for a Rotation2d as radians."""
    function = called.__init__ if isinstance(called, type) else called  # type: ignore[misc]
    forms = _FORM.findall(str(function.__doc__)) if str(getattr(called, "__module__", "")).startswith("wpi") else []
    kinds = [re.findall(r"(?<![.\w])(?!self)\w+: ([\w.]+)", form) for form in forms]
    if isinstance(called, type) and called.__name__ == "Rotation2d":
        return [0] if count == 1 else []
    length = min((len(each) for each in kinds if len(each) >= count), default=0)
    used = [form[:count] for form in kinds if len(form) == length]
    return [at for form in used for at, kind in enumerate(form) if kind.endswith(".Rotation2d")]


def _of_angle(angle: ast.expr, call: ast.Call, source: Source) -> Iterator[CodeWarning]:
    number, written, name = _number(angle), ast.unparse(angle), last_name(call.func)
    is_degrees = isinstance(angle, ast.Call) and normalized(last_name(angle.func)) in _DEGREES
    if is_degrees or (isinstance(number, int) and abs(number) > 2 * math.pi):
        right = f"math.radians({written})" if name in ("sin", "cos", "tan") else f"Rotation2d.fromDegrees({written})"
        takes = "radians" if name in ("sin", "cos", "tan", "Rotation2d") else "a Rotation2d or radians"
        right = right if name == "Rotation2d" else ast.unparse(call).replace(written, right)
        yield CodeWarning(
            source.at(call), f"{name}() takes {takes}, and {written} is a number in degrees", f"Write {right}"
        )


def _of_power(call: ast.Call, kinds: Kinds, source: Source) -> Iterator[CodeWarning]:
    owner = kinds.of(call.func.value, source) if isinstance(call.func, ast.Attribute) else None
    bases = {each.__name__ for each in getattr(owner, "__mro__", ())}
    numbers = [number for each in call.args if (number := _number(each)) is not None and abs(number) > 1]
    if numbers and bases & {"MotorController", "RobotDriveBase", "SparkBase"}:
        text = f"{ast.unparse(call)}: power is from -1 to 1, so {numbers[0]} is full power"
        yield CodeWarning(source.at(call), text, f"If it is in percent, write {numbers[0] / 100:g}")


def _number(expression: ast.expr) -> float | int | None:
    try:
        value = ast.literal_eval(expression)
    except ValueError:
        return None
    return value if isinstance(value, (int, float)) and not isinstance(value, bool) else None
