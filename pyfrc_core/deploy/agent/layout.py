"""What the agent must know of the controller. The laptop's first message describes it, since the agent knows none."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple


class Layout(NamedTuple):
    """The files and commands of a controller.

    :param name:          its product name, for messages
    :param user:          the user who runs the robot program, and owns its files
    :param owner:         the same with the group, as ``chown`` takes it
    :param administrator: the user who may change everything
    :param home:          the user's home directory
    :param code:          the directory with the robot program, in `home`
    :param start:         the start command; ``{main}`` is the main file
    :param start_debug:   the same for debugging
    :param command:       the file in `home` with the command that the controller runs
    :param debug_command: the file that it runs instead while `debug_flag` exists; empty if `command` has either of them
    :param debug_flag:    empty without `debug_command`
    :param stop:          the path and the options of the command that stops the program
    :param restart:       of the command that stops it and starts the current one
    :param stopper:       what messages call these commands
    :param profiles:      files that a shell sources before these commands
    :param texts:         files whose content the laptop needs, by names
    :param command_mode:  the permissions of the files with start commands
    :param can_fail:      whether the exit code of `stop` and `restart` says that they have failed
    :param python:        the Python in the start commands, of the system or another tool; a program with an environment
        of pyfrc's starts with the Python of that instead
    :param installing:    the directory in which scripts of pyfrc write, in names that begin with their process's number
    :param output:        a command that prints what the program prints from then on; without one, the console service
        on the robot sends that
    """

    name: str
    user: str
    owner: str
    administrator: str
    home: str
    code: str
    start: str
    start_debug: str
    command: str
    debug_command: str
    debug_flag: str
    stop: Sequence[str]
    restart: Sequence[str]
    stopper: str
    profiles: Sequence[str]
    texts: Mapping[str, str]
    python: str
    command_mode: int = 0o644
    can_fail: bool = False
    output: Sequence[str] = ()
    installing: str = ""

    @property
    def by_administrator(self) -> str:
        """Return where a user types a command for the administrator, for messages."""
        return f"as {self.administrator} on the robot:" if self.administrator != self.user else "on the robot: sudo"

    @property
    def environments(self) -> str:
        """Return the directory with the environments."""
        return f"{self.home}/.pyfrc/environments"

    @property
    def logs(self) -> tuple[str, ...]:
        """Return the directories of logs: on a USB stick, where robots prefer to write them, and on the robot."""
        return ("/u/logs", "/U/logs", f"{self.home}/logs")

    @property
    def command_files(self) -> list[str]:
        """Return the names of the files with start commands."""
        return [each for each in (self.command, self.debug_command) if each]
