"""A robot for a game in which the field says, as autonomous begins, which side of the switch is to be served."""

from dataclasses import dataclass

import wpilib
import wpilib.drive

CUBE_BUTTON = 1


@dataclass(frozen=True)
class Leg:
    """A part of the way.

    :param seconds: how long it takes
    :param speed: from -1 to 1
    :param turn: from -1 to 1, clockwise
    """

    seconds: float
    speed: float
    turn: float = 0.0


CROSS_THE_LINE = (Leg(2.5, 0.5),)

RED = wpilib.DriverStation.Alliance.kRed
BLUE = wpilib.DriverStation.Alliance.kBlue

# The way to the switch, by its side as the audience sees it: blue comes from the other end of the field.
TO_THE_SWITCH = {
    (RED, "L"): (Leg(0.5, 0.4), Leg(0.5, 0.0, -0.5), Leg(1.5, 0.5), Leg(0.5, 0.0, 0.5), Leg(0.8, 0.4)),
    (RED, "R"): (Leg(0.5, 0.4), Leg(0.5, 0.0, 0.5), Leg(1.2, 0.5), Leg(0.5, 0.0, -0.5), Leg(0.8, 0.4)),
    (BLUE, "L"): (Leg(0.5, 0.4), Leg(0.5, 0.0, 0.5), Leg(1.2, 0.5), Leg(0.5, 0.0, -0.5), Leg(0.8, 0.4)),
}


class MyRobot(wpilib.TimedRobot):
    """Drives to its side of the switch, drops a cube there, then the driver takes over."""

    def robotInit(self) -> None:
        """Create the devices; the motors face each other."""
        self.left_motor = wpilib.PWMSparkMax(0)
        self.right_motor = wpilib.PWMSparkMax(1)
        self.right_motor.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)
        self.rollers = wpilib.PWMSparkMax(2)
        self.stick = wpilib.Joystick(0)
        self.timer = wpilib.Timer()
        self.legs: tuple[Leg, ...] = CROSS_THE_LINE
        self.drops_cube = False

    def disabledInit(self) -> None:
        """Nothing moves."""
        self.drive.stopMotor()
        self.rollers.set(0.0)

    def autonomousInit(self) -> None:
        """The first letter is the near switch's side; when the field is silent, cross the line."""
        side = wpilib.DriverStation.getGameSpecificMessage()[:1]
        alliance = wpilib.DriverStation.getAlliance() or RED
        if side in ("L", "R"):
            self.legs = TO_THE_SWITCH[alliance, side]  # the bug: one of the four ways nobody has written
        else:
            self.legs = CROSS_THE_LINE
        self.drops_cube = self.legs is not CROSS_THE_LINE
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        """Drive leg by leg; at the end drop the cube for a second."""
        elapsed = self.timer.get()
        for leg in self.legs:
            if elapsed < leg.seconds:
                self.drive.arcadeDrive(leg.speed, -leg.turn, squareInputs=False)
                return
            elapsed -= leg.seconds
        self.drive.stopMotor()
        self.rollers.set(-0.6 if self.drops_cube and elapsed < 1.0 else 0.0)

    def teleopPeriodic(self) -> None:
        """The stick drives, the trigger drops the cube."""
        self.drive.arcadeDrive(-self.stick.getY(), -self.stick.getX())
        self.rollers.set(-0.6 if self.stick.getRawButton(CUBE_BUTTON) else 0.0)
