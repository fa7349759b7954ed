"""A robot with a winch to climb with: the further the stick, the more power, and two buttons for more of it."""

import wpilib
import wpilib.drive

LEFT, RIGHT, WINCH = range(3)
RATCHET_CHANNEL = 0

FORWARD_AXIS, TURN_AXIS, WINCH_AXIS = 1, 4, 5
BOOST_BUTTON, HEAVY_BUTTON = 5, 6

DEADBAND = 0.1

# What the winch gets for each fifth of the stick's way, and for a step more.
WINCH_POWER = (0.0, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0)


class Winch:
    """Pulls the robot up; a ratchet holds it there."""

    def __init__(self) -> None:
        """The ratchet's servo is at 1 when it is out of the way."""
        self.motor = wpilib.PWMSparkMax(WINCH)
        self.ratchet = wpilib.Solenoid(wpilib.PneumaticsModuleType.CTREPCM, RATCHET_CHANNEL)
        self.power = 0.0

    def pull(self, stick: float, more: int) -> None:
        """Pull the robot up, or let it down.

        :param stick: from -1, down, to 1, up
        :param more: by how many steps to pull harder than the stick says
        """
        if abs(stick) < DEADBAND:
            self.stop()
            return
        power = WINCH_POWER[round(abs(stick) * 5) + more]  # the bug: a full stick has room for one step more, not two
        self.power = power if stick > 0 else -power
        # Going down, the ratchet has to be out of the way.
        self.ratchet.set(self.power < 0)
        self.motor.set(self.power)

    def stop(self) -> None:
        """Hang there."""
        self.power = 0.0
        self.ratchet.set(False)
        self.motor.set(0.0)


class MyRobot(wpilib.TimedRobot):
    """Drives with the left stick, climbs with the right one."""

    def robotInit(self) -> None:
        """Create the devices; the drive's motors face each other."""
        self.left_motor = wpilib.PWMSparkMax(LEFT)
        self.right_motor = wpilib.PWMSparkMax(RIGHT)
        self.right_motor.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)
        self.winch = Winch()
        self.gamepad = wpilib.Joystick(0)
        self.timer = wpilib.Timer()

    def disabledInit(self) -> None:
        """Nothing moves."""
        self.drive.stopMotor()
        self.winch.stop()

    def autonomousInit(self) -> None:
        """Start the clock."""
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        """Leave the starting line."""
        self.drive.arcadeDrive(0.5 if self.timer.get() < 2.0 else 0.0, 0.0)

    def teleopPeriodic(self) -> None:
        """Pushing a stick forward reads as a negative number."""
        gamepad = self.gamepad
        self.drive.arcadeDrive(-gamepad.getRawAxis(FORWARD_AXIS), -gamepad.getRawAxis(TURN_AXIS))
        boost = gamepad.getRawButton(BOOST_BUTTON)
        heavy = gamepad.getRawButton(HEAVY_BUTTON)
        self.winch.pull(-gamepad.getRawAxis(WINCH_AXIS), more=boost + heavy)
        wpilib.SmartDashboard.putNumber("Winch power", self.winch.power)
