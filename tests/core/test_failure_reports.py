"""What is shown of failed tests: each bug once, a long output by its end, and what a test has left out."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.errors import PyfrcError
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.test_support import summary
from pyfrc_core.test_support.autoload import _exists, _robot_project_of
from pyfrc_core.test_support.controller import TestController
from pyfrc_core.test_support.options import READY_MADE_TESTS
from pyfrc_core.test_support.reporting import BUG, never_ran_the_robot, put_first, seed_section
from pyfrc_core.test_support.summary import _end_of, _explain_each_bug_once, _shorten_output, _take_device_warnings
from pyfrc_core.test_support.uncollected import find_uncollected


def report(name: str, longrepr: str = "", bug: str | None = None, *sections: tuple[str, str]) -> Any:
    made = pytest.TestReport(
        nodeid=f"t.py::{name}",
        location=("t.py", 1, name),
        keywords={},
        outcome="failed",
        longrepr=longrepr,
        when="call",
        sections=list(sections),
    )
    if bug is not None:
        setattr(made, BUG, bug)
    return made


def test_one_bug_is_explained_once() -> None:
    bug = "robot.py:3: ZeroDivisionError: division by zero"
    reports = [report("a", "long", bug), report("b", "long", bug, ("out", "x")), report("c", "other")]
    stats: dict[str, list[Any]] = {"failed": [*reports]}
    _explain_each_bug_once(stats)
    assert stats["failed"][0] is reports[0]
    assert stats["failed"][1].longrepr == "robot.py:3: the same as in a, which is explained above"
    assert stats["failed"][1].sections == []
    assert stats["failed"][2] is reports[2]
    assert reports[1].longrepr == "long", "other reports have each failure in full"


def test_an_error_of_the_same_test_is_shown() -> None:
    bug = "robot.py:3: ValueError: #"
    stats: dict[str, list[Any]] = {"error": [report("a", "first", bug)], "failed": [report("a", "second", bug)]}
    _explain_each_bug_once(stats)
    assert stats["failed"][0].longrepr == "second"


def test_a_long_output_is_shortened_to_what_fits_beside_the_failure() -> None:
    text = "".join(f"line {number}\n" for number in range(100))
    for longrepr, shown in (("one line", 20), ("\n" * 10, 10), ("\n" * 90, 6)):
        stats: dict[str, list[Any]] = {"failed": [report("a", longrepr, None, ("out", text), ("err", ""))]}
        _shorten_output(stats)
        lines = stats["failed"][0].sections[0][1].splitlines()
        assert lines[0] == f"({100 - shown} lines before these: pyfrc test -v)"
        assert lines[1:] == [f"line {number}" for number in range(100 - shown, 100)]
    assert _end_of("a\nb\nc\n", 2) == "a\nb\nc\n", "a line that says that one line is missing takes as much room"


def test_warnings_about_devices_are_taken_out_and_said_once() -> None:
    mark = f"tests/t.py:3: {summary.DeviceWarning.__name__}: "
    messages = [f"{mark}robot.py:4: two devices\n  code", f"{mark}robot.py:4: two devices\n  code", "another warning"]
    stats: dict[str, list[Any]] = {"warnings": [SimpleNamespace(message=each) for each in messages]}
    assert _take_device_warnings(stats) == ["robot.py:4: two devices"]
    assert [each.message for each in stats["warnings"]] == ["another warning"]


def test_a_text_comes_before_a_report_without_a_traceback() -> None:
    for before, after in (("what pytest says", "the line\n\nwhat pytest says"), (None, "the line")):
        made: Any = SimpleNamespace(longrepr=before)
        put_first(made, "the line")
        assert made.longrepr == after


def test_the_seed_is_said_and_before_it_why_the_run_ended_early() -> None:
    control = SimpleNamespace(ended_early="/project/tests/t.py:4: it() returned None\n")
    for funcargs, early in (({}, ""), ({"control": control}, "tests/t.py:4: it() returned None\n")):
        item: Any = SimpleNamespace(funcargs=funcargs, config=SimpleNamespace(rootpath="/project"))
        options: Any = SimpleNamespace(seed=7)
        assert seed_section(options, item) == ("pyfrc", f"{early}random seed: 7 (--seed 7 repeats it)")


def test_a_robot_project_is_found_above_its_tests_and_not_beyond_another_project(tmp_path: Any) -> None:
    robot = tmp_path / "robot"
    (robot / "tests" / "more").mkdir(parents=True)
    (robot / "tool").mkdir()
    (robot / "robot.py").write_text("import wpilib\nclass MyRobot(wpilib.TimedRobot): ...\n")
    (robot / "tool" / "pyproject.toml").write_text("")
    assert _robot_project_of(robot / "tests" / "more") == robot
    assert _robot_project_of(robot / "tool") is None
    assert not _exists(tmp_path / ("x" * 5000)), "no file can have this name"


def test_files_that_have_tests_and_of_which_none_is_run(tmp_path: Path) -> None:
    directory = tmp_path / "tests"
    directory.mkdir()
    off, alike = "import a\n# from pyfrc.tests import *\n", "def arm_test(robot):\n    pass\n"
    texts = {"off_test.py": off, "test_alike.py": alike, "test_none.py": "x = 1\n", "test_run.py": "", "other.py": "",
             "conftest.py": off, "arm_tests.py": "def test_a(): ...\n", "tests.py": "class TestA: ...\n"}  # fmt: skip
    for name, text in texts.items():
        (directory / name).write_text(text)
    found = find_uncollected(directory, {directory / "test_run.py"}, ("test_*.py", "*_test.py"))
    read = "its tests are not run, since pytest reads files called test_*.py and *_test.py. Rename it to"
    assert sorted(found) == [
        f"tests/arm_tests.py: {read} test_arm.py.",
        "tests/off_test.py: no test was found in it. Remove the # in line 2, for the ready-made tests.",
        "tests/test_alike.py: no test was found in it. The name of a test begins with test_: rename arm_test.",
        "tests/test_none.py: no test was found in it. The name of a test begins with test_, as in: "
        "def test_drive(control, robot):",
        f"tests/tests.py: {read} test_robot.py.",
    ]
    project: Any = SimpleNamespace(unreadable_sources=lambda: ["a.py: damaged"], find_tests=lambda: directory)
    session: Any = SimpleNamespace(testsfailed=0, config=SimpleNamespace(getini=lambda name: ("test_*.py",)))
    for whole, failed, count in ((True, 0, 5), (True, 1, 0), (False, 0, 0)):
        session.testsfailed = failed
        plugin = summary.SummaryPlugin(project, whole)
        plugin.pytest_collection_finish(session)
        assert (len(plugin._uncollected), plugin._unreadable) == (count, ["a.py: damaged"])


def test_a_test_that_never_ran_its_robot_is_reminded_of_it() -> None:
    run = RobotRun()

    def reminded(error: BaseException, test: object = len, robot_run: object = run) -> bool:
        item: Any = SimpleNamespace(funcargs={"_robot_run": robot_run}, function=test)
        failure: Any = SimpleNamespace(value=error, traceback=[])
        return never_ran_the_robot(item, failure)

    def runs(control: Any) -> None:
        control.run_test(lambda now: True)

    def ready_made() -> None: ...

    ready_made.__module__ = f"{READY_MADE_TESTS}.docstring_test"
    assert reminded(AssertionError())
    assert not reminded(PyfrcError("a wrong key"))
    misspelled = AttributeError("no set_automous", obj=object.__new__(TestController))
    assert not reminded(misspelled)
    assert not reminded(AssertionError(), runs)
    assert not reminded(AssertionError(), ready_made)
    assert not reminded(AssertionError(), len, None)
