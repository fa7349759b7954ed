"""What `pyfrc migrate` makes of code: WPILib's names by what the objects are, and the team's own names unchanged."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest
from loops import for_each

pytest.importorskip("libcst")

from pyfrc_core.migrate.migration import migrate
from pyfrc_core.migrate.report import Remark


def migrated(tmp_path: Path, **files: str) -> dict[str, str]:
    """Return the files after a migration; a name's `__` is a `/`."""
    for name, text in files.items():
        file = tmp_path / (name.replace("__", "/") + ".py")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(dedent(text).lstrip("\n"), "utf-8")
    done = migrate(tmp_path)
    done.write()
    assert not migrate(tmp_path).after, "a second run changes something"
    return {name: (tmp_path / (name.replace("__", "/") + ".py")).read_text("utf-8") for name in files}


def remarks(tmp_path: Path, code: str) -> list[Remark]:
    (tmp_path / "robot.py").write_text(dedent(code).lstrip("\n"), "utf-8")
    report = migrate(tmp_path).report
    return [*report.by_hand(), *report.to_check()]


#: Code, and what it becomes, as a diff: lines that begin with `-` are those before, with `+` those after.
CODE = {
    "a stand-in for the simulator": """
          import wpilib
          class Fake:
        -     def getRate(self): return 0.0
        +     def get_rate(self): return 0.0
          class Slow(Fake):
        -     def getRate(self): return super().getRate() / 2
        +     def get_rate(self): return super().get_rate() / 2
          def made(real):
              return wpilib.Encoder(0, 1) if real else Slow()
        - print(made(True).getRate(), Fake().getRate())
        + print(made(True).get_rate(), Fake().get_rate())
    """,
    "a class that is not called": """
          import wpilib
          class Swerve:
        -     gyro: wpilib.ADXRS450_Gyro
        +     gyro: wpilib.OnboardIMU
        - print(isinstance(Swerve.gyro, wpilib.ADXRS450_Gyro))
        + print(isinstance(Swerve.gyro, wpilib.OnboardIMU))
    """,
    "what a callable returns": """
          from typing import Callable
        - from wpimath.geometry import Pose2d
        + from wpimath import Pose2d
          class Drive:
              def __init__(self, pose: Callable[[], Pose2d]):
                  self.pose = pose
              def far(self):
        -         return self.pose().X()
        +         return self.pose().x
    """,
    "private modules, from which editors import": """
        - from wpimath.kinematics._kinematics import SwerveModuleState
        - from wpimath._controls._controls.controller import PIDController
        - from wpilib._wpilib import Encoder as Sensor
        + from wpimath import PIDController, SwerveModuleVelocity
        + from wpilib import Encoder as Sensor
        - print(SwerveModuleState().speed, PIDController(1, 0, 0).getP(), Sensor(0, 1).getRate())
        + print(SwerveModuleVelocity().velocity, PIDController(1, 0, 0).get_p(), Sensor(0, 1).get_rate())
    """,
    "a protocol": """
          import typing
          import wpilib
          class HasRate(typing.Protocol):
        -     def getRate(self) -> float: ...
        +     def get_rate(self) -> float: ...
          def show(sensor: HasRate):
        -     print(sensor.getRate())
        +     print(sensor.get_rate())
          show(wpilib.Encoder(0, 1))
    """,
    "motors by setattr, in lambdas, by map and in dictionaries": """
          import wpilib
        + import wpilib_drivers
          class Drive:
              def __init__(self, left=None, right=None):
                  self.sides = [left, right]
                  for name in ("front", "back"):
        -             setattr(self, name, wpilib.Talon(2))
        +             setattr(self, name, wpilib_drivers.Talon(2))
              @staticmethod
              def run(each, speed):
        -         each.set(speed)
        +         each.set_throttle(speed)
              def each(self, do):
                  for motor in self.sides:
                      do(motor)
              def stop(self):
        -         self.front.set(0)
        -         self.each(lambda motor: motor.set(0))
        -         list(map(lambda motor: motor.set(1), self.sides))
        +         self.front.set_throttle(0)
        +         self.each(lambda motor: motor.set_throttle(0))
        +         list(map(lambda motor: motor.set_throttle(1), self.sides))
                  Drive.run(self.back, 1)
        - drive = Drive(**{"left": wpilib.Talon(0), "right": wpilib.Talon(1)})
        + drive = Drive(**{"left": wpilib_drivers.Talon(0), "right": wpilib_drivers.Talon(1)})
          for each in map(wpilib.Encoder, range(2), range(2, 4)):
        -     each.getRate()
        +     each.get_rate()
    """,
    "what a mixin and an own base use of derived classes": """
          import commands2
          import wpilib
          class Sided:
        -     def isFinished(self): return self.encoder.getDistance() > 1
        +     def is_finished(self): return self.encoder.get_distance() > 1
          class Turn(Sided, commands2.Command):
              def __init__(self):
                  self.encoder = wpilib.Encoder(0, 1)
    """,
    "comments and line breaks": """
          import wpilib
        - from wpimath import applyDeadband
        + import telemetry
          class Robot(wpilib.TimedRobot):
        -     def robotInit(self):
        +     def __init__(self):
                  # nothing yet
        -         pass  # so far
        -     def teleopPeriodic(self):
        -         wpilib.SmartDashboard.putNumber(  # shown
        +         super().__init__()  # so far
        +     def teleop_periodic(self):
        +         telemetry.log(  # shown
                      "a",
                      1)
        -         now = wpilib.RobotController.getFPGATime(  # in microseconds
        -         )
        -         turn = applyDeadband(wpilib.XboxController(0)
        -             .getLeftY(), 0.1)
        +         # in microseconds
        +         now = (wpilib.RobotController.get_monotonic_time() // 1000)
        +         turn = (wpilib.XboxController(0)
        +             .get_left_y())
    """,
    "methods that are not called where they are named": """
          import wpilib
        + import telemetry
          from wpilib import RobotController
        - now = wpilib.RobotController.getFPGATime
        - then, put = RobotController.getFPGATime, wpilib.SmartDashboard.putNumber
        + now = (lambda: (wpilib.RobotController.get_monotonic_time() // 1000))
        + then, put = (lambda: (RobotController.get_monotonic_time() // 1000)), telemetry.log
          put("passed", now() - then())
    """,
    "the constructor of a base of the team's": """
          import wpilib
          class Base(wpilib.TimedRobot):
        -     def robotInit(self):
        +     def __init__(self):
        +         super().__init__()
                  self.encoder = wpilib.Encoder(0, 1)
          class Robot(Base):
        -     def robotInit(self):
        -         super().robotInit()
        +     def __init__(self):
        +         super().__init__()
                  self.timer = wpilib.Timer()
    """,
    "names that tests replace": """
          from unittest.mock import patch
          import wpilib
        - with patch.object(wpilib.Encoder, "getRate"):
        + with patch.object(wpilib.Encoder, "get_rate"):
              pass
    """,
    "an old name of a base class": """
          import commands2
        - from commands2 import Command, SubsystemBase, SubsystemBase as Part
        - class Drive(commands2.SubsystemBase):
        + from commands2 import Command, Subsystem, Subsystem as Part
        + class Drive(commands2.Subsystem):
              pass
          class Arm(Part):
              def setup(self):
        -         self.setDefaultCommand(Move(self))
        - class Shooter(SubsystemBase):
        +         self.set_default_command(Move(self))
        + class Shooter(Subsystem):
              pass
          class Move(Command):
        -     def isFinished(self):
        +     def is_finished(self):
                  return True
    """,
    "buttons and axes of controllers, by numbers and by names": """
          from commands2.button import CommandXboxController
          from wpilib import XboxController
          pad = CommandXboxController(0)
        - shoots, fast = pad.button(5), pad.axisGreaterThan(2, 0.5)
        - stops = pad.button(XboxController.Button.kA)
        - slow = pad.axisLessThan(XboxController.Axis.kLeftX, 0.1)
        - x = pad.getRawAxis(XboxController.Axis.kRightX) + pad.getHID().getRawAxis(4)
        + shoots, fast = pad.get_hid().button(9), pad.get_hid().axis_greater_than(4, 0.5)
        + stops = pad.get_hid().button(XboxController.Button.A)
        + slow = pad.get_hid().axis_less_than(XboxController.Axis.LEFT_X, 0.1)
        + x = pad.get_hid().get_raw_axis(XboxController.Axis.RIGHT_X) + pad.get_controller().get_hid().get_raw_axis(2)
    """,
    "a name of several types": """
          from typing import List, Union
          import rev
          Config = Union[rev.SparkMaxConfig, "rev.SparkFlexConfig"]
          def prepare(configs: Union[Config, List[Config]]):
              for each in configs if isinstance(configs, list) else [configs]:
        -         each.smartCurrentLimit(40)
        +         each.smart_current_limit(40)
    """,
    "a short name of the dashboard": """
          import wpilib
        + import telemetry
          def show(x):
              sd = wpilib.SmartDashboard
        -     sd.putNumber("x", x)
        +     telemetry.log("x", x)
    """,
    "cameras": """
        - from cscore import CameraServer as CS, VideoMode
        + from cscore import CameraServer as CS
        + from wpiutil import PixelFormat
          def main():
        -     CS.enableLogging()
        -     camera = CS.startAutomaticCapture()
        -     camera.setVideoMode(VideoMode.PixelFormat.kMJPEG, 320, 240, 30)
        -     sink, out = CS.getVideo(), CS.putVideo("a", 320, 240)
        -     time, image = sink.grabFrame(None)
        -     out.notifyError(sink.getError())
        +     CS.enable_logging()
        +     camera = CS.start_automatic_capture()
        +     camera.set_video_mode(PixelFormat.MJPEG, 320, 240, 30)
        +     sink, out = CS.get_video(), CS.put_video("a", 320, 240)
        +     time, image = sink.grab_frame(None)
        +     out.notify_error(sink.get_error())
    """,
    "what the dashboard shows": """
          import wpilib
        - import wpilib.drive
        + import telemetry
        + import tunables
          from commands2 import Command, CommandScheduler
        - from wpilib import SmartDashboard
        - from wpimath.controller import PIDController
        + from wpimath import PIDController
          class Shoot(Command): pass
          class R(wpilib.TimedRobot):
        -     def robotPeriodic(self):
        -         SmartDashboard.putData("Field", wpilib.Field2d())
        -         SmartDashboard.putData(PIDController(1, 0, 0))
        -         SmartDashboard.putData("Shoot", Shoot())
        -         SmartDashboard.putData(CommandScheduler.getInstance())
        -         SmartDashboard.putData("Arm", wpilib.Mechanism2d(1, 1))
        +     def robot_periodic(self):
        +         telemetry.log("Field", wpilib.Field2d())
        +         tunables.publish("PIDController", PIDController(1, 0, 0))
        +         tunables.publish("Shoot", Shoot())
        +         tunables.publish("Scheduler", CommandScheduler.get_instance())
        +         telemetry.log("Arm", wpilib.Mechanism2d(1, 1))
          if __name__ == "__main__":
        -     wpilib.run(R)
        +     pass
    """,
    "PlayStation controllers": """
          import wpilib
        - from commands2.button import CommandPS4Controller, JoystickButton
        - pad = wpilib.PS5Controller(0)
        - print(pad.getRawButton(2), pad.getRawAxis(5), pad.getL2Axis())
        - shoot = JoystickButton(wpilib.PS4Controller(1), 1)
        - fast = CommandPS4Controller(2).getR2Axis()
        + from commands2.button import CommandDualShock4Controller, JoystickButton
        + pad = wpilib.DualSenseController(0)
        + print(pad.get_hid().get_raw_button(0), pad.get_hid().get_raw_axis(3), pad.get_l2())
        + shoot = JoystickButton(wpilib.DualShock4Controller(1).get_hid(), 2)
        + fast = CommandDualShock4Controller(2).get_r2()
    """,
    "what is put into containers": """
          import rev
        + import wpilib_drivers
          import wpilib
          KINDS = {"drive": rev.SparkMax}
          class Robot(wpilib.TimedRobot):
              def __init__(self):
                  self.objects, self.motors, self.mine = {}, [], []
                  field = wpilib.Field2d()
                  for name in ("a", "b"):
        -             self.objects[name] = field.getObject(name)
        -             self.motors.append(wpilib.Talon(0))
        +             self.objects[name] = field.get_object(name)
        +             self.motors.append(wpilib_drivers.Talon(0))
                      self.mine.append(3)
        -         self.spark = KINDS["drive"](1, rev.SparkMax.MotorType.kBrushless)
        +         self.spark = KINDS["drive"](wpilib.CANPort.CAN_S0, 1, rev.SparkMax.MotorType.BRUSHLESS)
                  self.requirements.add(3)
              def show(self):
        -         self.objects["a"].setPoses([])
        +         self.objects["a"].set_poses([])
                  for motor in self.motors:
        -             motor.set(self.mine[0])
        -         self.spark.set(1)
        +             motor.set_throttle(self.mine[0])
        +         self.spark.set_throttle(1)
    """,
    "one of two gamepads": """
        - from commands2.button import CommandPS4Controller, CommandXboxController
        + from commands2.button import CommandDualShock4Controller, CommandXboxController
          def made(sony):
        -     return CommandPS4Controller(0) if sony else CommandXboxController(0)
        +     return CommandDualShock4Controller(0) if sony else CommandXboxController(0)
          pad = made(True)
        - start = pad.options() if pad.L1() else pad.start()
        + start = pad.options() if pad.l1() else pad.menu()
    """,
    "CTRE's devices": """
          from phoenix6 import CANBus, hardware
        + import phoenix6
        + import wpilib
        + from wpilib import CANPort
          from phoenix6.hardware import TalonFX
          UPPER = "canivore"
          bus = CANBus(UPPER)
        - left = TalonFX(1)
        - right = TalonFX(2, "rio")
        - arm = TalonFX(3, canbus=UPPER)
        - gyro = hardware.Pigeon2(device_id=4)
        + left = TalonFX(1, CANBus(CANPort.CAN_S0))
        + right = TalonFX(2, CANBus(CANPort.CAN_S0))
        + arm = TalonFX(3, canbus=CANBus(UPPER))
        + gyro = hardware.Pigeon2(device_id=4, canbus=phoenix6.CANBus(wpilib.CANPort.CAN_S0))
          encoder = hardware.CANcoder(5, bus)
        - own = CANBus.roborio()
        - recorded = CANBus("rio", "./logs/example.hoot"), CANBus(canbus=UPPER, hoot_filepath="a.hoot")
        - left.set(right.get())
        - left.setNeutralMode(1)
        - angle = gyro.getRotation2d().degrees()
        + own = CANBus(CANPort.CAN_S0)
        + recorded = CANBus(CANPort.CAN_S0), CANBus(UPPER)
        + left.set_throttle(right.get_throttle())
        + left.config_neutral_mode(1)
        + angle = gyro.get_rotation2d().degrees()
          turned = left.get_position().value
    """,
    "classes made of generic ones, and of devices": """
          import rev
          import wpilib
          from commands2 import Subsystem
          from phoenix6 import hardware, swerve
          class Drive(Subsystem, swerve.SwerveDrivetrain[hardware.TalonFX, hardware.TalonFX, hardware.CANcoder]):
              def show(self):
                  state = self.get_state()
        -         print(state.pose.X(), state.speeds.vx)
        -         return self.runOnce(self.show)
        +         print(state.pose.x, state.velocity.vx)
        +         return self.run_once(self.show)
          class Motor(rev.SparkMax):
              def __init__(self, number):
        -         super().__init__(number, rev.SparkMax.MotorType.kBrushless)
        +         super().__init__(wpilib.CANPort.CAN_S0, number, rev.SparkMax.MotorType.BRUSHLESS)
    """,
    "trajectories": """
        - from wpimath.controller import RamseteController
        - from wpimath.geometry import Pose2d
        - from wpimath.trajectory import TrajectoryConfig, TrajectoryGenerator
        - path = TrajectoryGenerator.generateTrajectory(Pose2d(), [], Pose2d(3, 0, 0), TrajectoryConfig(1, 1))
        - there = path.sample(path.totalTime() / 2)
        - speeds = RamseteController(2.0, 0.7).calculate(Pose2d(), there)
        - print(there.pose.X(), there.velocity, path.initialPose().Y(), speeds.vx)
        + from wpimath import DrivetrainSplineTrajectoryGenerator, LTVUnicycleController, Pose2d, TrajectoryConfig
        + path = DrivetrainSplineTrajectoryGenerator.generate(Pose2d(), [], Pose2d(3, 0, 0), TrajectoryConfig(1, 1))
        + there = path.sample_at(path.duration() / 2)
        + speeds = LTVUnicycleController(0.02).calculate(Pose2d(), there)
        + print(there.pose.x, there.forward_velocity(), path.initial_pose().y, speeds.vx)
    """,
    "lists of lights that patterns are applied to": """
          import wpilib
          class Lights:
              LENGTH = 60
              def __init__(self):
                  self.strip = wpilib.AddressableLED(1)
        -         self.buffer = [wpilib.AddressableLED.LEDData() for _ in range(self.LENGTH)]
        -         self.other = [self.strip.LEDData()] * 5
        -         self.strip.setData(self.buffer)
        +         self.buffer = wpilib.AddressableLEDBuffer(self.LENGTH)
        +         self.other = wpilib.AddressableLEDBuffer(5)
        +         self.strip.set_data(self.buffer)
              def show(self):
        -         wpilib.LEDPattern.rainbow(255, 128).applyTo(self.buffer)
        -         self.buffer[0].setRGB(1, 2, 3)
        +         wpilib.LEDPattern.rainbow(255, 128).apply_to(self.buffer)
        +         self.buffer[0].set_rgb(1, 2, 3)
    """,
    "a rumble of both sides in an expression": """
        - from wpilib.interfaces import GenericHID
        + from wpilib import GenericHID
          stick, Side = GenericHID(0), GenericHID.RumbleType
        - shake = lambda: stick.setRumble(Side.kBothRumble, 1)
        + shake = lambda: (stick.set_rumble(Side.LEFT_RUMBLE, 1), stick.set_rumble(Side.RIGHT_RUMBLE, 1))
    """,
    "buttons in hal_data": """
          from wpilib import XboxController
          def test_it(control, hal_data):
              stick = hal_data["joysticks"][0]
        -     stick["buttons"][1] = True
        -     hal_data["joysticks"][1]["buttons"][XboxController.Button.kA] = True
        +     stick["buttons"][0] = True
        +     hal_data["joysticks"][1]["buttons"][XboxController.Button.A] = True
              for each in range(1, 3):
        -         stick["buttons"][each] = False
        +         stick["buttons"][each - 1] = False
              mine = {"buttons": [1, 2]}
              mine["buttons"][1] = 3
    """,
    "modules that are one now": """
        - import wpimath.geometry
        - import wpimath.controller
        - from wpimath.kinematics import ChassisSpeeds
        - pose = wpimath.geometry.Pose2d()
        - pid = wpimath.controller.PIDController(Kp=1, Ki=0, Kd=0)
        - speeds = ChassisSpeeds(1, 0, 0)
        - turned = pose.rotation().rotateBy(wpimath.geometry.Rotation2d.fromDegrees(90))
        - far, get = pose.X() + (pose.translation().Y()), pose.X
        + import wpimath
        + from wpimath import ChassisVelocities
        + pose = wpimath.Pose2d()
        + pid = wpimath.PIDController(kp=1, ki=0, kd=0)
        + speeds = ChassisVelocities(1, 0, 0)
        + turned = pose.rotation().rotate_by(wpimath.Rotation2d.from_degrees(90))
        + far, get = pose.x + (pose.translation().y), (lambda: pose.x)
    """,
    "imports below comments stay where they are": """
          import wpilib
        - from wpimath.geometry import Pose2d
        + from wpimath import Pose2d
          # for the arm
        - from wpimath.controller import PIDController
        + from wpimath import PIDController
          # for the sensors
          import wpilib
          print(wpilib, Pose2d(), PIDController)
    """,
    "aliases": """
        - import wpilib as w, wpimath.geometry as geo
        - from wpilib.drive import DifferentialDrive as DD
        - drive = DD(w.Spark(0), w.Spark(1))
        - drive.arcadeDrive(0, 0)
        - angle = geo.Rotation2d.fromDegrees(3)
        + import wpilib as w, wpimath as geo
        + import wpilib_drivers
        + from wpilib import DifferentialDrive as DD
        + drive = DD(wpilib_drivers.Spark(0), wpilib_drivers.Spark(1))
        + drive.arcade_drive(0, 0)
        + angle = geo.Rotation2d.from_degrees(3)
    """,
    "everything from a module": """
          from wpilib import *
        - from wpimath.geometry import *
        + from wpilib_drivers import PWMSparkMax
        + from wpimath import Pose2d, Transform2d
          motor = PWMSparkMax(0)
        - stick = PS4Controller(1)
        - pose = Pose2d().transformBy(Transform2d())
        + stick = DualShock4Controller(1)
        + pose = Pose2d().transform_by(Transform2d())
    """,
    "imports in branches": """
          from typing import TYPE_CHECKING
          if TYPE_CHECKING:
              from wpilib import Encoder
        -     from wpimath.geometry import Pose2d
        +     from wpimath import Pose2d

          def far(encoder: "Encoder", poses: "list[Pose2d]") -> float:
        -     return encoder.getDistance() + poses[0].x
        +     return encoder.get_distance() + poses[0].x
    """,
    "motors": """
          import wpilib
        - from wpilib.interfaces import MotorController
        + from wpilib import MotorController

          def run(motors: list[MotorController], led: wpilib.DigitalOutput):
              for motor in motors:
        -         motor.set(0.5)
        -         print(f"{motor.get():.2f} {motors[0].getInverted()}")
        +         motor.set_throttle(0.5)
        +         print(f"{motor.get_throttle():.2f} {motors[0].get_inverted()}")
              led.set(True)
        -     [m.stopMotor() for m in motors]
        +     [m.disable() for m in motors]
    """,
    "the driver station": """
        - from wpilib import DriverStation
        + from wpilib import Alliance, MatchState, RobotState
          import wpilib
        - if DriverStation.isEnabled() and wpilib.DriverStation.getAlliance() == DriverStation.Alliance.kRed:
        -     data = DriverStation.getGameSpecificMessage()[:1]
        + if RobotState.is_enabled() and wpilib.MatchState.get_alliance() == Alliance.RED:
        +     data = (MatchState.get_game_data() or '')[:1]
    """,
    "times": """
          import wpilib
        - start = wpilib.RobotController.getFPGATime()
        - late = 1e6 / wpilib.RobotController.getFPGATime()
        - now = wpilib.Timer.getFPGATimestamp()
        + start = (wpilib.RobotController.get_monotonic_time() // 1000)
        + late = 1e6 / (wpilib.RobotController.get_monotonic_time() // 1000)
        + now = wpilib.Timer.get_monotonic_timestamp()
    """,
    "buttons count from 0": """
          import wpilib
          from commands2.button import CommandXboxController, JoystickButton
          stick = wpilib.Joystick(0)
          driver = CommandXboxController(1)
          FIRE = 3
        - if stick.getRawButton(1) or stick.getRawButtonPressed(FIRE):
        + if stick.get_raw_button(0) or stick.get_raw_button_pressed(FIRE - 1):
              pass
        - JoystickButton(stick, 2).onTrue(None)
        - driver.button(4).onTrue(None)
        + JoystickButton(stick.get_hid(), 1).on_true(None)
        + driver.get_hid().button(3).on_true(None)
    """,
    "directions of a POV": """
          import wpilib
          stick = wpilib.Joystick(0)
        - if stick.getPOV() == 90:
        + if stick.get_pov() == wpilib.POVDirection.RIGHT:
              pass
        - free = stick.getPOV(0) in (180, -1)
        + free = stick.get_pov(0) in (wpilib.POVDirection.DOWN, wpilib.POVDirection.CENTER)
    """,
    "dashboards": """
          import wpilib
        + import ntcore
        + import telemetry
        + import tunables

          class Auto:
              def __init__(self):
        -         self.chooser = wpilib.SendableChooser()
        -         self.chooser.setDefaultOption("none", None)
        -         self.chooser.addOption("one", 1)
        -         wpilib.SmartDashboard.putData("Auto", self.chooser)
        -         wpilib.SmartDashboard.putNumber("gain", 1)
        -         wpilib.SmartDashboard.putBoolean("ready", True)
        +         self.chooser = tunables.Selectable()
        +         self.chooser.add_default("none", None)
        +         self.chooser.add("one", 1)
        +         tunables.publish("Auto", self.chooser)
        +         ntcore.NetworkTableInstance.get_default().get_table("SmartDashboard").put_number("gain", 1)
        +         telemetry.log("ready", True)

              def get(self):
        -         gain = wpilib.SmartDashboard.getNumber("gain", 0)
        -         return self.chooser.getSelected()
        +         gain = ntcore.NetworkTableInstance.get_default().get_table("SmartDashboard").get_number("gain", 0)
        +         return self.chooser.get_selected()
    """,
    "simulation": """
          import wpilib
        + import wpilib_drivers
          from magicbot import MagicRobot

          class MyRobot(MagicRobot):
        -     def createObjects(self):
        -         self.motor = wpilib.Talon(0)
        +     def create_objects(self):
        +         self.motor = wpilib_drivers.Talon(0)

        -     def _simulationPeriodic(self):
        +     def simulation_periodic(self):
                  pass
    """,
    "a constructor that there is": """
          import wpilib

          class MyRobot(wpilib.TimedRobot):
              def __init__(self):
                  super().__init__(0.01)
        +         self.robot_init()

        -     def robotInit(self):
        +     def robot_init(self):
                  self.timer = wpilib.Timer()
    """,
    "commands": """
          import commands2
          import commands2.cmd

          class Lift(commands2.Subsystem):
              def up(self) -> commands2.Command:
        -         return self.runOnce(self.raiseIt).andThen(commands2.cmd.waitSeconds(1)).withName("up")
        +         return self.run_once(self.raiseIt).and_then(commands2.cmd.wait_seconds(1)).with_name("up")

              def raiseIt(self):
        -         self.getCurrentCommand()
        +         self.get_current_command()

          class Wait(commands2.Command):
              def __init__(self, lift: Lift):
                  super().__init__()
        -         self.addRequirements(lift)
        +         self.add_requirements(lift)

        -     def isFinished(self):
        +     def is_finished(self):
                  return True

        - Wait(Lift()).isFinished()
        - commands2.CommandScheduler.getInstance().run()
        + Wait(Lift()).is_finished()
        + commands2.CommandScheduler.get_instance().run()
    """,
    "arguments that are gone": """
        - from wpimath.estimator import DifferentialDrivePoseEstimator
        - from wpimath.geometry import Pose2d, Rotation2d
        - from wpimath.kinematics import DifferentialDriveKinematics
        + from wpimath import DifferentialDriveKinematics, DifferentialDrivePoseEstimator, Pose2d, Rotation2d
          kinematics = DifferentialDriveKinematics(0.5)
        - estimator = DifferentialDrivePoseEstimator(kinematics, Rotation2d(), 0, 0, Pose2d())
        + estimator = DifferentialDrivePoseEstimator(Rotation2d(), 0, 0, Pose2d())
    """,
    "choosers in tests": """
        - from wpilib.simulation import SendableChooserSim, XboxControllerSim
        + from ntcore.util import SelectableControl
        + from wpilib.simulation import XboxControllerSim

          def test_it(control):
        -     SendableChooserSim("/SmartDashboard/Auto Mode/").setSelected("Stay")
        +     SelectableControl("Auto Mode").set_selected("Stay")
    """,
    "an Xbox controller by numbers": """
          import wpilib
          driver, stick = wpilib.XboxController(0), wpilib.Joystick(1)
        - turn = driver.getRawAxis(4) + stick.getRawAxis(4)
        - fire = driver.getRawButton(6) or stick.getRawButton(6)
        + turn = driver.get_hid().get_raw_axis(2) + stick.get_raw_axis(4)
        + fire = driver.get_hid().get_raw_button(10) or stick.get_raw_button(5)
    """,
    "a PlayStation controller by numbers": """
        - from wpilib import PS4Controller
        - pad = PS4Controller(0)
        - turn, fire = pad.getRawAxis(5), pad.getRawButton(1)
        + from wpilib import DualShock4Controller
        + pad = DualShock4Controller(0)
        + turn, fire = pad.get_hid().get_raw_axis(3), pad.get_hid().get_raw_button(2)
          def test_it(hal_data):
        -     hal_data["joysticks"][0]["axes"][5] = hal_data["joysticks"][0]["buttons"][2] = 1
        +     hal_data["joysticks"][0]["axes"][3] = hal_data["joysticks"][0]["buttons"][0] = 1
    """,
    "an Xbox controller in hal_data": """
          import wpilib
          DRIVER = 0
        - X, Y = wpilib.XboxController.Button.kX, wpilib.XboxController.Button.kY
        + X, Y = wpilib.XboxController.Button.X, wpilib.XboxController.Button.Y
          A = 1
          B = 2
          driver, stick = wpilib.XboxController(DRIVER), wpilib.Joystick(1)
          def test_it(control, hal_data):
              gamepad = hal_data["joysticks"][0]
        -     gamepad["axes"][4] = hal_data["joysticks"][DRIVER]["axes"][1] = 0.5
        -     gamepad["buttons"][5] = hal_data["joysticks"][0]["buttons"][1] = True
        -     hal_data["joysticks"][1]["buttons"][5] = True
        +     gamepad["axes"][2] = hal_data["joysticks"][DRIVER]["axes"][1] = 0.5
        +     gamepad["buttons"][9] = hal_data["joysticks"][0]["buttons"][0] = True
        +     hal_data["joysticks"][1]["buttons"][4] = True
              buttons = hal_data["joysticks"][0]["buttons"]
        -     buttons[5] = buttons[B] = buttons[X] = hal_data["joysticks"][0]["buttons"][A] = True
        +     buttons[9] = buttons[B - 1] = buttons[X] = hal_data["joysticks"][0]["buttons"][A - 1] = True
    """,
    "the deadband that sticks have": """
          from wpilib import Joystick, XboxController
        - from wpimath import applyDeadband

          class Driver:
              def __init__(self):
                  self.pad = XboxController(0)

              def forward(self):
        -         return -applyDeadband(self.pad.getLeftY(), 0.1) * 4
        +         return -self.pad.get_left_y() * 4
    """,
    "deadbands of another size": """
          from wpilib import Joystick, XboxController
        - from wpimath import applyDeadband
        - forward = applyDeadband(Joystick(1).getY(), 0.1) + applyDeadband(XboxController(0).getLeftX(), 0.2)
        + from wpimath import apply_deadband
        + forward = apply_deadband(Joystick(1).get_y(), 0.1) + apply_deadband(XboxController(0).get_left_x(), 0.2)
    """,
    "controllers on the dashboard": """
          import wpilib
        - from wpimath.controller import PIDController
        + import tunables
        + from wpimath import PIDController

          class Own(PIDController):
              pass

        - wpilib.SmartDashboard.putData("turn", PIDController(1, 0, 0))
        - wpilib.SmartDashboard.putData("lift", Own(1, 0, 0))
        + tunables.publish("turn", PIDController(1, 0, 0))
        + tunables.publish("lift", Own(1, 0, 0))
    """,
    "what dashboards show again and again": """
          import wpilib
        + import telemetry
          from commands2 import Subsystem
        - from wpilib import SmartDashboard

          class MyRobot(wpilib.TimedRobot):
        -     def robotInit(self):
        +     def __init__(self):
        +         super().__init__()
                  self.field = wpilib.Field2d()
        -         # The field.
        -         SmartDashboard.putData(self.field)
                  self.picture = wpilib.Mechanism2d(1, 1)
        -         wpilib.SmartDashboard.putData("picture", self.picture)
                  self.timer = wpilib.Timer()

        -     def robotPeriodic(self):
        -         pass
        +     def robot_periodic(self):
        +         # The field.
        +         telemetry.log("Field", self.field)
        +         telemetry.log("picture", self.picture)

          class Arm(Subsystem):
              def __init__(self):
                  super().__init__()
                  self.encoder = wpilib.Encoder(0, 1)
        -         SmartDashboard.putData("arm", self.encoder)

              def periodic(self):
        -         self.encoder.getRate()
        +         self.encoder.get_rate()
        +         telemetry.log("arm", self.encoder)
    """,
    "what cannot be shown again and again": """
          import wpilib
        + import telemetry

          class MyRobot(wpilib.TimedRobot):
        -     def robotInit(self):
        +     def __init__(self):
        +         super().__init__()
                  self.field = wpilib.Field2d()
        -         wpilib.SmartDashboard.putData("field", self.field)
        +         telemetry.log("field", self.field)

        -     def robotPeriodic(self):
        -         if self.isDisabled():
        +     def robot_periodic(self):
        +         if self.is_disabled():
                      return

          class Arm(wpilib.TimedRobot):
              def __init__(self):
                  super().__init__()
                  encoder = wpilib.Encoder(0, 1)
        -         wpilib.SmartDashboard.putData("arm", encoder)
        +         telemetry.log("arm", encoder)

        -     def robotPeriodic(self):
        +     def robot_periodic(self):
                  pass
    """,
    "gyros that physics turns": """
          from pyfrc.physics.core import PhysicsInterface

          class PhysicsEngine:
              def __init__(self, physics_controller: PhysicsInterface, robot):
        -         physics_controller.add_device_gyro_channel("adxrs450_spi_0_angle")
                  physics_controller.add_device_gyro_channel("navX-Sensor[4]_Yaw")
    """,
    "dictionaries": """
          import wpilib
        - motors = {"left": wpilib.Talon(0)}
        - alerts = {name: wpilib.Alert(name, wpilib.Alert.AlertType.kInfo) for name in motors}
        + import wpilib_drivers
        + import wpiutil
        + motors = {"left": wpilib_drivers.Talon(0)}
        + alerts = {name: wpiutil.Alert(name, name, wpiutil.Alert.Level.LOW) for name in motors}
          for name, motor in motors.items():
        -     motor.set(len(name))
        +     motor.set_throttle(len(name))
              alerts[name].set(True)
    """,
    "swerve": """
        - from wpimath.geometry import Rotation2d
        - from wpimath.kinematics import ChassisSpeeds, SwerveModuleState
        + from wpimath import ChassisVelocities, Rotation2d, SwerveModuleVelocity

        - def turn(state: SwerveModuleState, angle: Rotation2d):
        -     state.optimize(angle)
        -     return state.speed
        + def turn(state: SwerveModuleVelocity, angle: Rotation2d):
        +     state = state.optimize(angle)
        +     return state.velocity

        - speeds = ChassisSpeeds.fromFieldRelativeSpeeds(1, 0, 0, Rotation2d())
        + speeds = ChassisVelocities(1, 0, 0).to_robot_relative(Rotation2d())
    """,
    "devices on a CAN bus": """
          import wpilib
          import rev
        - pdp = wpilib.PowerDistribution()
        - spark = rev.SparkMax(3, rev.SparkMax.MotorType.kBrushless)
        - encoder = spark.getEncoder()
        - angle, later = encoder.getPosition() * 360, encoder.getVelocity
        + pdp = wpilib.PowerDistribution(wpilib.CANPort.CAN_S0)
        + spark = rev.SparkMax(wpilib.CANPort.CAN_S0, 3, rev.SparkMax.MotorType.BRUSHLESS)
        + encoder = spark.get_encoder()
        + angle, later = encoder.get_position().get() * 360, (lambda: encoder.get_velocity().get())
    """,
    "members named in strings": """
          import wpilib
          encoder = wpilib.Encoder(0, 1)
        - distance = getattr(encoder, "getDistance")()
        + distance = getattr(encoder, "get_distance")()
    """,
    "servos": """
          import wpilib
        - hood = wpilib.Servo(1)
        - hood.set(0.5)
        - hood.setAngle(90)
        + hood = wpilib.PWM(1)
        + hood.set_pulse_time(int(600 + 1800 * 0.5))
        + hood.set_pulse_time(int(600 + 10 * 90))
    """,
    "rumble on both sides": """
          import wpilib
          stick = wpilib.XboxController(0)
          if True:
        -     stick.setRumble(wpilib.XboxController.RumbleType.kBothRumble, 0.5)
        +     stick.set_rumble(wpilib.GenericHID.RumbleType.LEFT_RUMBLE, 0.5)
        +     stick.set_rumble(wpilib.GenericHID.RumbleType.RIGHT_RUMBLE, 0.5)
    """,
}


