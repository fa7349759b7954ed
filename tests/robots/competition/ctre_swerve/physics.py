"""Physics of the robot: what its motors' voltages do, and what its sensors then measure.

CTRE's devices are simulated by their library. It computes the voltage of each motor from the control request and from
the sensor values that are written here.
"""

import math

from phoenix6.hardware import CANcoder, TalonFX
from phoenix6.sim import ChassisReference
from pyfrc.physics.core import PhysicsInterface
from wpilib import RobotController
from wpilib.simulation import DCMotorSim, DIOSim, ElevatorSim, SingleJointedArmSim
from wpimath.geometry import Rotation2d
from wpimath.kinematics import SwerveModuleState
from wpimath.system.plant import DCMotor, LinearSystemId

from constants import Arm, Elevator, Shooter, Swerve
from robot import MyRobot
from subsystems.swervemodule import WHEEL_CIRCUMFERENCE, SwerveModule


def write_rotor(motor: TalonFX, rotations: float, rps: float) -> None:
    """Write what the motor's own sensor measures, before any gearing."""
    motor.sim_state.set_raw_rotor_position(rotations)
    motor.sim_state.set_rotor_velocity(rps)


def write_encoder(encoder: CANcoder, offset: float, rotations: float, rps: float) -> None:
    """Write what the magnet shows: without the offset that the robot adds."""
    encoder.sim_state.set_raw_position(rotations - offset)
    encoder.sim_state.set_velocity(rps)


class ModulePhysics:
    """One wheel: a quarter of the robot's mass on it, and a steering motor."""

    def __init__(self, module: SwerveModule, offset: float) -> None:
        self.module = module
        self.offset = offset
        kraken = DCMotor.krakenX60(1)
        inertia = Swerve.MASS / 4 * Swerve.WHEEL_RADIUS**2
        self.drive = DCMotorSim(LinearSystemId.DCMotorSystem(kraken, inertia, Swerve.DRIVE_RATIO), kraken)
        self.steer = DCMotorSim(LinearSystemId.DCMotorSystem(kraken, 0.01, Swerve.STEER_RATIO), kraken)
        # The steering motor hangs upside down.
        module.steer_motor.sim_state.orientation = ChassisReference.CLOCKWISE_POSITIVE

    def update(self, battery: float, tm_diff: float) -> SwerveModuleState:
        """Move for `tm_diff` seconds. Return how the wheel moved."""
        drive, steer = self.module.drive_motor.sim_state, self.module.steer_motor.sim_state
        for device in self.module.devices:
            device.sim_state.set_supply_voltage(battery)
        self.drive.setInputVoltage(drive.motor_voltage)
        self.steer.setInputVoltage(steer.motor_voltage)
        self.drive.update(tm_diff)
        self.steer.update(tm_diff)
        rolled, speed = self.drive.getAngularPosition() / math.tau, self.drive.getAngularVelocity() / math.tau
        turned, turning = self.steer.getAngularPosition() / math.tau, self.steer.getAngularVelocity() / math.tau
        write_rotor(self.module.drive_motor, rolled * Swerve.DRIVE_RATIO, speed * Swerve.DRIVE_RATIO)
        write_rotor(self.module.steer_motor, turned * Swerve.STEER_RATIO, turning * Swerve.STEER_RATIO)
        write_encoder(self.module.encoder, self.offset, turned, turning)
        return SwerveModuleState(speed * WHEEL_CIRCUMFERENCE, self.module_angle())

    def module_angle(self) -> Rotation2d:
        """Return the direction of the wheel."""
        return Rotation2d(self.steer.getAngularPosition())


class PhysicsEngine:
    """Created after the robot. Moves all its mechanisms."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        self.container = robot.container
        self.drivetrain = self.container.drivetrain
        self.kinematics = self.drivetrain.kinematics
        self.modules = [
            ModulePhysics(module, numbers[4])
            for module, numbers in zip(self.drivetrain.modules, Swerve.MODULES, strict=True)
        ]
        self.yaw = 0.0
        self.elevator = ElevatorSim(
            DCMotor.krakenX60(2),
            Elevator.RATIO,
            Elevator.CARRIAGE_MASS,
            Elevator.DRUM_RADIUS,
            0.0,
            Elevator.MAX_HEIGHT,
            True,
            0.0,
        )
        self.elevator_switch = DIOSim(self.container.elevator.bottom_switch)
        self.arm = SingleJointedArmSim(
            DCMotor.krakenX60(1),
            Arm.RATIO,
            SingleJointedArmSim.estimateMOI(Arm.LENGTH, Arm.MASS),
            Arm.LENGTH,
            math.radians(-45),
            math.radians(100),
            True,
            Arm.STOWED,
        )
        kraken = DCMotor.krakenX60(1)
        self.rollers = [
            (motor, DCMotorSim(LinearSystemId.DCMotorSystem(kraken, Shooter.INERTIA, 1), kraken))
            for motor in (self.container.shooter.top, self.container.shooter.bottom, self.container.intake.motor)
        ]

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        battery = RobotController.getBatteryVoltage()
        self._move_robot(battery, tm_diff)
        self._move_elevator(battery, tm_diff)
        self._move_arm(battery, tm_diff)
        for motor, roller in self.rollers:
            motor.sim_state.set_supply_voltage(battery)
            roller.setInputVoltage(motor.sim_state.motor_voltage)
            roller.update(tm_diff)
            write_rotor(motor, roller.getAngularPosition() / math.tau, roller.getAngularVelocity() / math.tau)

    def _move_robot(self, battery: float, tm_diff: float) -> None:
        speeds = self.kinematics.toChassisSpeeds(tuple(module.update(battery, tm_diff) for module in self.modules))
        self.physics_controller.drive(speeds, tm_diff)
        self.yaw += math.degrees(speeds.omega) * tm_diff
        pigeon = self.drivetrain.pigeon.sim_state
        pigeon.set_supply_voltage(battery)
        pigeon.set_raw_yaw(self.yaw)
        pigeon.set_angular_velocity_z(math.degrees(speeds.omega))

    def _move_elevator(self, battery: float, tm_diff: float) -> None:
        leader, follower = self.container.elevator.leader, self.container.elevator.follower
        for motor in (leader, follower):
            motor.sim_state.set_supply_voltage(battery)
        self.elevator.setInputVoltage(leader.sim_state.motor_voltage)
        self.elevator.update(tm_diff)
        per_metre = Elevator.RATIO / (math.tau * Elevator.DRUM_RADIUS)
        rotations, rps = self.elevator.getPosition() * per_metre, self.elevator.getVelocity() * per_metre
        write_rotor(leader, rotations, rps)
        write_rotor(follower, -rotations, -rps)
        self.elevator_switch.setValue(self.elevator.getPosition() > 0.005)

    def _move_arm(self, battery: float, tm_diff: float) -> None:
        motor, encoder = self.container.arm.motor, self.container.arm.encoder
        for device in (motor, encoder):
            device.sim_state.set_supply_voltage(battery)
        self.arm.setInputVoltage(motor.sim_state.motor_voltage)
        self.arm.update(tm_diff)
        turned, turning = self.arm.getAngle() / math.tau, self.arm.getVelocity() / math.tau
        write_rotor(motor, turned * Arm.RATIO, turning * Arm.RATIO)
        write_encoder(encoder, 0.0, turned, turning)
