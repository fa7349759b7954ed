"""pytest behaves as its user expects, although each robot test runs in a process of its own."""

from __future__ import annotations

import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from conftest import MakeProject, Result, RobotProject

needs_fork = pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="tests are not forked here")

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        made = 0

        def __init__(self):
            super().__init__()
            MyRobot.made += 1
            self.motor = wpilib.PWMSparkMax(0)

        def teleopPeriodic(self):
            self.motor.set(0.5)
"""

# -- a run with a bit of everything ---------------------------------------------------------------------------------

CONFTEST = """
    import os
    from pathlib import Path

    import pytest

    LOG = Path(__file__).with_name("events.log")


    def note(event):
        with LOG.open("a") as log:
            log.write(f"{os.getpid()} {event}\\n")


    @pytest.fixture
    def noting():
        return note


    @pytest.fixture(scope="session")
    def of_session():
        note("session up")
        yield ["session"]
        note("session down")


    @pytest.fixture(scope="module")
    def of_module(of_session, request):
        note(f"module {request.module.__name__} up")
        yield [*of_session, "module"]
        note(f"module {request.module.__name__} down")


    @pytest.fixture(scope="class")
    def of_class(of_module):
        note("class up")
        yield [*of_module, "class"]
        note("class down")


    @pytest.fixture
    def of_function(of_class):
        note("function up")
        yield [*of_class, "function"]
        note("function down")


    @pytest.fixture(scope="session")
    def failing_of_session():
        raise OSError("no field today")


    @pytest.fixture
    def failing_teardown():
        yield
        raise OSError("stuck in the mud")
"""

TESTS_OF_ROBOT = """
    import logging
    import os
    import unittest
    import warnings

    import pytest
    from conftest import note

    import robot as robot_module


    def setup_module():
        note("setup_module")


    def teardown_module():
        note("teardown_module")


    @pytest.mark.parametrize("stick", [0.25, 0.5])
    def test_parametrised(control, stick, noting):
        noting(f"test {stick}")
        control.run_test(lambda tm: tm < stick)


    class TestScopes:
        def test_first(self, control, of_function, noting):
            noting("test first")
            assert of_function == ["session", "module", "class", "function"]
            control.run_test(lambda tm: tm < 1)

        def test_second(self, control, of_function, noting):
            noting("test second")
            assert of_function == ["session", "module", "class", "function"]
            control.run_test(lambda tm: tm < 1)


    def test_of_module(control, of_module, noting):
        noting("test of module")
        control.run_test(lambda tm: tm < 1)


    def test_modules_are_new(robot, noting):
        noting("test made")
        assert robot_module.MyRobot.made == 1


    def test_talks_and_passes(control):
        print("said by one that passes")
        logging.warning("logged by one that passes")
        control.run_test(lambda tm: tm < 1)


    def test_talks_and_fails(control):
        print("said by one that fails")
        logging.warning("logged by one that fails")
        control.run_test(lambda tm: tm < 1)
        assert False


    def test_crashes(control):
        print("said before the crash")
        os.abort()


    def test_first_on_the_field(failing_of_session, control):
        pass


    def test_second_on_the_field(failing_of_session, control):
        pass


    def test_torn_down(failing_teardown, control):
        pass


    @pytest.mark.xfail(reason="the arm is missing")
    def test_expected_to_fail(control):
        assert False


    @pytest.mark.xfail(reason="the arm was missing")
    def test_unexpectedly_passes(control):
        pass


    def test_skips_itself(control):
        pytest.skip("no vision today")


    @pytest.mark.skip(reason="not ready")
    def test_skipped(control):
        assert False


    def test_warns(control):
        warnings.warn("the battery is low", UserWarning)


    def test_has_a_directory(control, tmp_path):
        (tmp_path / "file").write_text("written")
        assert [path.name for path in tmp_path.iterdir()] == ["file"]


    class OldStyle(unittest.TestCase):
        def setUp(self):
            self.number = 3

        def test_old_style(self):
            self.assertEqual(self.number, 3)

        def test_old_style_fails(self):
            self.assertEqual(self.number, 4)
"""

TESTS_WITHOUT_ROBOT = """
    def test_plain(of_session, of_module, noting):
        noting("test plain")
