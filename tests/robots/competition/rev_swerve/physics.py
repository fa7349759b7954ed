"""Physics of the robot in tests and in the simulator: modules, mechanisms, battery, gyro, camera, game pieces."""

import math
import random

import ntcore
import rev
import wpilib
from pyfrc.physics.core import PhysicsInterface
from wpilib.simulation import (
    BatterySim,
    DCMotorSim,
    DIOSim,
    ElevatorSim,
    FlywheelSim,
    RoboRioSim,
    SingleJointedArmSim,
)
from wpimath.geometry import Pose2d, Rotation2d, Transform2d, Translation2d
from wpimath.kinematics import ChassisSpeeds, SwerveModuleState
from wpimath.system.plant import DCMotor, LinearSystemId

from constants import Climber, Drive, Elevator, Intake, Robot, Shooter, Vision
from robot import MyRobot
from subsystems.swervemodule import SwerveModule

RPM = 60 / math.tau  # in a radian per second
# A NEO 550: 12 V, stall torque 0.97 N m, stall current 100 A, free current 1.4 A, free speed 11000 rpm.
NEO_550 = DCMotor(12, 0.97, 100, 1.4, 11000 / RPM, 1)
PIECES = (Translation2d(3.6, 6.6), Translation2d(7.5, 1.5), Translation2d(8.3, 4.0))
FRAME = 0.6  # metres from the robot's centre to where the intake takes a piece


class ModulePhysics:
    """The wheel of one module. Its motors move it, and it moves the encoders."""

    def __init__(self, module: SwerveModule) -> None:
        self.module = module
        gearbox = DCMotor.NEO(1)
        self.driving_spark = rev.SparkMaxSim(module.driving_motor, gearbox)
        self.turning_spark = rev.SparkMaxSim(module.turning_motor, NEO_550)
        self.turning_sensor = self.turning_spark.getAbsoluteEncoderSim()
        # Each wheel carries a quarter of the robot.
        inertia = Robot.MASS / 4 * (Drive.WHEEL_DIAMETER / 2) ** 2
        self.driving = DCMotorSim(
            LinearSystemId.DCMotorSystem(gearbox, inertia, Drive.DRIVING_REDUCTION),
            gearbox.withReduction(Drive.DRIVING_REDUCTION),
        )
        self.turning = DCMotorSim(
            LinearSystemId.DCMotorSystem(NEO_550, 0.004, Drive.TURNING_REDUCTION),
            NEO_550.withReduction(Drive.TURNING_REDUCTION),
        )
        self.turning.setAngle((module.angle() + module.offset).radians())

    def angle(self) -> Rotation2d:
        """Return the wheel's direction, relative to the robot."""
        return Rotation2d(self.turning.getAngularPosition()) - self.module.offset

    def speed(self) -> float:
        """Return the wheel's speed in metres per second."""
        return self.driving.getAngularVelocity() * Drive.WHEEL_DIAMETER / 2

    def move(self, volts: float, tm_diff: float) -> SwerveModuleState:
        """Apply the motors' power for `tm_diff` seconds. Return how the wheel moves."""
        self.driving.setInputVoltage(self.driving_spark.getAppliedOutput() * volts)
        self.driving.update(tm_diff)
        self.turning.setInputVoltage(self.turning_spark.getAppliedOutput() * volts)
        self.turning.update(tm_diff)
        return SwerveModuleState(self.speed(), self.angle())

    def measure(self, speeds: ChassisSpeeds, position: Translation2d, volts: float, tm_diff: float) -> None:
        """Set the sensors. The wheel rolls as the robot moves, because it does not slip along its direction."""
        vx = speeds.vx - speeds.omega * position.Y()
        vy = speeds.vy + speeds.omega * position.X()
        angle = self.angle()
        speed = vx * angle.cos() + vy * angle.sin()
        self.driving.setState(self.driving.getAngularPosition(), speed / (Drive.WHEEL_DIAMETER / 2))
        self.driving_spark.iterate(speed, volts, tm_diff)
        self.turning_spark.iterate(self.turning.getAngularVelocity(), volts, tm_diff)
        self.turning_sensor.setPosition(self.turning.getAngularPosition() % math.tau)

    def current(self) -> float:
        """Return the current of both motors, in amperes."""
        return abs(self.driving.getCurrentDraw()) + abs(self.turning.getCurrentDraw())


