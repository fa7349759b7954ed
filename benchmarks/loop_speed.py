"""How long the loop of the robot in the current directory takes: one measurement, in a process of its own.

``python loop_speed.py in-place`` measures pyfrc's loop, ``python loop_speed.py stepped`` WPILib's own without pyfrc.
Part of test_speed.py, which runs this; it lies outside of the robot's directory, where pyfrc would change its clock.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from pathlib import Path
from typing import Any

#: The simulated time, about a match; and how often the driver station speaks in it.
SECONDS, PACKET_SECONDS = 150, 0.02

JOYSTICKS, CONTROLS = 6, 12


def counting(robot_class: Any) -> Any:
    """The robot class, telling how often its `teleopPeriodic` ran: both loops must do the same."""

    class Counting(robot_class):  # type: ignore[misc]
        turns = 0

        def teleopPeriodic(self) -> None:
            super().teleopPeriodic()
            self.turns += 1

    return Counting


def in_place() -> tuple[float, int]:
    """The seconds that pyfrc's loop takes for `SECONDS` of an enabled robot, and how often its code was called."""
    perf_counter = time.perf_counter  # before it is redirected
    from pyfrc_core.project import find_project
    from pyfrc_core.runtime.loading import load_robot
    from pyfrc_core.runtime.patches.install import patches
    from pyfrc_core.runtime.robot import RobotRun
    from pyfrc_core.wpi import station

    project = find_project(Path.cwd())
    patches.install(project.files)
    run = RobotRun()
    run.open()
    robot = run.construct(counting(load_robot(project)))
    run.start()
    station.set_mode(enabled=True)
    begin = perf_counter()
    run.run_until(SECONDS * 1_000_000)
    return perf_counter() - begin, robot.turns


def stepped() -> tuple[float, int]:
    """The same of WPILib's own loop on a thread, stepped from this one: what any test could do without pyfrc."""
    import hal.simulation
    import ntcore
    import wpilib.simulation

    sys.path.insert(0, str(Path.cwd()))
    robot_class = __import__("robot").MyRobot
    ntcore.NetworkTableInstance.getDefault().startLocal()
    wpilib.simulation.pauseTiming()
    station = wpilib.simulation.DriverStationSim
    station.setDsAttached(True)
    station.setEnabled(True)
    for stick in range(JOYSTICKS):  # without these, WPILib would print warnings of missing controls
        station.setJoystickAxisCount(stick, CONTROLS)
        station.setJoystickButtonCount(stick, CONTROLS)
    robot = counting(robot_class)()
    thread = threading.Thread(target=robot.startCompetition, daemon=True)
    thread.start()
    wpilib.simulation.waitForProgramStart()
    begin = time.perf_counter()
    for _ in range(round(SECONDS / PACKET_SECONDS)):
        hal.simulation.notifyDriverStationNewData()
        wpilib.simulation.stepTiming(PACKET_SECONDS)
    seconds = time.perf_counter() - begin
    robot.endCompetition()
    thread.join()
    return seconds, robot.turns


def main() -> None:
    """Measure, and tell the simulated seconds per second as JSON."""
    seconds, turns = {"in-place": in_place, "stepped": stepped}[sys.argv[1]]()
    # The first and the last turn may fall on either side of what was timed.
    if abs(turns - SECONDS / PACKET_SECONDS) > 2:
        sys.exit(f"the robot's loop ran {turns} times in {SECONDS} s of {PACKET_SECONDS} s periods")
    print(json.dumps({"speed": SECONDS / seconds}), flush=True)
    os._exit(0)  # without taking the HAL down, which is not what is measured


if __name__ == "__main__":
    main()
