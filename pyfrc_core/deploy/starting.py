"""Starting what is current on the robot, watching its first seconds, and going back when it ends in them."""

from __future__ import annotations

from .errors import ProgramDiedError
from .facts import Watched
from .progress import Conversation
from .robot import Robot

#: Seconds in which a program has to say that it has started, or to end, for that to be seen.
WATCH_SECONDS = 5.0

_NOTHING_HEARD = "(robots tell what a program prints only while a Driver Station is connected to them)"
_GO_BACK = "Go back to the program before with: pyfrc deploy --rollback"


def start(robot: Robot, talk: Conversation, previous: int | None, auto_rollback: bool = False) -> None:
    """Start the new program, and see it through its first seconds.

    :param previous: the release to go back to, if there is one
    :param auto_rollback: go back when it ends at once, without asking
    :raises ProgramDiedError: when it ends at once; the one before runs again when that was wanted
    """
    watched = _restart(robot, talk)
    if watched.alive:
        return
    talk.progress.output(watched.traceback or watched.output or _NOTHING_HEARD)
    what = "the new program ended at once"
    if previous is None:
        raise ProgramDiedError(what, remedy="There is no program before to go back to: correct it, and deploy again.")
    if auto_rollback or (talk.ask and talk.ask.yes(f"{what.capitalize()}. Go back to release {previous}?")):
        release = go_back(robot, talk, previous)
        raise ProgramDiedError(f"{what}; release {release} runs again")
    raise ProgramDiedError(what, remedy=_GO_BACK)


def go_back(robot: Robot, talk: Conversation, release: int | None) -> int:
    """Make an earlier release current and start it; its number.

    :raises ProgramDiedError: when that ends at once, as well
    """
    with talk.progress.phase("back") as phase:
        back = robot.rollback(release)
        phase.detail = f"to release {back.release.number}"
    if back.changed:
        talk.progress.note(f"  the program itself had changed of it: {', '.join(map(ascii, back.changed))}")
    watched = _restart(robot, talk)
    if not watched.alive:
        talk.progress.output(watched.traceback or watched.output or _NOTHING_HEARD)
        raise ProgramDiedError(
            f"release {back.release.number} is current again, but ended at once",
            remedy="Choose another with --rollback ID: pyfrc deploy-info lists them.",
        )
    return back.release.number


def _restart(robot: Robot, talk: Conversation) -> Watched:
    with talk.progress.phase("start") as phase:
        robot.restart()
        watched = robot.watch(WATCH_SECONDS)
        if not watched.alive:
            phase.detail = "it ended at once"
        else:
            phase.detail = "the program runs" if watched.started else f"the program runs, after {WATCH_SECONDS:g} s"
    return watched
