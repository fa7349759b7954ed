"""Facts about a robot, and the requests and responses of the deploy agent."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ..terminal_text import one_line
from .agent import start_monitor
from .responses import Raw, parse, sent_as, value_of
from .targets import ControllerKind

#: The image of a virtual robot, which has none.
VIRTUAL_IMAGE = "virtual robot"

#: What WPILib and AdvantageKit append to a log's name: ``_OHCL_Q12.wpilog``, ``_ohcl_q12.wpilog``.
_MATCH = re.compile(r"[0-9]_([A-Za-z][A-Za-z0-9]*)_([PQEpqe][0-9]{1,3})\.\w+$")

_TRACEBACK = re.compile(r"^Traceback \(most recent call last\):\n(?:[ \t].*\n|\n)*(?P<error>\S.*\n?)?", re.MULTILINE)

#: What Python prints if C code ends it by a signal. WPILib's runner lets it do so.
_FATAL = re.compile(r"^Fatal Python error: ([A-Z][A-Za-z -]{0,40})$", re.MULTILINE)


@dataclass(frozen=True)
class Release:
    """A release on the robot.

    :param number:      its number
    :param taken:       whether another tool deployed it
    :param main:        its main file; None if unknown
    :param debug:       whether it was deployed for debugging
    :param files:       the number of deployed files
    :param previous:    the release that it replaced
    :param deploy_json: who deployed it, when, from where
    :param ran:         whether any watch has confirmed that it runs
    :param ended:       whether it has ended during its last watched start or since
    :param damaged:     whether its record cannot be read
    """

    number: int = field(metadata=sent_as("release"))
    taken: bool
    main: str | None
    debug: bool | None
    files: int
    previous: int | None = field(metadata=sent_as("from"))
    deploy_json: Mapping[str, str] = field(metadata=sent_as("deploy"))
    ran: bool = False
    ended: bool = False
    damaged: bool = False


@dataclass(frozen=True)
class RobotLog:
    """A log on the robot.

    :param path:     its path there
    :param name:     its path in the directory of logs
    :param size:     in bytes
    :param modified: when it was last written, in seconds since 1970, by the robot's clock
    :param usb:      whether it is on a USB stick
    :param written:  whether the program may still write it
    """

    path: Raw
    name: Raw
    size: int
    modified: float
    usb: bool
    written: bool

    @property
    def match(self) -> str:
        """The event and the match in its name, such as ``OHCL Q12``; empty without one."""
        found = _MATCH.search(self.name)
        return f"{found[1]} {found[2]}".upper() if found else ""


@dataclass(frozen=True)
class RobotFacts:
    """The facts that the agent reports about the robot.

    :param controller:   the kind of computer that it should be
    :param not_controller: the reason why it is not one; None if it is
    :param python:       the version of its Python
    :param wpilib:       the version of `wpilib`; None if it is not installed
    :param image:        the version of its image
    :param wastes_memory: whether its image wastes memory, which the controller's `save_memory` frees
    :param free_bytes:   free disk space in bytes
    :param user:         the user who owns new files
    :param current:      the release that it starts; None for another tool's program, and without a program
    :param releases:     all releases, oldest first
    :param other_code:   whether another tool's program is current
    :param deploy_json:  ``deploy.json`` of the current program
    :param command:      the command that starts the program at boot; None if there is none
    :param debug:        whether the program is started for debugging
    :param running:      whether a program runs
    :param packages:     versions of the installed Python packages by normalized name
    :param missing_modules: requested top-level modules that its Python cannot find
    :param machine:      its processor architecture
    :param environment:  the environment in which the agent runs, if pyfrc has made it
    :param program_age:  seconds since the program's start; None if unknown or no program runs
    :param remains:      whether there is something that an interrupted installation may have left
    """

    controller: str
    not_controller: str | None
    python: str
    wpilib: str | None
    image: str | None
    wastes_memory: bool
    free_bytes: int = field(metadata=sent_as("free"))
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
    machine: str
    program_age: float | None = None
    remains: bool = False
    environment: str | None = None

    @classmethod
    def of(cls, message: object, controller: ControllerKind) -> RobotFacts:
        """Parse the agent's message.

        :raises ResponseError: if a field is missing or invalid
        """
        texts = value_of(message, "texts", dict[str, Raw | None])
        image = VIRTUAL_IMAGE if value_of(message, "virtual", bool) else controller.image_in(texts)
        why = None
        if image is None and controller.has_image_file:
            why = f"there is no {controller.name} image on it"
        elif not value_of(message, "home", bool):
            why = f"there is no {controller.layout.home} on it"
        elif not value_of(message, "can_restart", bool):
            why = f"there is no {controller.layout.restart[0].rpartition('/')[2]} on it"
        return parse(
            cls,
            message,
            controller=controller.name,
            not_controller=why,
            image=None if image is None else one_line(image),
            wastes_memory=controller.wastes_memory(texts),
        )


@dataclass(frozen=True)
class Plan:
    """The changes that a deploy would make: paths relative to the code's directory, and the data to send."""

    added: tuple[str, ...]
    changed: tuple[str, ...]
    removed: tuple[str, ...]
    files_to_send: int = field(metadata=sent_as("files"))
    bytes_to_send: int = field(metadata=sent_as("bytes"))


