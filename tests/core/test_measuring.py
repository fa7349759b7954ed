"""Measurements of this process: which functions are timed, what the reports say, and that nothing is left of it."""

from __future__ import annotations

import json
import os
import pstats
import signal
from collections.abc import Iterator
from pathlib import Path
from textwrap import dedent
from typing import Any
from xml.etree import ElementTree

import pytest

from pyfrc_core.errors import UsageError
from pyfrc_core.measure import processes
from pyfrc_core.measure.coverage import CoverageOptions, measuring
from pyfrc_core.measure.figures import added_up
from pyfrc_core.measure.profile import ProfileOptions, begin, profiling
from pyfrc_core.processes import spawn
from pyfrc_core.processes.exit import before_every_exit, exit_by_signal
from pyfrc_core.processes.fork import Fork
from pyfrc_core.project import Project

ROBOT = """
    def used():
        return 1

    def unused():
        first = 1
        return first

    def longer():
        first = 1
        second = 2
        return first + second

    used()
"""

TIMED_ROBOT = """
    from functools import partial

    import commands2
    import magicbot
    import wpilib

    class Arm(commands2.Subsystem):
        def periodic(self): pass
        def helper(self): pass

    class Lift(commands2.Command):
        def execute(self): pass

    class Shooter:
        def execute(self): pass

    class Plan(magicbot.StateMachine):
        pass

    class MyRobot(wpilib.TimedRobot):
        def teleopPeriodic(self):
            self.helper()
            Arm.periodic(self)
        def helper(self=None): pass

    class Magic(magicbot.MagicRobot):
        shooter: Shooter
        plan: Plan
"""


@pytest.fixture(autouse=True)
def nothing_is_left() -> Iterator[None]:
    yield
    assert (before_every_exit, spawn.first_calls, Fork.grace_seconds) == ([], [], 0.0)
    assert not [name for name in os.environ if name in ("PYFRC_COVERAGE", "PYFRC_PROFILE")]


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Project:
    root = tmp_path / "a [robot]"
    (root / "tests").mkdir(parents=True)
    (root / "tests/test_a.py").write_text("used = True\n")
    monkeypatch.chdir(root)
    return Project(root / "robot.py")


def run(project: Project, source: str) -> dict[str, Any]:
    """Run this as the robot's file, and return its names."""
    project.main_file.write_text(dedent(source))
    names: dict[str, Any] = {"__name__": "robot"}
    for file in (project.main_file, *(project.root / "tests").iterdir()):
        exec(compile(file.read_text(), str(file), "exec", dont_inherit=True), names)
    return names


def test_coverage_prints_and_writes_its_reports(project: Project, capsys: pytest.CaptureFixture[str]) -> None:
    html, xml, as_json = (project.root.parent / name for name in ("pages", "a.xml", "a.json"))
    project.main_file.write_text(dedent(ROBOT))
    with measuring(project, CoverageOptions(True, html, xml, as_json, fail_under=99.9)) as measured:
        assert processes.is_announced("coverage")
        assert not processes.is_announced("profile")
        assert Fork.grace_seconds > 0.5
        with (
            pytest.raises(UsageError, match="coverage is already being measured"),
            measuring(project, CoverageOptions(enabled=True)),
        ):
            pass
        run(project, ROBOT)
    printed = capsys.readouterr()
    assert measured.status == 1
    assert printed.err == "coverage: 50.0 % is less than the required 99.9 %\n"
    assert [" ".join(line.split()) for line in printed.out.splitlines() if "---" not in line] == [
        "",
        "Name Stmts Miss Cover Missing",
        "robot.py 10 5 50% 6-7, 10-12",
        "TOTAL 10 5 50%",
        "",
        "Functions never run, worst first:",
        "robot.py: 2 functions, 5 lines",
        "longer (robot.py:9), 3 lines",
        "unused (robot.py:5), 2 lines",
        f"coverage as web pages: {html / 'index.html'}",
        f"coverage as XML: {xml}",
        f"coverage as JSON: {as_json}",
    ]
    assert (html / "index.html").is_file()
    assert [each.attrib["name"] for each in ElementTree.parse(xml).getroot().iter("class")] == ["robot.py"]
    assert json.loads(as_json.read_text("utf-8"))["totals"]["missing_lines"] == 5
    assert sorted(each.name for each in project.root.iterdir()) == ["robot.py", "tests"]


