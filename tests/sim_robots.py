"""A robot for the simulator's tests, and what every one of them does with a simulation."""

from __future__ import annotations

import re
from collections.abc import Callable

from pyfrc_core.season import CURRENT
from pyfrc_core.sim import Simulation

#: Wall seconds after which a test gives up. Decides nothing else: a busy machine may take its time.
PATIENCE = 60.0

FILES = {
    "robot.py": """
        import os
        import sys

        import wpilib
        from pyfrc.sim import get_user_renderer

        SPEED = 1.0


        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.left = wpilib.PWMSparkMax(0)
                self.right = wpilib.PWMSparkMax(1)
                self.stick = wpilib.Joystick(0)
                self.switch = wpilib.DigitalInput(3)
                self.chooser = wpilib.SendableChooser()
                self.chooser.setDefaultOption("Nothing", 0.0)
                self.chooser.addOption("Forward", 1.0)
                wpilib.SmartDashboard.putData("Auto", self.chooser)
                print("the robot is there")
                renderer = get_user_renderer()
                if renderer is not None:
                    renderer.draw_text("hello", (1, 2))

            def autonomousPeriodic(self):
                speed = self.chooser.getSelected()
                self.left.set(speed)
                self.right.set(-speed)

            def teleopPeriodic(self):
                forward, turn = -SPEED * self.stick.getY(), self.stick.getX()
                self.left.set(forward + turn)
                self.right.set(-forward + turn)
                if self.stick.getRawButton(5):
                    self.left.set(1 / 0)
                if self.stick.getRawButton(6):
                    while True:
                        pass
                if self.stick.getRawButton(7):
                    os._exit(3)

            def disabledInit(self):
                self.left.set(0)
                self.right.set(0)
    """,
    "physics.py": """
        from pyfrc.physics import drivetrains


        class PhysicsEngine:
            def __init__(self, physics_controller):
                self.physics_controller = physics_controller
                self.drivetrain = drivetrains.TwoMotorDrivetrain(x_wheelbase=2, speed=5)

            def update_sim(self, hal_data, now, tm_diff):
                left, right = hal_data["pwm"][0]["value"], hal_data["pwm"][1]["value"]
                speed, rotation = self.drivetrain.get_vector(-left, -right)
                self.physics_controller.drive(speed, rotation, tm_diff)
    """,
    "sim/config.json": """
        {"pyfrc": {"robot": {"starting_x": 10, "starting_y": 12, "starting_angle": 0,
                             "start_positions": [{"name": "left", "x": 2, "y": 3, "angle": 90},
                                                 {"name": "right", "x": 2, "y": 20}]}}}
    """,
    "pyproject.toml": """
        [tool.pyfrc.test]
        hang_seconds = 0.5

        [tool.pyfrc.match]
        before = 0.2
        autonomous = 1
        pause = 0.2
        teleop = 2
    """,
}

if CURRENT.year >= 2027:  # which has no choosers
    FILES["robot.py"] = re.sub(r"self\.chooser\.getSelected\(\)", "0.0", FILES["robot.py"])
    FILES["robot.py"] = re.sub(r"(?m)^.*[Cc]hooser.*\n", "", FILES["robot.py"])


def wait(simulation: Simulation, condition: Callable[[], bool]) -> None:
    """Wait until this is so."""
    assert simulation.wait_for(condition, PATIENCE), (simulation.status, simulation.output_cursor().read())


def settle(simulation: Simulation) -> None:
    """Wait until the robot stands still in time, or has failed."""
    wait(simulation, lambda: simulation.status.state in ("paused", "failed"))


def run(simulation: Simulation, seconds: float) -> None:
    """Let so much robot time pass."""
    settle(simulation)
    assert simulation.snapshot is not None
    until = simulation.snapshot.time + seconds - 1e-6
    simulation.run_for(seconds)
    wait(
        simulation,
        lambda: (
            simulation.status.state == "failed"
            or (
                simulation.status.state == "paused"
                and simulation.snapshot is not None
                and simulation.snapshot.time > until
            )
        ),
    )
