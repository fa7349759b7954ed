"""What can go wrong between the laptop and the robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..errors import PyfrcError

if TYPE_CHECKING:
    from .discovery import Tried


class DeployError(PyfrcError):
    """The robot has not been changed, or starts a whole program all the same; the message says what to do."""


class RobotNotFoundError(DeployError):
    """No robot has answered at any of the addresses tried: `tried` has them, with the reasons."""

    tried: tuple[Tried, ...] = ()


class ConnectionFailedError(DeployError):
    """The robot has answered, but does not let us in; or the link to it was lost."""


class StoppedError(DeployError):
    """The user has pressed Ctrl-C when the robot was being changed; the message says what is so now."""

    exit_code = 2


class HostKeyError(DeployError):
    """The robot's key is not the one that this project knows."""


class OnTheFieldError(DeployError):
    """The Driver Station is connected to a competition field, where robots are not to be changed."""


class RefusedError(DeployError):
    """Something is wrong with the project or the robot, found before anything was changed."""


class ProgramDiedError(DeployError):
    """The new program was deployed and started, and has ended at once."""

    exit_code = 3
