"""Starting what is current on the robot, watching its start, and going back when it ends."""

from __future__ import annotations

from .agent import watching
from .errors import ConnectionFailedError, DeployError, NotSeenToRunError, ProgramDiedError
from .facts import StartState, Watched
from .progress import Conversation, Phase
from .robot import Robot

#: Seconds after which a program is reported as still starting. On a roboRIO (667 MHz), imports take 5 to 10 s, and
#: those of large libraries 5 s more; a `robotInit` that configures twenty devices takes 5 to 10 s. That is 25 s, and
#: twice as much is within the limit.
WATCH_SECONDS = 60.0
#: Seconds after which a program whose console is silent is judged by its process alone: the imports, and a crash 6 s
#: after them, are within it.
UNHEARD_SECONDS = 20.0

_NOTE_SECONDS = 10  # between two lines about a start that takes long
_LINES_SHOWN = 20  # of a program without a traceback
_NOTHING_HEARD = (
    "(nothing that the program prints has arrived: a robot's console may be silent without a Driver Station)"
)
_GO_BACK = "Go back to the program before with: pyfrc deploy --rollback"


def start(robot: Robot, talk: Conversation, previous: int | None, auto_rollback: bool = False) -> str:
    """Start the new program, and watch until it has started; the verdict, ``running`` or ``unheard``.

    :param previous: the release to go back to, if there is one
    :param auto_rollback: go back when it ends, without asking
    :raises ProgramDiedError: when it ends; the one before runs again when that was wanted
    :raises NotSeenToRunError: when it is still starting at the end of the watch
    """
    watched = _restart(robot, talk)
    if watched.verdict == watching.STARTING:
        raise _still_starting(watched, "the new program was started")
    if watched.alive:
        return watched.verdict
    what = f"the new program {_end_of(watched.state)}"
    if previous is None:
        raise ProgramDiedError(what, remedy="There is no program before to go back to: correct it, and deploy again.")
    if auto_rollback or (talk.ask and talk.ask.yes(f"{what.capitalize()}. Go back to release {previous}?")):
        try:
            release = go_back(robot, talk, previous)
        except DeployError as error:
            # After a lost link, the same command again would deploy the crashing program again.
            remedy = None if isinstance(error, ConnectionFailedError) else error.remedy
            raise ProgramDiedError(f"{what}; {error.message}", where=error.where, remedy=remedy) from error
        raise ProgramDiedError(f"{what}; release {release} runs again")
    raise ProgramDiedError(what, remedy=_GO_BACK)


def go_back(robot: Robot, talk: Conversation, release: int | None) -> int:
    """Make an earlier release current and start it; its number.

    :raises ProgramDiedError: when that ends as well
    :raises NotSeenToRunError: when it is still starting at the end of the watch
    """
    with talk.progress.phase("back") as phase:
        back = robot.rollback(release, phase.work)
        phase.detail = f"to release {back.release.number}"
    if back.changed:
        talk.progress.note(f"  the program itself had changed of it: {', '.join(map(ascii, back.changed))}")
    watched = _restart(robot, talk)
    if watched.verdict == watching.STARTING:
        raise _still_starting(watched, f"release {back.release.number} is current again and was started")
    if not watched.alive:
        raise ProgramDiedError(
            f"release {back.release.number} is current again, but {_end_of(watched.state)}",
            remedy="Choose another with --rollback ID: pyfrc deploy-info lists them.",
        )
    return back.release.number


def _restart(robot: Robot, talk: Conversation) -> Watched:
    with talk.progress.phase("start") as phase:
        if robot.restart():
            talk.progress.note("  the old program went on after frcKillRobot.sh, and was ended")
        signs = _SignsOfLife(talk, phase)
        watched = robot.watch(WATCH_SECONDS, on_state=signs.show, unheard=UNHEARD_SECONDS)
        state = watched.state
        phase.detail = {
            watching.RUNNING: "the program runs",
            watching.UNHEARD: f"its process has run for {state.age:.0f} s",
            watching.STARTING: f"still starting after {state.seconds:.0f} s",
        }.get(watched.verdict, f"it {_end_of(state)}")
    if watched.verdict == watching.UNHEARD:
        why = "its console is silent, as a robot's may be without a Driver Station"
        if state.heard:
            why = "a MagicRobot does not report that its start is over"
        talk.progress.note(f"  judged by its process alone: {why}; {_known_of(state)}")
    if watched.alive and state.lived:
        talk.progress.note(
            f"  its first process ended after {state.lived:.1f} s, and the robot started it again: see pyfrc console"
        )
    if watched.verdict in (watching.ENDED, watching.STARTING):
        ended = watched.traceback if watched.verdict == watching.ENDED else None
        last = "\n".join(watched.output.splitlines()[-_LINES_SHOWN:])
        talk.progress.output(ended or last or _NOTHING_HEARD)
    return watched


class _SignsOfLife:
    """Shows each second that the watch goes on, and every ten seconds a line."""

    def __init__(self, talk: Conversation, phase: Phase) -> None:
        self._progress = talk.progress
        self._phase = phase
        self._next = _NOTE_SECONDS

    def show(self, state: StartState) -> None:
        self._phase.doing(f"{state.seconds:.0f} s; {_known_of(state)}")
        if state.seconds >= self._next:
            how = "still starting" if state.heard else "nothing heard"
            self._progress.note(f"  {how} after {state.seconds:.0f} s: {_known_of(state)}")
            self._next = (int(state.seconds) // _NOTE_SECONDS + 1) * _NOTE_SECONDS


def _still_starting(watched: Watched, what: str) -> NotSeenToRunError:
    """The error for a slow start: it is neither seen to run nor seen to end."""
    return NotSeenToRunError(
        f"{what}, and is still starting after {watched.state.seconds:.0f} s: {_known_of(watched.state)}",
        remedy=f"It may be slow, or wait for something. See what it prints with: pyfrc console. {_GO_BACK}",
    )


def _known_of(state: StartState) -> str:
    if not state.age:
        return "the robot has not started it again yet" if state.seen else "the robot has not started it yet"
    known = f"its process has run for {state.age:.0f} s"
    if state.cpu is not None:
        known += f", has used {state.cpu:.1f} s of processor time"
    if state.network_tables is not None:
        serves = "serves NetworkTables (its imports are over)"
        known += f" and {serves if state.network_tables else 'does not serve NetworkTables yet'}"
    return known


def _end_of(state: StartState) -> str:
    """How a program has ended, behind a subject."""
    if not state.seen:
        return "was not started by the robot, or ended before it was seen"
    return f"ended after {state.lived:.1f} s"
