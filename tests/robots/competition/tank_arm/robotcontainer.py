"""All subsystems, the buttons, and the choice of the autonomous routine."""

import autos
import commands2
import commands2.button
import commands2.cmd
import wpilib
from constants import Driver, Positions
from subsystems.arm import ArmAndWrist
from subsystems.drivetrain import Drivetrain
from subsystems.elevator import ElevatorLift
from subsystems.gripper import Gripper
from subsystems.leds import Leds
from subsystems.vision import Cameras
from superstructure import Superstructure
from wpimath import applyDeadband
from wpimath.filter import SlewRateLimiter


class RobotContainer:
    """Creates the subsystems, and binds commands to buttons."""

    def __init__(self) -> None:
        self.drivetrain = Drivetrain()
        self.elevator = ElevatorLift()
        self.arm = ArmAndWrist(self.elevator.lift)
        self.gripper = Gripper()
        self.vision = Cameras(self.drivetrain)
        self.leds = Leds(self.gripper)
        self.superstructure = Superstructure(self.elevator, self.arm)

        self.driver = commands2.button.CommandXboxController(Driver.DRIVER_PORT)
        self.operator = commands2.button.CommandXboxController(Driver.OPERATOR_PORT)
        self.forward_limiter = SlewRateLimiter(4.0)
        self.bind_driver()
        self.bind_operator()

        self.speed_chooser = wpilib.SendableChooser()
        self.speed_chooser.setDefaultOption("Full speed", 1.0)
        self.speed_chooser.addOption("Demonstration", 0.5)
        wpilib.SmartDashboard.putData("Speed", self.speed_chooser)
        self.chooser = wpilib.SendableChooser()
        self.chooser.setDefaultOption("Leave", autos.leave(self.drivetrain))
        self.chooser.addOption("Nothing", autos.nothing())
        for name, side in (("left", 1), ("right", -1)):
            routine = autos.score_high(self.drivetrain, self.superstructure, self.gripper, side)
            self.chooser.addOption(f"Score high, {name}", routine)
        wpilib.SmartDashboard.putData("Autonomous", self.chooser)
        wpilib.SmartDashboard.putData("Scheduler", commands2.CommandScheduler.getInstance())

    def bind_driver(self) -> None:
        """Bind the driver's gamepad."""
        self.drivetrain.setDefaultCommand(
            commands2.cmd.run(self.drive_with_sticks, self.drivetrain).withName("Drive with sticks")
        )
        self.driver.a().whileTrue(commands2.cmd.run(self.aim_at_goal, self.drivetrain).withName("Aim"))
        self.driver.y().onTrue(self.drivetrain.turn_to(0).withTimeout(3))
        self.driver.back().onTrue(
            commands2.cmd.runOnce(lambda: self.drivetrain.reset_pose(self.drivetrain.pose())).ignoringDisable(True)
        )
        self.driver.rightTrigger(0.5).whileTrue(self.gripper.intake())
        self.driver.leftTrigger(0.5).onTrue(self.gripper.release())
        commands2.button.Trigger(self.gripper.has_piece).onTrue(
            commands2.cmd.startEnd(lambda: self.rumble(0.7), lambda: self.rumble(0)).withTimeout(0.4)
        )

    def bind_operator(self) -> None:
        """Bind the operator's gamepad."""
        self.operator.a().onTrue(self.superstructure.go_to(Positions.LOW, "Low"))
        self.operator.b().onTrue(self.superstructure.go_to(Positions.MIDDLE, "Middle"))
        self.operator.y().onTrue(self.superstructure.go_to(Positions.HIGH, "High"))
        self.operator.x().onTrue(self.superstructure.go_to(Positions.STOW, "Stow"))
        self.operator.leftBumper().onTrue(self.superstructure.go_to(Positions.INTAKE, "Intake"))
        self.operator.rightBumper().onTrue(commands2.cmd.runOnce(self.gripper.close, self.gripper))
        self.operator.povUp().onTrue(self.superstructure.nudge(0.05))
        self.operator.povDown().onTrue(self.superstructure.nudge(-0.05))

    def drive_with_sticks(self) -> None:
        """Drive with the driver's sticks, slower with the left bumper or with the elevator up."""
        slow = self.driver.getHID().getLeftBumper() or self.elevator.height() > 0.6
        scale = self.speed_chooser.getSelected() * (Driver.SLOW if slow else 1.0)
        forward = -applyDeadband(self.driver.getLeftY(), Driver.DEADBAND) * scale
        turn = -applyDeadband(self.driver.getRightX(), Driver.DEADBAND) * scale * 0.7
        forward = self.forward_limiter.calculate(forward)
        self.drivetrain.curvature(forward, turn, abs(forward) < 0.15)

    def aim_at_goal(self) -> None:
        """Drive with the sticks, and turn to the goal that the Limelight sees."""
        forward = -applyDeadband(self.driver.getLeftY(), Driver.DEADBAND) * Driver.SLOW
        turn = -0.015 * self.vision.goal_offset() if self.vision.sees_goal() else 0.0
        self.drivetrain.curvature(forward, turn, True)

    def rumble(self, strength: float) -> None:
        """Make the driver's gamepad rumble."""
        self.driver.setRumble(wpilib.XboxController.RumbleType.kBothRumble, strength)

    def autonomous_command(self) -> commands2.Command | None:
        """Return the routine that was chosen."""
        return self.chooser.getSelected()
