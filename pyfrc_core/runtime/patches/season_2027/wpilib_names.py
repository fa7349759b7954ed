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

from ....compat.private_name import PrivateName
from ....hal.season_2027 import onboard_imu
from ....wpi.season_2027 import robots, timing
from ...clock import to_us
from ...exceptions import TestEnded
from ...patch_table import Patch
from ...threads import cooperative
from ..active_run import active_run
from . import driver_station, hal_notifiers, hal_resets, log_names, noise, opmodes
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
        *_timed_robots(),
        *_directories(files),
        _onboard_imu(),
        Patch(wpilib.RobotController, "is_browned_out", _is_browned_out),
        *log_names.patches(),
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

    def stepping(owner: object, name: str, in_us: Callable[[Any], int]) -> Patch:
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


def _directories(files: Callable[[], RobotFiles]) -> list[Patch]:
    """WPILib takes the directory of whichever program was started for the robot's."""
    return [
        Patch(wpilib, "get_operating_directory", lambda: str(Path(files().root))),
        Patch(wpilib, "get_deploy_directory", lambda: str(Path(files().root, "deploy"))),
    ]


def _onboard_imu() -> Patch:
    """Tell `hal_data` of the robot's IMU: the HAL does not."""
    real: Callable[..., None] = wpilib.OnboardIMU.__init__

    def __init__(self: Any, *args: Any, **kwargs: Any) -> None:
        real(self, *args, **kwargs)
        onboard_imu.note(self)

    return Patch(wpilib.OnboardIMU, "__init__", __init__)


def _is_browned_out() -> bool:
    """Return whether the battery is too weak for the outputs: the simulated HAL always returns False."""
    return wpilib.RobotController.get_battery_voltage() < wpilib.simulation.RoboRioSim.get_brownout_voltage()