def test_coverage_that_is_quiet_or_off_or_empty(project: Project, capsys: pytest.CaptureFixture[str]) -> None:
    project.main_file.write_text(dedent(ROBOT))
    as_json = project.root.parent / "a.json"
    with measuring(project, CoverageOptions(True, json=as_json, fail_under=50, quiet=True)) as measured:
        run(project, ROBOT)
    assert (measured.status, as_json.is_file()) == (0, True)
    assert str(as_json) not in capsys.readouterr().out
    with measuring(project, CoverageOptions(enabled=False)) as measured:
        assert not processes.is_announced("coverage")
    assert (measured.status, *capsys.readouterr()) == (0, "", "")
    project.main_file.unlink()
    with measuring(project, CoverageOptions(enabled=True)) as measured:
        pass
    assert (measured.status, capsys.readouterr().err) == (1, "coverage: no line of the project was run\n")
    project.pyproject.write_text("[tool.coverage.run]\nbranch = 3\n[tool.coverage.report]\nprecision = 'x'\n")
    with pytest.raises(UsageError, match="coverage: ") as wrong, measuring(project, CoverageOptions(enabled=True)):
        pass
    assert wrong.value.where in (None, "pyproject.toml")


def test_a_profile_times_what_libraries_call(project: Project, capsys: pytest.CaptureFixture[str]) -> None:
    as_json, calls = project.root.parent / "a.json", project.root.parent / "new/a.pstats"
    with profiling(project, ProfileOptions(calls, as_json, top=2), "pyfrc test"):
        with (
            pytest.raises(UsageError, match="a profile is already being measured"),
            profiling(project, ProfileOptions(), "pyfrc test"),
        ):
            pass
        names = run(project, TIMED_ROBOT)
        for _ in range(3):
            names["MyRobot"].teleopPeriodic(names["MyRobot"])
        for name in ("Lift", "Shooter", "Plan"):
            assert hasattr(names[name].execute, "__wrapped__"), name
        names["Lift"].execute(None)
        names["Shooter"].execute(None)
        for name, method in (("MyRobot", "helper"), ("Arm", "helper")):
            assert not hasattr(getattr(names[name], method), "__wrapped__"), name
    report = json.loads(as_json.read_text("utf-8"))
    assert report["command"] == "pyfrc test"
    assert {(each["kind"], each["name"], each["place"], each["count"]) for each in report["functions"]} == {
        ("robot", "MyRobot.teleopPeriodic", "robot.py:22", 3),
        ("subsystem", "Arm.periodic", "robot.py:9", 3),
        ("command", "Lift.execute", "robot.py:13", 1),
        ("component", "Shooter.execute", "robot.py:16", 1),
    }
    printed = capsys.readouterr().out.splitlines()
    assert printed[:2] == ["", next(line for line in printed if line.startswith("How long each call took"))]
    assert printed[-2:] == [f"profile for pstats: {calls}", f"profile as JSON: {as_json}"]
    assert "  and 2 more functions (--top 4)" in printed
    stats: Any = pstats.Stats(str(calls))
    counted = {name: counts[1] for (file, _, name), counts in stats.stats.items() if file.endswith("robot.py")}
    assert counted == {"teleopPeriodic": 3, "helper": 3, "periodic": 3, "execute": 1}


def test_a_profile_that_is_quiet(project: Project, capsys: pytest.CaptureFixture[str]) -> None:
    as_json = project.root.parent / "a.json"
    with profiling(project, ProfileOptions(json=as_json, quiet=True), "pyfrc test"):
        pass
    assert capsys.readouterr().out == "\nprofile: no function of the robot was called\n"
    assert json.loads(as_json.read_text("utf-8"))["functions"] == []


def test_what_a_process_has_saved_is_not_saved_again(project: Project, tmp_path: Path) -> None:
    """As a fork must not save what its parent has measured."""
    save = begin({"root": str(project.root), "directory": str(tmp_path), "calls": True})
    run(project, TIMED_ROBOT)["Arm"].periodic(None)
    save()
    save()
    times = added_up(tmp_path.glob("*.figures")).times.values()
    assert (sum(map(len, times)), len(list(tmp_path.glob("*.pstats")))) == (1, 1)


def test_a_new_interpreter_measures_what_its_environment_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    handler, grace = signal.getsignal(signal.SIGTERM), Fork.grace_seconds
    try:
        processes.measure_here()
        assert (before_every_exit, signal.getsignal(signal.SIGTERM)) == ([], handler)
        settings = {"root": str(tmp_path), "directory": str(tmp_path), "calls": False}
        monkeypatch.setenv("PYFRC_PROFILE", json.dumps(settings))
        processes.measure_here()
        processes.measure_here()
        assert (len(before_every_exit), signal.getsignal(signal.SIGTERM)) == (1, exit_by_signal)
        before_every_exit.pop()()
    finally:
        signal.signal(signal.SIGTERM, handler)
        Fork.grace_seconds = grace
        spawn.first_calls.clear()
        monkeypatch.delenv("PYFRC_PROFILE", raising=False)
