"""A differential drive with odometry that follows a trajectory in autonomous."""

import wpilib
import wpilib.drive
from wpimath.controller import LTVUnicycleController
from wpimath.geometry import Pose2d, Rotation2d, Translation2d
from wpimath.kinematics import DifferentialDriveKinematics, DifferentialDriveOdometry
from wpimath.trajectory import TrajectoryConfig, TrajectoryGenerator

MAX_SPEED = 3.0


class MyRobot(wpilib.TimedRobot):
    def robotInit(self) -> None:
        self.left = wpilib.PWMSparkMax(0)
        self.right = wpilib.PWMSparkMax(1)
        self.right.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left, self.right)
        self.left_encoder = wpilib.Encoder(0, 1)
        self.right_encoder = wpilib.Encoder(2, 3)
        for encoder in (self.left_encoder, self.right_encoder):
            encoder.setDistancePerPulse(0.48 / 2048)
        self.gyro = wpilib.ADXRS450_Gyro()
        self.kinematics = DifferentialDriveKinematics(0.6)
        self.odometry = DifferentialDriveOdometry(Rotation2d(), 0.0, 0.0)
        self.controller = LTVUnicycleController(0.02)
        config = TrajectoryConfig(1.5, 1.0)
        config.setKinematics(self.kinematics)
        self.path = TrajectoryGenerator.generateTrajectory(
            Pose2d(), [Translation2d(1.0, 0.4)], Pose2d(2.0, 0.0, Rotation2d()), config
        )
        self.field = wpilib.Field2d()
        wpilib.SmartDashboard.putData("Field", self.field)
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()

    def robotPeriodic(self) -> None:
        self.odometry.update(
            self.gyro.getRotation2d(), self.left_encoder.getDistance(), self.right_encoder.getDistance()
        )
        self.field.setRobotPose(self.odometry.getPose())

    def autonomousInit(self) -> None:
        self.odometry.resetPosition(
            self.gyro.getRotation2d(), self.left_encoder.getDistance(), self.right_encoder.getDistance(), Pose2d()
        )
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        now = self.timer.get()
        if now > self.path.totalTime():
            self.drive.stopMotor()
            return
        speeds = self.controller.calculate(self.odometry.getPose(), self.path.sample(now))
        wheels = self.kinematics.toWheelSpeeds(speeds)
        wheels.desaturate(MAX_SPEED)
        self.drive.tankDrive(wheels.left / MAX_SPEED, wheels.right / MAX_SPEED, squareInputs=False)

    def teleopPeriodic(self) -> None:
        self.drive.curvatureDrive(-self.gamepad.getLeftY(), -self.gamepad.getRightX(), self.gamepad.getRightBumper())

    def testPeriodic(self) -> None:
        self.drive.stopMotor()

    def disabledInit(self) -> None:
        self.drive.stopMotor()