@pytest.mark.parametrize("name", CODE)
def test_code(tmp_path: Path, name: str) -> None:
    lines = dedent(CODE[name]).strip("\n").splitlines()
    before, after = ("".join(f"{line[2:]}\n" for line in lines if line[:1] != sign) for sign in "+-")
    assert migrated(tmp_path, robot=before)["robot"] == after


#: Code that stays as it is.
OWN = {
    "lists of lights without a pattern": """
        import wpilib
        buffer = [wpilib.AddressableLED.LEDData() for _ in range(9)]
        buffer[3] = wpilib.AddressableLED.LEDData(1, 2, 3)
    """,
    "a method with WPILib's name": """
        class Drive:
            def getRate(self):
                return 1

            def set(self, speed):
                self.speed = speed

        drive = Drive()
        drive.set(drive.getRate())
    """,
    "a dictionary and a list": """
        settings = {"isFinished": True}
        settings.get("isFinished")
        names = ["getRate"]
        names.sort()
    """,
    "another library": """
        import threading
        threading.Thread(target=print).isAlive
        threading.currentThread().getName()
    """,
    "a function and variables": """
        def getInstance(arcadeDrive):
            teleopPeriodic = arcadeDrive
            return teleopPeriodic
        kRed = getInstance(arcadeDrive=1)
    """,
    "what can be either": """
        import wpilib

        class Mine:
            def set(self, on):
                pass

        def switch(which: "Mine | wpilib.DigitalOutput"):
            which.set(True)
    """,
    "imports of one module": """
        from math import cos
        from math import sin
        import wpilib
    """,
    "an object that is not known": """
        def read(sensor):
            return sensor.getRate()
    """,
}


