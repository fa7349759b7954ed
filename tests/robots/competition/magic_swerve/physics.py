"""What the motors move, and what the sensors measure of it."""

import math

import constants as c
import rev
from robot import MyRobot
from wpilib import PneumaticsModuleType
from wpilib.simulation import (
    ADXRS450_GyroSim,
    AnalogInputSim,
    BatterySim,
    DCMotorSim,
    DIOSim,
    DutyCycleEncoderSim,
    ElevatorSim,
    EncoderSim,
    FlywheelSim,
    PWMSim,
    RoboRioSim,
    SingleJointedArmSim,
    SolenoidSim,
)
from wpimath.geometry import Rotation2d
from wpimath.kinematics import SwerveDrive4Kinematics, SwerveModuleState
from wpimath.system.plant import DCMotor, LinearSystemId

from pyfrc.physics.core import PhysicsInterface


class ModuleSim:
    """A corner of the drivetrain."""

    def __init__(self, module):
        """Each wheel carries a quarter of 55 kg."""
        neo = DCMotor.NEO(1)
        radius = c.WHEEL_CIRCUMFERENCE / (2 * math.pi)
        self.drive = rev.SparkMaxSim(module.drive, neo)
        self.steer = rev.SparkMaxSim(module.steer, neo)
        self.wheel = DCMotorSim(LinearSystemId.DCMotorSystem(neo, 55 / 4 * radius**2, c.DRIVE_GEARING), neo)
        self.direction = DCMotorSim(LinearSystemId.DCMotorSystem(neo, 0.004, c.STEER_GEARING), neo)
        self.encoder = DutyCycleEncoderSim(module.absolute_encoder)
        self.encoder.set(0.0)
        self.radius = radius

    def update(self, volts, tm_diff):
        """Return the wheel's state, after the motors' controllers have done their part."""
        self.wheel.setInputVoltage(self.drive.getAppliedOutput() * volts)
        self.wheel.update(tm_diff)
        speed = self.wheel.getAngularVelocity() * self.radius
        self.drive.iterate(speed, volts, tm_diff)

        self.direction.setInputVoltage(self.steer.getAppliedOutput() * volts)
        self.direction.update(tm_diff)
        rpm = self.direction.getAngularVelocity() * c.STEER_GEARING * 60 / (2 * math.pi)
        self.steer.iterate(rpm, volts, tm_diff)
        angle = math.remainder(self.direction.getAngularPosition(), 2 * math.pi)
        self.encoder.set(angle)
        return SwerveModuleState(speed, Rotation2d(angle))

    def current(self):
        """Return what both motors draw (A)."""
        return abs(self.wheel.getCurrentDraw()) + abs(self.direction.getCurrentDraw())


class Balls:
    """What lies on the carpet, and what is in the hopper."""

    ENTERS, LEAVES, IN_BARRIER = 0.4, 0.25, 0.1  # s

    def __init__(self, loaded):
        """The hopper is loaded as the rules allow."""
        self.entry, self.exit = DIOSim(c.DIO_INDEXER_ENTRY), DIOSim(c.DIO_INDEXER_EXIT)
        self.inside = loaded
        self.entering = self.leaving = 0.0

    def update(self, belt, collecting, tm_diff):
        """Let balls in while the robot collects, and out while the belt is fast enough to push them into the wheels."""
        self.entering += tm_diff if collecting and belt > 0.2 and self.inside < 10 else -self.entering
        if self.entering > self.ENTERS:
            self.entering = 0.0
            self.inside += 1
        self.leaving += tm_diff if belt > 0.7 and self.inside else -self.leaving
        if self.leaving > self.LEAVES:
            self.leaving = 0.0
            self.inside -= 1
        self.entry.setValue(self.entering < self.ENTERS - self.IN_BARRIER)
        self.exit.setValue(self.leaving < self.LEAVES - self.IN_BARRIER)


