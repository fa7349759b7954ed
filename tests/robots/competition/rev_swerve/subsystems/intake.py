"""The intake folds out over the bumper and collects game pieces."""

import math

import commands2
import rev
import wpilib
from wpimath.controller import ArmFeedforward, ProfiledPIDController
from wpimath.trajectory import TrapezoidProfile

from constants import CanIds
from constants import Intake as Settings


class Intake(commands2.Subsystem):
    """An arm with a profiled controller, and rollers."""

    def __init__(self) -> None:
        super().__init__()
        self.pivot = rev.SparkMax(CanIds.INTAKE_PIVOT, rev.SparkMax.MotorType.kBrushless)
        self.rollers = rev.SparkMax(CanIds.INTAKE_ROLLERS, rev.SparkMax.MotorType.kBrushless)
        config = rev.SparkMaxConfig()
        config.setIdleMode(rev.SparkBaseConfig.IdleMode.kBrake).smartCurrentLimit(30).voltageCompensation(12)
        config.encoder.positionConversionFactor(math.tau / Settings.REDUCTION)
        config.encoder.velocityConversionFactor(math.tau / Settings.REDUCTION / 60)
        self.pivot.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        config = rev.SparkMaxConfig()
        config.setIdleMode(rev.SparkBaseConfig.IdleMode.kCoast).smartCurrentLimit(25)
        self.rollers.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        self.encoder = self.pivot.getEncoder()
        self.encoder.setPosition(Settings.STOWED)  # the robot is switched on with the intake folded in

        self.controller = ProfiledPIDController(
            Settings.KP,
            Settings.KI,
            Settings.KD,
            TrapezoidProfile.Constraints(Settings.MAX_SPEED, Settings.MAX_ACCELERATION),
        )
        self.feedforward = ArmFeedforward(Settings.KS, Settings.KG, Settings.KV)
        self.goal = Settings.STOWED
        wpilib.SmartDashboard.putData("Intake/Controller", self.controller)
        self.mechanism = wpilib.Mechanism2d(1.0, 1.0)
        root = self.mechanism.getRoot("pivot", 0.3, 0.2)
        self.arm = root.appendLigament("arm", Settings.LENGTH, math.degrees(Settings.STOWED))
        wpilib.SmartDashboard.putData("Intake/Mechanism", self.mechanism)

    def angle(self) -> float:
        """Return the arm's angle above horizontal, in radians."""
        return self.encoder.getPosition()

    def at_goal(self) -> bool:
        """Return whether the arm is where it should be."""
        return abs(self.angle() - self.goal) < Settings.TOLERANCE

    def set_goal(self, angle: float) -> None:
        """Move the arm to this angle."""
        self.goal = angle

    def collect(self) -> commands2.Command:
        """Return a command that folds out and collects for as long as it runs."""

        def execute() -> None:
            self.set_goal(Settings.DEPLOYED)
            self.rollers.set(Settings.ROLLER_POWER)

        return self.runEnd(execute, self.fold_in).withName("Collect")

    def spit_out(self) -> commands2.Command:
        """Return a command that runs the rollers backwards."""
        return self.runEnd(lambda: self.rollers.set(-Settings.ROLLER_POWER), self.fold_in).withName("SpitOut")

    def fold_in(self) -> None:
        """Stop the rollers and move the arm in."""
        self.rollers.stopMotor()
        self.set_goal(Settings.STOWED)

    def periodic(self) -> None:
        """Control the arm. While disabled, start again from where it is."""
        angle = self.angle()
        if wpilib.DriverStation.isDisabled():
            self.controller.reset(angle)
            self.goal = angle
        feedback = self.controller.calculate(angle, self.goal)
        setpoint = self.controller.getSetpoint()
        self.pivot.setVoltage(feedback + self.feedforward.calculate(setpoint.position, setpoint.velocity))

        self.arm.setAngle(math.degrees(angle))
        wpilib.SmartDashboard.putNumber("Intake/Angle", math.degrees(angle))
        wpilib.SmartDashboard.putNumber("Intake/Current", self.rollers.getOutputCurrent())
