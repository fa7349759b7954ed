"""Messages and exit codes of a deploy about the start of the program."""

from __future__ import annotations

import contextlib
import io
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, Cut, LocalRobot, project_of

from pyfrc_core.deploy import recovery_hints
from pyfrc_core.deploy.agent.host import age_of
from pyfrc_core.deploy.agent.start_monitor import ENDED, RUNNING, STARTING, UNHEARD
from pyfrc_core.deploy.agent_client import AgentClient
from pyfrc_core.deploy.errors import (
    ConnectionFailedError,
    DeployError,
    NotSeenToRunError,
    ProgramDiedError,
    RefusedError,
    StoppedError,
)
from pyfrc_core.deploy.facts import DeployRequest, Release, RolledBack, StartState, Watched
from pyfrc_core.deploy.manifest import Manifest
from pyfrc_core.deploy.progress import DeployProgress, Questions, UserInterface
from pyfrc_core.deploy.recovery_hints import RecoveryHint, explain_interruption
from pyfrc_core.deploy.starting import go_back, start

REQUEST = DeployRequest("robot.py", {})
TRACEBACK = "Traceback (most recent call last):\n  File robot.py\nRuntimeError: no such gyro\n"
CRASHED = Watched(ENDED, TRACEBACK, StartState(seconds=4.5, lived=4.1, has_output=True, seen=True))
RUNS = Watched(RUNNING, "", StartState(seconds=1.0, age=1.0, has_output=True, seen=True))
SLOW = Watched(
    STARTING,
    "looking for the camera\n",
    StartState(seconds=60.0, age=60.0, has_output=True, seen=True, cpu=7.25, network_tables=True),
)
SILENT = Watched(UNHEARD, "", StartState(seconds=20.0, age=20.0, seen=True, cpu=7.25, network_tables=False))


class Watching(AgentClient):
    """A robot on which programs do as listed, one after the other."""

    def __init__(self, *watched: Watched | DeployError) -> None:
        self._watched = list(watched)
        self.recovery_hint: RecoveryHint | None = None
        self.went_back_to: list[int | None] = []
        self.states: list[StartState] = []
        self.different: list[tuple[str, ...]] = []

    def restart(self) -> None:
        self.recovery_hint = recovery_hints.started(2, 1)

    def watch(self, seconds, on_output=None, on_state=None, unheard=None) -> Watched:  # type: ignore[no-untyped-def]
        watched = self._watched.pop(0)
        if isinstance(watched, DeployError):
            raise watched
        for state in self.states:
            on_state(state)
        self.recovery_hint = None
        return watched

    def check(self, on_progress=None) -> tuple[str, ...]:  # type: ignore[no-untyped-def]
        return self.different.pop(0) if self.different else ()

    def rollback(self, release=None, on_progress=None, *, only_from_deployed=False) -> RolledBack:  # type: ignore[no-untyped-def]
        self.went_back_to.append(release)
        self.recovery_hint = recovery_hints.rolled_back(1)
        return RolledBack(Release(1, False, "robot.py", False, 1, None, {}), 2, ())


@pytest.fixture
def shown() -> io.StringIO:
    return io.StringIO()


@pytest.fixture
def talk(shown: io.StringIO) -> UserInterface:
    return UserInterface(DeployProgress(shown))


def test_a_crash_is_shown_with_its_traceback_and_goes_back(talk: UserInterface, shown: io.StringIO) -> None:
    robot = Watching(CRASHED, RUNS)
    with pytest.raises(ProgramDiedError, match=r"^the new program ended after 4.1 s; release 1 runs again$") as caught:
        start(robot, talk, 1, auto_rollback=True)
    assert caught.value.exit_code == 3
    assert robot.went_back_to == [1]
    assert "| RuntimeError: no such gyro" in shown.getvalue()


def test_the_user_decides_whether_to_go_back(talk: UserInterface) -> None:
    asked: list[str] = []

    def answer(yes: bool) -> UserInterface:
        return UserInterface(talk.progress, Questions(text=str, yes=lambda question: asked.append(question) or yes))  # type: ignore[func-returns-value]

    with pytest.raises(ProgramDiedError, match=r"^the new program ended after 4.1 s; release 1 runs again$"):
        start(Watching(CRASHED, RUNS), answer(True), 1)
    robot = Watching(CRASHED)
    with pytest.raises(
        ProgramDiedError, match=r"^the new program ended after 4.1 s\n  Go back to the previous program with"
    ):
        start(robot, answer(False), 1)
    assert robot.went_back_to == []
    assert asked == ["The new program ended after 4.1 s. Go back to release 1?"] * 2
    with pytest.raises(
        ProgramDiedError, match=r"4.1 s\n  There is no earlier program to go back to: correct the program"
    ):
        start(Watching(CRASHED), answer(True), None, auto_rollback=True)


