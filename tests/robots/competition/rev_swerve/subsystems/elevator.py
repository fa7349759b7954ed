"""The elevator lifts the shooter."""

import commands2
import rev
import wpilib
from wpimath.controller import ElevatorFeedforward, ProfiledPIDController
from wpimath.trajectory import TrapezoidProfile

from constants import CanIds, Ports
from constants import Elevator as Settings


class Elevator(commands2.Subsystem):
    """Moves to a height and stays there. A profile keeps its acceleration low."""

    def __init__(self) -> None:
        super().__init__()
        self.leader = rev.SparkMax(CanIds.ELEVATOR_LEADER, rev.SparkMax.MotorType.kBrushless)
        self.follower = rev.SparkMax(CanIds.ELEVATOR_FOLLOWER, rev.SparkMax.MotorType.kBrushless)
        metres_per_rotation = 2 * 3.14159265 * Settings.DRUM_RADIUS / Settings.REDUCTION
        config = rev.SparkMaxConfig()
        config.setIdleMode(rev.SparkBaseConfig.IdleMode.kBrake).smartCurrentLimit(40).voltageCompensation(12)
        config.encoder.positionConversionFactor(metres_per_rotation).velocityConversionFactor(metres_per_rotation / 60)
        self.leader.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        follow = rev.SparkMaxConfig()
        follow.setIdleMode(rev.SparkBaseConfig.IdleMode.kBrake).smartCurrentLimit(40).follow(self.leader, True)
        self.follower.configure(follow, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        self.encoder = self.leader.getEncoder()
        self.bottom_switch = wpilib.DigitalInput(Ports.ELEVATOR_BOTTOM_SWITCH)

        self.controller = ProfiledPIDController(
            Settings.KP,
            Settings.KI,
            Settings.KD,
            TrapezoidProfile.Constraints(Settings.MAX_SPEED, Settings.MAX_ACCELERATION),
        )
        self.controller.setTolerance(Settings.TOLERANCE)
        self.feedforward = ElevatorFeedforward(Settings.KS, Settings.KG, Settings.KV, Settings.KA)
        self.goal = Settings.STOWED
        self.volts = 0.0

        wpilib.Preferences.initDouble("ElevatorHub", Settings.HUB)
        wpilib.Preferences.initDouble("ElevatorTop", Settings.TOP)
        wpilib.SmartDashboard.putData("Elevator/Controller", self.controller)
        self.mechanism = wpilib.Mechanism2d(1.0, 2.0)
        root = self.mechanism.getRoot("elevator", 0.5, 0.1)
        self.carriage = root.appendLigament("carriage", 0.5, 90)
        wpilib.SmartDashboard.putData("Elevator/Mechanism", self.mechanism)
        self.hot_alert = wpilib.Alert("The elevator's motors are hot", wpilib.Alert.AlertType.kWarning)

    def height(self) -> float:
        """Return the height of the carriage, in metres."""
        return self.encoder.getPosition()

    def at_bottom(self) -> bool:
        """Return whether the carriage presses its switch."""
        return not self.bottom_switch.get()

    def at_goal(self) -> bool:
        """Return whether the carriage is where it should be."""
        return abs(self.height() - self.goal) < 2 * Settings.TOLERANCE

    def set_goal(self, height: float) -> None:
        """Move to this height, in metres."""
        self.goal = min(max(height, Settings.MIN_HEIGHT), Settings.MAX_HEIGHT)

    def nudge(self, distance: float) -> None:
        """Move up or down from the current goal."""
        self.set_goal(self.goal + distance)

    def move_to(self, preference: str) -> commands2.Command:
        """Return a command that ends at a height that is kept in the preferences."""
        return (
            self.runOnce(lambda: self.set_goal(wpilib.Preferences.getDouble(preference)))
            .andThen(commands2.cmd.waitUntil(self.at_goal))
            .withName(f"MoveTo{preference}")
        )

    def stow(self) -> commands2.Command:
        """Return a command that ends when the carriage is down."""
        return self.runOnce(lambda: self.set_goal(Settings.STOWED)).andThen(commands2.cmd.waitUntil(self.at_goal))

    def periodic(self) -> None:
        """Control the height. While disabled, keep the goal where the carriage is."""
        height = self.height()
        if wpilib.DriverStation.isDisabled():
            self.controller.reset(height)
            self.goal = min(max(height, Settings.MIN_HEIGHT), Settings.MAX_HEIGHT)
        if self.at_bottom() and abs(height) > 0.005:
            self.encoder.setPosition(0)

        feedback = self.controller.calculate(height, self.goal)
        self.volts = feedback + self.feedforward.calculate(self.controller.getSetpoint().velocity)
        self.leader.setVoltage(self.volts)

        self.carriage.setLength(0.5 + height)
        self.hot_alert.set(self.leader.getMotorTemperature() > 80)
        wpilib.SmartDashboard.putNumber("Elevator/Height", height)
        wpilib.SmartDashboard.putNumber("Elevator/Goal", self.goal)
        wpilib.SmartDashboard.putNumber("Elevator/Volts", self.volts)