@for_each("name", OWN)
def test_what_is_the_teams_own_stays(tmp_path: Path, name: str) -> None:
    code = dedent(OWN[name]).lstrip("\n")
    assert migrated(tmp_path, own=code)["own"] == code


def test_types_are_followed_through_files(tmp_path: Path) -> None:
    """A return, a parameter that calls pass, an attribute, magicbot's injection, a fixture, a class in between."""
    after = migrated(
        tmp_path,
        parts="""
            import wpilib


            def made():
                return wpilib.Encoder(0, 1)


            class Base(wpilib.TimedRobot):
                def autonomousPeriodic(self):
                    pass
        """,
        components__arm="""
            from wpilib import Encoder


            class Arm:
                encoder: Encoder
                speed = 3

                def angle(self):
                    return self.encoder.getDistance()
        """,
        robot="""
            from components.arm import Arm
            from parts import Base, made


            class MyRobot(Base):
                arm: Arm

                def teleopPeriodic(self):
                    super().autonomousPeriodic()
                    self.show(made())
                    self.arm.encoder.reset()

                def show(self, encoder):
                    print(encoder.getRate(), self.arm.encoder.getRate())
        """,
        tests__arm_test="""
            import pytest
            from wpilib.simulation import XboxControllerSim


            @pytest.fixture
            def driver():
                return XboxControllerSim(0)


            def test_it(driver, robot):
                driver.setLeftY(-1)
                robot.teleopPeriodic()
                assert robot.arm.encoder.getDistance() == 0
        """,
    )
    assert "def autonomous_periodic(self)" in after["parts"]
    assert "self.encoder.get_distance()" in after["components__arm"]
    assert "super().autonomous_periodic()" in after["robot"]
    assert "encoder.get_rate(), self.arm.encoder.get_rate()" in after["robot"]
    assert "driver.set_left_y(-1)" in after["tests__arm_test"]
    assert "robot.teleop_periodic()" in after["tests__arm_test"]
    assert "robot.arm.encoder.get_distance()" in after["tests__arm_test"]