def test_a_crash_in_c_code_is_named(talk: UserInterface, shown: io.StringIO) -> None:
    printed = f'{TRACEBACK}Fatal Python error: Segmentation fault\n\n  File "robot.py", line 4 in robotInit\n'
    watched = replace(CRASHED, output=printed)
    with pytest.raises(ProgramDiedError, match=r"ended after 4.1 s, by a crash in C code \(Segmentation fault\)"):
        start(Watching(watched), talk, 1)
    assert "line 4 in robotInit" in shown.getvalue()


def test_a_slow_start_is_not_a_success_and_causes_no_rollback(talk: UserInterface, shown: io.StringIO) -> None:
    robot = Watching(SLOW)
    with pytest.raises(NotSeenToRunError) as caught:
        start(robot, talk, 1, auto_rollback=True)
    assert caught.value.exit_code == 4
    assert caught.value.message == (
        "the new program was started, and is still starting after 60 s: its process has run for 60 s, "
        "has used 7.2 s of processor time and serves NetworkTables (its imports are complete)"
    )
    assert "pyfrc console" in str(caught.value.remedy)
    assert "| looking for the camera" in shown.getvalue()
    assert robot.went_back_to == []


def test_with_a_silent_console_a_note_explains_the_verdict(talk: UserInterface, shown: io.StringIO) -> None:
    start(Watching(SILENT), talk, 1)
    assert "its process has run for 20 s " in shown.getvalue()
    assert "judged by its process alone" in shown.getvalue()
    assert "its console is silent, which is normal without a Driver Station" in shown.getvalue()
    assert "does not serve NetworkTables yet" in shown.getvalue()
    start(Watching(replace(SILENT, state=replace(SILENT.state, has_output=True))), talk, 1)
    assert "a main loop of its own, such as a MagicRobot's, does not report the end of its start" in shown.getvalue()


def test_a_first_process_that_ended_is_reported(talk: UserInterface, shown: io.StringIO) -> None:
    """One may end right after the restart since two start it; or it crashed, and did not crash again."""
    start(Watching(Watched(UNHEARD, "", StartState(seconds=20.4, age=20.0, lived=0.3, seen=True))), talk, 1)
    assert "its first process ended after 0.3 s, and the robot restarted it" in shown.getvalue()


def test_a_long_start_prints_notes(talk: UserInterface, shown: io.StringIO) -> None:
    robot = Watching(RUNS)
    robot.states = [
        StartState(seconds=float(each), age=float(each), has_output=each > 15, seen=True) for each in range(45)
    ]
    start(robot, talk, 1)
    lines = [line for line in shown.getvalue().splitlines() if " after " in line]
    assert [line.partition(":")[0] for line in lines] == [
        "  no output after 10 s",
        "  still starting after 20 s",
        "  still starting after 30 s",
        "  still starting after 40 s",
    ]


@pytest.mark.parametrize(
    ("then", "says"),
    [
        (CRASHED, "; release 1 is current again, but ended after 4.1 s"),
        (SLOW, "; release 1 is current again and was started, and is still starting after 60 s"),
        (ConnectionFailedError("the connection to the robot was lost"), "; the connection to the robot was lost; "),
    ],
    ids=["crashes", "slow", "link"],
)
def test_a_crash_is_a_crash_however_going_back_ends(
    then: Watched | DeployError, says: str, talk: UserInterface
) -> None:
    robot = Watching(CRASHED, then)
    with pytest.raises(ProgramDiedError) as caught, explain_interruption(robot):
        start(robot, talk, 1, auto_rollback=True)
    assert caught.value.exit_code == 3
    assert caught.value.message.startswith(f"the new program ended after 4.1 s{says}")


def test_ctrl_c_during_the_watch_reports_how_long_the_program_has_run() -> None:
    robot = Watching()
    robot.recovery_hint = recovery_hints.started(2, 1, StartState(seconds=13.0, age=12.0, seen=True))
    says = r"release 2 was started, but not confirmed to run; its process has run for 12 s"
    with pytest.raises(StoppedError, match=says), explain_interruption(robot):
        raise KeyboardInterrupt