"""

EVERYTHING = {
    "robot.py": ROBOT,
    "tests/conftest.py": CONFTEST,
    "tests/test_a_robot.py": TESTS_OF_ROBOT,
    "tests/test_b_plain.py": TESTS_WITHOUT_ROBOT,
}

OUTCOMES = {
    "test_parametrised[0.25]": "PASSED",
    "test_parametrised[0.5]": "PASSED",
    "TestScopes::test_first": "PASSED",
    "TestScopes::test_second": "PASSED",
    "test_of_module": "PASSED",
    "test_modules_are_new": "PASSED",
    "test_talks_and_passes": "PASSED",
    "test_talks_and_fails": "FAILED",
    "test_crashes": "FAILED",
    "test_first_on_the_field": "ERROR",
    "test_second_on_the_field": "ERROR",
    "test_torn_down": "ERROR",
    "test_expected_to_fail": "XFAIL",
    "test_unexpectedly_passes": "XPASS",
    "test_skips_itself": "SKIPPED",
    "test_skipped": "SKIPPED",
    "test_warns": "PASSED",
    "test_has_a_directory": "PASSED",
    "OldStyle::test_old_style": "PASSED",
    "OldStyle::test_old_style_fails": "FAILED",
    "test_plain": "PASSED",
}


@pytest.fixture(scope="module")
def everything(make_shared_project: MakeProject) -> RobotProject:
    return make_shared_project(EVERYTHING)


@pytest.fixture(scope="module")
def report(everything: RobotProject) -> Result:
    """All of it, one test after another."""
    noted = everything.path / "tests" / "events.log"
    noted.unlink(missing_ok=True)  # another test may have run the project first
    result = everything.run("test", "-j", "1", "--", "-v", "-rfExXs", "--durations=3", "--junitxml=report.xml")
    noted.rename(noted.with_name("first-events.log"))
    return result


@pytest.fixture(scope="module")
def events(report: Result, everything: RobotProject) -> list[tuple[int, str]]:
    """What the fixtures and tests of that run noted, and in which process."""
    lines = (everything.path / "tests" / "first-events.log").read_text().splitlines()
    return [(int(pid), event) for pid, event in (line.split(" ", 1) for line in lines)]


def short(outcomes: dict[str, str]) -> list[tuple[str, str]]:
    return [(name.partition("::")[2], outcome) for name, outcome in outcomes.items()]


def test_every_outcome_is_what_pytest_would_say(report: Result) -> None:
    assert report.code == 1, report.output
    assert short(report.outcomes()) == list(OUTCOMES.items())
    assert "INTERNALERROR" not in report.output


def test_several_at_a_time_give_the_same_in_the_same_order(everything: RobotProject, report: Result) -> None:
    several = everything.run("test", "-j", "2", "--", "-v", "-k", "parametrised or first or crashes or down or plain")
    chosen = several.outcomes()
    assert len(chosen) == 7
    assert list(chosen.items()) == [each for each in report.outcomes().items() if each[0] in chosen]
    assert list(several.blocks()) == [each for each in report.blocks() if each in several.blocks()]
    assert several.code == 1


@pytest.mark.parametrize(
    ("isolation", "left_out"),
    [
        # Used again, each is as good as new.
        pytest.param("reuse", (), marks=pytest.mark.slow),
        # Together in one process, one crash is everybody's, and so is what a module keeps.
        ("none", ("test_crashes", "test_modules_are_new")),
    ],
)
def test_another_isolation_gives_the_same(everything: RobotProject, isolation: str, left_out: tuple[str, ...]) -> None:
    selection = " and ".join(f"not {name}" for name in left_out)
    result = everything.run("test", "-j", "2", "--isolation", isolation, "--", "-v", "-k", selection)
    assert result.code == 1, result.output
    expected = [(name, outcome) for name, outcome in OUTCOMES.items() if not name.startswith(left_out)]
    assert short(result.outcomes()) == expected


@pytest.mark.slow
def test_plain_pytest_gives_the_same(everything: RobotProject) -> None:
    result = everything.pytest("-v")
    assert result.code == 1, result.output
    assert short(result.outcomes()) == list(OUTCOMES.items())


@needs_fork
def test_shared_fixtures_are_set_up_and_torn_down_once_at_their_time(events: list[tuple[int, str]]) -> None:
    assert [event for _, event in events] == [
        "setup_module",
        "test 0.25",
        "test 0.5",
        "session up",
        "module test_a_robot up",
        "class up",
        "function up",
        "test first",
        "function down",
        "function up",
        "test second",
        "function down",
        "class down",
        "test of module",
        "test made",
        "module test_a_robot down",
        "teardown_module",
        "module test_b_plain up",
        "test plain",
        "module test_b_plain down",
        "session down",
    ]


@needs_fork
def test_each_robot_test_has_a_process_of_its_own_and_others_have_none(events: list[tuple[int, str]]) -> None:
    shared = {pid for pid, event in events if event.startswith(("session", "module", "class")) or "_module" in event}
    assert len(shared) == 1
    assert {pid for pid, event in events if event == "test plain"} == shared
    robots = [pid for pid, event in events if event.startswith("test ") and event != "test plain"]
    assert len(set(robots) - shared) == len(robots) == 6
    functions = [pid for pid, event in events if event.startswith("function")]
    assert set(functions) <= set(robots)


def test_output_and_logs_are_shown_for_what_fails_only(report: Result) -> None:
    failing = report.blocks()["test_talks_and_fails"]
    assert "said by one that fails" in failing
    assert "logged by one that fails" in failing
    assert "said before the crash" in report.blocks()["test_crashes"]
    assert "by one that passes" not in report.output
    assert report.output.splitlines().count("said by one that fails") == 1


def test_a_failing_shared_fixture_is_an_error_of_each_test_that_needs_it(
    report: Result, everything: RobotProject
) -> None:
    place = everything.place("tests/conftest.py", "no field today")
    for test in ("test_first_on_the_field", "test_second_on_the_field"):
        block = report.blocks()[f"ERROR at setup of {test}"]
        assert block.startswith(f"{place}: OSError: no field today\n")


def test_an_error_in_a_teardown_is_told(report: Result, everything: RobotProject) -> None:
    place = everything.place("tests/conftest.py", "stuck in the mud")
    assert report.blocks()["ERROR at teardown of test_torn_down"].startswith(f"{place}: OSError: stuck in the mud\n")


def test_the_stack_of_a_crash_ends_with_the_users_code(report: Result) -> None:
    block = report.blocks()["test_crashes"]
    assert "in test_crashes" in block
    assert "_pytest" not in block


def test_warnings_are_in_the_summary_once(report: Result, everything: RobotProject) -> None:
    summary = report.stdout.partition("warnings summary")[2].partition("Docs:")[0]
    assert f"{everything.place('tests/test_a_robot.py', 'the battery is low')}: UserWarning: the battery" in summary
    assert summary.count("test_a_robot.py::test_warns") == 1
    assert re.search(r"\b1 warning\b", report.stdout)


def test_reasons_of_skips_and_expected_failures_are_told(report: Result) -> None:
    summary = report.stdout.partition("short test summary info")[2]
    assert re.search(r"SKIPPED \[1\] tests.test_a_robot.py:\d+: no vision today", summary)
    assert re.search(r"SKIPPED \[1\] tests.test_a_robot.py:\d+: not ready", summary)
    assert "XFAIL tests/test_a_robot.py::test_expected_to_fail - the arm is missing" in summary
    assert "XPASS tests/test_a_robot.py::test_unexpectedly_passes - the arm was missing" in summary


def test_the_junit_file_has_every_test_the_crashed_one_too(report: Result, everything: RobotProject) -> None:
    assert "report.xml" in report.stdout
    cases = {
        case.attrib["name"]: {child.tag for child in case}
        for case in ElementTree.parse(everything.path / "report.xml").getroot().iter("testcase")
    }
    assert cases.keys() == {name.rpartition("::")[2] for name in OUTCOMES}
    assert "failure" in cases["test_crashes"]
    assert "failure" in cases["test_talks_and_fails"]
    assert "error" in cases["test_first_on_the_field"]
    assert "error" in cases["test_torn_down"]
    assert "skipped" in cases["test_skipped"]
    assert not cases["test_has_a_directory"] & {"failure", "error", "skipped"}


# -- pytest's options -----------------------------------------------------------------------------------------------

FEW_TESTS = """
    import pytest


    def test_one(control):
        print("one speaks")
        control.run_test(lambda tm: tm < 1)


    def test_two(control):
        assert False, "two"


    def test_three(control):
        assert False, "three"


    def test_four(control):
        pass
