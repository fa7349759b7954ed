"""Drives a square in autonomous, by its encoders and its gyro."""

import wpilib

SIDE_FT = 4.0
TICKS_PER_FT = 360


class MyRobot(wpilib.TimedRobot):
    """Two motors, an encoder on each side, a gyro."""

    def robotInit(self) -> None:
        """Create the devices once; they live as long as the program."""
        self.left_motor = wpilib.PWMSparkMax(0)
        self.right_motor = wpilib.PWMSparkMax(1)
        self.left_encoder = wpilib.Encoder(0, 1)
        self.right_encoder = wpilib.Encoder(2, 3)
        for encoder in (self.left_encoder, self.right_encoder):
            encoder.setDistancePerPulse(1 / TICKS_PER_FT)
        self.gyro = wpilib.AnalogGyro(0)
        self.stick = wpilib.Joystick(0)

    def drive(self, forward: float, turn: float) -> None:
        """The motors face each other, so forward for one is backward for the other."""
        self.left_motor.set(forward + turn)
        self.right_motor.set(-(forward - turn))

    def distance(self) -> float:
        """How far the robot has come since the encoders were reset, in feet."""
        return (self.left_encoder.getDistance() + self.right_encoder.getDistance()) / 2

    def autonomousInit(self) -> None:
        """Four sides are to come, the first of them from here."""
        self.sides_driven = 0
        self.turning = False
        self.corner = 0.0
        self.reset()

    def reset(self) -> None:
        """A new side begins."""
        self.left_encoder.reset()
        self.right_encoder.reset()

    def autonomousPeriodic(self) -> None:
        """Forward until the side is done, slower near its end; then a quarter turn, likewise."""
        if self.sides_driven == 4:
            self.drive(0, 0)
        elif self.turning:
            left = self.corner - self.gyro.getAngle()
            self.drive(0, min(0.4, max(0.05, left / 60)))
            if left < 1:
                self.turning = False
                self.sides_driven += 1
                self.reset()
        else:
            left = SIDE_FT - self.distance()
            self.drive(min(0.8, max(0.05, left)), 0)
            if left < 0.02:
                self.turning = True
                self.corner += 90

    def teleopPeriodic(self) -> None:
        """Pushing a stick forward reads as a negative number."""
        self.drive(-self.stick.getY(), self.stick.getX())
