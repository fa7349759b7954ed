"""Robot tests run in forks, whatever is installed and not used; where they cannot, the output gives the reason once."""

from __future__ import annotations

import sys

import pytest
from conftest import MakeProject, RobotProject

pytestmark = pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="tests are not forked here")

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        pass
"""

TESTS = """
    import os
    import sys


    def test_forked(control):
        assert not any("processes.spawn" in argument for argument in sys.orig_argv)


    def test_another(control):
        control.run_test(lambda tm: tm < 1)
"""

#: As pytest-rerunfailures does where pytest-xdist is installed, too, although neither is used.
PLUGIN = """
    import socket
    import threading


    def pytest_configure(config):
        server = socket.socket()
        server.bind(("127.0.0.1", 0))
        server.listen()
        threading.Thread(target=server.accept, name="server", daemon=True).start()
"""

#: As pytest-rerunfailures, which expects to have seen each test that is reported run in this process.
PLUGIN_WITH_A_PROTOCOL = """
    import pytest


    def pytest_runtest_protocol(item):
        return None  # nothing is to be repeated


    def pytest_runtest_setup(item):
        item.seen = True


    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(item):
        assert item.seen
        return (yield)
"""

FAILING_TEARDOWN = """
    import pytest


    @pytest.fixture(scope="session")
    def field():
        yield
        raise OSError("the field is stuck")


    def test_first(control, field):
        pass


    def test_second(control, field):
        pass
"""

#: A library with a thread of its own, from its import on.
LIBRARY = """
    import threading


    def grab():
        threading.Event().wait()


    threading.Thread(target=grab, name="frames", daemon=True).start()
"""

NO_FORK = """
    from pyfrc_core.processes import fork

    fork.FORK_IS_SAFE = False
"""


def run(project: RobotProject, *options: str) -> tuple[list[str], dict[str, str]]:
    """Run the project's tests with modules of other people's at hand; return what pyfrc explains, and the outcomes."""
    others = project.path.parent / "others"
    others.mkdir()
    for name, text in {
        "serving": PLUGIN,
        "protocol": PLUGIN_WITH_A_PROTOCOL,
        "vision_library": LIBRARY,
        "no_fork": NO_FORK,
    }.items():
        RobotProject(others, others).write({f"{name}.py": text})
    result = project.run("test", "--", "-v", *options, env={"PYTHONPATH": str(others)})
    outcomes = {name.rpartition("::")[2]: outcome for name, outcome in result.outcomes().items()}
    assert len(outcomes) == 2, result.output
    return [line for line in result.output.splitlines() if line.startswith("pyfrc: ")], outcomes


@pytest.mark.slow
def test_a_plugin_with_a_thread_of_its_own_changes_nothing(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": TESTS})
    assert run(project, "-p", "serving") == ([], {"test_forked": "PASSED", "test_another": "PASSED"})


def test_a_plugin_with_a_protocol_of_its_own_changes_nothing(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": FAILING_TEARDOWN})
    assert run(project, "-p", "protocol") == ([], {"test_first": "PASSED", "test_second": "ERROR"})


def test_a_thread_that_the_robot_starts_on_import_is_named_with_its_line(make_project: MakeProject) -> None:
    project = make_project({"robot.py": "    import vision_library\n" + ROBOT.lstrip("\n"), "tests/test_a.py": TESTS})
    (explained,), outcomes = run(project)
    assert "imports the robot again" in explained
    assert "robot.py:1 starts the thread 'frames', which runs vision_library.grab" in explained
    assert outcomes == {"test_forked": "FAILED", "test_another": "PASSED"}


@pytest.mark.slow
def test_a_device_in_the_robots_class_is_named(make_project: MakeProject) -> None:
    robot = ROBOT.replace("pass", "motor = wpilib.PWMSparkMax(3)")
    (explained,), _ = run(make_project({"robot.py": robot, "tests/test_a.py": TESTS}))
    assert "devices are made: pwm[3]" in explained


@pytest.mark.slow
def test_a_thread_of_a_test_file_is_named_with_its_line(make_project: MakeProject) -> None:
    tests = "    import vision_library\n" + TESTS.lstrip("\n")
    (explained,), outcomes = run(make_project({"robot.py": ROBOT, "tests/test_a.py": tests}))
    assert "imports the robot again" in explained
    assert "tests/test_a.py:1 starts the thread 'frames'" in explained.replace("\\", "/")
    assert outcomes == {"test_forked": "FAILED", "test_another": "PASSED"}


@pytest.mark.slow
def test_where_nothing_is_forked_interpreters_are_used_again(make_project: MakeProject) -> None:
    robot = ROBOT.replace("pass", "motor = wpilib.PWMSparkMax(3)")
    explained, outcomes = run(make_project({"robot.py": robot, "tests/test_a.py": TESTS}), "-p", "no_fork")
    assert explained == []
    assert outcomes == {"test_forked": "FAILED", "test_another": "PASSED"}


@pytest.mark.slow
def test_what_a_test_has_left_is_the_reason_for_a_new_interpreter(make_project: MakeProject) -> None:
    tests = """
        import json


        def test_forked(robot):
            json.robot_of_test = robot


        def test_another(control, robot):
            with control.run_robot():
                control.step_timing(seconds=0.1, autonomous=False, enabled=True)
    """
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": tests})
    (explained,), outcomes = run(project, "-p", "no_fork")
    assert "A new interpreter for each test, because a test has left an object of the class robot." in explained
    assert outcomes == {"test_forked": "PASSED", "test_another": "PASSED"}
    doctor = project.run("doctor", "--no-robot")
    assert "each test took a new interpreter, because one had left an object of the class robot" in doctor.stdout

    project.run("test")
    assert "new interpreter" not in project.run("doctor", "--no-robot").stdout