class SwervePhysics:
    """The four modules together move the robot."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        self.drivetrain = robot.container.drivetrain
        self.modules = [ModulePhysics(module) for module in self.drivetrain.modules]
        self.poses_reset = self.drivetrain.poses_reset
        physics_controller.add_device_gyro_channel("navx_spi_4_angle")

    def update(self, volts: float, tm_diff: float) -> None:
        """Move the robot according to its wheels."""
        if self.drivetrain.poses_reset != self.poses_reset:
            # The robot says where it has been put: the drive team put it there.
            self.poses_reset = self.drivetrain.poses_reset
            here = self.physics_controller.get_pose()
            there = Pose2d(self.drivetrain.pose().translation(), here.rotation())
            self.physics_controller.move_robot(Transform2d(here, there))
        speeds = Drive.KINEMATICS.toChassisSpeeds(tuple(module.move(volts, tm_diff) for module in self.modules))
        for module, position in zip(self.modules, Drive.MODULE_POSITIONS, strict=True):
            module.measure(speeds, position, volts, tm_diff)
        self.physics_controller.drive(speeds, tm_diff)

    def current(self) -> float:
        """Return the current of all motors, in amperes."""
        return sum(module.current() for module in self.modules)


class ElevatorPhysics:
    """Two NEOs lift the carriage."""

    def __init__(self, robot: MyRobot) -> None:
        elevator = robot.container.elevator
        gearbox = DCMotor.NEO(2)
        self.spark = rev.SparkMaxSim(elevator.leader, gearbox)
        self.switch = DIOSim(elevator.bottom_switch)
        self.sim = ElevatorSim(
            gearbox,
            Elevator.REDUCTION,
            Elevator.CARRIAGE_MASS,
            Elevator.DRUM_RADIUS,
            Elevator.MIN_HEIGHT,
            Elevator.MAX_HEIGHT,
            True,
            Elevator.MIN_HEIGHT,
        )

    def update(self, volts: float, tm_diff: float) -> None:
        """Move the carriage."""
        self.sim.setInputVoltage(self.spark.getAppliedOutput() * volts)
        self.sim.update(tm_diff)
        self.spark.iterate(self.sim.getVelocity(), volts, tm_diff)
        self.spark.getRelativeEncoderSim().setPosition(self.sim.getPosition())
        self.switch.setValue(self.sim.getPosition() > 0.005)


class IntakePhysics:
    """A NEO moves the arm."""

    def __init__(self, robot: MyRobot) -> None:
        gearbox = DCMotor.NEO(1)
        self.spark = rev.SparkMaxSim(robot.container.intake.pivot, gearbox)
        self.rollers = rev.SparkMaxSim(robot.container.intake.rollers, NEO_550)
        self.sim = SingleJointedArmSim(
            gearbox,
            Intake.REDUCTION,
            SingleJointedArmSim.estimateMOI(Intake.LENGTH, Intake.MASS),
            Intake.LENGTH,
            Intake.MIN_ANGLE,
            Intake.MAX_ANGLE,
            True,
            Intake.STOWED,
        )

    def update(self, volts: float, tm_diff: float) -> None:
        """Move the arm."""
        self.sim.setInputVoltage(self.spark.getAppliedOutput() * volts)
        self.sim.update(tm_diff)
        self.spark.iterate(self.sim.getVelocity(), volts, tm_diff)
        self.spark.getRelativeEncoderSim().setPosition(self.sim.getAngle())
        self.rollers.iterate(self.rollers.getAppliedOutput() * 11000, volts, tm_diff)

    def collects(self) -> bool:
        """Return whether the intake is out and its rollers turn inwards."""
        return self.sim.getAngle() < math.radians(10) and self.rollers.getAppliedOutput() > 0.1


class ShooterPhysics:
    """Two flywheels and a feeder."""

    def __init__(self, robot: MyRobot) -> None:
        shooter = robot.container.shooter
        gearbox = DCMotor.neoVortex(1)
        plant = LinearSystemId.flywheelSystem(gearbox, Shooter.INERTIA, Shooter.REDUCTION)
        self.sparks = [rev.SparkFlexSim(motor, gearbox) for motor in (shooter.top, shooter.bottom)]
        self.flywheels = [FlywheelSim(plant, gearbox) for _ in self.sparks]
        self.feeder = rev.SparkMaxSim(shooter.feeder, NEO_550)

    def update(self, volts: float, tm_diff: float) -> None:
        """Turn the flywheels."""
        for spark, flywheel in zip(self.sparks, self.flywheels, strict=True):
            flywheel.setInputVoltage(spark.getAppliedOutput() * volts)
            flywheel.update(tm_diff)
            spark.iterate(flywheel.getAngularVelocity() * RPM, volts, tm_diff)
        self.feeder.iterate(self.feeder.getAppliedOutput() * 11000, volts, tm_diff)

    def rpm(self) -> float:
        """Return the speed of the slower flywheel."""
        return min(flywheel.getAngularVelocity() for flywheel in self.flywheels) * RPM

    def slow_down(self) -> None:
        """Lose the energy that a game piece takes with it."""
        for flywheel in self.flywheels:
            flywheel.setState([flywheel.getAngularVelocity() * 0.85])


class ClimberPhysics:
    """A winch without load."""

    def __init__(self, robot: MyRobot) -> None:
        gearbox = DCMotor.NEO(1)
        self.spark = rev.SparkMaxSim(robot.container.climber.motor, gearbox)
        self.switch = self.spark.getReverseLimitSwitchSim()
        self.sim = ElevatorSim(
            gearbox, Climber.REDUCTION, 1.0, Climber.DRUM_RADIUS, 0.0, Climber.MAX_TRAVEL + 0.02, False, 0.0
        )

    def update(self, volts: float, tm_diff: float) -> None:
        """Move the hook."""
        self.sim.setInputVoltage(self.spark.getAppliedOutput() * volts)
        self.sim.update(tm_diff)
        metres_per_rotation = math.tau * Climber.DRUM_RADIUS / Climber.REDUCTION
        self.spark.iterate(self.sim.getVelocity() / metres_per_rotation * 60, volts, tm_diff)
        self.spark.getRelativeEncoderSim().setPosition(self.sim.getPosition())
        self.switch.setPressed(self.sim.getPosition() < 0.005)


class GamePieces:
    """One piece is in the feeder at the start, the others lie on the field."""

    def __init__(self, robot: MyRobot) -> None:
        self.beam = DIOSim(robot.container.shooter.beam)
        self.field_object = robot.container.drivetrain.field.getObject("pieces")
        self.on_field = list(PIECES)
        self.loaded = True
        self.shots = 0
        self.fed = 0.0  # seconds that the feeder has pushed
        self.show()

    def show(self) -> None:
        """Tell the robot's light barrier and the dashboard."""
        self.beam.setValue(not self.loaded)
        self.field_object.setPoses([Pose2d(piece, Rotation2d()) for piece in self.on_field])
        wpilib.SmartDashboard.putNumber("Sim/Shots", self.shots)

    def update(self, pose: Pose2d, intake: IntakePhysics, shooter: ShooterPhysics, tm_diff: float) -> None:
        """Pick up and shoot."""
        feeding = shooter.feeder.getAppliedOutput() > 0.5
        self.fed = self.fed + tm_diff if feeding and self.loaded else 0.0
        if self.fed > 0.2 and shooter.rpm() > 2000:
            self.loaded, self.fed = False, 0.0
            self.shots += 1
            shooter.slow_down()
            self.show()
        elif not self.loaded and intake.collects():
            mouth = pose.transformBy(Transform2d(FRAME, 0, 0)).translation()
            for piece in self.on_field:
                if mouth.distance(piece) < 0.35:
                    self.on_field.remove(piece)
                    self.loaded = True
                    self.show()
                    break


