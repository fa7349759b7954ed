"""A robot with a loop of its own, and joysticks of whatever make the team finds in its box."""

import hal
import wpilib

PERIOD = 0.02
DEADBAND = 0.05

# The axes of most joysticks.
TURN, FORWARD, THROTTLE = 0, 1, 2

ARM_UP, ARM_DOWN = 3, 2


def without_deadband(value: float) -> float:
    """Zero near the middle, and no jump at its edge."""
    if abs(value) < DEADBAND:
        return 0.0
    rest = (abs(value) - DEADBAND) / (1 - DEADBAND)
    return rest if value > 0 else -rest


class MyRobot(wpilib.RobotBase):
    """Asks for the mode, does its work, waits, and does it again."""

    def __init__(self) -> None:
        """Create the devices."""
        super().__init__()
        self.running = True
        self.left_motor = wpilib.PWMSparkMax(0)
        self.right_motor = wpilib.PWMSparkMax(1)
        self.right_motor.setInverted(True)
        self.arm_motor = wpilib.PWMSparkMax(2)
        self.stick = wpilib.Joystick(0)
        self.autonomous_loops = 0

    def startCompetition(self) -> None:
        """The whole program; it returns after endCompetition was called."""
        # Without this line the driver station shows "No Robot Code".
        hal.observeUserProgramStarting()
        while self.running:
            # Joysticks and modes stay as they were until they are refreshed.
            wpilib.DriverStation.refreshData()
            if self.isDisabled():
                hal.observeUserProgramDisabled()
                self.autonomous_loops = 0
                self.stop()
            elif self.isAutonomous():
                hal.observeUserProgramAutonomous()
                self.autonomous()
            elif self.isTeleop():
                hal.observeUserProgramTeleop()
                self.teleop()
            else:
                hal.observeUserProgramTest()
                self.stop()
            wpilib.wait(PERIOD)

    def endCompetition(self) -> None:
        """Ask the loop to come to its end."""
        self.running = False

    def autonomous(self) -> None:
        """Drive forward for two seconds."""
        self.autonomous_loops += 1
        moving = self.autonomous_loops * PERIOD < 2.0
        self.drive(0.4 if moving else 0.0, 0.0)

    def teleop(self) -> None:
        """One stick drives; its throttle says how fast. Two buttons move the arm."""
        axes = [without_deadband(self.stick.getRawAxis(axis)) for axis in range(self.stick.getAxisCount())]
        # Not every joystick has a throttle.
        scale = 0.6 - 0.4 * axes[THROTTLE] if len(axes) > THROTTLE else 0.6
        self.drive(-axes[FORWARD] * scale, axes[TURN] * scale)  # the bug: a joystick that is unplugged has no axes
        if self.stick.getRawButton(ARM_UP):
            self.arm_motor.set(0.5)
        elif self.stick.getRawButton(ARM_DOWN):
            self.arm_motor.set(-0.3)
        else:
            self.arm_motor.set(0.0)

    def drive(self, forward: float, turn: float) -> None:
        """Set both sides, at most at full power."""
        self.left_motor.set(max(-1.0, min(1.0, forward + turn)))
        self.right_motor.set(max(-1.0, min(1.0, forward - turn)))

    def stop(self) -> None:
        """Stand still."""
        self.drive(0.0, 0.0)
        self.arm_motor.set(0.0)
