"""The arm on the elevator, with a NEO and an absolute encoder, and the wrist at its end with a potentiometer."""

import math

import commands2
import commands2.cmd
import rev
import wpilib
from constants import Analog, Arm, Can, Dio, Pwm
from wpimath.controller import ArmFeedforward, PIDController, ProfiledPIDController
from wpimath.trajectory import TrapezoidProfile


class ArmAndWrist(commands2.Subsystem):
    """Holds the arm's angle with a profiled PID and feed-forward, and the wrist's with a PID."""

    def __init__(self, lift: wpilib.MechanismLigament2d) -> None:
        super().__init__()
        self.motor = rev.SparkMax(Can.ARM, rev.SparkLowLevel.MotorType.kBrushless)
        config = rev.SparkMaxConfig()
        config.smartCurrentLimit(40).setIdleMode(rev.SparkBaseConfig.IdleMode.kBrake)
        config.encoder.positionConversionFactor(2 * math.pi / Arm.GEARING)
        config.encoder.velocityConversionFactor(2 * math.pi / Arm.GEARING / 60)
        self.motor.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        self.motor_encoder = self.motor.getEncoder()
        self.encoder = wpilib.DutyCycleEncoder(Dio.ARM_ENCODER)
        self.wrist_motor = wpilib.PWMVictorSPX(Pwm.WRIST)
        self.wrist_potentiometer = wpilib.AnalogPotentiometer(Analog.WRIST_POTENTIOMETER, Arm.WRIST_RANGE_DEGREES)

        self.pid = ProfiledPIDController(
            Arm.KP, 0, Arm.KD, TrapezoidProfile.Constraints(Arm.MAX_SPEED, Arm.MAX_ACCELERATION)
        )
        self.pid.setTolerance(Arm.TOLERANCE)
        self.feedforward = ArmFeedforward(0, Arm.VOLTS_GRAVITY, Arm.KV)
        self.wrist_pid = PIDController(Arm.WRIST_KP, 0, 0)
        self.wrist_pid.setTolerance(Arm.WRIST_TOLERANCE_DEGREES)
        self.goal = math.radians(-55)
        self.wrist_goal = 90.0
        self.unplugged = wpilib.Alert("The arm's encoder is not connected.", wpilib.Alert.AlertType.kError)
        self.hot = wpilib.Alert("The arm's motor is hot.", wpilib.Alert.AlertType.kWarning)
        self.drawing = lift.appendLigament("arm", Arm.LENGTH, -90)

    def angle(self) -> float:
        """Return the arm's angle above the horizontal."""
        turns = self.encoder.get() - Arm.ENCODER_OFFSET
        return 2 * math.pi * (turns - round(turns))

    def wrist_angle(self) -> float:
        """Return the wrist's angle, in degrees."""
        return self.wrist_potentiometer.get()

    def at_goal(self) -> bool:
        """Return whether arm and wrist are where they should be."""
        return abs(self.angle() - self.goal) < Arm.TOLERANCE * 2 and self.wrist_pid.atSetpoint()

    def periodic(self) -> None:
        """Move arm and wrist towards their goals."""
        angle = self.angle()
        connected = self.encoder.isConnected()
        self.unplugged.set(not connected)
        self.hot.set(self.motor.getMotorTemperature() > 80)
        if wpilib.DriverStation.isDisabled():
            self.pid.reset(angle)
        correction = self.pid.calculate(angle, self.goal)
        setpoint = self.pid.getSetpoint()
        volts = correction + self.feedforward.calculate(setpoint.position, setpoint.velocity)
        wrist = self.wrist_pid.calculate(self.wrist_angle(), self.wrist_goal)
        if wpilib.DriverStation.isDisabled() or not connected:
            self.motor.stopMotor()
            self.wrist_motor.stopMotor()
        else:
            self.motor.setVoltage(max(-8.0, min(8.0, volts)))
            self.wrist_motor.set(max(-0.5, min(0.5, wrist)))
        self.drawing.setAngle(math.degrees(angle) - 90)
        wpilib.SmartDashboard.putNumber("Arm/angle", math.degrees(angle))
        wpilib.SmartDashboard.putNumber("Arm/setpoint", math.degrees(setpoint.position))
        wpilib.SmartDashboard.putNumber("Arm/volts", volts)
        wpilib.SmartDashboard.putNumber("Arm/speed", math.degrees(self.motor_encoder.getVelocity()))
        wpilib.SmartDashboard.putNumber("Arm/wrist", self.wrist_angle())

    def set_goal(self, arm_degrees: float, wrist_degrees: float) -> None:
        """Set where arm and wrist go."""
        self.goal = max(Arm.MIN_ANGLE, min(Arm.MAX_ANGLE, math.radians(arm_degrees)))
        self.wrist_goal = wrist_degrees

    def move_to(self, arm_degrees: float, wrist_degrees: float) -> commands2.Command:
        """Make a command that ends when arm and wrist are there."""
        return commands2.cmd.startRun(lambda: self.set_goal(arm_degrees, wrist_degrees), lambda: None, self).until(
            self.at_goal
        )
