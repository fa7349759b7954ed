"""The record of a controller."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..agent.layout import Layout

#: The contents of the files in `Layout.texts`, by their names there; None for a file that cannot be read.
Texts = Mapping[str, "str | None"]


@dataclass(frozen=True)
class AdministratorTask:
    """A shell script for the robot's administrator. Its failure causes only a warning.

    :param script: for the administrator's shell
    :param done:   the note after its success
    :param failed: the warning after a failure, without the reason
    """

    script: str
    done: str
    failed: str


@dataclass(frozen=True)
class PythonInstaller:
    """How Python is installed on a robot that has none: a shell script, which reads its file.

    The script prints ``there`` if this Python is on the robot, or ``full`` and the kilobytes that are free, or ``send``
    before it reads. Two computers may run it at once. If it is interrupted, the next one removes its remains.

    :param script: for the shell of `user`; ``{name}`` is a name for this Python, ``{size}`` and ``{sha256}`` are about
        its file, ``{kilobytes}`` have to be free
    :param user:   who runs it
    :param needed: returns how many bytes have to be free for a file
    :param is_system: whether it installs the system's Python, which no newer one replaces; others have a name each
    """

    script: str
    user: str
    needed: Callable[[Path], int]
    is_system: bool = False


@dataclass(frozen=True)
class DriverStation:
    """A program on this computer from which robots are driven.

    :param port:  its port on this computer, at which it sends a line of JSON
    :param robot: returns from that JSON the host of the connected robot (None: not connected), and whether that is on
        a competition field
    """

    port: int
    robot: Callable[[Mapping[str, Any]], tuple[str | None, bool]]


@dataclass(frozen=True)
class ControllerKind:
    """A kind of computer on robots.

    :param layout:           its files and commands, which the agent needs
    :param install_python:   installs Python
    :param check_python:     a shell command that exits with 127 if its Python is not complete, and a semicolon
    :param password:         of its users, unless the team has changed it
    :param shared_hosts:     hosts that all teams' robots have, as on a USB cable
    :param machine:          the beginning of its processor architecture, as `platform.machine` returns it
    :param image_it:         how to install its image
    :param stations:         the Driver Stations for it
    :param addresses:        returns the hosts of a team's robot, each with a description
    :param team_of_host:     returns the team to which a host belongs, or None
    :param has_image_file:   whether a file names the version of its image; then a computer without one is another
    :param image_in:         returns the version of its image, or None
    :param image_problem:    returns why an image (the first parameter, None if unknown) is none of the season's images
        (the third) for this version of `wpilib` (the second), or None if it is one
    :param save_memory:      frees memory that the image wastes; None: it wastes none
    :param radio:            what its radio needs, as a sentence
    :param wastes_memory:    returns whether `save_memory` is needed
    :param repair_stop:      returns the task that replaces a stop command which did not end the program, if any
    """

    layout: Layout
    install_python: PythonInstaller
    password: str
    shared_hosts: tuple[str, ...]
    machine: str
    image_it: str
    stations: tuple[DriverStation, ...]
    addresses: Callable[[int], list[tuple[str, str]]]
    team_of_host: Callable[[str], int | None]
    check_python: str = ""
    has_image_file: bool = False
    image_in: Callable[[Texts], str | None] = lambda texts: None
    image_problem: Callable[[str | None, str, Sequence[str]], str | None] = lambda image, wpilib, accepted: None
    radio: str = ""
    save_memory: AdministratorTask | None = None
    wastes_memory: Callable[[Texts], bool] = lambda texts: False
    repair_stop: Callable[[], AdministratorTask | None] = lambda: None

    @property
    def name(self) -> str:
        """Its product name."""
        return self.layout.name

    @property
    def python(self) -> str:
        """The path of its Python, which programs without an environment start with."""
        return self.layout.python

    @property
    def remove_remains(self) -> AdministratorTask:
        """Removes what interrupted installations have left."""
        script, what = remove_remains(self.layout.installing), "what an interrupted installation had left on the robot"
        return AdministratorTask(script, f"{what} was removed", f"{what} could not be removed")

    def python_command(self, environment: str | None = None) -> str:
        """Return the beginning of a shell command: the Python that the current program starts with.

        :param environment: the name of an environment, whose Python is taken if it is complete
        """
        layout, other = self.layout, ""
        if environment is not None:
            place = f"{layout.environments}/{environment}"
            other = f"[ ! -e {place}/environment.json ] || p={place}/bin/python3; "
        named = f"grep -o '{layout.environments}/[^/]*/bin/python3' {layout.home}/{layout.command} 2> /dev/null"
        return f'{self.check_python}p=$({named}); [ -x "$p" ] || p={self.python}; {other}exec $p'


def team_of_address(host: str) -> int | None:
    """Return the team of an address 10.TE.AM.2, or None."""
    numbers = re.fullmatch(r"10\.([0-9]{1,3})\.([0-9]{1,2})\.2", host)
    return int(numbers[1]) * 100 + int(numbers[2]) if numbers else None


def address_of_team(team: int) -> str:
    """Return the address 10.TE.AM.2 of a team's robot."""
    return f"10.{team // 100}.{team % 100}.2"


def remove_remains(directory: str) -> str:
    """Return shell commands that remove what interrupted scripts have left in a directory.

    Each name there begins with the number of a process, whose command line has the directory's name while it runs.
    """
    return f"""for each in {directory}/[0-9]*.*; do
    process=$(basename "$each" | cut -d. -f1)
    grep -q {directory} /proc/$process/cmdline 2> /dev/null || rm -rf "$each"
done"""
