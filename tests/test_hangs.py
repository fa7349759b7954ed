"""Code that makes no progress: what the terminal says meanwhile, and the failure that names its line."""

from __future__ import annotations

import itertools
import re
import signal
import sys
import threading
from types import SimpleNamespace

import pytest
from conftest import MakeProject, Result, RobotProject

from pyfrc_core.runtime.checks.hang_detector import HangDetector
from pyfrc_core.runtime.patches.active_run import active_run
from pyfrc_core.runtime.threads.thread_cpu import ThreadTimes

QUICK = """
    [tool.pyfrc.test]
    hang_seconds = 0.25
"""

ROBOT = """
    import asyncio
    import concurrent.futures
    import queue
    import subprocess
    import threading
    import time

    import wpilib


    class MyRobot(wpilib.TimedRobot):
        trouble = ""

        def robotInit(self):
            self.running = True
            self.queue = queue.Queue()
            self.times = []

        def endCompetition(self):
            self.running = False
            super().endCompetition()

        def autonomousInit(self):
            target = getattr(self, self.trouble, None)
            if target is not None:
                threading.Thread(target=target, name=self.trouble).start()

        def waits_for_work_for_ever(self):
            while True:
                self.queue.get()  # no work comes

        def sleeps_until_the_end(self):
            while self.running:
                time.sleep(0.05)

        def looks_until_the_end(self):
            while self.running:
                try:
                    self.queue.get(timeout=0.5)
                except queue.Empty:
                    pass

        def has_a_pool(self):
            self.pool = concurrent.futures.ThreadPoolExecutor()
            self.pool.submit(time.sleep, 0.1)

        def autonomousPeriodic(self):
            if self.trouble == "swallows_all":
                try:
                    while True:  # swallows all
                        pass  # and on
                except:
                    pass
            if self.trouble == "child process":
                subprocess.run(["sleep", "1000"])  # a child process

        def teleopInit(self):
            asyncio.run(self.two_tasks())

        async def two_tasks(self):
            loop = asyncio.get_running_loop()
            begun = loop.time()

            async def note(name, seconds):
                await asyncio.sleep(seconds)
                self.times.append((name, round(loop.time() - begun, 2), round(time.monotonic() - begun, 2)))

            await asyncio.gather(note("late", 0.3), note("early", 0.1))
            with concurrent.futures.ThreadPoolExecutor() as pool:
                await loop.run_in_executor(pool, time.sleep, 0.2)
            try:
                await asyncio.wait_for(asyncio.Event().wait(), 0.5)
            except asyncio.TimeoutError:
                self.times.append(("end", round(loop.time() - begun, 2), round(time.monotonic() - begun, 2)))
"""

TESTS = """
    import asyncio
    import threading
    import time

    import pytest


    @pytest.mark.parametrize(
        "trouble",
        [
            "waits_for_work_for_ever",
            "sleeps_until_the_end",
            "looks_until_the_end",
            "has_a_pool",
            "swallows_all",
        ],
    )
    def test_autonomous(control, robot, trouble):
        type(robot).trouble = trouble
        control.set_autonomous()
        control.run_test(lambda tm: tm < 1)


    def test_event_loop(control, robot, fake_time):
        control.set_operator_control()
        control.run_test(lambda tm: tm < 3)
        assert robot.times == [("early", 0.1, 0.1), ("late", 0.3, 0.3), ("end", 1.0, 1.0)]


    def test_event_loop_of_the_test(control, robot):
        before = time.monotonic()
        asyncio.run(asyncio.sleep(0.01))
        assert time.monotonic() - before >= 0.01


    def test_thread_that_ends(control, robot):
        threading.Thread(target=time.sleep, args=(0.01,)).start()
        control.run_test(lambda tm: tm < 1)
"""


@pytest.fixture(scope="module")
def project(make_shared_project: MakeProject) -> RobotProject:
    return make_shared_project({"robot.py": ROBOT, "tests/test_it.py": TESTS, "pyproject.toml": QUICK})


@pytest.fixture(scope="module")
def report(project: RobotProject) -> Result:
    return project.run("test", "--", "-v")


def test_a_hang_that_robot_code_catches_fails_the_test(report: Result, project: RobotProject) -> None:
    block = report.blocks()["test_autonomous[swallows_all]"]
    lines = ("# swallows all", "# and on")
    assert block.startswith(tuple(f"{project.place('robot.py', each)}: the robot code hangs here" for each in lines))


def test_a_thread_that_a_robot_leaves_running_fails_the_test(report: Result, project: RobotProject) -> None:
    block = report.blocks()["ERROR at teardown of test_autonomous[waits_for_work_for_ever]"]
    place = project.place("robot.py", "# no work comes")
    assert block.startswith(f"{place}: the thread 'waits_for_work_for_ever' is still running after the test was over.")


def test_threads_that_end_and_event_loops_are_fine(report: Result) -> None:
    outcomes = {name.rpartition("::")[2]: outcome for name, outcome in report.outcomes().items()}
    fine = [f"test_autonomous[{each}]" for each in ("sleeps_until_the_end", "looks_until_the_end", "has_a_pool")]
    fine += ["test_event_loop", "test_event_loop_of_the_test", "test_thread_that_ends"]
    assert {outcomes[name] for name in fine} == {"PASSED"}, report.output