class Camera:
    """Publishes where the robot is, as the real camera does: late, and not quite right."""

    def __init__(self) -> None:
        table = ntcore.NetworkTableInstance.getDefault().getTable(Vision.TABLE)
        self.publisher = table.getDoubleArrayTopic("botpose").publish()
        self.random = random.Random(1)
        self.frames: list[tuple[float, Pose2d]] = []
        self.next_frame = 0.0

    def update(self, now: float, pose: Pose2d) -> None:
        """Take a picture every 50 ms, and publish the one before."""
        if now < self.next_frame:
            return
        self.next_frame = now + 0.05
        self.frames.append((now, pose))
        if len(self.frames) < 2:
            return
        taken, seen = self.frames.pop(0)
        x = seen.X() + self.random.gauss(0, 0.02)
        y = seen.Y() + self.random.gauss(0, 0.02)
        self.publisher.set([x, y, seen.rotation().degrees(), (now - taken) * 1000, 2.0])


class PhysicsEngine:
    """Moves everything. Created after robotInit."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        self.swerve = SwervePhysics(physics_controller, robot)
        self.elevator = ElevatorPhysics(robot)
        self.intake = IntakePhysics(robot)
        self.shooter = ShooterPhysics(robot)
        self.climber = ClimberPhysics(robot)
        self.pieces = GamePieces(robot)
        self.camera = Camera()

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        volts = RoboRioSim.getVInVoltage()
        self.swerve.update(volts, tm_diff)
        for mechanism in (self.elevator, self.intake, self.shooter, self.climber):
            mechanism.update(volts, tm_diff)
        pose = self.physics_controller.get_pose()
        self.pieces.update(pose, self.intake, self.shooter, tm_diff)
        self.camera.update(now, pose)
        RoboRioSim.setVInVoltage(BatterySim.calculate([self.swerve.current(), 2.0]))
