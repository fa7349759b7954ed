"""What is so on the robot while its program is changed: for the user who is cut off, or has had enough, in between."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from .errors import CHANGED, ConnectionFailedError, DeployError, StoppedError

if TYPE_CHECKING:
    from .facts import StartState


@dataclass(frozen=True)
class Standing:
    """A moment at which a deploy may be cut short.

    :param what: what is so then
    :param remedy: what the user can do about it
    """

    what: str
    remedy: str


TAKES_OVER = Standing(
    "the new release is taking over: the robot starts it or the one before from now on, and still runs the one before",
    "Deploy again to have it started: pyfrc deploy. To see which it has: pyfrc deploy-info.",
)
MAY_TAKE_OVER = Standing(
    "the robot may have the new release already: it starts that one or the one before when it is switched on, and "
    "still runs the one before",
    TAKES_OVER.remedy,
)
GOES_BACK = Standing(
    "the robot may have gone back already, but still runs the program from before",
    "Run the command again. To see which release it has: pyfrc deploy-info.",
)
GOES_AWAY = Standing(
    "the robot may have no program any more, or only a part of its releases",
    "Run the command again. To see what it has: pyfrc deploy-info.",
)


OVERWRITES = Standing(
    "some of the program's files may have been overwritten already, and others not",
    "Run the command again, or deploy without --in-place.",
)


def deployed(release: int | None, previous: int | None) -> Standing:
    """It is on the robot, and has not been started there yet."""
    back = "" if previous is None else " Or go back to the one before: pyfrc deploy --rollback."
    return Standing(
        f"release {release} is on the robot, which starts it when it is switched on, but may still run the program "
        "from before",
        f"Deploy again to have it started now: pyfrc deploy.{back}",
    )


def went_back(release: int) -> Standing:
    """The same of an earlier release."""
    return Standing(
        f"the robot starts release {release} when it is switched on, but may still run the program from before",
        f"To have it started now: pyfrc deploy --rollback {release}.",
    )


def started(release: int | None, previous: int | None, state: StartState | None = None) -> Standing:
    """It was started, and is being watched.

    :param state: what was seen of it last
    """
    back = "" if previous is None else " To go back to the one before: pyfrc deploy --rollback."
    seen = "" if state is None or not state.age else f"; its process has run for {state.age:.0f} s"
    return Standing(
        f"{f'release {release}' if release else 'the program'} was started, but not seen to run{seen}",
        f"To see whether it does: pyfrc deploy-info.{back}",
    )


class Stands(Protocol):
    """Who knows what is so."""

    standing: Standing | None


@contextmanager
def told_what_is_so(robot: Stands) -> Iterator[None]:
    """Ctrl-C or a failure while the robot's program is being changed: the error says what is so now.

    Its exit code says that the robot was changed.
    """
    try:
        yield
    except (KeyboardInterrupt, DeployError) as error:
        now = robot.standing
        if now is None:
            raise
        if isinstance(error, KeyboardInterrupt):
            raise StoppedError(f"interrupted; {now.what}", remedy=now.remedy) from error
        own_remedy = "" if isinstance(error, ConnectionFailedError) or not error.remedy else f"{error.remedy} "
        told = type(error)(f"{error.message}; {now.what}", where=error.where, remedy=own_remedy + now.remedy)
        told.exit_code = error.exit_code if error.exit_code != DeployError.exit_code else CHANGED
        raise told from error
