"""The buggy sample robots: the ready-made tests pass, their input script breaks them, and nothing but the bug does."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from pyfrc_core.runtime.scripts.script import load_script

ROBOTS = Path(__file__).parent / "robots" / "buggy"
MARK = "# the bug"


@dataclass(frozen=True)
class Bug:
    """What is wrong with a robot.

    :param error: what the robot's code raises; None when it raises nothing
    :param wrong: a part of one line
    :param right: what would repair the robot, in its place
    :param file: where that line, and the mark, are
    """

    error: str | None
    wrong: str
    right: str
    file: str = "robot.py"


BUGS = {
    "brown_out": Bug("ValueError: math domain error", "math.sqrt(margin)", "math.sqrt(max(0.0, margin))"),
    "cancelled_command": Bug(
        "TypeError: unsupported operand type(s) for -: 'float' and 'NoneType'",
        "if interrupted:",
        "if interrupted and self.lifting_since is not None:",
    ),
    "chooser": Bug("KeyError: 'Curvature'", "TANK: self.tank,", "TANK: self.tank, CURVATURE: self.curvature,"),
    "chord": Bug("IndexError: tuple index out of range", "0.65, 0.8, 1.0)", "0.65, 0.8, 1.0, 1.0)"),
    "crawl": Bug(None, "stick / stick.norm()", "stick / (stick.norm() or 1.0)", "components/base.py"),
    "game_message": Bug(
        "KeyError: (<Alliance.kBlue: 1>, 'R')", '(BLUE, "L"): ', '(BLUE, "R"): CROSS_THE_LINE, (BLUE, "L"): '
    ),
    "limit_switch": Bug(
        None, "(State.TAKING, State.REVERSING):  #", "(State.TAKING, State.REVERSING, State.STUCK):  #"
    ),
    "pov_315": Bug("KeyError: 315", "270: -90.0,", "270: -90.0, 315: -40.0,", "components/turret.py"),
    "second_enable": Bug(
        "TypeError: unsupported operand type(s) for -: 'float' and 'NoneType'",
        "if not self.scoring:",
        "if not self.scoring or self.started is None:",
    ),
    "selector_switch": Bug("IndexError: list index out of range", "VOLTS * len(PLANS)", "VOLTS * (len(PLANS) - 1)"),
    "unplugged": Bug(
        "IndexError: list index out of range",
        "range(self.stick.getAxisCount())",
        "range(max(2, self.stick.getAxisCount()))",
    ),
    "zero_rate": Bug(
        "ZeroDivisionError: float division by zero",
        "if not self.spinning or self.kicking():",
        "if not self.spinning or self.kicking() or self.encoder.getRate() == 0:",
    ),
}


@pytest.fixture(params=sorted(BUGS))
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def project(name: str, make_project) -> Any:
    made = make_project({})
    made.copy(ROBOTS / name)
    return made


def commands_while_disabled(trace: Path) -> Iterator[float]:
    """Commands to motors after the half second that the robot has to stop them."""
    disabled_at = 0.0
    enabled = False
    for now, changes in changes_in(trace):
        before, enabled = enabled, changes.get("control.enabled", enabled)
        if before and not enabled:
            disabled_at = now
        if not enabled and now > disabled_at + 0.5:
            yield from (
                value for path, value in changes.items() if path.startswith("pwm[") and path.endswith("].value")
            )


def not_numbers(trace: Path) -> Iterator[float]:
    for _, changes in changes_in(trace):
        yield from (value for value in changes.values() if isinstance(value, float) and math.isnan(value))


def changes_in(trace: Path) -> Iterator[tuple[float, dict[str, Any]]]:
    """(seconds, changed values by path)"""
    for line in trace.read_text("utf-8").splitlines():
        change = json.loads(line)
        if "set" in change:
            yield change["t"], change["set"]


def test_every_robot_has_its_bug() -> None:
    assert sorted(path.parent.name for path in ROBOTS.glob("*/robot.py")) == sorted(BUGS)
    assert len(BUGS) == 12
    for name, bug in BUGS.items():
        assert (ROBOTS / name / bug.file).read_text("utf-8").count(MARK) == 1


@pytest.mark.slow
def test_the_ready_made_tests_do_not_find_it(project) -> None:
    result = project.run("test", "--builtin", "--", "-v")
    assert result.code == 0, result.output
    outcomes = {test.partition("[")[0].rpartition("::")[2]: outcome for test, outcome in result.outcomes().items()}
    ready_made = ("test_practice", "test_autonomous", "test_disabled", "test_operator_control")
    assert outcomes == dict.fromkeys(ready_made, "PASSED")


def test_the_script_does(name: str, project) -> None:
    bug = BUGS[name]
    trace = project.path / "trace.jsonl"
    result = project.run("replay", "crash.jsonl", "--trace", trace)
    if bug.error is not None:
        assert result.code == 1, result.output
        assert f"then {project.place(bug.file, MARK)}: {bug.error}\n" in result.stdout
    else:
        assert result.code == 0, result.output
        assert any(commands_while_disabled(trace)) == (name == "limit_switch")
        assert any(not_numbers(trace)) == (name == "crawl")
    assert sum(len(step.writes) for step in load_script(ROBOTS / name / "crash.jsonl").steps) <= 5


def test_repaired_it_does_not_break(name: str, project) -> None:
    bug = BUGS[name]
    file = project.path / bug.file
    text = file.read_text("utf-8")
    assert text.count(bug.wrong) == 1
    assert "\n" not in bug.wrong + bug.right
    file.write_text(text.replace(bug.wrong, bug.right), "utf-8")
    trace = project.path / "trace.jsonl"
    result = project.run("replay", "crash.jsonl", "--trace", trace)
    assert result.code == 0, result.output
    assert "then " not in result.stdout
    assert not any(commands_while_disabled(trace))
    assert not any(not_numbers(trace))