#: Code with one line that a person has to change, which ends in `# here`, and what is said there.
BY_HAND = {
    "one of several": (
        "import wpilib\nthings = [wpilib.Talon(0), wpilib.DigitalOutput(1)]\nthings[0].set(1)  # here\n",
        "set can be several things here",
    ),
    "other arguments": (
        "from wpimath.trajectory import TrapezoidProfile\n"
        "profile = TrapezoidProfile(TrapezoidProfile.Constraints(1, 1))\n"
        "left = profile.timeLeftUntil(3)  # here\n",
        "takes other arguments",
    ),
    "a list of lights": (
        "import wpilib\nlights = [wpilib.AddressableLED.LEDData(number, 0, 0) for number in range(9)]\n"
        "wpilib.LEDPattern.rainbow(255, 128).applyTo(lights)  # here\n",
        "AddressableLEDBuffer",
    ),
    "hardware": ("import wpilib\nlight = wpilib.Relay(1)  # here\n", "wpilib.Relay is gone."),
    "an import": ("from wpilib import Relay  # here\nlight = Relay(1)\n", "wpilib.Relay is gone."),
    "a module": (
        "from wpilib.shuffleboard import Shuffleboard  # here\nShuffleboard.update()\n",
        "Shuffleboard is gone",
    ),
    "a member": ("import wpilib\nprint(wpilib.Encoder(0, 1).getPeriod())  # here\n", "use get_rate"),
    "a vendor": ("import pathplannerlib.auto  # here\n", "has no release for 2027"),
    "a channel": ("import wpilib\nPORT = 9\nled = wpilib.AddressableLED(PORT)  # here\n", "channels 0 to 5"),
    "one port for a strip and a switch": (
        "import wpilib\nswitch = wpilib.DigitalInput(2)\nled = wpilib.AddressableLED(2)  # here\n",
        "as the DigitalInput in robot.py:2",
    ),
    "the bus of a CTRE device": (
        "from phoenix6.hardware import TalonFX\ndef made(bus):\n    return TalonFX(1, bus)  # here\n",
        "takes a phoenix6.CANBus, not its name",
    ),
    "a button that is an axis": (
        "import wpilib\nfast = wpilib.PS4Controller(0).getRawButton(7)  # here\n",
        "other numbers",
    ),
    "a POV's angle": ("import wpilib\nangle = wpilib.Joystick(0).getPOV()  # here\n", "not an angle"),
    "a button of an Xbox controller": (
        "import wpilib\nBUMPER = 5\nheld = wpilib.XboxController(0).getRawButton(BUMPER)  # here\n",
        "Button 5 of an Xbox controller is 9 now.",
    ),
    "the same in hal_data": (
        "import wpilib\npad = wpilib.XboxController(0)\nBUMPER = 5\n"
        'def test_it(hal_data):\n    hal_data["joysticks"][0]["buttons"][BUMPER] = True  # here\n',
        "Button 5 of an Xbox controller is 9 now.",
    ),
    "a key of hal_data": (
        'def test_it(hal_data):\n    assert hal_data["analog_gyro"][0]["angle"] == 0  # here\n',
        'Use hal_data["onboard_imu"]["yaw"]',
    ),
    "an unknown object": ("def f(sensor):\n    return sensor.getRate()  # here\n", "write get_rate"),
    "a path in a string": ('patched = "wpilib.DriverStation.isEnabled"  # here\n', "names something of WPILib 2026"),
    "a new method": (
        "import wpilib\nclass R(wpilib.TimedRobot):\n    def simulation_periodic(self):  # here\n        pass\n",
        "overrides a method of WPILib 2027",
    ),
    "a button of a gamepad that is not written there": (
        "import wpilib\npad = wpilib.XboxController(0)\nfor each in range(1, 9):\n    pad.getRawButton(each)  # here\n",
        "Write {1: 0, 2: 1, 3: 2, 4: 3, 5: 9, 6: 10, 7: 4, 8: 6, 9: 7, 10: 8}[each] for each",
    ),
    "a package outside the project": (
        "from teamlib import TeamRobot\nclass Robot(TeamRobot):\n    def teleopPeriodic(self):  # here\n        pass\n",
        "TeamRobot of teamlib is outside this project and not known, so these names stay: teleopPeriodic.",
    ),
    "a name that is looked up": (
        "from operator import methodcaller\nrate = methodcaller('getRate')  # here\n",
        "methodcaller names getRate.",
    ),
    "an object of a class that WPILib 2026 has not": (
        "import wpilib\nmotor = wpilib.Jaguar(0)\nprint(motor.getChannel())  # here\n",
        "What motor is (robot.py:2) is not known, so these names stay: getChannel.",
    ),
    "an import of what WPILib 2026 has not there": (
        "from wpimath.system import LinearSystemId as made\nit = made.identifyDrivetrainSystem(1, 2, 3, 4)  # here\n",
        "so these names stay: identifyDrivetrainSystem.",
    ),
    "an enumeration that is elsewhere since 2026": (
        "import rev\nmode = rev.SparkMax.PersistMode.kPersistParameters  # here\n",
        "Write rev.PersistMode.PERSIST_PARAMETERS.",
    ),
    "what a callable returns, of unknown type": (
        "class A:\n    def __init__(self, do):\n        self.do = do\n    def go(self):\n"
        "        self.do().getRate()  # here\n",
        "What do is, a parameter of A.__init__ (robot.py:2), is not known",
    ),
    "a motor of unknown type": (
        "def stop(motor):\n    motor.set(0)  # here\n",
        "or write set_throttle if it is a motor.",
    ),
    "a part of an object of unknown type, whose names say nothing of the object": (
        "class Container:\n    def __init__(self, timer):\n        self.timer = timer\nclass A:\n"
        "    def __init__(self, container):\n        self.container = container\n    def go(self):\n"
        "        return self.container.timer.get()  # here\n",
        "container: Container. It could also be",
    ),
    "an object that can be of three types": (
        "def go(sensor):\n    return sensor.getRate() + sensor.getDistance()  # here\n",
        "sensor: wpilib.Encoder. It could also be wpilib.simulation.EncoderSim or wpilib.Counter.",
    ),
    "a constructor that calls before the rest of another": (
        "import wpilib\nclass Base(wpilib.TimedRobot):\n    def __init__(self):\n        super().__init__()\n"
        "    def robotInit(self):\n        pass\nclass Robot(Base):\n    def __init__(self):\n"
        "        super().__init__()\n    def robotInit(self):  # here\n        pass\n",
        "robotInit is called robot_init now, by the constructor of Base",
    ),
    "a Sendable": (
        "import wpiutil\nclass A(wpiutil.Sendable):  # here\n    pass\n",
        "write log_to(self, table)",
    ),
}


