"""The drivetrain: four NEOs on SPARK MAXes, wheel encoders, a gyro, and where the robot is on the field."""

import math

import commands2
import commands2.cmd
import ntcore
import rev
import wpilib
import wpilib.drive
from constants import Can, Dio, Drive
from wpimath.controller import LTVUnicycleController, PIDController, ProfiledPIDController, SimpleMotorFeedforwardMeters
from wpimath.estimator import DifferentialDrivePoseEstimator
from wpimath.geometry import Pose2d
from wpimath.kinematics import ChassisSpeeds, DifferentialDriveKinematics, DifferentialDriveWheelSpeeds
from wpimath.trajectory import Trajectory, TrapezoidProfile


class Drivetrain(commands2.Subsystem):
    """Drives, and estimates the robot's pose."""

    def __init__(self) -> None:
        super().__init__()
        self.left = rev.SparkMax(Can.LEFT_LEADER, rev.SparkLowLevel.MotorType.kBrushless)
        self.left_follower = rev.SparkMax(Can.LEFT_FOLLOWER, rev.SparkLowLevel.MotorType.kBrushless)
        self.right = rev.SparkMax(Can.RIGHT_LEADER, rev.SparkLowLevel.MotorType.kBrushless)
        self.right_follower = rev.SparkMax(Can.RIGHT_FOLLOWER, rev.SparkLowLevel.MotorType.kBrushless)
        self._configure(self.left, inverted=False)
        self._configure(self.right, inverted=True)
        self._configure(self.left_follower, leader=self.left)
        self._configure(self.right_follower, leader=self.right)
        self.left_motor_encoder = self.left.getEncoder()
        self.right_motor_encoder = self.right.getEncoder()

        self.left_encoder = wpilib.Encoder(*Dio.LEFT_ENCODER)
        self.right_encoder = wpilib.Encoder(*Dio.RIGHT_ENCODER, True)
        for encoder in (self.left_encoder, self.right_encoder):
            encoder.setDistancePerPulse(math.pi * Drive.WHEEL_DIAMETER / Drive.ENCODER_COUNTS)
        self.gyro = wpilib.ADXRS450_Gyro()

        self.drive = wpilib.drive.DifferentialDrive(self.left, self.right)
        self.kinematics = DifferentialDriveKinematics(Drive.TRACK_WIDTH)
        self.feedforward = SimpleMotorFeedforwardMeters(Drive.KS, Drive.KV, Drive.KA)
        self.left_pid = PIDController(Drive.KP, 0, 0)
        self.right_pid = PIDController(Drive.KP, 0, 0)
        self.distance_pid = ProfiledPIDController(
            2.2, 0, 0, TrapezoidProfile.Constraints(Drive.MAX_SPEED * 0.6, Drive.MAX_ACCELERATION)
        )
        self.distance_pid.setTolerance(0.04, 0.1)
        self.heading_pid = ProfiledPIDController(
            Drive.TURN_KP, 0, Drive.TURN_KD, TrapezoidProfile.Constraints(math.radians(240), math.radians(360))
        )
        self.heading_pid.enableContinuousInput(-math.pi, math.pi)
        self.heading_pid.setTolerance(math.radians(2), math.radians(5))
        self.follower = LTVUnicycleController(0.02)

        self.estimator = DifferentialDrivePoseEstimator(
            self.kinematics, self.gyro.getRotation2d(), 0, 0, Drive.START, (0.02, 0.02, 0.01), (0.3, 0.3, 0.6)
        )
        self.field = wpilib.Field2d()
        wpilib.SmartDashboard.putData("Field", self.field)
        wpilib.SmartDashboard.putData("Drive", self.drive)
        table = ntcore.NetworkTableInstance.getDefault().getTable("Drivetrain")
        self.pose_topic = table.getStructTopic("pose", Pose2d).publish()
        self.speeds_topic = table.getStructTopic("speeds", ChassisSpeeds).publish()
        self.current_topic = table.getDoubleArrayTopic("currents").publish()

    def _configure(self, motor: rev.SparkMax, inverted: bool = False, leader: rev.SparkMax | None = None) -> None:
        config = rev.SparkMaxConfig()
        config.smartCurrentLimit(Drive.CURRENT_LIMIT).setIdleMode(rev.SparkBaseConfig.IdleMode.kBrake)
        config.voltageCompensation(12).openLoopRampRate(0.1)
        config.encoder.positionConversionFactor(Drive.METRES_PER_TURN)
        config.encoder.velocityConversionFactor(Drive.METRES_PER_TURN / 60)
        if leader is None:
            config.inverted(inverted)
        else:
            config.follow(leader)
        error = motor.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        if error != rev.REVLibError.kOk:
            wpilib.reportWarning(f"SPARK MAX {motor.getDeviceId()}: {error.name}")

    def periodic(self) -> None:
        """Update the pose and the dashboard."""
        pose = self.estimator.update(
            self.gyro.getRotation2d(), self.left_encoder.getDistance(), self.right_encoder.getDistance()
        )
        self.field.setRobotPose(pose)
        self.pose_topic.set(pose)
        self.speeds_topic.set(self.kinematics.toChassisSpeeds(self.wheel_speeds()))
        motors = (self.left, self.left_follower, self.right, self.right_follower)
        self.current_topic.set([motor.getOutputCurrent() for motor in motors])
        wpilib.SmartDashboard.putNumber("Drive/left speed", self.left_motor_encoder.getVelocity())
        wpilib.SmartDashboard.putNumber("Drive/right speed", self.right_motor_encoder.getVelocity())
        wpilib.SmartDashboard.putNumber("Drive/hottest motor", max(motor.getMotorTemperature() for motor in motors))

    def pose(self) -> Pose2d:
        """Return where the robot is."""
        return self.estimator.getEstimatedPosition()

    def wheel_speeds(self) -> DifferentialDriveWheelSpeeds:
        """Return the speeds of both sides, in m/s."""
        return DifferentialDriveWheelSpeeds(self.left_encoder.getRate(), self.right_encoder.getRate())

    def distance(self) -> float:
        """Return how far the robot has driven."""
        return (self.left_encoder.getDistance() + self.right_encoder.getDistance()) / 2

    def reset_pose(self, pose: Pose2d) -> None:
        """Set where the robot is."""
        self.estimator.resetPosition(
            self.gyro.getRotation2d(), self.left_encoder.getDistance(), self.right_encoder.getDistance(), pose
        )

    def add_vision(self, pose: Pose2d, timestamp: float, deviations: tuple[float, float, float]) -> None:
        """Take over a camera's measurement."""
        self.estimator.addVisionMeasurement(pose, timestamp, deviations)

    def curvature(self, forward: float, turn: float, in_place: bool) -> None:
        """Drive as the sticks say."""
        self.drive.curvatureDrive(forward, turn, in_place)

    def speeds(self, speeds: ChassisSpeeds) -> None:
        """Drive at these speeds, with feed-forward and PID on both sides."""
        wanted = self.kinematics.toWheelSpeeds(speeds)
        wanted.desaturate(Drive.MAX_SPEED)
        measured = self.wheel_speeds()
        left = self.feedforward.calculate(wanted.left) + self.left_pid.calculate(measured.left, wanted.left)
        right = self.feedforward.calculate(wanted.right) + self.right_pid.calculate(measured.right, wanted.right)
        self.left.setVoltage(max(-12.0, min(12.0, left)))
        self.right.setVoltage(max(-12.0, min(12.0, right)))
        self.drive.feed()

    def stop(self) -> None:
        """Stop both sides."""
        self.drive.stopMotor()

    def drive_distance(self, metres: float) -> commands2.Command:
        """Make a command that drives straight on."""

        def begin() -> None:
            self.distance_pid.reset(self.distance())
            self.distance_pid.setGoal(self.distance() + metres)

        def run() -> None:
            correction = self.distance_pid.calculate(self.distance())
            self.speeds(ChassisSpeeds(self.distance_pid.getSetpoint().velocity + correction, 0, 0))

        return (
            commands2.cmd.startRun(begin, run, self)
            .until(self.distance_pid.atGoal)
            .finallyDo(lambda interrupted: self.stop())
            .withName(f"Drive {metres} m")
        )

    def turn_to(self, degrees: float) -> commands2.Command:
        """Make a command that turns to this heading on the field."""

        def begin() -> None:
            self.heading_pid.reset(self.pose().rotation().radians())
            self.heading_pid.setGoal(math.radians(degrees))

        def run() -> None:
            correction = self.heading_pid.calculate(self.pose().rotation().radians())
            self.speeds(ChassisSpeeds(0, 0, self.heading_pid.getSetpoint().velocity + correction))

        return (
            commands2.cmd.startRun(begin, run, self)
            .until(self.heading_pid.atGoal)
            .finallyDo(lambda interrupted: self.stop())
            .withName(f"Turn to {degrees}")
        )

    def follow(self, trajectory: Trajectory) -> commands2.Command:
        """Make a command that follows a trajectory."""
        timer = wpilib.Timer()

        def begin() -> None:
            timer.restart()
            self.field.getObject("trajectory").setTrajectory(trajectory)

        def run() -> None:
            self.speeds(self.follower.calculate(self.pose(), trajectory.sample(timer.get())))

        return (
            commands2.cmd.startRun(begin, run, self)
            .until(lambda: timer.hasElapsed(trajectory.totalTime()))
            .finallyDo(lambda interrupted: self.stop())
            .withName("Follow trajectory")
        )
