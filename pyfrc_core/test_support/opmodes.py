"""The opmodes that a robot publishes, for tests that run once for each of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..processes.call import run_in_subprocess
from ..runtime.checks.hang_detector import HangDetector
from ..runtime.loading import load_robot
from ..runtime.patches.install import patches
from ..runtime.robot import RobotRun
from ..wpi import station

if TYPE_CHECKING:
    from ..processes.crash_report import CrashLog
    from ..project import Project
    from ..wpi.opmodes import Opmode


def published_opmodes(project: Project) -> tuple[Opmode, ...]:
    """Return what the robot publishes when it is made: in another process, since tests are only collected here.

    :raises RobotCodeError: when the robot cannot be made
    """
    return run_in_subprocess(_publish, project, "while it was asked for its opmodes")


def _publish(project: Project, log: CrashLog) -> tuple[Opmode, ...]:
    patches.install(project.files)
    robot_class = load_robot(project)
    run = RobotRun()
    with HangDetector(project.files, project.settings.test.hang_seconds, log).watching():
        run.open()
        run.construct(robot_class)
        return tuple(sorted(station.published_opmodes(), key=lambda each: (each.mode, each.name)))
