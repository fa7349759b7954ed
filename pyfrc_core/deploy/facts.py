"""What a robot tells of itself, and what came of what it was asked for."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Release:
    """A program that the robot has, and can go back to.

    :param number:      by which it is named
    :param taken:       whether another tool has left it
    :param main:        its main file; none: not known
    :param debug:       whether it was deployed for debugging
    :param files:       how many it came with
    :param previous:    the release it has replaced
    :param deploy_json: who has deployed it, when, from where
    """

    number: int
    taken: bool
    main: str | None
    debug: bool
    files: int
    previous: int | None
    deploy_json: Mapping[str, str]

    @classmethod
    def of(cls, told: Mapping[str, Any]) -> Release:
        """From what the agent tells."""
        return cls(
            number=int(told["release"]),
            taken=bool(told["taken"]),
            main=told["main"],
            debug=bool(told["debug"]),
            files=int(told["files"]),
            previous=told["from"],
            deploy_json=_texts(told["deploy"]),
        )


@dataclass(frozen=True)
class RobotFacts:
    """What there is on the robot.

    :param not_roborio:  why it is no roboRIO; none: it is one
    :param python:       its Python's version
    :param wpilib:       its version; none: not installed
    :param image:        its image's version
    :param startup_dlls: whether the line that costs 24 MB is in effect
    :param free_bytes:   that may still be written
    :param user:         as whom we write
    :param current:      the release that it starts; none: another tool's program, or no program
    :param releases:     all that it has, oldest first
    :param other_code:   whether another tool's program is in place
    :param deploy_json:  of the program that is in place
    :param command:      the line that starts the program at boot; none: nothing is started
    :param debug:        whether the program is started for debugging
    :param running:      whether a program runs
    """

    not_roborio: str | None
    python: str
    wpilib: str | None
    image: str | None
    startup_dlls: bool
    free_bytes: int
    user: str
    current: int | None
    releases: tuple[Release, ...]
    other_code: bool
    deploy_json: Mapping[str, str]
    command: str | None
    debug: bool
    running: bool

    @classmethod
    def of(cls, told: Mapping[str, Any]) -> RobotFacts:
        """From what the agent tells."""
        why = None
        if told["image"] is None:
            why = "there is no roboRIO image on it"
        elif not told["home"]:
            why = "there is no /home/lvuser on it"
        elif not told["kill_script"]:
            why = "there is no frcKillRobot.sh on it"
        try:
            deploy_json = _texts(json.loads(told["deploy_json"] or "{}"))
        except ValueError:
            deploy_json = {}
        return cls(
            not_roborio=why,
            python=told["python"],
            wpilib=told["wpilib"],
            image=told["image"],
            startup_dlls=told["startup_dlls"],
            free_bytes=told["free"],
            user=told["user"],
            current=told["current"],
            releases=tuple(map(Release.of, told["releases"])),
            other_code=told["other_code"],
            deploy_json=deploy_json,
            command=told["command"],
            debug=told["debug"],
            running=told["running"],
        )


@dataclass(frozen=True)
class Plan:
    """What a deploy would do: paths relative to the code's directory; files and bytes that would be sent."""

    added: tuple[str, ...]
    changed: tuple[str, ...]
    removed: tuple[str, ...]
    files_to_send: int
    bytes_to_send: int


@dataclass(frozen=True)
class DeployRequest:
    """How a program is to be deployed.

    :param main:        its main file, relative to the project
    :param deploy_json: what is kept with it
    :param debug:       whether the robot is to start it for debugging
    :param in_place:    overwrite the files of the program that is there, delete none
    """

    main: str
    deploy_json: Mapping[str, str]
    debug: bool = False
    in_place: bool = False


@dataclass(frozen=True)
class Deployed:
    """What a deploy did.

    :param release:    the number of the release that is current now; none: another tool's directory, in place
    :param previous:   the one that was before it
    :param taken:      the release as which another tool's directory was kept
    :param unchanged:  whether the same files were there already
    :param files_sent: whose contents the robot had not
    :param bytes_sent: of contents, before they were compressed
    """

    release: int | None
    previous: int | None
    taken: int | None
    unchanged: bool
    files_sent: int
    bytes_sent: int


@dataclass(frozen=True)
class RolledBack:
    """What a rollback did.

    :param previous: the release that was current before
    :param changed:  the release's files that are not as they were deployed: the program has written into them
    """

    release: Release
    previous: int | None
    changed: tuple[str, ...]


@dataclass(frozen=True)
class Watched:
    """How a program that was started is doing.

    :param alive:   whether it ran at the end
    :param started: whether it has said that it has started
    :param output:  what it has printed; nothing, where the robot's console tells nothing
    """

    alive: bool
    started: bool
    output: str

    @property
    def traceback(self) -> str | None:
        """The last traceback in its output, with the error's line."""
        found = re.findall(
            r"^Traceback \(most recent call last\):\n(?:[ \t].*\n|\n)*(?:\S.*\n?)?", self.output, re.MULTILINE
        )
        return found[-1].rstrip() if found else None


def _texts(about: Any) -> dict[str, str]:
    return {str(key): str(value) for key, value in about.items()} if isinstance(about, dict) else {}
