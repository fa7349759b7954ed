"""What a robot tells of itself, and what came of what it was asked for."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..season import CURRENT
from ..terminal_text import one_line
from .agent import watching

if TYPE_CHECKING:
    from .answers import Fields

_TRACEBACK = re.compile(r"^Traceback \(most recent call last\):\n(?:[ \t].*\n|\n)*(?P<error>\S.*\n?)?", re.MULTILINE)


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
    :param ran:         whether a watch has seen it run, at any of its starts
    :param ended:       whether it ended at the last of its starts that was watched
    """

    number: int
    taken: bool
    main: str | None
    debug: bool
    files: int
    previous: int | None
    deploy_json: Mapping[str, str]
    ran: bool = False
    ended: bool = False

    @classmethod
    def of(cls, fields: Fields) -> Release:
        """From what the agent sends."""
        return cls(
            number=fields.count("release"),
            taken=fields.flag("taken"),
            main=fields.line_or_none("main"),
            debug=bool(fields.flag_or_none("debug")),
            files=fields.count("files"),
            previous=fields.count_or_none("from"),
            deploy_json=fields.record("deploy"),
            ran=fields.flag("ran"),
            ended=fields.flag("ended"),
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
    :param packages:     the versions of what is installed for its Python, by normalized names
    :param missing_modules: of the modules that were asked for, those that its Python cannot find
    :param extension_suffixes: with which the names of its Python's extension modules end
    :param machine:      its processor
    :param other_languages: files and directories of programs in Java and C++
    :param program_age:  seconds for which the program has run; none: not known, or no program runs
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
    packages: Mapping[str, str]
    missing_modules: tuple[str, ...]
    extension_suffixes: tuple[str, ...]
    machine: str
    other_languages: tuple[str, ...]
    program_age: float | None = None

    @classmethod
    def of(cls, fields: Fields) -> RobotFacts:
        """From what the agent sends."""
        image = fields.line_or_none("image")
        why = None
        if image is None:
            why = f"there is no {CURRENT.controller.name} image on it"
        elif not fields.flag("home"):
            why = f"there is no {CURRENT.controller.home} on it"
        elif not fields.flag("kill_script"):
            why = "there is no frcKillRobot.sh on it"
        return cls(
            not_roborio=why,
            python=fields.line("python"),
            wpilib=fields.line_or_none("wpilib"),
            image=image,
            startup_dlls=fields.flag("startup_dlls"),
            free_bytes=fields.count("free"),
            user=fields.line("user"),
            current=fields.count_or_none("current"),
            releases=tuple(map(Release.of, fields.objects("releases"))),
            other_code=fields.flag("other_code"),
            deploy_json=fields.record_in_text("deploy_json"),
            command=fields.text_or_none("command"),
            debug=fields.flag("debug"),
            running=fields.flag("running"),
            packages=fields.record("packages"),
            missing_modules=tuple(map(one_line, fields.texts("missing_modules"))),
            extension_suffixes=tuple(map(one_line, fields.texts("extension_suffixes"))),
            machine=fields.line("machine"),
            other_languages=tuple(map(one_line, fields.texts("other_languages"))),
            program_age=fields.seconds_or_none("program_age"),
        )


@dataclass(frozen=True)
class Plan:
    """What a deploy would do: paths relative to the code's directory; files and bytes that would be sent."""

    added: tuple[str, ...]
    changed: tuple[str, ...]
    removed: tuple[str, ...]
    files_to_send: int
    bytes_to_send: int

    @classmethod
    def of(cls, fields: Fields) -> Plan:
        """From what the agent sends."""
        added, changed, removed = (fields.texts(key) for key in ("added", "changed", "removed"))
        return cls(added, changed, removed, fields.count("files"), fields.count("bytes"))


@dataclass(frozen=True)
class DeployRequest:
    """How a program is to be deployed.

    :param main:        its main file, relative to the project
    :param deploy_json: what is kept with it
    :param debug:       whether the robot is to start it for debugging
    :param in_place:    overwrite the files of the program that is there, delete none
    :param program:     the files that are imported when it starts: the robot's Python has to be able to compile them
    """

    main: str
    deploy_json: Mapping[str, str]
    debug: bool = False
    in_place: bool = False
    program: Sequence[str] = ()


@dataclass(frozen=True)
class Deployed:
    """What a deploy did.

    :param release:    the number of the release that is current now; none: another tool's directory, in place
    :param previous:   the one that was before it
    :param fallback:   the one that a rollback goes back to: the one before, or the newest that was seen to run
    :param taken:      the release as which another tool's directory was kept
    :param unchanged:  whether the same files were there already
    :param files_sent: whose contents the robot had not
    :param bytes_sent: of contents, before they were compressed
    """

    release: int | None
    previous: int | None
    fallback: int | None
    taken: int | None
    unchanged: bool
    files_sent: int
    bytes_sent: int

    @classmethod
    def of(cls, fields: Fields) -> Deployed:
        """From what the agent sends."""
        return cls(
            release=fields.count_or_none("release"),
            previous=fields.count_or_none("previous"),
            fallback=fields.count_or_none("fallback"),
            taken=fields.count_or_none("taken"),
            unchanged=fields.flag("unchanged"),
            files_sent=fields.count("files"),
            bytes_sent=fields.count("bytes"),
        )


@dataclass(frozen=True)
class RolledBack:
    """What a rollback did.

    :param previous: the release that was current before
    :param changed:  the release's files that are not as they were deployed: the program has written into them
    """

    release: Release
    previous: int | None
    changed: tuple[str, ...]

    @classmethod
    def of(cls, fields: Fields) -> RolledBack:
        """From what the agent sends."""
        return cls(Release.of(fields.object("about")), fields.count_or_none("previous"), fields.texts("changed"))


@dataclass(frozen=True)
class StartState:
    """What is seen of a program while it starts.

    :param seconds:        since its start
    :param age:            seconds for which its process has been seen; 0 without one
    :param lived:          the same of the process that has ended
    :param heard:          whether anything that it has printed has arrived
    :param seen:           whether it ever had a process
    :param cpu:            processor time that its process has used, in seconds; none: unknown
    :param network_tables: whether its NetworkTables server listens, which WPILib starts after the imports and before
        ``robotInit``; none: unknown
    """

    seconds: float = 0.0
    age: float = 0.0
    lived: float = 0.0
    heard: bool = False
    seen: bool = False
    cpu: float | None = None
    network_tables: bool | None = None

    @classmethod
    def of(cls, fields: Fields) -> StartState:
        """From what the agent sends."""
        return cls(
            seconds=fields.seconds("seconds"),
            age=fields.seconds("age"),
            lived=fields.seconds("lived") if "lived" in fields else 0.0,
            heard=fields.flag("heard"),
            seen=fields.flag("seen"),
            cpu=fields.seconds_or_none("cpu") if "cpu" in fields else None,
            network_tables=fields.flag_or_none("network_tables") if "network_tables" in fields else None,
        )


@dataclass(frozen=True)
class Watched:
    """What came of watching a program that was started.

    :param verdict: ``running``, ``ended``, ``starting`` (still, at the end of the watch) or ``unheard``: its process
        lives, and its console is silent
    :param output:  the end of what it has printed; nothing, where the robot's console is silent
    :param state:   how it was at the end
    """

    verdict: str
    output: str
    state: StartState = StartState()

    @property
    def alive(self) -> bool:
        """Whether its process lived at the end."""
        return self.verdict != watching.ENDED

    @property
    def started(self) -> bool:
        """Whether it has reported that it has started, and lived on."""
        return self.verdict == watching.RUNNING

    @property
    def traceback(self) -> str | None:
        """The last traceback in its output, with the error's line; one that is cut off counts if there is no other.

        The output of a program that is started again at once ends anywhere in the next crash.
        """
        found = list(_TRACEBACK.finditer(self.output))
        whole = [each for each in found if each["error"]] or found
        return whole[-1][0].rstrip() if whole else None
