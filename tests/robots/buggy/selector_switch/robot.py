"""A robot with a rotary switch of six positions: which autonomous, and how far to throw."""

import wpilib
import wpilib.drive

SELECTOR_CHANNEL = 0
THROW_BUTTON = 1

# The switch is a chain of five resistors between 0 and 5 V.
VOLTS = 5.0


class Plan:
    """What one position of the switch stands for."""

    def __init__(self, name: str, drive_seconds: float, wheel_power: float) -> None:
        """:param drive_seconds: of autonomous, before it throws; :param wheel_power: from 0 to 1."""
        self.name = name
        self.drive_seconds = drive_seconds
        self.wheel_power = wheel_power


PLANS = [
    Plan("Stand still", 0.0, 0.0),
    Plan("Near, from the left", 1.0, 0.45),
    Plan("Near, from the right", 1.2, 0.45),
    Plan("Line, from the middle", 1.8, 0.6),
    Plan("Far", 2.4, 0.75),
    Plan("Far, and over", 3.0, 0.9),
]


class Selector:
    """The rotary switch."""

    def __init__(self) -> None:
        """It is an analog input."""
        self.input = wpilib.AnalogInput(SELECTOR_CHANNEL)

    def position(self) -> int:
        """The position nearest to what is measured, from 0."""
        return max(0, round(self.input.getVoltage() / VOLTS * len(PLANS)))

    def plan(self) -> Plan:
        """What the switch is set to."""
        return PLANS[self.position()]  # the bug: six positions are five steps apart


class MyRobot(wpilib.TimedRobot):
    """Drives and throws, as the switch says."""

    def robotInit(self) -> None:
        """Create the devices; the motors face each other."""
        self.left_motor = wpilib.PWMSparkMax(0)
        self.right_motor = wpilib.PWMSparkMax(1)
        self.right_motor.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)
        self.wheel = wpilib.PWMSparkMax(2)
        self.selector = Selector()
        self.gamepad = wpilib.Joystick(0)
        self.timer = wpilib.Timer()
        self.plan = PLANS[0]

    def disabledInit(self) -> None:
        """Nothing moves."""
        self.drive.stopMotor()
        self.wheel.set(0.0)

    def autonomousInit(self) -> None:
        """Look at the switch once: nobody turns it during a match."""
        self.plan = self.selector.plan()
        wpilib.SmartDashboard.putString("Autonomous", self.plan.name)
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        """Drive there, then throw for two seconds."""
        driving = self.timer.get() < self.plan.drive_seconds
        throwing = not driving and self.timer.get() < self.plan.drive_seconds + 2.0
        self.drive.arcadeDrive(0.5 if driving else 0.0, 0.0)
        self.wheel.set(self.plan.wheel_power if throwing else 0.0)

    def teleopPeriodic(self) -> None:
        """The trigger throws as far as the switch says."""
        self.drive.arcadeDrive(-self.gamepad.getY(), -self.gamepad.getX())
        throwing = self.gamepad.getRawButton(THROW_BUTTON)
        self.wheel.set(self.selector.plan().wheel_power if throwing else 0.0)