"""

ANNOUNCER = """
    def pytest_report_header():
        return "announced by a plugin"
"""


@pytest.fixture(scope="module")
def few(make_shared_project: MakeProject) -> RobotProject:
    return make_shared_project({"robot.py": ROBOT, "tests/test_few.py": FEW_TESTS, "announcer.py": ANNOUNCER})


def few_outcomes(result: Result) -> list[tuple[str, str]]:
    return short(result.outcomes())


ONE_AND_TWO = [("test_one", "PASSED"), ("test_two", "FAILED")]


def test_x_stops_at_the_first_failure(few: RobotProject) -> None:
    result = few.run("test", "-j", "2", "--", "-v", "-x")
    assert result.code == 1
    assert few_outcomes(result) == ONE_AND_TWO
    assert "stopping after 1 failures" in result.stdout


def test_k_selects_s_shows_what_tests_print_and_a_plugin_joins_in(few: RobotProject) -> None:
    result = few.run("test", "--", "-v", "-s", "-k", "one or four", "-p", "announcer", "tests/test_few.py")
    assert result.code == 0, result.output
    assert "2 passed, 2 deselected" in result.stdout
    assert "announced by a plugin" in result.stdout
    assert "one speaks" in result.stdout


@pytest.mark.slow
@needs_fork
def test_the_debugger_stops_in_the_failing_test(few: RobotProject) -> None:
    result = few.run("test", "--", "--pdb", "-k", "two", stdin="p 'the ' + 'robot is', type(control).__name__\nc\n")
    assert result.code == 1, result.output
    assert "('the robot is', 'TestController')" in result.stdout
    assert "1 failed" in result.stdout


@needs_fork
def test_ctrl_c_ends_the_run_and_every_process(make_project: MakeProject) -> None:
    tests = """
        import os
        import signal
        from pathlib import Path

        PIDS = Path(__file__).with_name("pids")


        def test_one(control):
            with PIDS.open("a") as pids:
                print(os.getpid(), file=pids)
            os.kill(os.getppid(), signal.SIGINT)
            while True:
                signal.pause()


        def test_two(control):
            raise AssertionError("not to be run")
    """
    project = make_project({"robot.py": ROBOT, "tests/test_interrupted.py": tests})
    result = project.run("test", "-j", "1")
    assert result.code == 130, result.output
    assert "KeyboardInterrupt" in result.output
    assert "not to be run" not in result.output
    for pid in (project.path / "tests" / "pids").read_text().split():
        assert not Path(f"/proc/{pid}").exists()


@pytest.mark.slow
@needs_fork
def test_sigterm_ends_the_run_of_a_robot_with_a_device_in_a_class_variable(make_project: MakeProject) -> None:
    robot = """
        import wpilib


        class MyRobot(wpilib.TimedRobot):
            motor = wpilib.PWMSparkMax(0)
    """
    tests = """
        import os
        import signal


        def test_one(control):
            os.kill(os.getppid(), signal.SIGTERM)
            while True:
                signal.pause()


        def test_two(control):
            raise AssertionError("not to be run")
    """
    project = make_project({"robot.py": robot, "tests/test_terminated.py": tests})
    result = project.run("test", "-j", "1", cold=True)  # so that the parent of a test is the command
    assert result.code == 143, result.output
    assert "KeyboardInterrupt" in result.output
    assert "not to be run" not in result.output


@needs_fork
def test_nothing_that_a_crashed_robot_has_started_is_left(make_project: MakeProject) -> None:
    robot = """
        import multiprocessing
        import os
        import time

        import wpilib


        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                camera = multiprocessing.get_context("fork").Process(target=time.sleep, args=(600,))
                camera.start()
                with open("camera", "w") as file:
                    file.write(str(camera.pid))

            def teleopInit(self):
                os._exit(1)
    """
    project = make_project({"robot.py": robot})
    result = project.run("test", "--builtin", "--", "-k", "operator")
    assert result.code == 1, result.output
    assert "os._exit(1)" in result.output
    stat = Path(f"/proc/{(project.path / 'camera').read_text()}/stat")
    assert not stat.exists() or stat.read_text(encoding="utf-8").rpartition(")")[2].split()[0] == "Z"


@pytest.mark.slow
@needs_fork
def test_standard_output_that_is_closed_and_a_parent_that_ignores_its_children(few: RobotProject) -> None:
    """Both are inherited from what starts pyfrc: a service, an editor, a script."""
    command = [sys.executable, "-m", "pyfrc", "test", "--project", str(few.path), "--", "--junitxml=report.xml"]
    script = f"import os, signal; signal.signal(signal.SIGCHLD, signal.SIG_IGN); os.execv({command[0]!r}, {command!r})"
    subprocess.run(["sh", "-c", '"$@" >&-', "sh", sys.executable, "-c", script], cwd=few.path, check=False)
    suite = ElementTree.parse(few.path / "report.xml").getroot().find("testsuite")
    assert suite is not None
    assert int(suite.get("tests", 0)) > 0
    assert suite.get("errors") == "0"


def test_a_parametrised_fixture_is_not_torn_down_under_a_running_test(make_project: MakeProject) -> None:
    tests = """
        import pytest
        from pathlib import Path

        LOG = Path(__file__).with_name("events.log")


        def note(event):
            with LOG.open("a") as log:
                print(event, file=log)


        @pytest.fixture(scope="module", params=["red", "blue", "green"])
        def alliance(request):
            note(f"{request.param} up")
            yield request.param
            note(f"{request.param} down")


        def test_alliance(alliance, control):
            control.run_test(lambda tm: tm < 60)
            note(f"{alliance} tested")
    """
    project = make_project({"robot.py": ROBOT, "tests/test_alliances.py": tests})
    result = project.run("test", "-j", "3")
    assert result.code == 0, result.output
    assert (project.path / "tests" / "events.log").read_text().splitlines() == [
        f"{alliance} {event}" for alliance in ("red", "blue", "green") for event in ("up", "tested", "down")
    ]


@needs_fork
def test_an_error_in_the_teardown_of_a_shared_fixture_is_told(make_project: MakeProject) -> None:
    tests = """
        import pytest


        @pytest.fixture(scope="module")
        def field():
            yield
            raise OSError("the field is stuck")


        def test_first(field, control):
            pass


        def test_last(field, control):
            pass
    """
    other = "def test_other(control):\n    pass\n"
    plain = "def test_plain():\n    pass\n"
    project = make_project(
        {
            "robot.py": ROBOT,
            "tests/test_a.py": tests,
            "tests/test_b.py": other,
            "tests/test_c.py": tests,
            "tests/test_d.py": plain,
        }
    )
    result = project.run("test")
    assert result.code == 1, result.output
    assert re.search(r"6 passed, 2 errors", result.stdout)
    place = project.place("tests/test_a.py", "the field is stuck")
    assert result.blocks()["ERROR at teardown of test_last"].startswith(f"{place}: OSError: the field is stuck\n")
    assert "ERROR tests/test_c.py::test_last" in result.stdout


# -- where tests are ------------------------------------------------------------------------------------------------


def test_plain_pytest_elsewhere_is_left_alone(make_project: MakeProject) -> None:
    tests = """
        import sys


        def test_nothing_is_imported():
            assert not {"wpilib", "hal", "ntcore", "pydantic", "numpy"} & set(sys.modules)


        def test_control(control):
            pass
    """
    result = make_project({"test_elsewhere.py": tests}).run("-v", program="pytest", cold=True)
    assert result.code == 1
    assert few_outcomes(result) == [("test_nothing_is_imported", "PASSED"), ("test_control", "ERROR")]
    assert "fixture 'control' not found" in result.stdout


@pytest.mark.slow
def test_tests_beside_the_robots_directory_are_found(make_project: MakeProject) -> None:
    tests = """
        from robot import MyRobot


        def test_robot(control, robot):
            control.run_test(lambda tm: tm < 1)
            assert isinstance(robot, MyRobot)


        def test_fails(control):
            assert False, "as it should"
    """
    project = make_project({"robot/robot.py": ROBOT, "tests/test_a.py": tests})
    result = project.run("test", "--", "-v", cwd=project.path / "robot")
    assert result.code == 1, result.output
    assert list(result.outcomes().values()) == ["PASSED", "FAILED"]
    line = project.line("tests/test_a.py", "assert False")
    assert re.match(rf"(\.\./)?tests/test_a\.py:{line}: AssertionError: as it should", result.blocks()["test_fails"])


@pytest.mark.slow
def test_plugins_of_libraries_that_pyfrc_depends_on_are_not_loaded(make_project: MakeProject) -> None:
    test = """
        import sys


        def test_plugins(request):
            for name in ("anyio", "platformdirs"):
                assert request.config.pluginmanager.hasplugin(name) is (name in sys.argv)
    """
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": test})
    assert project.run("test").code == 0
    asked_for = project.run("test", "--", "-p", "anyio")
    assert asked_for.code == 0, asked_for.output
