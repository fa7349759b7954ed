"""Rewrite what a project's settings files say about packages: pyproject.toml, requirements.txt, workflows.

They are changed as text, so that comments and layout stay.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from .report import Report
from .rewrite.gamepads import Gamepad

#: The packages that WPILib for Python consists of; all have one version.
_WPILIB = re.compile(
    r"robotpy|wpilib|wpilib-drivers|pyntcore|robotpy-(hal|wpimath|wpiutil|wpinet|wpilog|telemetry|tunables|fields"
    r"|commands-v2|wpilib-utilities|halsim-(gui|ds-socket|ws)|apriltag|cscore|romi|xrp)"
)
_REQUIREMENT = re.compile(
    r"(?P<name>[A-Za-z][\w.-]*)(?P<extras>\[[\w, -]*\])?(?P<versions>\s*(?:[=~<>!]=|[<>])\s*[\w.*+!]+"
    r"(?:\s*,\s*(?:[=~<>!]=|[<>])\s*[\w.*+!]+)*)"
)
_HEADER = re.compile(r"^\[tool\.robotpy\][ \t]*(#[^\r\n]*)?(?=\r?$)", re.M)
_VERSION = re.compile(r"^(robotpy_version[ \t]*=[ \t]*)([\"'])[^\"']*\2", re.M)
_REQUIRES = re.compile(r"^requires[ \t]*=[ \t]*\[", re.M)
_JOYSTICK = re.compile(r'"(?P<port>\d+)"\s*:\s*\{(?:[^{}]|\{[^{}]*\})*\}')
_LABELS = re.compile(r'"(?P<kind>axes|buttons)"\s*:\s*\{[^{}]*\}')
_NUMBER = re.compile(r'"(\d+)"(?=\s*:)')
_PYTHON = re.compile(r"(python-version:\s*)([\"']?)3\.(\d+)\2(?=\s)")


class Settings:
    """The settings files of one project.

    :param version: of WPILib in the new season
    :param corrections: what is known about vendors' packages
    :param drivers: the robot needs the package of the PWM motor controllers
    :param gamepads: those that the robot has, by their ports
    """

    def __init__(
        self,
        version: str,
        corrections: Mapping[str, Any],
        report: Report,
        *,
        drivers: bool,
        gamepads: Mapping[int, Gamepad],
    ) -> None:
        self._version = version
        self._versions: Mapping[str, str] = corrections["vendor_versions"]
        self._vendors: Mapping[str, str] = corrections["vendors"]
        self._report = report
        self._drivers = drivers
        self._gamepads = gamepads

    def pyproject(self, name: str, text: str) -> str:
        """Return the new text of pyproject.toml; of a project without one, the text is ""."""
        text = self._requirements(name, text)
        newline = "\r\n" if "\r\n" in text else "\n"
        header = _HEADER.search(text)
        if header is None:
            lines = ["[tool.robotpy]", f'robotpy_version = "{self._version}"']
            if self._drivers:
                lines.append(f'requires = ["wpilib-drivers=={self._version}"]')
            joined = newline.join([*lines, ""])
            return f"{text.rstrip()}{newline * 2 if text.strip() else ''}{joined}"
        start = header.end()
        following = re.compile(r"^\[", re.M).search(text, start)
        end = following.start() if following is not None else len(text)
        section = text[start:end]
        if _VERSION.search(section):
            if '"ignored"' not in section:
                section = _VERSION.sub(rf"\g<1>\g<2>{self._version}\g<2>", section, count=1)
        else:
            section = f'{newline}robotpy_version = "{self._version}"{section}'
        if self._drivers and "wpilib-drivers" not in section:
            section = self._with_drivers(section, newline)
        return text[:start] + section + text[end:]

    def _with_drivers(self, section: str, newline: str) -> str:
        wanted = f'"wpilib-drivers=={self._version}"'
        found = _REQUIRES.search(section)
        if found is not None:
            rest = section[found.end() :]
            comma = "" if rest.lstrip().startswith("]") else ", "
            return section[: found.end()] + wanted + comma + rest
        body = section.rstrip()
        return f"{body}{newline}requires = [{wanted}]{section[len(body) :] or newline}"

    def requirements(self, name: str, text: str) -> str:
        """Return the new text of requirements.txt."""
        new = self._requirements(name, text)
        if self._drivers and new != text and "wpilib-drivers" not in new:
            newline = "\r\n" if "\r\n" in text else "\n"
            new = f"{new.rstrip()}{newline}wpilib-drivers=={self._version}{newline}"
        return new

    def workflow(self, name: str, text: str) -> str:
        """Return the new text of a workflow."""

        def python(found: re.Match[str]) -> str:
            return found[0] if int(found[3]) >= 11 else f'{found[1]}"3.13"'

        return _PYTHON.sub(python, self._requirements(name, text))

    def labels(self, text: str) -> str:
        """Return the new text of sim/config.json, where labels have the numbers of axes and buttons."""

        def joystick(found: re.Match[str]) -> str:
            gamepad = self._gamepads.get(int(found["port"]))
            return _LABELS.sub(lambda labels: renumbered(labels, gamepad), found[0])

        def renumbered(labels: re.Match[str], gamepad: Gamepad | None) -> str:
            return _NUMBER.sub(lambda found: f'"{new(labels["kind"], int(found[1]), gamepad)}"', labels[0])

        def new(kind: str, number: int, gamepad: Gamepad | None) -> int:
            known = gamepad.number(kind, number) if gamepad is not None else None
            if known is not None:
                return known
            return max(0, number - 1) if kind == "buttons" else number

        return _JOYSTICK.sub(joystick, text)

    def _requirements(self, name: str, text: str) -> str:
        """Return a text with the versions of 2026 of WPILib's packages replaced."""

        def replaced(found: re.Match[str]) -> str:
            package = re.sub(r"[-_.]+", "-", found["name"]).lower()
            if package in self._versions:
                return f"{found['name']}{found['extras'] or ''}=={self._versions[package]}"
            if "2026" not in found["versions"]:
                return found[0]
            if _WPILIB.fullmatch(package):
                return f"{found['name']}{found['extras'] or ''}=={self._version}"
            line = text.count("\n", 0, found.start()) + 1
            vendor = next((what for module, what in self._vendors.items() if module in package), "")
            if vendor:
                self._report.add(name, line, f"{found[0]} is for 2026.", vendor)
            return found[0]

        return _REQUIREMENT.sub(replaced, text)
