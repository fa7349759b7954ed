"""A MagicRobot: components that do one thing each, and a state machine that plays them together."""

import magicbot
import wpilib
from components.drivetrain import Drivetrain
from components.launcher import Launcher, LauncherControl


class MyRobot(magicbot.MagicRobot):
    """Creates the devices; magicbot hands them to the components by name."""

    # Components run in this order: the state machine decides before the launcher acts.
    launcher_control: LauncherControl
    launcher: Launcher
    drivetrain: Drivetrain

    def createObjects(self) -> None:
        """Create what the components ask for as 'component_thing'."""
        self.drivetrain_left = wpilib.PWMSparkMax(0)
        self.drivetrain_right = wpilib.PWMSparkMax(1)
        self.drivetrain_right.setInverted(True)
        self.launcher_wheel = wpilib.PWMSparkMax(2)
        self.launcher_feeder = wpilib.PWMSparkMax(3)
        self.gamepad = wpilib.XboxController(0)
        self.teleop_entered = 0
        self.teleop_loops = 0

    def teleopInit(self) -> None:
        """Count the start of teleop."""
        self.teleop_entered += 1

    def teleopPeriodic(self) -> None:
        """Read the gamepad, and tell the components what to do."""
        self.teleop_loops += 1
        self.drivetrain.go(-self.gamepad.getLeftY())
        if self.gamepad.getAButton():
            self.launcher_control.fire()