@dataclass(frozen=True)
class DeployRequest:
    """Options of a deploy.

    :param main:        the main file, relative to the project
    :param deploy_json: the content of ``deploy.json``
    :param debug:       start the program for debugging
    :param program:     files that the program imports at its start, which the robot's Python must be able to compile
    :param restart:     restart the program after the deploy
    :param environment: the environment on the robot that it runs in; None: the current one
    :param reinstall:   make a new release in any case, compile everything again, and mend damaged files of others
    """

    main: str
    deploy_json: Mapping[str, str]
    debug: bool = False
    program: Sequence[str] = ()
    restart: bool = False
    environment: str | None = None
    reinstall: bool = False


@dataclass(frozen=True)
class Deployed:
    """The result of a deploy.

    :param release:    the current release
    :param previous:   the release before it
    :param fallback:   the release that a rollback selects: the previous one, or the newest confirmed to run
    :param taken:      the new release number of another tool's directory
    :param unchanged:  whether the robot already had the same files
    :param files_sent: the number of files whose contents were sent
    :param bytes_sent: the size of these contents before compression
    :param skipped:    files beside the old program that were not carried over: pipes, sockets, devices
    :param renamed:    the new names of those whose names the new program has taken
    """

    release: int
    previous: int | None
    fallback: int | None
    taken: int | None
    unchanged: bool
    files_sent: int = field(metadata=sent_as("files"))
    bytes_sent: int = field(metadata=sent_as("bytes"))
    skipped: tuple[str, ...] = ()
    renamed: tuple[str, ...] = ()


@dataclass(frozen=True)
class RolledBack:
    """The result of a rollback.

    :param release:  the release that is current now
    :param previous: the release that was current before
    :param changed:  deployed files of the release that the program has changed
    """

    release: Release = field(metadata=sent_as("about"))
    previous: int | None
    changed: tuple[str, ...]


@dataclass(frozen=True)
class StartState:
    """The observed state of a program during its start.

    :param seconds:        seconds since the restart
    :param age:            seconds for which its process has been observed; 0 without one
    :param lived:          the same for a process that has ended
    :param has_output:     whether any output was received
    :param seen:           whether a process was ever observed
    :param cpu:            processor time of the process in seconds; None if unknown
    :param network_tables: whether its NetworkTables server listens, which WPILib starts after the imports and before
        ``robotInit``; None if unknown
    """

    seconds: float = 0.0
    age: float = 0.0
    lived: float = 0.0
    has_output: bool = field(default=False, metadata=sent_as("heard"))
    seen: bool = False
    cpu: float | None = None
    network_tables: bool | None = None


@dataclass(frozen=True)
class Watched:
    """The result of watching a program's start.

    :param verdict: ``running``, ``ended``, ``starting`` (not finished within the time limit) or ``unheard`` (the
        process runs, but its output does not confirm the start)
    :param output:  the last part of its output; empty if the console is silent
    :param state:   the state at the end of the watch
    """

    verdict: str
    output: str
    state: StartState = StartState()

    @property
    def alive(self) -> bool:
        """Return whether its process was running at the end."""
        return self.verdict != start_monitor.ENDED

    @property
    def started(self) -> bool:
        """Return whether it has reported its start and kept running."""
        return self.verdict == start_monitor.RUNNING

    @property
    def traceback(self) -> str | None:
        """Return the last complete traceback in the output, else the last incomplete one, else None.

        A traceback may be incomplete because the robot restarts a crashed program immediately.
        """
        found = list(_TRACEBACK.finditer(self.output))
        whole = [each for each in found if each["error"]] or found
        return whole[-1][0].rstrip() if whole else None

    @property
    def fatal_error(self) -> str | None:
        """Return Python's name for the signal that has ended the process, such as ``Segmentation fault``, if known."""
        found = _FATAL.findall(self.output)
        return str(found[-1]) if found and not self.alive else None
