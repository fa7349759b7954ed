"""Write the parts of ``physics.py`` for vendors' motor controllers on the CAN bus."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from ...wpi import source
from .can_devices import CanMotor, known_gearing
from .module_text import ModuleText
from .motors import Motor
from .survey import Encoder
from .swerve_modules import WheelModule

#: Words in the names of motors that turn a flywheel or a roller, which have no gears.
_WITHOUT_GEARS = {"flywheel", "shooter", "launcher"}

#: The gearing of other mechanisms, and the inertia that makes a motor take about 0.1 s to its speed.
_GEARING, _INERTIA = 50.0, 2e-4
_FLYWHEEL_INERTIA = 0.002

_WHEEL_DIAMETER, _DRIVE_GEARING, _STEER_GEARING = 0.1016, 6.75, 21.43

_SWERVE_NUMBERS = """
# The swerve drive.
DRIVE_MOTOR = {drive}
STEER_MOTOR = {steer}
DRIVE_GEARING = {drive_gearing:.4g}  # turns of the motor for one turn of the wheel
STEER_GEARING = {steer_gearing:.4g}
WHEEL_DIAMETER = {diameter}  # metres
MASS = 50.0  # kg, with battery and bumpers
DRIVE_INERTIA = MASS / {wheels} * (WHEEL_DIAMETER / 2) ** 2  # each wheel moves its part of the robot
STEER_INERTIA = 0.01  # kg m²
"""

_MECHANISM_NUMBERS = """
# {motor}
{name}_MOTOR = {made}
{name}_GEARING = {gearing:.4g}  # turns of the motor for one turn of what it moves
{name}_INERTIA = {inertia:.3g}  # of what it moves, in kg m²
{name}_LOW, {name}_HIGH = None, None  # its end stops, in turns from the start
"""


def controller(text: ModuleText, motor: CanMotor, model: str, gearing: str, zero: str = "") -> str:
    """Return the expression that makes the motor's controller."""
    text.from_can_motors.add(motor.vendor)
    parts = [motor.expression, model, gearing, *([motor.cancoder] if motor.cancoder else [])]
    return f"{motor.vendor}({', '.join([*parts, *([f'zero={zero}'] if zero else [])])})"


def wheel_numbers(motors: Sequence[Motor]) -> str:
    """Return the numbers of a drivetrain that only motors on the CAN bus need."""
    first = next((motor for motor in motors if isinstance(motor, CanMotor)), None)
    if first is None:
        return ""
    return (
        "GEARING = 10.71  # turns of a motor for one turn of its wheel\n"
        f"WHEEL_MOTOR = {source.motor(first.model, 1)}  # on each motor controller\n"
        "WHEEL_CIRCUMFERENCE = 0.479  # metres\n"
    )


def wheel_motors(text: ModuleText, motors: Sequence[Motor], wanted: str) -> tuple[str, list[str]]:
    """Add the set-up of motors that are geared together.

    :returns: the expression for the output of the first, and the names of all controllers that have sensors
    """
    if not isinstance(motors[0], CanMotor):
        return text.motor(motors[0], wanted), []
    names = []
    text.needs_motors = True
    for motor in motors:
        if isinstance(motor, CanMotor):
            names.append(text.name(wanted))
            text.setup.append(f"self.{names[-1]} = {controller(text, motor, 'WHEEL_MOTOR', 'GEARING')}")
    return f"self.{names[0]}.output()", names


def add_swerve(text: ModuleText, modules: list[WheelModule]) -> None:
    """Add a swerve drive; `speeds` are those of the robot in the code that follows."""
    drive, steer = modules[0].drive, modules[0].steer
    units = (math.pi * _WHEEL_DIAMETER, math.pi * _WHEEL_DIAMETER / 0.0254, 1.0, math.tau, 360.0)
    text.numbers.append(
        _SWERVE_NUMBERS.format(
            drive=source.motor(drive.model, drive.count),
            steer=source.motor(steer.model, steer.count),
            drive_gearing=known_gearing(drive, 3.0, 12.0, *units) or _DRIVE_GEARING,
            steer_gearing=known_gearing(steer, 5.0, 60.0, 1.0, math.tau, 360.0) or _STEER_GEARING,
            diameter=_WHEEL_DIAMETER,
            wheels=len(modules),
        )
    )
    text.from_can_motors |= {"Mechanism", "SwerveDrive", "SwerveModule"}
    text.needs_motors = True
    text.setup += ["", "# `zero`: what a wheel's encoder measures when the wheel points ahead, in turns."]
    text.setup.append("self.drivetrain = SwerveDrive(")
    for module in modules:
        driving = controller(text, module.drive, "DRIVE_MOTOR", "DRIVE_GEARING")
        steering = controller(text, module.steer, "STEER_MOTOR", "STEER_GEARING", f"{module.ahead:g}")
        text.setup += [
            "    SwerveModule(",
            "        Mechanism(",
            f"            {driving},",
            "            DRIVE_INERTIA,",
            "        ),",
            "        Mechanism(",
            f"            {steering},",
            "            STEER_INERTIA,",
            "        ),",
            f"        x={module.x:.4g},",
            f"        y={module.y:.4g},",
            "        wheel_diameter=WHEEL_DIAMETER,",
            "    ),",
        ]
    text.setup.append(")")
    text.update += ["speeds = self.drivetrain.update(tm_diff)", "self.physics_controller.drive(speeds, tm_diff)"]


def add_mechanism(text: ModuleText, motor: CanMotor, encoder: Encoder | None) -> None:
    """Add a mechanism that one controller moves.

    :param encoder: a quadrature encoder on what it moves
    """
    words = [word for word in re.split(r"[\W_]+", str(motor.name)) if word not in ("motor", "container", "robot")]
    name = text.name("_".join(words) or "mechanism")
    number = name.upper()
    flywheel = not _WITHOUT_GEARS.isdisjoint(re.split(r"[\W_\d]+", str(motor.name).lower()))
    gearing = 1.0 if flywheel else known_gearing(motor, 1.0, 500.0, math.tau, 360.0, 1.0, only_round=True) or _GEARING
    inertia = _FLYWHEEL_INERTIA if flywheel else _INERTIA * gearing**2
    text.numbers.append(
        _MECHANISM_NUMBERS.format(
            motor=motor,
            name=number,
            made=source.motor(motor.model, motor.count),
            gearing=gearing,
            inertia=inertia * motor.count,
        )
    )
    text.from_can_motors.add("Mechanism")
    text.needs_motors = True
    made = controller(text, motor, f"{number}_MOTOR", f"{number}_GEARING")
    text.setup += [
        "",
        f"self.{name} = Mechanism(",
        f"    {made},",
        f"    {number}_INERTIA,",
        f"    {number}_LOW,",
        f"    {number}_HIGH,",
        ")",
    ]
    first = not text.update or not text.update[-1].endswith(".update(tm_diff)")
    text.update += [*([""] if text.update and first else []), f"self.{name}.update(tm_diff)"]
    if encoder is not None:
        text.numbers.append(f"{number}_ENCODER_UNITS = 1.0  # what {encoder} measures in one turn\n")
        shaft = text.encoder(encoder, f"{name}_encoder", f"{number}_ENCODER_UNITS")
        text.update.append(f"self.{shaft}.turn_to(self.{name}.turns, self.{name}.speed)")