class PhysicsEngine:
    """The whole robot."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot):
        """Everything is at rest, the intake stowed, the hook down."""
        self.physics_controller = physics_controller
        self.modules = [ModuleSim(module) for module in robot.swerve_modules]
        self.kinematics = SwerveDrive4Kinematics(*(module.location for module in robot.swerve_modules))
        self.gyro = ADXRS450_GyroSim(robot.gyro)
        self.heading = 0.0

        flywheel, vortex = DCMotor.NEO(2), DCMotor.NEO(1)
        self.shooter = FlywheelSim(LinearSystemId.flywheelSystem(flywheel, 0.006, 1.0), flywheel)
        self.shooter_left = rev.SparkMaxSim(robot.shooter_left, vortex)
        self.shooter_right = rev.SparkMaxSim(robot.shooter_right, vortex)

        arm = DCMotor.krakenX60(1)
        self.pivot = PWMSim(robot.intake_pivot.getChannel())
        self.arm = SingleJointedArmSim(
            arm,
            c.INTAKE_GEARING,
            SingleJointedArmSim.estimateMOI(c.INTAKE_LENGTH, c.INTAKE_MASS),
            c.INTAKE_LENGTH,
            c.INTAKE_DEPLOYED - 0.05,
            c.INTAKE_STOWED + 0.05,
            True,
            c.INTAKE_STOWED,
        )
        self.potentiometer = AnalogInputSim(c.ANALOG_INTAKE_PIVOT)
        self.roller = rev.SparkMaxSim(robot.intake_roller, DCMotor.NEO550(1))
        self.roller_wheel = FlywheelSim(
            LinearSystemId.flywheelSystem(DCMotor.NEO550(1), 0.0006, 4.0), DCMotor.NEO550(1)
        )

        self.belt = PWMSim(robot.indexer_belt.getChannel())
        self.balls = Balls(loaded=3)

        lift = DCMotor.NEO(2)
        self.winch = PWMSim(robot.climber_left.getChannel())
        self.hook = ElevatorSim(
            lift, c.CLIMBER_GEARING, c.CLIMBER_MASS, c.CLIMBER_DRUM, 0.0, c.CLIMBER_TRAVEL, True, 0.0
        )
        self.hook_encoder = EncoderSim(robot.climber_encoder)
        self.bottom = DIOSim(robot.climber_bottom)
        self.brake = SolenoidSim(c.PNEUMATICS, PneumaticsModuleType.REVPH, c.SOLENOID_CLIMBER_BRAKE)
        self.measure()

    def measure(self):
        """Set the sensors of arm and hook."""
        turned = self.arm.getAngle() - c.INTAKE_POTENTIOMETER_OFFSET
        self.potentiometer.setVoltage(5 * turned / c.INTAKE_POTENTIOMETER_RANGE)
        self.hook_encoder.setDistance(self.hook.getPosition())
        self.bottom.setValue(self.hook.getPosition() > 0.004)

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Move everything by one step."""
        volts = RoboRioSim.getVInVoltage()

        states = [module.update(volts, tm_diff) for module in self.modules]
        speeds = self.kinematics.toChassisSpeeds(states)
        self.physics_controller.drive(speeds, tm_diff)
        self.heading -= math.degrees(speeds.omega * tm_diff)  # the gyro counts clockwise
        self.gyro.setRate(-math.degrees(speeds.omega))
        self.gyro.setAngle(self.heading)

        self.shooter.setInputVoltage(self.shooter_left.getAppliedOutput() * volts)
        self.shooter.update(tm_diff)
        rpm = self.shooter.getAngularVelocity() * 60 / (2 * math.pi)
        self.shooter_left.iterate(rpm, volts, tm_diff)
        self.shooter_right.iterate(-rpm, volts, tm_diff)

        self.arm.setInputVoltage(self.pivot.getSpeed() * volts)
        self.arm.update(tm_diff)
        self.roller_wheel.setInputVoltage(self.roller.getAppliedOutput() * volts)
        self.roller_wheel.update(tm_diff)
        self.roller.iterate(self.roller_wheel.getAngularVelocity() * 4 * 60 / (2 * math.pi), volts, tm_diff)

        collecting = self.roller.getAppliedOutput() > 0.3 and self.arm.getAngle() < 0.2
        self.balls.update(-self.belt.getSpeed(), collecting, tm_diff)

        if self.brake.getOutput():
            self.hook.setInputVoltage(self.winch.getSpeed() * volts)
            self.hook.update(tm_diff)
        self.measure()

        drawn = [module.current() for module in self.modules]
        drawn += [self.shooter.getCurrentDraw(), self.arm.getCurrentDraw(), self.hook.getCurrentDraw()]
        RoboRioSim.setVInVoltage(max(7.0, BatterySim.calculate([abs(current) for current in drawn])))
