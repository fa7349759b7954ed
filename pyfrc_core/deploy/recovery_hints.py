"""The robot's state during a deploy, explained to the user if the deploy is interrupted."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Protocol

from .errors import CHANGED, ConnectionFailedError, DeployError, StoppedError
from .facts import StartState


@dataclass(frozen=True)
class RecoveryHint:
    """The robot's state at one point of a deploy.

    :param state: a description for the user
    :param remedy: what the user can do
    """

    state: str
    remedy: str


_EITHER = (
    "when it is switched on, it will start either the new or the previous release, and it may already run the new one"
)
SWITCHING = RecoveryHint(
    f"the robot was switching to the new release: {_EITHER}",
    "Deploy again to start the new release: pyfrc deploy. To see which release the robot has: pyfrc deploy-info.",
)
MAYBE_SWITCHED = RecoveryHint(
    f"the robot may have switched to the new release: {_EITHER}",
    SWITCHING.remedy,
)
UNDEPLOYING = RecoveryHint(
    "the robot's program and some of its releases may have been removed",
    "Run the command again. To see what is on the robot: pyfrc deploy-info.",
)


def deployed(release: int | None, previous: int | None) -> RecoveryHint:
    """Return the hint for a release that is current and not started yet."""
    back = "" if previous is None else " Or go back to the previous release: pyfrc deploy --rollback."
    return RecoveryHint(
        f"release {release} is on the robot, which will start it when it is switched on, but may still run the "
        "previous program",
        f"Deploy again to start it now: pyfrc deploy.{back}",
    )


def rolling_back(release: int | None) -> RecoveryHint:
    """Return the hint for a switch to an earlier release.

    :param release: its number; None if the robot selects it
    """
    # Not the same command again: it may have been a deploy, and from the earlier release it would go back further.
    name = f"release {release}" if release else "an earlier release"
    return RecoveryHint(
        f"the robot may have switched to {name}, but may still run the program from before",
        f"To see which release the robot has: pyfrc deploy-info. To start {name}: "
        f"pyfrc deploy --rollback {release or 'ID'}.",
    )


def rolled_back(release: int) -> RecoveryHint:
    """Return the hint for an earlier release that is current again and not started yet."""
    return RecoveryHint(
        f"the robot will start release {release} when it is switched on, but may still run the previous program",
        f"To start it now: pyfrc deploy --rollback {release}.",
    )


def started(release: int | None, previous: int | None, state: StartState | None = None) -> RecoveryHint:
    """Return the hint for a program that was started and is being watched.

    :param state: its last known state
    """
    back = "" if previous is None else " To go back to the previous release: pyfrc deploy --rollback."
    seen = "" if state is None or not state.age else f"; its process has run for {state.age:.0f} s"
    return RecoveryHint(
        f"{f'release {release}' if release else 'the program'} was started, but not confirmed to run{seen}",
        f"To see whether it runs: pyfrc deploy-info.{back}",
    )


class HasRecoveryHint(Protocol):
    """Knows the robot's current state."""

    recovery_hint: RecoveryHint | None


@contextmanager
def explain_interruption(robot: HasRecoveryHint) -> Iterator[None]:
    """Add the robot's state to an error or Ctrl-C while the robot's program is being changed.

    :raises StoppedError: after Ctrl-C
    :raises DeployError: of the original class; its exit code shows that the robot was changed
    """
    try:
        yield
    except (KeyboardInterrupt, DeployError) as error:
        now = robot.recovery_hint
        if now is None:
            raise
        if isinstance(error, KeyboardInterrupt):
            raise StoppedError(f"interrupted; {now.state}", remedy=now.remedy) from error
        own_remedy = "" if isinstance(error, ConnectionFailedError) or not error.remedy else f"{error.remedy} "
        explained = type(error)(f"{error.message}; {now.state}", where=error.where, remedy=own_remedy + now.remedy)
        explained.exit_code = error.exit_code if error.exit_code != DeployError.exit_code else CHANGED
        raise explained from error