def test_going_back_is_watched_in_the_same_way(talk: UserInterface) -> None:
    assert go_back(Watching(RUNS), talk, 1) == 1
    assert go_back(Watching(SILENT), talk, None) == 1
    for watched, code in ((CRASHED, 3), (SLOW, 4)):
        with pytest.raises(DeployError) as caught:
            go_back(Watching(watched), talk, None)
        assert caught.value.exit_code == code


DAMAGED = ("arm.py", "lib/python3.14/site-packages/rev.py", "c")
NAMED = "damaged on the robot's disk: arm.py, lib/python3.14/site-packages/rev.py and 1 more"


def test_what_is_damaged_is_sent_again_and_started_again(talk: UserInterface) -> None:
    robot, sent = Watching(CRASHED, RUNS), []
    robot.different = [DAMAGED]
    assert start(robot, talk, None, reinstall=lambda: sent.append(True)) == RUNNING
    assert sent == [True]


def test_a_program_that_ends_after_that_too_is_gone_back_from(talk: UserInterface) -> None:
    robot = Watching(CRASHED, CRASHED, RUNS)
    robot.different = [DAMAGED, DAMAGED]
    with pytest.raises(ProgramDiedError, match="release 1 runs again"):
        start(robot, talk, None, auto_rollback=True, reinstall=lambda: 3)
    assert robot.went_back_to == [3]


def test_what_is_damaged_is_named_after_a_rollback_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    robot = Watching(CRASHED)
    robot.different = [DAMAGED]
    printed = io.StringIO()
    with pytest.raises(ProgramDiedError, match="is current again, but ended"):
        go_back(robot, UserInterface(DeployProgress(printed), None), 1)
    assert f"{NAMED}. To send it again: pyfrc deploy --reinstall" in printed.getvalue()


# -- exit codes of failures on the way: 1 only where the robot has the program that it had ---------------------------


@pytest.fixture
def project(tmp_path: Path) -> Manifest:
    return project_of(tmp_path / "project", {"robot.py": ROBOT_PY})


@contextlib.contextmanager
def failing(robot: AgentClient, code: int, says: str) -> Iterator[pytest.ExceptionInfo[DeployError]]:
    with pytest.raises(DeployError) as caught, explain_interruption(robot):
        yield caught
    assert (caught.value.exit_code, says in caught.value.message) == (code, True), caught.value


def changed(project: Manifest) -> Manifest:
    return project_of(project.entries[0].file.parent, {"robot.py": ROBOT_PY + "# 2\n"})


def test_a_restart_that_fails_after_the_change(robot: LocalRobot, project: Manifest) -> None:
    robot.deploy(project)
    (robot.root / "usr/local/frc/bin/frcKillRobot.sh").chmod(0o644)
    with contextlib.closing(robot.start()) as agent:
        agent.deploy(changed(project), REQUEST)
        with failing(agent, 4, "; release 2 is on the robot"):
            agent.restart()
        agent.rollback()
        with failing(agent, 4, "; the robot will start release 1 when it is switched on"):
            agent.restart()
        with failing(agent, 4, "; the robot's program and some of its releases may have been removed"):
            agent.undeploy()


def test_a_failure_right_after_the_change(robot: LocalRobot, project: Manifest) -> None:
    (robot.root / "tmp").rmdir()
    (robot.root / "tmp").write_text("no directory, so that debugging cannot be switched on")
    with contextlib.closing(robot.start()) as agent, failing(agent, 4, "; release 1 is on the robot"):
        agent.deploy(project, DeployRequest("robot.py", {}, debug=True))


def test_a_link_that_is_lost_from_the_change_on(robot: LocalRobot, project: Manifest) -> None:
    def lose(phase: str, done: int, total: int) -> None:
        if phase == "switch":
            raise ConnectionFailedError("the connection to the robot was lost")

    with pytest.raises(ConnectionFailedError) as caught:
        robot.deploy(project, cut_to_robot=100)
    assert caught.value.exit_code == 1
    with (
        contextlib.closing(robot.start()) as agent,
        failing(agent, 4, "; the robot was switching"),
    ):
        agent.deploy(project, REQUEST, lose)


