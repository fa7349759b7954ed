"""What can go wrong between the laptop and the robot."""

from __future__ import annotations

from ..errors import PyfrcError


class DeployError(PyfrcError):
    """The robot has not been changed, or starts a whole program all the same; the message says what to do."""


class ConnectionFailedError(DeployError):
    """The robot has answered, but does not let us in; or the link to it was lost."""


class NoConsoleError(DeployError):
    """What listens at the console's port is not a robot's console."""


class StoppedError(DeployError):
    """The user has pressed Ctrl-C when the robot was being changed; the message says what is so now."""

    exit_code = 2


class HostKeyError(DeployError):
    """The robot's key is not the one that this project knows."""


class KeyFileError(DeployError):
    """The file with the keys of robots cannot be read or written."""


class OnTheFieldError(DeployError):
    """The Driver Station is connected to a competition field, where robots are not to be changed."""


class RefusedError(DeployError):
    """Something is wrong with the project or the robot, found before anything was changed."""


class LockedError(RefusedError):
    """Another computer is changing the robot's programs; this command has changed nothing."""


class NoPythonError(RefusedError):
    """There is no Python on the robot."""


class ProgramDiedError(DeployError):
    """The new program was deployed and started, and has ended while it was watched."""

    exit_code = 3


#: The exit code of an error after which the robot has, or may have, the new program, which was not seen to run.
CHANGED = 4


class NotSeenToRunError(DeployError):
    """The program was started, and was still starting at the end of the watch."""

    exit_code = CHANGED
