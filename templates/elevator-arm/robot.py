"""An elevator with an arm at its top: buttons choose a position, controllers move both there and hold them."""

import math

import wpilib

from arm import Arm
from elevator import Elevator

# Positions by name: the elevator's height in metres, the arm's angle in radians (0 is level, up is positive).
STOWED = (0.0, math.radians(-80))
FLOOR = (0.1, math.radians(-30))
SHELF = (0.7, math.radians(0))
TOP = (1.3, math.radians(60))


class MyRobot(wpilib.TimedRobot):
    """The robot. WPILib calls each method at the time that its name says."""

    def robotInit(self) -> None:
        """Called once when the program starts."""
        self.elevator = Elevator()
        self.arm = Arm()
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()
        self.create_picture()

    def create_picture(self) -> None:
        """Create a drawing for the dashboard: a line as long as the elevator's height, with the arm at its end."""
        self.picture = wpilib.Mechanism2d(2.0, 2.7)  # metres wide and high
        self.elevator_line = self.picture.getRoot("elevator", 1.0, 0.4).appendLigament("carriage", 0.3, 90)
        self.arm_line = self.elevator_line.appendLigament("arm", 0.6, -90)
        wpilib.SmartDashboard.putData("Mechanism", self.picture)

        # Their numbers can be changed on the dashboard while the robot runs.
        wpilib.SmartDashboard.putData("Elevator controller", self.elevator.controller)
        wpilib.SmartDashboard.putData("Arm controller", self.arm.controller)

    def robotPeriodic(self) -> None:
        """Called every 20 ms in every mode: show the measured positions."""
        wpilib.SmartDashboard.putNumber("Elevator height", self.elevator.height)
        wpilib.SmartDashboard.putNumber("Arm angle", math.degrees(self.arm.angle))
        self.elevator_line.setLength(0.3 + self.elevator.height)
        self.arm_line.setAngle(math.degrees(self.arm.angle) - 90)

    def autonomousInit(self) -> None:
        """Called once when autonomous starts."""
        self.start_from_here()
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        """Called every 20 ms in autonomous: reach to the top for four seconds, then stow."""
        self.go_to(TOP if self.timer.get() < 4.0 else STOWED)
        self.move()

    def teleopInit(self) -> None:
        """Called once when teleop starts."""
        self.start_from_here()

    def teleopPeriodic(self) -> None:
        """Called every 20 ms in teleop. One press of a button is enough: the robot holds the position."""
        if self.gamepad.getAButtonPressed():
            self.go_to(FLOOR)
        if self.gamepad.getBButtonPressed():
            self.go_to(SHELF)
        if self.gamepad.getYButtonPressed():
            self.go_to(TOP)
        if self.gamepad.getXButtonPressed():
            self.go_to(STOWED)
        self.move()

    def disabledInit(self) -> None:
        """Called once when the robot is disabled: turn off, so that nothing moves suddenly later."""
        self.elevator.stop()
        self.arm.stop()

    def disabledPeriodic(self) -> None:
        """Called every 20 ms while the robot is disabled."""

    def go_to(self, place: tuple[float, float]) -> None:
        """Set the goals of both mechanisms."""
        height, angle = place
        self.elevator.go_to(height)
        self.arm.go_to(angle)

    def move(self) -> None:
        """Move both mechanisms to their goals. Call this every 20 ms."""
        self.elevator.move()
        self.arm.move()

    def start_from_here(self) -> None:
        """Hold the current positions: both mechanisms have sunk while the robot was disabled."""
        self.elevator.start_from_here()
        self.arm.start_from_here()
