"""A robot's own code in a bare loop, without pyfrc: the least that a match of it can cost. Used by competition.py.

    python bare_loop.py PROJECT

constructs the robot and its physics, calls both every 20 ms of a practice match, steps WPILib's clock in between, and
prints the processor time as JSON. PROJECT's robot is a `TimedRobot`, or a `magicbot.MagicRobot`.
"""

from __future__ import annotations

import contextlib
import inspect
import json
import math
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

        self.pose, self.field, self._yaw = Pose2d(), wpilib.Field2d(), None

    def drive(self, speeds: Any, seconds: float) -> Any:
        from wpimath.geometry import Twist2d

        self.pose = self.pose.exp(Twist2d(speeds.vx * seconds, speeds.vy * seconds, speeds.omega * seconds))
        if self._yaw is not None:
            self._yaw.set(-self.pose.rotation().degrees())
        return self.pose

    def add_device_gyro_channel(self, name: str) -> None:
        from wpilib.simulation import SimDeviceSim

        if name != "navx_spi_4_angle":
            raise NotImplementedError(name)
        self._yaw = SimDeviceSim("navX-Sensor", 4).getDouble("Yaw")

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
        from hal.simulation import notifyDriverStationNewData
        from wpilib.simulation import DriverStationSim, stepTimingAsync

        self._physics = physics.PhysicsEngine(Controller(), self._robot)
        DriverStationSim.setDsAttached(True)
        for port in range(wpilib.DriverStation.kJoystickPorts):
            DriverStationSim.setJoystickAxisCount(port, 6)
            DriverStationSim.setJoystickButtonCount(port, 12)
            DriverStationSim.setJoystickPOVCount(port, 1)
        for seconds, enabled, autonomous in MATCH:
            for number in range(round(seconds / PERIOD)):
                stepTimingAsync(PERIOD)
                self._now += PERIOD
                self._physics.update_sim(self._now, PERIOD)
                DriverStationSim.setEnabled(enabled)
                DriverStationSim.setAutonomous(autonomous)
                notifyDriverStationNewData()  # the robot's loop takes it in, as WPILib's and magicbot's do
                yield enabled, autonomous, number == 0


class Periodic:
    """What a robot calls beside its modes: `TimedRobot.addPeriodic`, which WPILib itself would call."""

    def __init__(self) -> None:
        self._calls: list[tuple[Callable[[], None], float, float]] = []

    def add(self, _: Any, callback: Callable[[], None], period: float, offset: float = 0.0) -> None:
        self._calls.append((callback, float(period), float(offset)))

    def run(self, packet: int) -> None:
        """Call what is due in this packet; the clock stands still meanwhile."""
        begin, end = packet * PERIOD, (packet + 1) * PERIOD
        for callback, period, offset in self._calls:
            first = math.ceil((begin - offset) / period - 1e-9)
            last = math.ceil((end - offset) / period - 1e-9)
            for _ in range(max(first, 0), last):
                callback()


def run_timed(robot: Any, periodic: Periodic) -> None:
    """Call what `TimedRobot` calls."""
    import hal
    import wpilib

    # Python's WPILib has the base class's method under a name of its own.
    simulation_periodic = getattr(robot, "simulationPeriodic", robot._simulationPeriodic)
    robot.robotInit()
    for packet, (enabled, autonomous, is_new) in enumerate(World(robot).packets()):
        wpilib.DriverStation.refreshData()
        mode = "disabled" if not enabled else "autonomous" if autonomous else "teleop"
        if is_new:
            getattr(robot, f"{mode}Init")()
        getattr(robot, f"{mode}Periodic")()
        robot.robotPeriodic()
        wpilib.SmartDashboard.updateValues()
        wpilib.LiveWindow.updateValues()
        hal.simPeriodicBefore()  # vendors' libraries register callbacks with it
        simulation_periodic()
        hal.simPeriodicAfter()
        periodic.run(packet)


def run_magic(robot: Any) -> None:
    """Run MagicRobot's own loops; they step the match where they would wait."""
    from robotpy_ext.misc.precise_delay import NotifierDelay

    packets: Iterator[Any] | None = None

    def step(_: object) -> None:
        nonlocal packets
        if packets is None:
            packets = World(robot).packets()
        if next(packets, None) is None:
            raise Ended

    # Changed in the class: MagicRobot and its autonomous selector have imported it by name.
    NotifierDelay.__init__ = lambda *_: None
    NotifierDelay.wait = step
    NotifierDelay.free = lambda _: None
    with contextlib.suppress(Ended):
        robot.startCompetition()


class Ended(Exception):
    """The match is over."""


def main() -> None:
    """Import, run, print."""
    project = Path(sys.argv[1]).resolve()
    os.chdir(project)
    sys.path.insert(0, str(project))
    sys.modules["__main__"].__file__ = str(project / "robot.py")  # WPILib finds the deploy directory beside it
    begin = time.process_time()
    import hal
    import ntcore
    import wpilib
    from wpilib.simulation import pauseTiming

    hal.initialize(500, 0)
    pauseTiming()
    # Or WPILib starts a server, whose threads send to nothing.
    ntcore.NetworkTableInstance.getDefault().startLocal()
    import robot as program

    classes = [each for each in vars(program).values() if inspect.isclass(each) and each.__module__ == "robot"]
    robot_class = next(each for each in classes if issubclass(each, wpilib.RobotBase))
    imported = time.process_time()
    periodic = Periodic()
    wpilib.TimedRobot.addPeriodic = lambda *args, **named: periodic.add(*args, **named)
    robot = robot_class()
    if isinstance(robot, wpilib.TimedRobot):
        run_timed(robot, periodic)
    else:
        run_magic(robot)
    print(json.dumps({"import": imported - begin, "match": time.process_time() - imported}), flush=True)
    os._exit(0)  # threads of vendors' libraries do not end


if __name__ == "__main__":
    main()
