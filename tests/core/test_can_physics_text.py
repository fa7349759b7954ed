"""What `pyfrc create-physics` writes for motors on vendors' controllers, without a vendor's library."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.physics.create import can_devices
from pyfrc_core.physics.create.can_devices import CanDevices, CanMotor, known_gearing
from pyfrc_core.physics.create.can_text import add_mechanism, add_swerve, wheel_motors, wheel_numbers
from pyfrc_core.physics.create.drivetrain import DrivetrainLayout, MotorGroup, Tank
from pyfrc_core.physics.create.module_text import ModuleText
from pyfrc_core.physics.create.motors import Motor
from pyfrc_core.physics.create.names import DeviceName
from pyfrc_core.physics.create.physics_file import physics_text
from pyfrc_core.physics.create.survey import Encoder, Survey
from pyfrc_core.physics.create.swerve_modules import WheelModule


def motor(name: str, factor: float = 1.0, vendor: str = "Spark", count: int = 1, cancoder: str = "") -> CanMotor:
    live: Any = None
    return CanMotor(
        DeviceName(tuple(name.split("."))),
        None,
        "SPARK MAX [1]",
        vendor=vendor,
        expression=f"robot.{name}",
        model="NEO",
        count=count,
        factor=factor,
        cancoder=cancoder,
        live=live,
    )


def test_a_gearing_is_known_from_a_conversion_factor() -> None:
    units = math.tau, 360.0, 1.0
    assert known_gearing(motor("a", 1 / 25), 1, 500, *units) == pytest.approx(25)
    assert known_gearing(motor("a", 360 / 12.5), 1, 500, *units) == pytest.approx(12.5)
    assert [known_gearing(motor("a", factor), 1, 500, *units) for factor in (1.0, 0.0, -2.0, 1e6)] == [None] * 4
    odd = motor("a", 1 / 12.3456)
    assert known_gearing(odd, 1, 500, 1.0) == pytest.approx(12.3456)
    assert known_gearing(odd, 1, 500, 1.0, only_round=True) is None
    assert known_gearing(motor("a", 1 / 25), 1, 25, 1.0) == known_gearing(motor("a", 1 / 25), 25, 30, 1.0) == 25
    assert known_gearing(motor("a", 1 / 25), 26, 30, 1.0) is None


def test_a_mechanism_has_a_motor_gears_and_ends() -> None:
    text = ModuleText()
    encoder = Encoder(DeviceName(("arm", "encoder")), 0, (2, 3), True)
    add_mechanism(text, motor("container.arm_motor", 1 / 25, count=2), encoder)
    add_mechanism(text, motor("shooter.wheel2", vendor="Talon", cancoder="robot.coder"), None)
    assert text.numbers[0] == (
        "\n# SPARK MAX [1] (container.arm_motor)\nARM_MOTOR = DCMotor.NEO(2)\n"
        "ARM_GEARING = 25  # turns of the motor for one turn of what it moves\n"
        "ARM_INERTIA = 0.25  # of what it moves, in kg m²\n"
        "ARM_LOW, ARM_HIGH = None, None  # its end stops, in turns from the start\n"
    )
    assert text.numbers[1].startswith("ARM_ENCODER_UNITS = 1.0  # what ")
    assert "SHOOTER_WHEEL2_GEARING = 1 " in text.numbers[2]
    assert "SHOOTER_WHEEL2_INERTIA = 0.002 " in text.numbers[2]
    assert text.setup[:8] == [
        "",
        "self.arm = Mechanism(",
        "    Spark(robot.container.arm_motor, ARM_MOTOR, ARM_GEARING),",
        "    ARM_INERTIA,",
        "    ARM_LOW,",
        "    ARM_HIGH,",
        ")",
        "self.arm_encoder = EncoderShaft(EncoderSim.createForChannel(2), ARM_ENCODER_UNITS)",
    ]
    assert "    Talon(robot.shooter.wheel2, SHOOTER_WHEEL2_MOTOR, SHOOTER_WHEEL2_GEARING, robot.coder)," in text.setup
    assert text.update == [
        "self.arm.update(tm_diff)",
        "self.arm_encoder.turn_to(self.arm.turns, self.arm.speed)",
        "",
        "self.shooter_wheel2.update(tm_diff)",
    ]
    assert (text.from_can_motors, text.needs_motors) == ({"Mechanism", "Spark", "Talon"}, True)


def test_a_swerve_drive_has_four_wheels() -> None:
    text = ModuleText()
    metres = math.pi * 0.1016 / 8.14
    modules = [
        WheelModule(motor(f"drive{n}", metres), motor(f"steer{n}", 360 / 12.8), 0.3, -0.25 * n, ahead=0.125 * n)
        for n in range(4)
    ]
    add_swerve(text, modules)
    (numbers,) = text.numbers
    assert "DRIVE_MOTOR = DCMotor.NEO(1)\nSTEER_MOTOR = DCMotor.NEO(1)\nDRIVE_GEARING = 8.14  # turns" in numbers
    assert "STEER_GEARING = 12.8\nWHEEL_DIAMETER = 0.1016  # metres\n" in numbers
    assert "DRIVE_INERTIA = MASS / 4 * (WHEEL_DIAMETER / 2) ** 2" in numbers
    assert text.setup[:4] == [
        "",
        "# `zero`: what a wheel's encoder measures when the wheel points ahead, in turns.",
        "self.drivetrain = SwerveDrive(",
        "    SwerveModule(",
    ]
    assert text.setup[4:15] == [
        "        Mechanism(",
        "            Spark(robot.drive0, DRIVE_MOTOR, DRIVE_GEARING),",
        "            DRIVE_INERTIA,",
        "        ),",
        "        Mechanism(",
        "            Spark(robot.steer0, STEER_MOTOR, STEER_GEARING, zero=0),",
        "            STEER_INERTIA,",
        "        ),",
        "        x=0.3,",
        "        y=-0,",
        "        wheel_diameter=WHEEL_DIAMETER,",
    ]
    assert "            Spark(robot.steer3, STEER_MOTOR, STEER_GEARING, zero=0.375)," in text.setup
    assert text.update == ["speeds = self.drivetrain.update(tm_diff)", "self.physics_controller.drive(speeds, tm_diff)"]
    assert text.from_can_motors == {"Mechanism", "Spark", "SwerveDrive", "SwerveModule"}
    unknown = ModuleText()
    add_swerve(unknown, [WheelModule(motor("drive"), motor("steer"), 0, 0)])
    assert "DRIVE_GEARING = 6.75 " in unknown.numbers[0]
    assert "STEER_GEARING = 21.43\n" in unknown.numbers[0]


def test_wheels_have_one_model_of_motor() -> None:
    text = ModuleText()
    plain = Motor(DeviceName(("left",)), 3)
    assert wheel_numbers([plain]) == ""
    assert "WHEEL_MOTOR = DCMotor.NEO(1)  # on each" in wheel_numbers([plain, motor("left")])
    assert wheel_motors(text, [plain], "left") == ("self.left.getSpeed()", [])
    assert wheel_motors(text, [motor("a"), motor("b")], "left") == ("self.left_2.output()", ["left_2", "left_3"])
    assert text.setup[-1] == "self.left_3 = Spark(robot.b, WHEEL_MOTOR, GEARING)"


def test_a_device_with_its_sensors_belongs_to_a_motor() -> None:
    devices = CanDevices([motor("a")], ["SPARK MAX [1]"])
    own = {"SPARK MAX [1]": True, "SPARK MAX [1] ABSOLUTE": True, "SPARK MAX [1]/x": True, "SPARK MAX [1]1": False}
    assert {name: devices.owns(name) for name in own} == own
    assert not devices.in_real_time
    assert CanDevices([motor("a", vendor="Talon")]).in_real_time


def test_the_simulated_devices_of_a_motor_controller(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(can_devices, "sparks", SimpleNamespace(device_of=lambda thing: f"SPARK MAX [{thing.number}]"))
    spark: Any = type("SparkMax", (), {"__module__": "rev", "number": 2})
    talon: Any = type("TalonFX", (), {"__module__": "phoenix6.hardware", "device_id": 3})
    assert can_devices._parts(spark()) == ["SPARK MAX [2]"]
    names = "CANMotor:Talon FX (v6)[3]", "CANEncoder:Talon FX (v6)[3]", "CANDIO:Talon FX (v6)[3]"
    assert can_devices._parts(talon()) == [*names]


def test_a_tank_drive_measures_all_its_motors_with_their_signs() -> None:
    tank = Tank(MotorGroup([motor("left"), motor("left2")], -1), MotorGroup([motor("right")], 1))
    text = physics_text(Survey(), DrivetrainLayout(tank))
    assert "TRACK_WIDTH = 22 * units.inch" in text
    assert "TRACK_WIDTH = 0.61 * units.metre" in physics_text(Survey(), DrivetrainLayout(tank, track_width=0.61))
    _, _, begin = text.partition("self.physics_controller = physics_controller\n\n")
    assert [line.strip() for line in begin.splitlines()] == [
        "# Of motors that are geared together, one is enough.",
        "self.left_motor = Spark(robot.left, WHEEL_MOTOR, GEARING)",
        "self.left_motor_2 = Spark(robot.left2, WHEEL_MOTOR, GEARING)  # left, left2",
        "self.right_motor = Spark(robot.right, WHEEL_MOTOR, GEARING)  # right",
        "",
        "self.drivetrain = drivetrains.TwoMotorDrivetrain(TRACK_WIDTH, TOP_SPEED)",
        "self.left_motor_turns = 0.0",
        "self.left_motor_2_turns = 0.0",
        "self.right_motor_turns = 0.0",
        "",
        "def update_sim(self, now: float, tm_diff: float) -> None:",
        '"""`now` is the robot time, `tm_diff` the time since the last call, in seconds."""',
        "# In the drivetrain, left motors are forward at 1 and right ones at -1; a minus adapts this robot's signs.",
        "speeds = self.drivetrain.calculate(",
        "-self.left_motor.output(),",
        "-self.right_motor.output(),",
        ")",
        "self.physics_controller.drive(speeds, tm_diff)",
        "",
        "wheels = self.drivetrain.wheelSpeeds  # in metres per second",
        "self.left_motor_turns += -wheels.left / WHEEL_CIRCUMFERENCE * tm_diff",
        "self.left_motor.measure(self.left_motor_turns, -wheels.left / WHEEL_CIRCUMFERENCE, tm_diff)",
        "self.left_motor_2_turns += -wheels.left / WHEEL_CIRCUMFERENCE * tm_diff",
        "self.left_motor_2.measure(self.left_motor_2_turns, -wheels.left / WHEEL_CIRCUMFERENCE, tm_diff)",
        "self.right_motor_turns += wheels.right / WHEEL_CIRCUMFERENCE * tm_diff",
        "self.right_motor.measure(self.right_motor_turns, wheels.right / WHEEL_CIRCUMFERENCE, tm_diff)",
    ]