STUCK_TESTS = """
    import threading

    import pytest


    def test_child_process(control, robot):
        type(robot).trouble = "child process"
        control.set_autonomous()
        control.run_test(lambda tm: tm < 1)


    def test_own_lock(robot):
        threading.Event().wait()  # in the test


    @pytest.fixture
    def camera(robot):
        threading.Event().wait()  # in the fixture


    def test_fixture(camera):
        pass


    def test_thread(control, robot):
        def spin():
            threading.Event().wait()  # in a thread

        threading.Thread(target=spin).start()
        control.run_test(lambda tm: tm < 1)
"""


@pytest.mark.slow
def test_code_that_waits_for_ever_is_named_after_3_s_and_fails_after_10(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_it.py": STUCK_TESTS})
    result = project.run("test", "-j", "4")
    assert result.code == 1, result.output
    blocks = result.blocks()
    stuck = [
        ("test_child_process", "robot.py", "# a child process", "the robot code is blocked here: robot time has stood"),
        ("test_own_lock", "tests/test_it.py", "# in the test", "the test is blocked here: robot time has stood"),
        ("ERROR at setup of test_fixture", "tests/test_it.py", "# in the fixture", "the test is blocked here"),
        ("test_thread", "tests/test_it.py", "# in a thread", "a thread that the test has started is still running"),
    ]
    for test, file, line, text in stuck:
        place = project.place(file, line)
        assert blocks[test].startswith(f"{place}: {text}"), result.output
        name = test.rpartition(" ")[2]
        told = re.search(
            rf"^{place}: no progress for (\d+) s in tests/test_it.py::{name} \(robot time stands at",
            result.output,
            re.M,
        )
        assert told is not None, result.output
        assert int(told[1]) >= 3  # a busy machine prints it later


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for one process")
def test_ctrl_c_says_where_the_test_stands(make_project: MakeProject) -> None:
    tests = "import threading\n\n\ndef test_waits(control, robot):\n    threading.Event().wait()  # here\n"
    project = make_project({"robot.py": ROBOT, "tests/test_it.py": tests})
    place = f"{project.place('tests/test_it.py', '# here')}: no progress for"
    with project.start("test") as command:
        for line in command.stdout:
            if line.startswith(place):
                break
        command.send_signal(signal.SIGINT)
        rest = command.stdout.read()
        assert command.wait() == 130
    assert f"interrupted: {place}" in rest


@pytest.mark.season_2026
def test_a_loop_of_the_robots_own_ends_with_its_notifier(make_project: MakeProject) -> None:
    robot = """
        from pathlib import Path

        import hal
        import wpilib


        class MyRobot(wpilib.IterativeRobotBase):
            def __init__(self):
                super().__init__(0.02)
                self.notifier, _ = hal.initializeNotifier()
                self.turns = 0

            def startCompetition(self):
                self.robotInit()
                hal.observeUserProgramStarting()
                due = wpilib.RobotController.getFPGATime()
                while True:
                    due += 20_000
                    hal.updateNotifierAlarm(self.notifier, due)
                    now, _ = hal.waitForNotifierAlarm(self.notifier)
                    if now == 0:
                        break
                    self._loopFunc()
                    self.turns += 1
                Path("closed").write_text(str(self.turns))

            def endCompetition(self):
                hal.stopNotifier(self.notifier)
                hal.cleanNotifier(self.notifier)
        """
    tests = "def test_it(control, robot):\n    control.run_test(lambda tm: tm < 1)\n"
    project = make_project({"robot.py": robot, "tests/test_it.py": tests})
    result = project.run("test")
    assert result.code == 0, result.output
    assert (project.path / "closed").read_text() == "49"


@pytest.mark.slow
def test_a_simulation_says_where_the_robot_stands(make_project: MakeProject) -> None:
    robot = ROBOT.replace('trouble = ""', 'trouble = "child process"')
    project = make_project({"robot.py": robot})
    result = project.run("sim", "--mode", "auto", "--seconds", "2")
    assert result.code == 1, result.output
    place = project.place("robot.py", "# a child process")
    assert f"{place}: no progress for" in result.output
    assert f"{place}: the robot code is blocked here" in result.output


def test_code_that_stops_running_while_it_is_looked_at_stays_watched(monkeypatch: pytest.MonkeyPatch) -> None:
    """As between two packets of a simulation: without the watch, the process would be ended as if it hung."""
    enough, mistakes = threading.Event(), list[object]()

    class Run:
        looks = itertools.count()
        clock = SimpleNamespace(now_us=0, now=0.0)
        threads = SimpleNamespace(whose_turn=lambda: (threading.main_thread().ident, ThreadTimes()))

        @property
        def in_motion(self) -> bool:
            look = next(self.looks)
            self.clock.now_us = look  # there is progress
            if look > 40:
                enough.set()
            return look % 2 == 0

    monkeypatch.setattr(active_run, "run", Run())
    monkeypatch.setattr(sys, "unraisablehook", lambda mistake: (mistakes.append(mistake.exc_value), enough.set()))
    with HangDetector(None, 0.1).watching():
        assert enough.wait(60)
    assert not mistakes
