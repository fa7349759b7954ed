"""The steps from a blank controller to a driving robot: which one is next, and its command."""

from __future__ import annotations

from enum import IntEnum

from ..deploy.robot_checks import PREPARE
from .check_result import CheckResult, hint, ok

#: The topic of the result.
NEXT_STEP = "next step"


class Step(IntEnum):
    """A step, in their order. All before it are done."""

    TEAM = 1
    DOWNLOADS = 2
    CONTROLLER = 3
    PACKAGES = 4
    PROGRAM = 5
    DRIVE = 6


_NAMES = {
    Step.TEAM: "the team number",
    Step.DOWNLOADS: "the downloads for the robot",
    Step.CONTROLLER: "the controller: its image, and the connection to it",
    Step.PACKAGES: "Python and packages on the robot",
    Step.PROGRAM: "the program on the robot",
}
_DRIVE = "Start the Driver Station, set your team number there, wait for Robot Code to become green, and enable."


def next_step(step: Step, remedy: str) -> CheckResult:
    """Return the result that names the next step.

    :param remedy: how to do it
    """
    if step is Step.DRIVE:
        return ok(NEXT_STEP, f"drive. {_DRIVE}")
    return hint(NEXT_STEP, f"{int(step)} of {len(Step)}, {_NAMES[step]}", remedy)


def first_missing(downloads: CheckResult | None, robot: tuple[Step, str]) -> CheckResult:
    """Return the next step. A robot that has all it needs makes the downloads unimportant.

    :param downloads: the result about the downloads; None: they were not checked
    :param robot:     the step that is missing for the robot, and how to do it
    """
    step, remedy = robot
    if downloads is not None and downloads.status != "ok" and Step.DOWNLOADS < step <= Step.PACKAGES:
        return next_step(Step.DOWNLOADS, downloads.remedy or "")
    if downloads is not None and remedy == PREPARE:
        remedy = "At the robot: pyfrc deploy, which installs what was downloaded."
    return next_step(step, remedy)
