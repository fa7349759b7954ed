"""The names of WPILib's that are replaced, in one table."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import hal
import hal.simulation
import wpilib
import wpilib.simulation

from ....patch_table import Patch
from ....project.robot_files import RobotFiles
from ....wpi import encoder_channels, robots
from ...clock import to_us
from .. import hal_resets, noise, timeslices
from ..active_run import active_run
from ..made_devices import noting
from ..stepping import left_to_the_run, stepping, wait
from . import counters, driver_station, hal_notifiers, log_names, sysid_logs
from .watchdog import Watchdog


def patches(files: Callable[[], RobotFiles]) -> list[Patch]:
    """Return the names to replace.

    :param files: returns the files of the robot project
    """
    return [
        Patch(wpilib, "wait", wait),
        Patch(wpilib, "Watchdog", Watchdog),
        *hal_notifiers.patches(),
        *_stepping_in_tests(),
        *driver_station.patches(),
        *hal_resets.patches("resetData", "resetDriverStationData", "resetAllSimData", _attach),
        *_timed_robot(),
        *timeslices.patches(wpilib.TimesliceRobot, _note_slices),
        *_directories(files),
        noting(
            wpilib.Encoder, lambda made, *args, **kwargs: encoder_channels.note(made.getFPGAIndex(), *args, **kwargs)
        ),
        Patch(wpilib.RobotController, "isBrownedOut", _is_browned_out),
        *counters.patches(),
        *log_names.patches(),
        *sysid_logs.patches(),
        *noise.patches("createKitbotSim"),
    ]


def _stepping_in_tests() -> list[Patch]:
    """Tests that step WPILib's simulated time themselves move the robot with it."""
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


def _note_slices(robot: Any, robotPeriodicAllocation: float, controllerPeriod: float) -> None:
    timeslices.note(robot, robotPeriodicAllocation, controllerPeriod)


def _attach() -> None:
    hal.simulation.setDriverStationDsAttached(True)


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
