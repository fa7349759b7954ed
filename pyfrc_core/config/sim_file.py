"""Read ``sim/config.json``: the values in effect, and the keys without effect.

It also finds values that are allowed but probably a mistake, most often in the wrong unit.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from math import pi
from pathlib import Path as File
from typing import Any

from pydantic import BaseModel, ValidationError

from ..errors import nearest
from .colors import color_problem
from .findings import MOST_TOLD, Finding, Path, dotted, finding_at, in_order, mistakes, settings_error
from .json_text import MOST_BYTES, JsonText
from .pictures import field_picture
from .resolve import ignored_keys, resolve
from .sim import AXES, FieldConfig, SimConfig, SimConfigFile

#: Feet. Smaller than the robots of XRP and Romi kits.
_TINY = 0.5

_EIGHTHS = [eighth * pi / 4 for eighth in (*range(-8, 0), *range(1, 9))]


def lint(config: SimConfig) -> Iterator[tuple[Path, str]]:
    """Yield the paths of values in effect that are implausible, each with the reason."""
    robot, field = config.robot, config.field
    size = f"{field.w:g} by {field.h:g} ft"
    for name, length in (("w", robot.w), ("l", robot.l)):
        if length < _TINY:
            yield ("robot", name), "this is very small: is that in metres? Lengths are in feet"
        elif length > min(field.w, field.h):
            yield ("robot", name), f"the robot is larger than the field ({size}); lengths are in feet"
    if len(robot.start_positions) != 1:  # which would be this one
        at_start = {"x": robot.starting_x, "y": robot.starting_y, "angle": robot.starting_angle}
        yield from _of_start(("robot",), "starting_", at_start, field, size)
    for index, start in enumerate(robot.start_positions):
        place = {"x": start.x, "y": start.y, "angle": start.angle}
        yield from _of_start(("robot", "start_positions", index), "", place, field, size)


def _of_start(
    path: Path, prefix: str, start: dict[str, float], field: FieldConfig, size: str
) -> Iterator[tuple[Path, str]]:
    for name, most in (("x", field.w), ("y", field.h)):
        if not 0 <= start[name] <= most:
            yield (*path, prefix + name), f"this is off the field ({size})"
    if _looks_like_radians(start["angle"]):
        yield (*path, f"{prefix}angle"), "this looks like radians; angles are in degrees"


def _looks_like_radians(angle: float) -> bool:
    """Return whether this is a multiple of an eighth of a turn as people write it: 0.785, 1.57, 3.14."""
    if angle == round(angle, 1):  # 5.5 is near an eighth too, but no one rounds so roughly
        return False
    return any(abs(angle - eighth) < 1e-3 or angle == round(eighth, 2) for eighth in _EIGHTHS)


SIM_CONFIG = File("sim", "config.json")


@dataclass(frozen=True)
class LoadedSimConfig:
    """``sim/config.json``, or the defaults where there is none."""

    #: The values in effect, after `resolve`.
    config: SimConfig
    #: The file's name as the user knows it, whether the file exists or not.
    name: str
    #: The parts of the file that have no effect, in the file's order.
    warnings: tuple[Finding, ...] = ()
    #: The file's text; None where there is no file.
    text: JsonText | None = None

    def lint(self) -> tuple[Finding, ...]:
        """Return the values in the file that are probably a mistake, in the file's order."""
        found = {}
        for path, why in lint(self.config):
            whole = ("pyfrc", *path)
            if self.text is not None and path == ("robot", "l") and not self.text.has(whole):
                whole = ("pyfrc", "robot", "h")  # its older name
            if self.text is not None and self.text.has(whole):
                found[whole] = finding_at(self.text, whole, f"{dotted(whole)} = {self.text.excerpt(whole)}: {why}")
        return tuple(in_order(found.values()))


def load_sim_config(root: File, *, shown_from: File | None = None) -> LoadedSimConfig:
    """Read ``sim/config.json`` below the project's directory.

    :param root: the directory of the robot's code
    :param shown_from: the directory that the displayed file name is relative to; default: `root`
    :raises SettingsError: with each mistake's line, path and value, and the allowed values
    """
    file = root / SIM_CONFIG
    shown_from = shown_from or root
    name = _shown(file, shown_from)
    if not (file.exists() or file.is_symlink()):
        elsewhere = tuple(
            Finding(_shown(other, shown_from), None, "pyfrc does not read this file", f"Move it to {name}")
            for other in _misplaced(root)
        )
        return LoadedSimConfig(resolve(SimConfig()), name, elsewhere)
    text = JsonText(file, name)
    try:
        given = SimConfigFile.model_validate(text.value).pyfrc
    except ValidationError as invalid:
        raise settings_error(mistakes(invalid, text.value, text)) from None
    return LoadedSimConfig(resolve(given), name, _warnings(given, text, file.parent), text)


