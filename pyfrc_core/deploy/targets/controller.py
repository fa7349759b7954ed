"""The record of a controller."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
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
class ControllerKind:
    """A kind of computer on robots.

    :param layout:           its files and commands, which the agent needs
    :param python:           the path of its Python
    :param password:         of both users
    :param shared_hosts:     addresses that all teams' robots have, as on a USB cable
    :param machine:          the beginning of its processor architecture, as `platform.machine` returns it
    :param marker_machine:   what markers of requirements call that architecture
    :param image_it:         how to install its image
    :param leftovers:        what `remove_leftovers` removes
    :param remove_leftovers: a shell script for the administrator, which removes programs in other languages and prints
        a line for each removed path or package
    :param save_memory:      frees memory that the image wastes
    :param station_port:     the port on this computer at which its Driver Station sends a line of JSON
    :param station_robot:    returns from that JSON the host of the connected robot (None: not connected), and whether
        that is on a competition field
    :param addresses:        returns the hosts of a team's robot, each with a description
    :param team_of_host:     returns the team to which a host belongs, or None
    :param image_in:         returns the version of its image, or None if it is another computer
    :param image_problem:    returns why an image (the first parameter, None if unknown) is none of the season's images
        (the third) for this version of `wpilib` (the second), or None if it is one
    :param wastes_memory:    returns whether `save_memory` is needed
    :param repair_stop:      returns the task that replaces a stop command which did not end the program
    """

    layout: Layout
    python: str
    password: str
    shared_hosts: tuple[str, ...]
    machine: str
    marker_machine: str
    image_it: str
    leftovers: str
    remove_leftovers: str
    save_memory: AdministratorTask
    station_port: int
    station_robot: Callable[[Mapping[str, Any]], tuple[str | None, bool]]
    addresses: Callable[[int], list[tuple[str, str]]]
    team_of_host: Callable[[str], int | None]
    image_in: Callable[[Texts], str | None]
    image_problem: Callable[[str | None, str, Sequence[str]], str | None]
    wastes_memory: Callable[[Texts], bool]
    repair_stop: Callable[[], AdministratorTask]

    @property
    def name(self) -> str:
        """Its product name."""
        return self.layout.name
