"""No process that robot code ends takes an error with it, in whatever order its messages and its end are seen."""

from __future__ import annotations

import os

import pytest
from conftest import MakeProject

from pyfrc_core.errors import RobotCodeError
from pyfrc_core.processes import fork
from pyfrc_core.processes.call import ForkedCall
from pyfrc_core.processes.exit import exit_now
from pyfrc_core.processes.fork import FORK_IS_SAFE
from pyfrc_core.project import Project

only_forked = pytest.mark.skipif(not FORK_IS_SAFE, reason="no fork")

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        pass
"""
TESTS = """
    import os

    import pytest


    @pytest.fixture
    def ends_late():
        yield
        os._exit(3)


    @pytest.fixture(scope="module")
    def shared():
        yield
        raise LookupError("a shared teardown")


    def test_late(control, ends_late):
        pass


    def test_both(control, ends_late):
        raise LookupError("in the call")


    def test_shared(control, shared):
        pass
"""


EACH_ISOLATION = [pytest.param("reuse", marks=pytest.mark.slow), pytest.param("fork", marks=only_forked)]


@pytest.mark.parametrize("isolation", EACH_ISOLATION)
def test_failures_after_a_test_has_been_called(isolation: str, make_project: MakeProject) -> None:
    """In a fixture's teardown: the test's own report of its call has been sent by then."""
    project = make_project({"robot.py": ROBOT, "tests/test_robot.py": TESTS})
    result = project.run("test", "--isolation", isolation)
    assert result.code == 1, result.output
    assert (
        f"{project.place('tests/test_robot.py', 'os._exit(3)')}: the robot's process ended itself with exit code 3"
        in (result.stdout)
    )
    assert "LookupError: a shared teardown" in result.stdout
    assert "LookupError: in the call" in result.stdout
    assert "1 failed, 2 passed, 3 errors" in result.stdout


def finished(work: ForkedCall[object], polled: bool) -> None:
    """Wait until the process has ended; whether or not its answer was read meanwhile."""
    if polled:
        while not work.finished:
            fork.wait_for_any([work.fileno()])
            work.poll()
    else:
        os.waitid(os.P_PID, work._worker._fork._pid, os.WEXITED | os.WNOWAIT)
        work.poll()


@only_forked
@pytest.mark.parametrize("polled", [True, False])
def test_an_answer_comes_before_the_exit(polled: bool, make_project: MakeProject) -> None:
    project = Project(make_project({"robot.py": ROBOT}).path / "robot.py")
    work: ForkedCall[object] = ForkedCall(lambda words: "the answer")
    finished(work, polled)
    assert work.result(project.files, "meanwhile") == "the answer"
    work.close()


@only_forked
def test_a_process_that_dies_in_the_middle_of_its_answer(
    make_project: MakeProject, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As when a thread of the robot's calls `os._exit` meanwhile."""
    project = Project(make_project({"robot.py": ROBOT}).path / "robot.py")
    write_all = fork.write_all

    def cut(descriptor: int, data: bytes) -> None:
        write_all(descriptor, data[: len(data) // 2])
        exit_now(5)

    monkeypatch.setattr(fork, "write_all", cut)
    work: ForkedCall[object] = ForkedCall(lambda words: "the answer" * 1000)
    finished(work, polled=True)
    with pytest.raises(RobotCodeError, match="exit code 5, in the middle of the match"):
        work.result(project.files, "in the middle of the match")
    work.close()