def test_whatever_is_lost_with_a_link_a_changed_robot_is_not_called_unchanged(
    robot: LocalRobot, project: Manifest, tmp_path: Path
) -> None:
    """The report that the switch begins may be lost, too; until the last contents are sent, there is no switch."""
    project = project_of(tmp_path / "project", {"robot.py": ROBOT_PY, "noise.bin": os.urandom(200_000)})
    whole = robot.copy(tmp_path / "whole")
    with contextlib.closing(whole.start()) as agent:
        before = whole.channel.bytes_from_robot
        agent.deploy(project, REQUEST)
    codes = set()

    def cut(**cut: int) -> None:
        tried = robot.copy(tmp_path / "tried")
        with contextlib.suppress(DeployError), contextlib.closing(tried.start(**cut)) as agent:
            try:
                with explain_interruption(agent):
                    agent.deploy(project, REQUEST)
            except DeployError as error:
                codes.add((error.exit_code, tried.startable() is not None))

    # What robots send differs by some bytes: at either end, a link may be lost before, or never.
    for place in range(before, whole.channel.bytes_from_robot, 7):
        cut(cut_from_robot=place)
    cut(cut_to_robot=whole.channel.bytes_to_robot // 2)
    assert (1, True) not in codes
    assert {(1, False), (4, True)} <= codes


# -- the agent ---------------------------------------------------------------------------------------------------------


def test_going_back_on_a_robot_without_releases(robot: LocalRobot) -> None:
    with contextlib.closing(robot.start()) as agent, pytest.raises(RefusedError) as caught:
        agent.rollback()
    assert caught.value.message == "there is no earlier release on the robot to go back to"
    assert caught.value.remedy == "It has no releases yet: each pyfrc deploy adds one."


def test_going_back_leaves_what_another_computer_has_deployed_meanwhile(
    robot: LocalRobot, project: Manifest, talk: UserInterface
) -> None:
    """While the user is asked about the rollback, the lock is free."""
    robot.deploy(project)

    def yes(question: str) -> bool:
        assert question.endswith("Go back to release 1?")
        theirs = project_of(project.entries[0].file.parent, {"robot.py": ROBOT_PY + "# theirs\n"})
        assert robot.deploy(theirs).release == 3
        return True

    asking = UserInterface(talk.progress, Questions(text=str, yes=yes))
    with contextlib.closing(robot.start(runs=False)) as agent:
        agent.deploy(changed(project), REQUEST)
        with failing(agent, 3, "the robot has release 3, no longer release 2") as caught:
            start(agent, asking, 1)
    assert (robot.home / "py").resolve().name == "3"
    assert "may still run" not in caught.value.message
    assert "pyfrc deploy --rollback 1" in str(caught.value.remedy)


def test_a_link_that_is_lost_while_going_back_does_not_suggest_to_deploy_again(
    robot: LocalRobot, project: Manifest, talk: UserInterface
) -> None:
    """That would deploy the crashing program."""
    robot.deploy(project)
    with contextlib.closing(robot.start(runs=False)) as agent:
        agent.deploy(changed(project), REQUEST)

        def sendall(data: bytes) -> None:
            raise Cut

        def lose(question: str) -> bool:
            robot.channel.sendall = sendall  # type: ignore[method-assign]
            return True

        with failing(agent, 3, "; the robot may have switched to release 1, but may still run") as caught:
            start(agent, UserInterface(talk.progress, Questions(text=str, yes=lose)), 1)
    assert "again" not in str(caught.value.remedy)
    assert "pyfrc deploy --rollback 1" in str(caught.value.remedy)


def test_a_process_that_the_kill_script_leaves_in_the_background_is_not_waited_for(
    robot: LocalRobot, project: Manifest, tmp_path: Path
) -> None:
    """It keeps the script's output open."""
    left = tmp_path / "left"
    script = robot.root / "usr/local/frc/bin/frcKillRobot.sh"
    script.write_text(f"#!/bin/sh\nsleep 600 &\necho $! > {left}\n")
    with contextlib.closing(robot.start()) as agent:
        agent.deploy(project, REQUEST)
        agent.restart()
    process = int(left.read_text())
    os.kill(process, signal.SIGKILL)  # it lived


def test_a_program_is_as_old_as_its_oldest_process() -> None:
    if not Path("/proc/uptime").exists():
        pytest.skip("when a process began is in /proc")
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as child:
        child_age, own_age, age = age_of([child.pid]), age_of([os.getpid()]), age_of([child.pid, os.getpid()])
        child.communicate(b"\n")
    assert child_age is not None
    assert own_age is not None
    assert age is not None
    assert child_age <= own_age <= age