def _shown(file: File, directory: File) -> str:
    try:
        return File(os.path.relpath(file, directory)).as_posix()
    except ValueError:  # on another drive
        return str(file)


def _misplaced(root: File) -> Iterator[File]:
    """Yield misplaced files that are probably meant to be ``sim/config.json``: files nearby with a key ``pyfrc``."""
    near = [root / "config.json", root / "tests" / SIM_CONFIG]
    if not (root.parent / "robot.py").exists():  # whose it would be
        near.append(root.parent / SIM_CONFIG)
    with suppress(OSError):
        for directory in sorted(root.iterdir()):
            if directory.name.casefold() == "sim" and directory.is_dir():
                near += sorted(file for file in directory.iterdir() if file.name.casefold() == "config.json")
    for file in near:
        with suppress(OSError):
            if file.is_file() and file.stat().st_size <= MOST_BYTES and b'"pyfrc"' in file.read_bytes():
                yield file


def _warnings(given: SimConfig, text: JsonText, directory: File) -> tuple[Finding, ...]:
    found = _find_warnings(given, text, directory)
    warnings = in_order(finding_at(text, path, message, remedy) for path, message, remedy in islice(found, MOST_TOLD))
    if next(found, None) is not None:
        warnings.append(Finding(text.name, None, "... and there is more"))
    return tuple(warnings)


def _find_warnings(given: SimConfig, text: JsonText, directory: File) -> Iterator[tuple[Path, str, str | None]]:
    """Yield what has no effect in the file: the path, the message, and the remedy."""
    for path, line in text.repeated_keys():
        if path[0] == "pyfrc":  # all else is other tools'
            yield path, f"{dotted(path)} stands here again, and replaces what line {line} says", None
    for key in text.value:
        if key in SimConfig.model_fields:
            yield (
                (key,),
                f"{key!r} has no effect outside of 'pyfrc'",
                f'Write "pyfrc": {{"{key}": ...}}.',
            )
    if "pyfrc" not in text.value:
        for key in text.value:
            if key.casefold() == "pyfrc" or nearest(key[:50], ["pyfrc"]).startswith("did you mean"):
                yield (key,), f"unknown key {key!r}", "did you mean 'pyfrc'?"
        return
    for path, known in _unknown_keys(given, text.value["pyfrc"], ("pyfrc",)):
        # Of a long key, the beginning is enough to find the nearest.
        yield path, f"unknown key {dotted(path)!r}", nearest(str(path[-1])[:50], known)
    for path, why in ignored_keys(given):
        yield ("pyfrc", *path), f"{dotted(('pyfrc', *path))} = {text.excerpt(('pyfrc', *path))}: {why}", None
    image = given.field.image
    if image is not None and (why := field_picture(directory.parent, image)[1]):
        path = ("pyfrc", "field", "image")
        yield path, f"{dotted(path)} = {text.excerpt(path)}: {why}", "It is looked for in sim/."
    for number, shape in enumerate(given.field.objects):
        if why := color_problem(shape.color):
            path = ("pyfrc", "field", "objects", number, "color")
            yield path, f"{dotted(path)} = {text.excerpt(path, shape.color)}: {why}", None
    for port, joystick in text.value["pyfrc"].get("joysticks", {}).items():
        for first, again in _same_axis(joystick.get("axes", {})):
            path = ("pyfrc", "joysticks", port, "axes", again)
            yield path, f"{dotted(path)}: this is the same axis as {first!r}, whose label it replaces", None


def _unknown_keys(given: Any, data: Any, path: Path) -> Iterator[tuple[Path, list[str]]]:
    """Yield the keys in `data` that its model `given` does not have, with the known keys there."""
    if isinstance(given, BaseModel):
        known = type(given).model_fields
        for key, item in data.items():
            if key in known:
                yield from _unknown_keys(getattr(given, key), item, (*path, key))
            else:
                yield (*path, key), list(known)
    elif isinstance(given, tuple):
        for index, (each, item) in enumerate(zip(given, data, strict=True)):
            yield from _unknown_keys(each, item, (*path, index))
    elif isinstance(given, dict):
        for key, item in data.items():
            if isinstance(item, dict):
                yield from _unknown_keys(given[int(key)], item, (*path, key))


def _same_axis(axes: dict[str, str]) -> Iterator[tuple[str, str]]:
    """Yield pairs of keys that name the same axis."""
    seen: dict[int, str] = {}
    for key in axes:
        first = seen.setdefault(AXES.numbers[key], key)
        if first != key:
            yield first, key
