"""The names of WPILib's that are replaced, in one table."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import hal
import hal.simulation
import wpilib
import wpilib.simulation

from ....wpi import robots
from ...clock import to_us
from ...exceptions import TestEnded
from ...patch_table import Patch
from ...threads import cooperative
from ..active_run import active_run
from . import counters, driver_station, hal_notifiers, hal_resets, log_names, noise, sysid_logs
from .watchdog import Watchdog

if TYPE_CHECKING:
    from ....project.robot_files import RobotFiles

_real_sleep = time.sleep


def patches(files: Callable[[], RobotFiles]) -> list[Patch]:
    """Return the names to replace.

    :param files: returns the files of the robot project
    """
    return [
        *_waiting(),
        *hal_notifiers.patches(),
        *_stepping_in_tests(),
        *driver_station.patches(),
        *hal_resets.patches(),
        *_timed_robot(),
        *_directories(files),
        Patch(wpilib.RobotController, "isBrownedOut", _is_browned_out),
        *counters.patches(),
        *log_names.patches(),
        *sysid_logs.patches(),
        *noise.patches(),
    ]


def _waiting() -> list[Patch]:
    def wait(seconds: float) -> None:
        __tracebackhide__ = True
        threads = cooperative.scope.taking_part()
        if threads is None:
            return _real_sleep(seconds)
        return threads.sleep_until(threads.clock.now_us + max(0, to_us(seconds)))

    return [
        Patch(wpilib, "wait", wait),
        Patch(wpilib, "Watchdog", Watchdog),
    ]


def _stepping_in_tests() -> list[Patch]:
    """Tests that step WPILib's simulated time themselves move the robot with it."""

    def stepping(owner: object, name: str, in_us: Callable[[float], int]) -> Patch:
        real = getattr(owner, name)

        def step(delta: float) -> None:
            __tracebackhide__ = True
            run = active_run.run
            if run is None:
                real(delta)
                return
            target_us = run.clock.now_us + in_us(delta)
            if run.sleep_on_robot_thread(target_us):
                return
            try:
                run.clock.run_until(target_us)
            except TestEnded:
                if run.threads.failure is None:
                    raise
                raise run.threads.failure from None  # to the test, which has called this

        return Patch(owner, name, step)

    def left_to_the_run(owner: object, name: str) -> Patch:
        real = getattr(owner, name)

        def call() -> None:
            if active_run.run is None:
                real()

        return Patch(owner, name, call)

    table = []
    for owner, in_us in ((wpilib.simulation, to_us), (hal.simulation, int)):
        table += [stepping(owner, "stepTiming", in_us), stepping(owner, "stepTimingAsync", in_us)]
        # Time stands still between steps already, and begins at 0 with the run.
        table += [left_to_the_run(owner, f"{verb}Timing") for verb in ("pause", "resume", "restart")]
        table.append(left_to_the_run(owner, "waitForProgramStart"))
    return table


def _timed_robot() -> list[Patch]:
    TimedRobot = wpilib.TimedRobot
    real_add, real_start = TimedRobot.addPeriodic, TimedRobot.startCompetition
    real_end = TimedRobot.endCompetition
    real_loop_start = TimedRobot.getLoopStartTime
    real_turn: Callable[[wpilib.IterativeRobotBase], None] = robots.LOOP_FUNCTION.find()

    # Under its original name: profiles and the limit of a loop recognize it by that.
    def _loopFunc(robot: wpilib.IterativeRobotBase) -> None:
        __tracebackhide__ = True
        run = active_run.run
        if run is None:
            return real_turn(robot)
        began_us = run.clock.now_us
        real_turn(robot)
        if run.clock.now_us != began_us:
            run.overruns.look(robot, began_us)
        return None

    def add_periodic(
        robot: wpilib.TimedRobot, callback: Callable[[], None], period: float, offset: float = 0.0
    ) -> None:
        if active_run.run is None:
            real_add(robot, callback, period, offset)
        else:
            active_run.run.timed_loop.add(robot, callback, period, offset)

    # Under its original name, too: otherwise WPILib's own takes it for the method of a derived class, and calls it.
    def startCompetition(robot: wpilib.TimedRobot) -> None:
        __tracebackhide__ = True
        if active_run.run is None:
            return real_start(robot)
        active_run.run.timed_loop.begin(robot)
        return active_run.run.timed_loop.run_blocking(active_run.run.threads)

    def endCompetition(robot: wpilib.TimedRobot) -> None:
        run = active_run.run
        if run is not None and run.started:  # before that, only its alarm is cancelled: see `construction`
            run.timed_loop.stopped = True
        real_end(robot)

    def loop_start_time(robot: wpilib.TimedRobot) -> Any:
        return real_loop_start(robot) if active_run.run is None else active_run.run.timed_loop.loop_start_us

    return [
        Patch(TimedRobot, "addPeriodic", add_periodic),
        Patch(TimedRobot, "startCompetition", startCompetition),
        Patch(TimedRobot, "endCompetition", endCompetition),
        Patch(TimedRobot, "getLoopStartTime", loop_start_time),
        Patch(*robots.LOOP_FUNCTION.place, _loopFunc),
    ]


def _directories(files: Callable[[], RobotFiles]) -> list[Patch]:
    """WPILib takes the directory of whichever program was started for the robot's."""
    return [
        Patch(wpilib, "getOperatingDirectory", lambda: str(Path(files().root))),
        Patch(wpilib, "getDeployDirectory", lambda: str(Path(files().root, "deploy"))),
    ]


def _is_browned_out() -> bool:
    """Return whether the battery is too weak for the roboRIO's outputs: the simulated HAL always returns False."""
    controller = wpilib.RobotController
    return controller.getBatteryVoltage() < controller.getBrownoutVoltage()
