"""Errors of deploys and connections to a robot."""

from __future__ import annotations

from ..errors import PyfrcError


class DeployError(PyfrcError):
    """A command about a robot failed. The robot still has a complete program. The message says what to do."""


class ConnectionFailedError(DeployError):
    """The login failed, or the connection was lost."""


class NoConsoleError(DeployError):
    """The server at the console's port is not a robot's console."""


class StoppedError(DeployError):
    """The user pressed Ctrl-C while the robot was being changed. The message explains the robot's state."""

    exit_code = 2


class HostKeyError(DeployError):
    """The robot's host key is not a known one."""


class KeyFileError(DeployError):
    """The file with the robots' host keys cannot be read or written."""


class OnTheFieldError(DeployError):
    """The Driver Station is connected to a competition field, where robots must not be changed."""


class RefusedError(DeployError):
    """The command was refused before anything was changed."""


class OtherComputerError(RefusedError):
    """Another computer changes or has changed the robot's programs. This command has changed nothing."""


class NoPythonError(RefusedError):
    """There is no Python on the robot."""


class ProgramDiedError(DeployError):
    """The new program was deployed and started, and ended during the watch."""

    exit_code = 3


#: The exit code if the robot has, or may have, the new program, and it was not confirmed to run.
CHANGED = 4


class NotSeenToRunError(DeployError):
    """The program was started, and was still starting at the end of the watch."""

    exit_code = CHANGED