@for_each("name", BY_HAND)
def test_what_is_to_do_by_hand_is_said_at_its_line(tmp_path: Path, name: str) -> None:
    code, said = BY_HAND[name]
    here = next(number for number, line in enumerate(code.splitlines(), 1) if line.endswith("# here"))
    found = [each for each in remarks(tmp_path, code) if said in str(each) and not each.done]
    assert here in [place.line for each in found for place in each.places]


#: Code with one line that runs, but means something else, which ends in `# here`, and what is said there.
TO_CHECK = {
    "analog inputs": (
        "import wpilib\nsensor = wpilib.AnalogInput(0)\nangle = sensor.getVoltage() / 5 * 360  # here\n",
        "0 to 3.3 V; the roboRIO's measured 0 to 5 V",
    ),
    "a simulated analog input": (
        "from wpilib.simulation import AnalogInputSim\nAnalogInputSim(0).setVoltage(2.5)  # here\n",
        "takes 3.3 V for its whole range",
    ),
    "a class that is imported": (
        "from wpilib import AnalogPotentiometer\npot = AnalogPotentiometer(0, 270)  # here\n",
        "takes 3.3 V for its whole range",
    ),
    "one port for a motor and a sensor": (
        "import wpilib\nmotor = wpilib.PWMSparkMax(0)\nencoder = wpilib.Encoder(1, 0)  # here\n",
        "Encoder has channel 0, as the PWMSparkMax in robot.py:2. SystemCore's ports 0 to 5 are for PWM, digital, "
        "analog and LEDs together. Give each its own; free: 2, 3, 4, 5.",
    ),
    "an import of what is gone, which nothing uses": (
        "from wpilib import DigitalInput, SmartDashboard  # here\nswitch = DigitalInput(0)\n",
        "SmartDashboard is gone, and its import, which is not used, is removed.",
    ),
    "a port that there is not": ("import wpilib\nswitch = wpilib.DigitalInput(9)  # here\n", "has channel 9."),
}


