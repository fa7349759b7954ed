"""The opmodes that a robot publishes, for tests that run once for each of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from ..errors import RobotCodeError, UsageError
from ..processes.call import run_in_subprocess
from ..processes.crash_report import CrashLog
from ..project import Project
from ..runtime.checks.failures import as_robot_code_error
from ..runtime.checks.hang_detector import HangDetector
from ..runtime.exceptions import TestFroze, TestRanTooLong
from ..runtime.loading import load_robot
from ..runtime.patches.install import patches
from ..runtime.robot import RobotRun
from ..wpi import station
from ..wpi.opmodes import OpmodeOfTests, PublishedOpmode
from .options import READY_MADE_TESTS

#: Limits a test with the fixture `opmode` to the opmodes that it names: ``@pytest.mark.opmode("Drive")``.
MARK = "opmode"


def run_for_each(metafunc: pytest.Metafunc, published: Callable[[], tuple[PublishedOpmode, ...]]) -> None:
    """Make a test that has the fixture `opmode` one test for each opmode, or for each that its mark names.

    :param published: returns the opmodes of the robot
    :raises UsageError: when there is no opmode of a name, or a mark without the fixture
    """
    named = [name for mark in metafunc.definition.iter_markers(MARK) for name in mark.args]
    if "opmode" not in metafunc.fixturenames:
        if metafunc.definition.get_closest_marker(MARK) is not None:
            raise UsageError(
                f"{metafunc.function.__name__} has the mark opmode, but no argument opmode",
                where=_place(metafunc),
                remedy="Give it the argument, and pass that on: control.step_timing(..., opmode=opmode).",
            )
        return
    if any("opmode" in str(mark.args[:1]) for mark in metafunc.definition.iter_markers("parametrize")):
        return  # the test's own choice
    try:
        opmodes = published()
    except RobotCodeError as error:  # for this test only: others may not need the robot
        metafunc.parametrize("opmode", [pytest.param(error, id="?")], indirect=True)
        return
    wrong = sorted(set(named) - {each.name for each in opmodes})
    if wrong:
        there = ", ".join(repr(each.name) for each in opmodes) or "none"
        raise UsageError(
            f"{metafunc.function.__name__} is marked with the opmode {wrong[0]!r}: the robot has published {there}",
            where=_place(metafunc),
        )
    chosen = [each for each in opmodes if not named or each.name in named]
    metafunc.parametrize(
        "opmode",
        [pytest.param(station.opmode_of_tests(each), id=f"{each.mode}-{each.name}") for each in chosen],
        indirect=True,
    )


def value_of(parameter: Any) -> OpmodeOfTests:
    """Return what the fixture `opmode` gives, or raise the reason why it is not known."""
    if isinstance(parameter, RobotCodeError):
        raise parameter
    opmode: OpmodeOfTests = parameter
    return opmode


def _place(metafunc: pytest.Metafunc) -> str:
    file, line, _ = metafunc.definition.location
    return f"{file}:{(line or 0) + 1}"


def hint_without_opmode(item: pytest.Item) -> list[tuple[str, str]]:
    """Return a section for the report of a failed test that has chosen none of the robot's opmodes."""
    if getattr(getattr(item, "function", None), "__module__", "").startswith(READY_MADE_TESTS):
        return []
    run = (getattr(item, "funcargs", None) or {}).get("_robot_run")
    if not isinstance(run, RobotRun) or not run.started or station.has_chosen_opmode():
        return []
    published = station.published_opmodes()
    if not published:
        return []
    text = "No opmode was selected in this test, so none has run: control.step_timing(..., opmode={!r}) selects one."
    return [("pyfrc", text.format(published[0].name))]


def published_opmodes(project: Project) -> tuple[PublishedOpmode, ...]:
    """Return what the robot publishes when it is made: in another process, since tests are only collected here.

    :raises RobotCodeError: when the robot cannot be made
    """
    return run_in_subprocess(_publish, project, "while it was asked for its opmodes")


def _publish(project: Project, log: CrashLog) -> tuple[PublishedOpmode, ...]:
    patches.install(project.files)
    robot_class = load_robot(project)
    run = RobotRun()
    with HangDetector(project.files, project.settings.test.hang_seconds, log).watching():
        run.open()
        try:
            run.construct(robot_class)
        except (Exception, SystemExit, TestFroze, TestRanTooLong) as error:
            raise as_robot_code_error(error, project.files) from error
        return tuple(sorted(station.published_opmodes(), key=lambda each: (each.mode, each.name)))
