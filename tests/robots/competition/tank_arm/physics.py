"""Simulate the drivetrain, the elevator, the arm, the pneumatics and the cameras."""

import math
from typing import TYPE_CHECKING

import ntcore
import rev
import wpilib
from constants import Arm, Can, Dio, Drive, Elevator, Pwm, Vision
from photonlibpy.simulation.photonCameraSim import PhotonCameraSim
from photonlibpy.simulation.simCameraProperties import SimCameraProperties
from photonlibpy.simulation.visionSystemSim import VisionSystemSim
from wpilib import simulation
from wpimath.geometry import Pose2d, Translation2d
from wpimath.system.plant import DCMotor

from pyfrc.physics import motor_cfgs, tankmodel
from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.units import units

if TYPE_CHECKING:
    from robot import MyRobot

GOAL = Translation2d(4.63, 4.03)  # the blue hub
FEET = 0.3048


class PhysicsEngine:
    """What is attached to the robot's motors."""

    def __init__(self, physics_controller: PhysicsInterface, robot: "MyRobot") -> None:
        self.controller = physics_controller
        container = robot.container
        self._create_drivetrain(container.drivetrain)
        self._create_mechanisms(container)
        self._create_cameras(container.vision)
        self.power = simulation.PowerDistributionSim(Can.PDH)
        self.hub = simulation.REVPHSim(Can.PNEUMATIC_HUB)

    def _create_drivetrain(self, drivetrain) -> None:
        # One motor: a SPARK MAX limits its own current. REV's simulation points to the DCMotor, so it must live on.
        self.neo = DCMotor.NEO(1)
        self.left = rev.SparkMaxSim(drivetrain.left, self.neo)
        self.right = rev.SparkMaxSim(drivetrain.right, self.neo)
        self.left_encoder = simulation.EncoderSim(drivetrain.left_encoder)
        self.right_encoder = simulation.EncoderSim(drivetrain.right_encoder)
        self.gyro = simulation.ADXRS450_GyroSim(drivetrain.gyro)
        self.drivetrain = tankmodel.TankModel.theory(
            motor_cfgs.MOTOR_CFG_NEO,
            robot_mass=Drive.ROBOT_KG * units.kg,
            gearing=Drive.GEARING,
            nmotors=2,
            x_wheelbase=Drive.TRACK_WIDTH * units.m,
            robot_width=0.85 * units.m,
            robot_length=0.9 * units.m,
            wheel_diameter=Drive.WHEEL_DIAMETER * units.m,
        )
        # Wheels that do not slip: the robot turns as far as the encoders measure.
        self.drivetrain.inertia = Drive.ROBOT_KG * units.kg * (Drive.TRACK_WIDTH * units.m) ** 2 / 2

    def _create_mechanisms(self, container) -> None:
        self.elevator_motor = simulation.PWMSim(Pwm.ELEVATOR_LEFT)
        self.elevator_encoder = simulation.EncoderSim(container.elevator.encoder)
        self.bottom_switch = simulation.DIOSim(Dio.ELEVATOR_BOTTOM)
        self.top_switch = simulation.DIOSim(Dio.ELEVATOR_TOP)
        self.elevator = simulation.ElevatorSim(
            DCMotor.falcon500(2),
            Elevator.GEARING,
            Elevator.CARRIAGE_KG,
            Elevator.DRUM_RADIUS,
            0,
            Elevator.MAX_HEIGHT,
            True,
            0.12,
        )
        # The encoder is relative: it reads 0 where the robot's code has reset it.
        self.elevator_zero = self.elevator.getPosition()
        self.on_reset = self.elevator_encoder.registerResetCallback(self._elevator_encoder_was_reset, False)

        self.arm_motor = rev.SparkMaxSim(container.arm.motor, self.neo)
        self.arm_encoder = simulation.DutyCycleEncoderSim(container.arm.encoder)
        self.arm = simulation.SingleJointedArmSim(
            DCMotor.NEO(1),
            Arm.GEARING,
            simulation.SingleJointedArmSim.estimateMOI(Arm.LENGTH, Arm.KG),
            Arm.LENGTH,
            Arm.MIN_ANGLE,
            Arm.MAX_ANGLE,
            True,
            math.radians(-58),
        )
        self.wrist_motor = simulation.PWMSim(Pwm.WRIST)
        self.wrist_potentiometer = simulation.AnalogInputSim(0)
        self.wrist_degrees = 60.0

    def _create_cameras(self, cameras) -> None:
        self.vision = VisionSystemSim("main")
        self.vision.addAprilTags(cameras.layout)
        properties = SimCameraProperties()
        properties.setFPS(20)
        # In seconds, although photonlibpy's documentation says milliseconds.
        properties.setAvgLatency(0.03)
        properties.setLatencyStdDev(0.005)
        for (camera, _), transform in zip(
            cameras.cameras, (Vision.FRONT_TRANSFORM, Vision.REAR_TRANSFORM), strict=True
        ):
            self.vision.addCamera(PhotonCameraSim(camera, properties), transform)
        table = ntcore.NetworkTableInstance.getDefault().getTable(Vision.LIMELIGHT)
        self.valid = table.getDoubleTopic("tv").publish()
        self.offset_x = table.getDoubleTopic("tx").publish()
        self.offset_y = table.getDoubleTopic("ty").publish()
        self.botpose = table.getDoubleArrayTopic("botpose_wpiblue").publish()
        self.until_next_frame = 0.0

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Move everything by one step."""
        volts = wpilib.RobotController.getBatteryVoltage()
        self._update_drivetrain(volts, tm_diff)
        self._update_elevator(volts, tm_diff)
        self._update_arm(volts, tm_diff)
        self.hub.setCompressorCurrent(12.0 if self.hub.getCompressorOn() else 0.0)
        current = self.elevator.getCurrentDraw() + self.arm.getCurrentDraw()
        # Each side has two motors.
        current += 2 * (abs(self.left.getMotorCurrent()) + abs(self.right.getMotorCurrent()))
        self.power.setCurrent(0, current)
        simulation.RoboRioSim.setVInVoltage(simulation.BatterySim.calculate([current]))
        pose = self.controller.get_pose()
        self.vision.update(pose)
        self._update_limelight(pose, tm_diff)

    def _update_drivetrain(self, volts: float, tm_diff: float) -> None:
        moved = self.drivetrain.calculate(self.left.getAppliedOutput(), -self.right.getAppliedOutput(), tm_diff)
        pose = self.controller.move_robot(moved)
        self.left.iterate(self.drivetrain.l_velocity * FEET, volts, tm_diff)
        self.right.iterate(self.drivetrain.r_velocity * FEET, volts, tm_diff)
        for encoder, position, velocity in (
            (self.left_encoder, self.drivetrain.l_position, self.drivetrain.l_velocity),
            (self.right_encoder, self.drivetrain.r_position, self.drivetrain.r_velocity),
        ):
            encoder.setDistance(position * FEET)
            encoder.setRate(velocity * FEET)
        self.gyro.setAngle(-pose.rotation().degrees())

    def _update_elevator(self, volts: float, tm_diff: float) -> None:
        self.elevator.setInputVoltage(self.elevator_motor.getSpeed() * volts)
        self.elevator.update(tm_diff)
        height = self.elevator.getPosition()
        self.elevator_encoder.setDistance(height - self.elevator_zero)
        self.elevator_encoder.setRate(self.elevator.getVelocity())
        self.bottom_switch.setValue(height > 0.004)
        self.top_switch.setValue(height < Elevator.MAX_HEIGHT - 0.004)

    def _elevator_encoder_was_reset(self, name: str, value: object) -> None:
        self.elevator_zero = self.elevator.getPosition()

    def _update_arm(self, volts: float, tm_diff: float) -> None:
        self.arm.setInputVoltage(self.arm_motor.getAppliedOutput() * volts)
        self.arm.update(tm_diff)
        self.arm_motor.iterate(self.arm.getVelocity(), volts, tm_diff)
        self.arm_encoder.set((self.arm.getAngle() / (2 * math.pi) + Arm.ENCODER_OFFSET) % 1)
        self.wrist_degrees += self.wrist_motor.getSpeed() * 320 * tm_diff
        self.wrist_degrees = max(0.0, min(Arm.WRIST_RANGE_DEGREES, self.wrist_degrees))
        self.wrist_potentiometer.setVoltage(5 * self.wrist_degrees / Arm.WRIST_RANGE_DEGREES)

    def _update_limelight(self, pose: Pose2d, tm_diff: float) -> None:
        """Publish what the Limelight sees, ten times a second."""
        self.until_next_frame -= tm_diff
        if self.until_next_frame > 0:
            return
        self.until_next_frame += 0.1
        to_goal = GOAL - pose.translation()
        # tx grows to the right, the robot's angles to the left.
        offset = -(to_goal.angle() - pose.rotation()).degrees()
        visible = abs(offset) < 30 and 0.5 < to_goal.norm() < 6
        self.valid.set(1.0 if visible else 0.0)
        self.offset_x.set(offset if visible else 0.0)
        self.offset_y.set(math.degrees(math.atan2(1.2, to_goal.norm())) if visible else 0.0)
        values = [pose.X(), pose.Y(), 0, 0, 0, pose.rotation().degrees(), 25.0, 1.0 if visible else 0.0, 0, 0, 0]
        self.botpose.set(values)
