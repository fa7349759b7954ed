"""The elevator: two Falcons on PWM, an encoder, and a limit switch at each end."""

import math

import commands2
import commands2.cmd
import wpilib
from constants import Dio, Elevator, Pwm
from wpimath.controller import ElevatorFeedforward, ProfiledPIDController
from wpimath.trajectory import TrapezoidProfile


class ElevatorLift(commands2.Subsystem):
    """Holds its goal with a profiled PID and feed-forward, from the moment that it has found its lower end."""

    def __init__(self) -> None:
        super().__init__()
        self.motor = wpilib.PWMTalonFX(Pwm.ELEVATOR_LEFT)
        self.second_motor = wpilib.PWMTalonFX(Pwm.ELEVATOR_RIGHT)
        self.motor.addFollower(self.second_motor)
        self.motor.setSafetyEnabled(False)
        self.encoder = wpilib.Encoder(*Dio.ELEVATOR_ENCODER)
        # A cascade: the carriage moves twice as far as the rope.
        self.encoder.setDistancePerPulse(2 * math.pi * Elevator.DRUM_RADIUS / Elevator.ENCODER_COUNTS)
        # The switches pull their inputs to ground.
        self.bottom_switch = wpilib.DigitalInput(Dio.ELEVATOR_BOTTOM)
        self.top_switch = wpilib.DigitalInput(Dio.ELEVATOR_TOP)
        wpilib.Preferences.initDouble("Elevator/kP", Elevator.KP)
        self.pid = ProfiledPIDController(
            Elevator.KP, 0, Elevator.KD, TrapezoidProfile.Constraints(Elevator.MAX_SPEED, Elevator.MAX_ACCELERATION)
        )
        self.pid.setTolerance(Elevator.TOLERANCE)
        self.feedforward = ElevatorFeedforward(0, Elevator.KG, Elevator.KV)
        self.goal = 0.0
        self.volts = 0.0
        self.not_homed = wpilib.Alert("The elevator has not been at its lower end.", wpilib.Alert.AlertType.kWarning)
        self.homed = False
        self.mechanism = wpilib.Mechanism2d(2.0, 2.5)
        self.lift = self.mechanism.getRoot("elevator", 1.0, 0.2).appendLigament("lift", 0.3, 90)
        wpilib.SmartDashboard.putData("Superstructure", self.mechanism)

    def height(self) -> float:
        """Return the height of the carriage."""
        return self.encoder.getDistance()

    def at_bottom(self) -> bool:
        """Return whether the carriage presses its lower switch."""
        return not self.bottom_switch.get()

    def at_top(self) -> bool:
        """Return whether the carriage presses its upper switch."""
        return not self.top_switch.get()

    def at_goal(self) -> bool:
        """Return whether the carriage is where it should be."""
        return abs(self.height() - self.goal) < Elevator.TOLERANCE * 2

    def periodic(self) -> None:
        """Move towards the goal. While the robot is disabled, the profile starts where the carriage is."""
        if self.at_bottom():
            if not self.homed or abs(self.height()) > 0.05:
                self.encoder.reset()
                self.pid.reset(0.0)
            self.homed = True
        height = self.height()
        correction = self.pid.calculate(height, self.goal)
        setpoint = self.pid.getSetpoint()
        self.volts = correction + self.feedforward.calculate(setpoint.velocity)
        if not self.homed:
            self.volts = -1.0
        if (self.at_top() and self.volts > 0) or (self.at_bottom() and self.volts < 0):
            self.volts = 0.0
        if wpilib.DriverStation.isDisabled():
            self.pid.reset(height)
            self.motor.stopMotor()
        else:
            self.motor.setVoltage(max(-10.0, min(10.0, self.volts)))
        self.not_homed.set(not self.homed)
        self.lift.setLength(0.3 + height)
        wpilib.SmartDashboard.putNumber("Elevator/height", height)
        wpilib.SmartDashboard.putNumber("Elevator/setpoint", setpoint.position)
        wpilib.SmartDashboard.putNumber("Elevator/volts", self.volts)

    def reload_gains(self) -> None:
        """Read the gain that the drive team has tuned."""
        self.pid.setP(wpilib.Preferences.getDouble("Elevator/kP", Elevator.KP))

    def set_goal(self, metres: float) -> None:
        """Set where the carriage goes."""
        self.goal = max(0.0, min(Elevator.MAX_HEIGHT, metres))

    def move_to(self, metres: float) -> commands2.Command:
        """Make a command that ends when the carriage is there."""
        return commands2.cmd.startRun(lambda: self.set_goal(metres), lambda: None, self).until(self.at_goal)