@for_each("name", TO_CHECK)
def test_another_meaning_is_said_at_its_line(tmp_path: Path, name: str) -> None:
    code, said = TO_CHECK[name]
    here = next(number for number, line in enumerate(code.splitlines(), 1) if line.endswith("# here"))
    found = [each for each in remarks(tmp_path, code) if said in str(each) and each.done]
    assert [place.line for each in found for place in each.places] == [here]


def test_ports_that_do_not_suffice_are_counted(tmp_path: Path) -> None:
    """Three devices share ports with others, and one port is free."""
    sensors = ["wpilib.Encoder(0, 1)", "wpilib.Encoder(2, 3)", "wpilib.DigitalInput(4)"]
    devices = [*(f"wpilib.PWMSparkMax({port})" for port in range(3)), *sensors]
    code = "\n".join(["import wpilib", *devices, ""])
    assert [each.remedy for each in remarks(tmp_path, code)] == [
        "SystemCore's ports 0 to 5 are for PWM, digital, analog and LEDs together, but this project needs 8. Replace "
        "some by CAN devices, such as a motor controller with an encoder; motors and servos can also be on an "
        "ExpansionHub."
    ] * 3


def test_a_form_feed_before_the_first_indentation(tmp_path: Path) -> None:
    robot = "import wpilib\nclass Robot(wpilib.TimedRobot):\n    def robotInit(self): pass\n"
    after = migrated(tmp_path, robot="\fdef page():\n\f    return 1\n" + robot)["robot"]
    assert "    def __init__(self):\n        super().__init__()\n" in after


