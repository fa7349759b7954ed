"""A MagicRobot with a turret: the driver points, it turns."""

import magicbot
import wpilib
import wpilib.drive
from components.turret import Turret

NOT_PRESSED = -1
DEADBAND = 0.1


class MyRobot(magicbot.MagicRobot):
    """Creates the devices; magicbot hands them to the components by name."""

    turret: Turret

    def createObjects(self) -> None:
        """Create what the components ask for as 'component_thing', and the wheels."""
        self.turret_motor = wpilib.PWMSparkMax(0)
        self.turret_encoder = wpilib.Encoder(0, 1)
        self.left_motor = wpilib.PWMSparkMax(1)
        self.right_motor = wpilib.PWMSparkMax(2)
        self.right_motor.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)
        self.lamp = wpilib.DigitalOutput(2)
        self.driver = wpilib.XboxController(0)
        self.gunner = wpilib.XboxController(1)

    def disabledInit(self) -> None:
        """Nothing moves, and nothing shines."""
        self.drive.stopMotor()
        self.lamp.set(False)

    def teleopPeriodic(self) -> None:
        """The driver drives; the gunner turns the turret by hand, or holds the left bumper and points."""
        self.drive.arcadeDrive(-self.driver.getLeftY(), -self.driver.getRightX())
        by_hand = self.gunner.getRightX()
        if self.gunner.getLeftBumper():
            pov = self.gunner.getPOV()
            if pov != NOT_PRESSED:
                self.turret.aim(pov)
        elif abs(by_hand) > DEADBAND:
            self.turret.turn(by_hand * 0.3)
        self.lamp.set(self.turret.aimed())
