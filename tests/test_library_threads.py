"""A library whose threads Python does not know, such as a CAN bus of phoenix6, is not forked with the robot.

In a fork those threads are missing: devices then do not answer, and each waits for its time-out.
"""

from __future__ import annotations

import sys

import pytest
from conftest import MakeProject, RobotProject

pytestmark = pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="tests are not forked here")

#: Its thread answers, and is none of `threading`'s.
LIBRARY = """
    import _thread
    import queue

    questions, answers = queue.SimpleQueue(), queue.SimpleQueue()


    def _serve():
        while True:
            answers.put(questions.get() + 1)


    def start():
        _thread.start_new_thread(_serve, ())


    def ask(number):
        questions.put(number)
        return answers.get(timeout=5)
"""

#: As the real one, it makes a notifier, with a thread, when it is imported.
URCL = """
    import threading

    import hal

    notifier = hal.initializeNotifier()[0]
    threading.Thread(target=hal.waitForNotifierAlarm, args=(notifier,), daemon=True).start()
"""

ROBOT = """
    import os

    import bus
    import wpilib

    imported_in = os.getpid()
    bus.start()


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            assert bus.ask(1) == 2
"""

TESTS = """
    def test_it(control):
        control.run_test(lambda tm: tm < 1)
"""


def run(project: RobotProject, *args: str) -> tuple[list[str], str]:
    """Run a command with the library at hand; return what pyfrc explains, and the output."""
    others = project.path.parent / "others"
    others.mkdir(exist_ok=True)
    RobotProject(others, others).write({"bus/__init__.py": LIBRARY, "urcl/__init__.py": URCL})
    result = project.run(*args, env={"PYTHONPATH": str(others)})
    assert result.code == 0, result.output
    return [line for line in result.output.splitlines() if line.startswith("pyfrc: ")], result.output


def test_each_test_imports_a_robot_whose_import_starts_a_librarys_thread(make_project: MakeProject) -> None:
    explained, output = run(make_project({"robot.py": ROBOT, "tests/test_a.py": TESTS}), "test")
    assert "1 passed" in output
    assert "libraries start 1 thread" in explained[0]


def test_a_robot_with_urcl_is_told_where_to_import_it_and_a_device_beside_it_is_named_too(
    make_project: MakeProject,
) -> None:
    robot = ROBOT.replace("    bus.start()\n", "    import urcl\n    motor = wpilib.PWMSparkMax(3)\n")
    robot = robot.replace("assert bus.ask(1) == 2", "pass")
    explained, output = run(make_project({"robot.py": robot, "tests/test_a.py": TESTS}), "test")
    assert "1 passed" in output
    assert explained[0].endswith("`import urcl` makes a notifier; devices are made: pwm[3]. Do that in robotInit.")


@pytest.mark.slow
def test_fuzz_imports_such_a_robot_in_each_match(make_project: MakeProject) -> None:
    _, output = run(make_project({"robot.py": ROBOT}), "fuzz", "--seed", "1", "--time", "2")
    assert "Nothing was found" in output


def test_a_library_whose_thread_starts_with_the_robot_and_numpy_need_none_of_this(make_project: MakeProject) -> None:
    robot = ROBOT.replace("    bus.start()\n", "    import numpy\n").replace(
        "assert bus", "bus.start()\n            assert bus"
    )
    explained, output = run(make_project({"robot.py": robot, "tests/test_a.py": TESTS}), "test")
    assert "1 passed" in output
    assert explained == []