def test_a_module_with_the_name_of_a_new_one_is_reported(tmp_path: Path) -> None:
    """CTRE's generated projects have a telemetry.py."""
    (tmp_path / "telemetry.py").write_text("class Telemetry:\n    pass\n", "utf-8")
    (remark,) = remarks(tmp_path, "from telemetry import Telemetry\nlog = Telemetry()\n")
    assert (remark.places[0].file, remark.done) == ("telemetry.py", False)
    assert "WPILib 2027 has a module telemetry, too" in str(remark)


#: Code in which the type of an object is not known, and the same with the hint that the report asks for.
HINTS = {
    "a parameter": ("def go(sensor):\n    HERE\n", "sensor.getRate(); sensor.getDistance()", "sensor: wpilib.Encoder"),
    "an attribute": (
        "class A:\n    pass\ndef go(a: A):\n    HERE\n",
        "a.sensor.getRate(); a.sensor.getDistance()",
        "class A: sensor: wpilib.Encoder",
    ),
    "a variable": (
        "import copy\nsensor = copy.copy(things())\ndef go():\n    HERE\n",
        "sensor.getRate(); sensor.getDistance()",
        "sensor: wpilib.Encoder",
    ),
    "a result": (
        "def made():\n    return copy(things)\nfrom copy import copy\nsensor = made()\ndef go():\n    HERE\n",
        "sensor.getRate(); sensor.getDistance()",
        "sensor: wpilib.Encoder",
    ),
    "a class of a package": (
        "from teamlib import Sensor\nsensor = Sensor()\ndef go():\n    HERE\n",
        "sensor.getRate(); sensor.getDistance()",
        "if TYPE_CHECKING: from wpilib import Encoder as Sensor\nelse: from teamlib import Sensor\n",
    ),
}


@for_each("name", HINTS)
def test_a_type_hint_where_the_report_asks_for_it_makes_its_lines_go(tmp_path: Path, name: str) -> None:
    frame, uses, hint = HINTS[name]
    code = "import wpilib\nfrom typing import TYPE_CHECKING\n" + frame.replace("HERE", uses.replace("; ", "\n    "))
    (remark,) = remarks(tmp_path, code)
    assert len(remark.places) == 2
    assert hint in str(remark).replace("into class A: ", "class A: ")
    hints = {
        "a parameter": ("go(sensor)", "go(sensor: wpilib.Encoder)"),
        "an attribute": ("    pass", "    sensor: wpilib.Encoder"),
        "a class of a package": ("from teamlib import Sensor\n", hint),
    }
    old, new = hints.get(name, ("sensor =", "sensor: wpilib.Encoder ="))
    assert old in code
    assert remarks(tmp_path, code.replace(old, new)) == []
