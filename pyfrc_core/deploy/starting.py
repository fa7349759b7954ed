"""Starting the current release, watching its start, and rolling back if it ends."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

from .agent import start_monitor
from .agent_client import AgentClient
from .errors import DeployError, NotSeenToRunError, ProgramDiedError, RefusedError
from .facts import StartState, Watched
from .progress import Phase, UserInterface
from .robot_checks import named

#: Seconds after which a program is reported as still starting. On a robot of 667 MHz, imports take 5 to 10 s, large
#: libraries 5 s more, and a `robotInit` that configures twenty devices 5 to 10 s: 25 s in all. The limit is more than
#: twice as long.
WATCH_SECONDS = 60.0
#: Seconds after which a program with a silent console is judged by its process alone: enough for the imports, and for a
#: crash 6 s after them.
UNHEARD_SECONDS = 20.0

_NOTE_SECONDS = 10  # between two notes about a slow start
_LINES_SHOWN = 20  # of a program without a traceback
_NO_OUTPUT = "(no output of the program was received: a robot's console may be silent without a Driver Station)"
_GO_BACK = "Go back to the previous program with: pyfrc deploy --rollback"


def start(
    robot: AgentClient,
    talk: UserInterface,
    previous: int | None,
    auto_rollback: bool = False,
    reinstall: Callable[[], int | None] | None = None,
) -> str:
    """Start the new program, and watch its start. Return the verdict, ``running`` or ``unheard``.

    :param previous: the release for a rollback, if there is one
    :param auto_rollback: roll back without asking if the program ends
    :param reinstall: is called if the program ends and its code or packages are damaged on the robot: sends them again,
        and returns the release for a rollback
    :raises ProgramDiedError: if it ends; after a rollback, the previous program runs again
    :raises NotSeenToRunError: if it is still starting at the end of the watch
    """
    watched = _restart(robot, talk)
    if reinstall is not None and not watched.alive and _note_damage(robot, talk):
        previous = reinstall()
        watched = _restart(robot, talk)
    if watched.verdict == start_monitor.STARTING:
        raise _still_starting(watched, "the new program was started")
    if watched.alive:
        return watched.verdict
    what = f"the new program {_end_of(watched)}"
    if previous is None:
        raise ProgramDiedError(
            what, remedy="There is no earlier program to go back to: correct the program, and deploy again."
        )
    if auto_rollback or (talk.ask and talk.ask.yes(f"{what.capitalize()}. Go back to release {previous}?")):
        try:
            release = go_back(robot, talk, previous, only_from_deployed=True)
        except DeployError as error:
            remedy = error.remedy
            if not isinstance(error, (RefusedError, ProgramDiedError, NotSeenToRunError)):
                # Its own is to repeat the command, which would deploy the crashing program again.
                remedy = None if robot.recovery_hint else _GO_BACK
            raise ProgramDiedError(f"{what}; {error.message}", where=error.where, remedy=remedy) from error
        raise ProgramDiedError(f"{what}; release {release} runs again")
    raise ProgramDiedError(what, remedy=_GO_BACK)


def go_back(robot: AgentClient, talk: UserInterface, release: int | None, *, only_from_deployed: bool = False) -> int:
    """Make an earlier release current, start it, and return its number.

    :param release: its number; default: the release that the robot selects
    :param only_from_deployed: refuse if another computer has replaced the release that this one has deployed
    :raises ProgramDiedError: if it ends as well
    :raises NotSeenToRunError: if it is still starting at the end of the watch
    """
    with talk.progress.phase("back") as phase:
        back = robot.rollback(release, phase.work, only_from_deployed=only_from_deployed)
        phase.detail = f"to release {back.release.number}"
    if back.changed:
        talk.progress.note(f"  files that the program has changed: {', '.join(map(ascii, back.changed))}")
    watched = _restart(robot, talk)
    if watched.verdict == start_monitor.STARTING:
        raise _still_starting(watched, f"release {back.release.number} is current again and was started")
    if not watched.alive:
        _note_damage(robot, talk)
        raise ProgramDiedError(
            f"release {back.release.number} is current again, but {_end_of(watched)}",
            remedy="Choose another with --rollback ID: pyfrc deploy-info lists them.",
        )
    return back.release.number


def _note_damage(robot: AgentClient, talk: UserInterface) -> bool:
    """Return whether code on the robot differs from what was deployed or installed, and name it."""
    with suppress(DeployError):  # the program's end is what matters
        if different := robot.check():
            text = f"  damaged on the robot's disk: {named(different)}. To send it again: pyfrc deploy --reinstall"
            talk.progress.note(text)
            return True
    return False


def _restart(robot: AgentClient, talk: UserInterface) -> Watched:
    with talk.progress.phase("start") as phase:
        if robot.restart():
            talk.progress.note(f"  {robot.stop_command} did not end the old program; it was killed")
        reporter = _StateReporter(talk, phase)
        watched = robot.watch(WATCH_SECONDS, on_state=reporter.show, unheard=UNHEARD_SECONDS)
        state = watched.state
        phase.detail = {
            start_monitor.RUNNING: "the program runs",
            start_monitor.UNHEARD: f"its process has run for {state.age:.0f} s",
            start_monitor.STARTING: f"still starting after {state.seconds:.0f} s",
        }.get(watched.verdict, f"it {_end_of(watched)}")
    if watched.verdict == start_monitor.UNHEARD:
        why = "its console is silent, which is normal without a Driver Station"
        if state.has_output:
            why = "a main loop of its own, such as a MagicRobot's, does not report the end of its start"
        talk.progress.note(f"  judged by its process alone: {why}; {_known_of(state)}")
    if watched.alive and state.lived:
        talk.progress.note(
            f"  its first process ended after {state.lived:.1f} s, and the robot restarted it: see pyfrc console"
        )
    if watched.verdict in (start_monitor.ENDED, start_monitor.STARTING):
        raised = watched.verdict == start_monitor.ENDED and watched.fatal_error is None
        ended = watched.traceback if raised else None
        last = "\n".join(watched.output.splitlines()[-_LINES_SHOWN:])
        talk.progress.output(ended or last or _NO_OUTPUT)
    return watched


class _StateReporter:
    """Shows the program's state each second, and prints a note every ten seconds."""

    def __init__(self, talk: UserInterface, phase: Phase) -> None:
        self._progress = talk.progress
        self._phase = phase
        self._next = _NOTE_SECONDS

    def show(self, state: StartState) -> None:
        self._phase.doing(f"{state.seconds:.0f} s; {_known_of(state)}")
        if state.seconds >= self._next:
            how = "still starting" if state.has_output else "no output"
            self._progress.note(f"  {how} after {state.seconds:.0f} s: {_known_of(state)}")
            self._next = (int(state.seconds) // _NOTE_SECONDS + 1) * _NOTE_SECONDS


def _still_starting(watched: Watched, what: str) -> NotSeenToRunError:
    """Return the error for a program that has neither started nor ended within the time limit."""
    return NotSeenToRunError(
        f"{what}, and is still starting after {watched.state.seconds:.0f} s: {_known_of(watched.state)}",
        remedy=f"It may be slow, or waiting for something. To see its output: pyfrc console. {_GO_BACK}",
    )


def _known_of(state: StartState) -> str:
    if not state.age:
        return "the robot has not started it again yet" if state.seen else "the robot has not started it yet"
    known = f"its process has run for {state.age:.0f} s"
    if state.cpu is not None:
        known += f", has used {state.cpu:.1f} s of processor time"
    if state.network_tables is not None:
        serves = "serves NetworkTables (its imports are complete)"
        known += f" and {serves if state.network_tables else 'does not serve NetworkTables yet'}"
    return known


def _end_of(watched: Watched) -> str:
    """Return how a program has ended, as a predicate for a sentence."""
    if not watched.state.seen:
        return "was not started by the robot, or ended immediately"
    why = "" if watched.fatal_error is None else f", by a crash in C code ({watched.fatal_error})"
    return f"ended after {watched.state.lived:.1f} s{why}"
