"""The names of WPILib's that are replaced, in one table."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import hal
import hal.simulation
import wpilib
import wpilib.simulation

from ....compat.private_name import PrivateName
from ....hal.season_2027 import onboard_imu
from ....patch_table import Patch
from ....wpi import encoder_channels
from ....wpi.season_2027 import robots, timing
from ...clock import to_us
from .. import hal_resets, noise, timeslices
from ..active_run import active_run
from ..made_devices import noting
from ..stepping import left_to_the_run, stepping, wait
from . import driver_station, hal_notifiers, log_names, opmodes
from .watchdog import Watchdog

if TYPE_CHECKING:
    from ....project.robot_files import RobotFiles


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
        *hal_resets.patches("reset_data", "reset_driver_station_data", "reset_all_sim_data", _attach),
        *_timed_robots(),
        *timeslices.patches(wpilib.TimesliceRobot, _note_slices),
        *_directories(files),
        noting(
            wpilib.Encoder, lambda made, *args, **kwargs: encoder_channels.note(made.get_fpga_index(), *args, **kwargs)
        ),
        noting(wpilib.OnboardIMU, onboard_imu.note),
        noting(wpilib.OpModeRobotBase, robots.note_period),
        Patch(wpilib.RobotController, "is_browned_out", _is_browned_out),
        *log_names.patches(),
        *noise.patches("create_kitbot_sim"),
    ]


def _stepping_in_tests() -> list[Patch]:
    """Tests that step WPILib's simulated time themselves move the robot with it."""
    table = []
    for owner, in_us in ((wpilib.simulation, to_us), (hal.simulation, lambda ns: int(ns) // timing.NS_PER_US)):
        table += [stepping(owner, "step_timing", in_us), stepping(owner, "step_timing_async", in_us)]
        # Time stands still between steps already, and begins at 0 with the run.
        table += [left_to_the_run(owner, f"{verb}_timing") for verb in ("pause", "resume", "restart")]
        table.append(left_to_the_run(owner, "wait_for_program_start"))
    return table


def _timed_robots() -> list[Patch]:
    table = [*_timed_robot(wpilib.TimedRobot, robots.LOOP_FUNCTION), *opmodes.patches()]
    return [*table, *_timed_robot(wpilib.OpModeRobotBase, robots.OPMODE_LOOP_FUNCTION)]


def _timed_robot(base: Any, loop_function: PrivateName) -> list[Patch]:
    """Return the functions of a class of robots that run its loop."""
    real_add, real_start, real_end = base.add_periodic, base.start_competition, base.end_competition
    real_loop_start = base.get_loop_start_time
    real_turn: Callable[[Any], None] = loop_function.find()

    # Under its original name: profiles and the limit of a loop recognize it by that.
    def _loop_func(robot: Any) -> None:
        __tracebackhide__ = True
        run = active_run.run
        if run is None:
            return real_turn(robot)
        began_us = run.clock.now_us
        real_turn(robot)
        opmodes.look()
        if run.clock.now_us != began_us:
            run.overruns.look(robot, began_us)
        return None

    def add_periodic(robot: Any, callback: Callable[[], None], period: float, offset: float = 0.0) -> None:
        if active_run.run is None:
            real_add(robot, callback, period, *([offset] if offset else []))
        else:
            active_run.run.timed_loop.add(robot, callback, period, offset)

    # Under its original name, too: otherwise WPILib's own takes it for the method of a derived class, and calls it.
    def start_competition(robot: Any) -> None:
        __tracebackhide__ = True
        if active_run.run is None:
            real_start(robot)
            return
        active_run.run.timed_loop.begin(robot)
        active_run.run.timed_loop.run_blocking(active_run.run.threads)

    def end_competition(robot: Any) -> None:
        run = active_run.run
        if run is not None and run.started:  # before that, only its alarm is cancelled: see `construction`
            run.timed_loop.stopped = True
        real_end(robot)

    def loop_start_time(robot: Any) -> Any:
        run = active_run.run
        return real_loop_start(robot) if run is None else timing.hal_time(run.timed_loop.loop_start_us)

    return [
        Patch(base, "add_periodic", add_periodic),
        Patch(base, "start_competition", start_competition),
        Patch(base, "end_competition", end_competition),
        Patch(base, "get_loop_start_time", loop_start_time),
        Patch(base, loop_function.name, _loop_func),
    ]


def _note_slices(robot: Any, robot_periodic_allocation: float, controller_period: float) -> None:
    timeslices.note(robot, robot_periodic_allocation, controller_period)


def _attach() -> None:
    hal.simulation.set_driver_station_ds_attached(True)


def _directories(files: Callable[[], RobotFiles]) -> list[Patch]:
    """WPILib takes the directory of whichever program was started for the robot's."""
    return [
        Patch(wpilib, "get_operating_directory", lambda: str(Path(files().root))),
        Patch(wpilib, "get_deploy_directory", lambda: str(Path(files().root, "deploy"))),
    ]


def _is_browned_out() -> bool:
    """Return whether the battery is too weak for the outputs: the simulated HAL always returns False."""
    return wpilib.RobotController.get_battery_voltage() < wpilib.simulation.RoboRioSim.get_brownout_voltage()
