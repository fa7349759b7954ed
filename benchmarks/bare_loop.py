"""A robot's own code in a bare loop, without pyfrc: the least that a match of it can cost. Used by competition.py.

    python bare_loop.py PROJECT

constructs the robot and its physics, calls both every 20 ms of a practice match, steps WPILib's clock in between, and
prints the processor time as JSON. PROJECT's robot is a `TimedRobot`, or a `magicbot.MagicRobot`.
"""

from __future__ import annotations

import contextlib
import inspect
import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

PERIOD = 0.02
#: Seconds of a match, as pyfrc's practice match has them: disabled, autonomous, disabled, teleoperated.
MATCH = ((1.0, False, False), (15.0, True, True), (3.0, False, False), (135.0, True, False))


class Controller:
    """What physics move the robot with."""

    def __init__(self) -> None:
        import wpilib
        from wpimath.geometry import Pose2d

        self.pose, self.field = Pose2d(), wpilib.Field2d()

    def drive(self, speeds: Any, seconds: float) -> Any:
        from wpimath.geometry import Twist2d

        self.pose = self.pose.exp(Twist2d(speeds.vx * seconds, speeds.vy * seconds, speeds.omega * seconds))
        return self.pose

    def move_robot(self, moved: Any) -> Any:
        self.pose = self.pose + moved
        return self.pose

    def get_pose(self) -> Any:
        return self.pose


class World:
    """Everything around the robot's loop: time, physics, driver station."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._physics: Any = None
        self._now = 0.0

    def packets(self) -> Iterator[tuple[bool, bool, bool]]:
        """Step through the match; yield for each packet: enabled, autonomous, whether the mode is new."""
        import physics
        import wpilib
        from wpilib.simulation import DriverStationSim, stepTiming

        self._physics = physics.PhysicsEngine(Controller(), self._robot)
        DriverStationSim.setDsAttached(True)
        for seconds, enabled, autonomous in MATCH:
            for number in range(round(seconds / PERIOD)):
                stepTiming(PERIOD)
                self._now += PERIOD
                self._physics.update_sim(self._now, PERIOD)
                DriverStationSim.setEnabled(enabled)
                DriverStationSim.setAutonomous(autonomous)
                DriverStationSim.notifyNewData()
                wpilib.DriverStation.refreshData()
                yield enabled, autonomous, number == 0


def run_timed(robot: Any) -> None:
    """Call what `TimedRobot` calls."""
    import wpilib

    robot.robotInit()
    for enabled, autonomous, is_new in World(robot).packets():
        mode = "disabled" if not enabled else "autonomous" if autonomous else "teleop"
        if is_new:
            getattr(robot, f"{mode}Init")()
        getattr(robot, f"{mode}Periodic")()
        robot.robotPeriodic()
        wpilib.SmartDashboard.updateValues()
        wpilib.LiveWindow.updateValues()
        robot.simulationPeriodic()


def run_magic(robot: Any) -> None:
    """Run MagicRobot's own loops; they step the match where they would wait."""
    import magicbot.magicrobot

    packets: Iterator[Any] = iter(())

    class Delay:
        def __init__(self, *_: object) -> None: ...

        def wait(self) -> None:
            nonlocal packets
            if not isinstance(packets, GeneratorType):
                packets = World(robot).packets()
            if next(packets, None) is None:
                raise Ended

        def __enter__(self) -> Delay:
            return self

        def __exit__(self, *_: object) -> None: ...

        def free(self) -> None: ...

    GeneratorType = type(World(robot).packets())
    magicbot.magicrobot.NotifierDelay = Delay
    with contextlib.suppress(Ended):
        robot.startCompetition()


class Ended(Exception):
    """The match is over."""


def main() -> None:
    """Import, run, print."""
    project = Path(sys.argv[1]).resolve()
    os.chdir(project)
    sys.path.insert(0, str(project))
    begin = time.process_time()
    import hal
    import wpilib
    from wpilib.simulation import pauseTiming

    hal.initialize(500, 0)
    pauseTiming()
    import robot as program

    classes = [each for each in vars(program).values() if inspect.isclass(each) and each.__module__ == "robot"]
    robot_class = next(each for each in classes if issubclass(each, wpilib.RobotBase))
    imported = time.process_time()
    robot = robot_class()
    run: Callable[[Any], None] = run_timed if isinstance(robot, wpilib.TimedRobot) else run_magic
    run(robot)
    print(json.dumps({"import": imported - begin, "match": time.process_time() - imported}), flush=True)
    os._exit(0)  # threads of vendors' libraries do not end


if __name__ == "__main__":
    main()
