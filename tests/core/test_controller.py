"""The controller of tests, with a run that notes what is done with it."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.test_support import controller
from pyfrc_core.test_support.controller import CalledTooLate, TestController, WrongController

FILES = RobotFiles(Path(__file__).parent)


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The rules that a run checks."""
    found: list[Any] = []
    monkeypatch.setattr(controller, "watch_invariants", lambda run, files, rules: found.append(rules))
    return found


def control_of(project: Any = None, rules: tuple[str, ...] = ("a rule",)) -> Any:
    run = SimpleNamespace(started=False, check_drives_clock=lambda what: None)
    return TestController(SimpleNamespace(run=run), project, 3, rules)  # type: ignore[arg-type]


def test_the_rules_of_a_project_are_checked_unless_the_test_says_no(watched: list[Any]) -> None:
    project = SimpleNamespace(files=FILES)
    control_of(project)._begin("run_test")
    assert watched == [("a rule",)]
    control = control_of(project)
    control.check_invariants = False
    control._begin("run_test")
    control_of(None)._begin("run_test")  # of no project
    assert watched == [("a rule",)]


def test_a_second_run_names_the_line_of_the_first(watched: list[Any]) -> None:
    control = control_of(SimpleNamespace(files=FILES))
    control._begin("run_test")
    control._run.started = True
    line = test_a_second_run_names_the_line_of_the_first.__code__.co_firstlineno + 2
    with pytest.raises(CalledTooLate, match=rf"run_robot\(\): .* in this test, at test_controller\.py:{line}\. It can"):
        control._begin("run_robot")
    with pytest.raises(CalledTooLate, match="must be called before run_test"):
        control.set_practice_match()


def test_what_cannot_be_called_with_the_time_is_refused() -> None:
    class NeedsMore:
        def __init__(self, robot: object) -> None: ...

    class NoStep: ...

    for wrong, text in (
        (lambda: True, "which does not fit its parameters"),
        (NeedsMore, "is called without arguments"),
        (NoStep, "is neither a function nor a class with an on_step method"),
        (None, "needs a function to call on each step"),
        (5, "5 is neither a function"),
    ):
        with pytest.raises(WrongController, match=text):
            control_of()._steps(wrong)


def test_none_ends_a_run_and_not_a_match() -> None:
    steps = iter([None, True, False])
    control = control_of()
    (step,) = control._steps(lambda now: next(steps))[1]
    with pytest.warns(UserWarning, match=r"returned None, which ends the run at 1\.50 s"):
        step(1.5)
    assert "returned None" in control.ended_early
    step = controller._until_false(lambda now: next(steps))
    assert [step(0.0), step(0.0)] == [True, False]
    assert controller._until_false(lambda now: None)(0.0) is True
