"""Write the text of a robot's ``physics.py``, of the current generation: in metres and counter-clockwise."""

from __future__ import annotations

import re
from textwrap import wrap

from ...errors import PyfrcError
from ...wpi import names as robot_names
from ...wpi import source
from . import can_text
from .can_devices import CanMotor
from .drivetrain import CORNERS, DrivetrainLayout, Mecanum, Tank
from .module_text import ModuleText
from .motors import Motor
from .names import one_line
from .report import notes
from .survey import Encoder, Gyro, Survey

_HEAD = '''"""The physics of this robot: how its motors change its sensors and its position on the field.

`pyfrc test` and the simulator use this file because it is beside the robot's code.
`pyfrc create-physics` wrote it; change it as you like. The numbers below are those of a common
robot: replace them with your own.
"""
'''

_DRIVETRAIN_NUMBERS = """
# The drivetrain.
TOP_SPEED = 10 * units.feet / units.second  # at full power
TRACK_WIDTH = {track_width}  # from the left wheels to the right ones
"""
_WHEELBASE = "WHEELBASE = 22 * units.inch  # from the front wheels to the rear ones\n"

_UNITS = """
# The unit of the robot's {sets_distance}, which is assumed: 1 for metres, 3.281 for feet,
# 39.37 for inches.
ENCODER_UNITS = 1.0
"""

_COUNTS = """
# The robot uses counts of some encoders: it does not call {sets_distance}.
COUNTS_PER_TURN = 360  # of a wheel
WHEEL_DIAMETER = 6 * units.inch
ENCODER_COUNTS = COUNTS_PER_TURN / (math.pi * WHEEL_DIAMETER.m_as("meter"))
"""

_ENGINE = '''

class PhysicsEngine:
    """Created after the robot's {initialization}; update_sim is called after each loop of the robot."""

    def __init__(self, physics_controller: PhysicsInterface, robot: {robot}) -> None:
        self.physics_controller = physics_controller
{setup}
    def update_sim(self, now: float, tm_diff: float) -> None:
        """`now` is the robot time, `tm_diff` the time since the last call, in seconds."""
{update}'''


def physics_text(found: Survey, layout: DrivetrainLayout) -> str:
    """Return the text of the file.

    :raises PyfrcError: when it is not valid Python
    """
    text = ModuleText()
    drivetrain = layout.drivetrain
    if drivetrain is not None:
        _drivetrain(text, drivetrain, layout, found.gyros)
    elif layout.modules:
        can_text.add_swerve(text, layout.modules)
        _gyros(text, found.gyros, "math.degrees(speeds.omega * tm_diff)")
    for motor, encoder in layout.mechanisms:
        if isinstance(motor, CanMotor):
            can_text.add_mechanism(text, motor, encoder)
        else:
            _mechanism(text, motor, encoder)
    for motor in layout.can_mechanisms:
        can_text.add_mechanism(text, motor, None)
    return checked(_assembled(text, notes(found, layout)))


def checked(text: str) -> str:
    """Return `text` if it is valid Python.

    :raises PyfrcError: otherwise, with a request to report it
    """
    try:
        compile(text, "physics.py", "exec", dont_inherit=True)
    except (SyntaxError, ValueError) as error:
        line = text.splitlines()[error.lineno - 1].strip() if isinstance(error, SyntaxError) and error.lineno else ""
        raise PyfrcError(
            f"the generated physics.py is not valid Python: {error}" + (f"\n    {line}" if line else ""),
            remedy="This is a bug in pyfrc: please report it, with this message and the names of your robot's "
            "motors and sensors. Nothing was written.",
        ) from error
    return text


def _assembled(text: ModuleText, remarks: list[str]) -> str:
    numbers = "".join(text.numbers)
    imports = ["import math\n"] if any("math." in part for part in (numbers, *text.update)) else []
    imports.append(source.imports(text.sims, motors=text.needs_motors))
    names = ", ".join(sorted(text.from_can_motors))
    ours = {"from pyfrc.physics.core import PhysicsInterface", *text.imports}
    ours |= {f"from pyfrc.physics.can_motors import {names}"} if names else set()
    ours |= {"from pyfrc.physics.encoders import EncoderShaft"} if source.ENCODER in text.sims else set()
    imports.append("\n".join(sorted(ours, key=_import_order)) + "\n")
    comments = [wrap(one_line(remark), 98, initial_indent="# ", subsequent_indent="# ") for remark in remarks]
    engine = _ENGINE.format(
        initialization=robot_names.INITIALIZATION,
        robot=source.ROBOT,
        setup=_indented(text.setup),
        update=_indented(text.update),
    )
    return "".join(
        [
            f"{_HEAD}\n",
            "\n".join(imports),
            *("\n{}\n".format("\n".join(lines)) for lines in comments),
            numbers,
            engine,
        ]
    )


def _import_order(line: str) -> tuple[bool, str]:
    return "physics import" not in line, line


def _indented(lines: list[str]) -> str:
    return "".join(f"        {line}\n" if line else "\n" for line in lines)


# -- drivetrains -------------------------------------------------------------------------------------------------


def _drivetrain(text: ModuleText, drivetrain: Tank | Mecanum, layout: DrivetrainLayout, gyros: list[Gyro]) -> None:
    text.imports |= {"from pyfrc.physics import drivetrains", "from pyfrc.physics.units import units"}
    is_tank = isinstance(drivetrain, Tank)
    width = f"{layout.track_width:.4g} * units.metre" if layout.track_width else "22 * units.inch"
    wheels = {"left": drivetrain.left, "right": drivetrain.right} if isinstance(drivetrain, Tank) else drivetrain.wheels
    text.numbers += [
        _DRIVETRAIN_NUMBERS.format(track_width=width),
        "" if is_tank else _WHEELBASE,
        can_text.wheel_numbers(drivetrain.motors),
    ]
    text.setup.append("")
    if any(len(group.motors) > 1 for group in wheels.values()):
        text.setup.append("# Of motors that are geared together, one is enough.")
    values = []
    on_can: list[tuple[str, str, int]] = []
    for wheel in ("left", "right") if is_tank else CORNERS:
        group = wheels[wheel]
        output, controllers = can_text.wheel_motors(text, group.motors, f"{wheel}_motor")
        on_can += [(wheel, name, group.forward) for name in controllers]
        names = [str(motor.name) for motor in group.motors if motor.name]
        if names:
            text.setup[-1] += f"  # {', '.join(names)}"
        values.append(_signed(group.forward if wheel.endswith("left") else -group.forward, output))
    model = "TwoMotorDrivetrain(TRACK_WIDTH" if is_tank else "MecanumDrivetrain(TRACK_WIDTH, WHEELBASE"
    text.setup += ["", f"self.drivetrain = drivetrains.{model}, TOP_SPEED)"]
    encoders = _wheel_encoders(text, layout)
    text.update += [
        *_about_signs("In the drivetrain, left motors are forward at 1 and right ones at -1", *values),
        "speeds = self.drivetrain.calculate(",
        *(f"    {value}," for value in values),
        ")",
        "self.physics_controller.drive(speeds, tm_diff)",
    ]
    if encoders or on_can:
        text.update += ["", "wheels = self.drivetrain.wheelSpeeds  # in metres per second"]
    for wheel, name, sign in on_can:
        turns = text.name(f"{name}_turns")
        text.setup.append(f"self.{turns} = 0.0")
        speed = _signed(sign, f"{source.wheel_speed('wheels', wheel)} / WHEEL_CIRCUMFERENCE")
        text.update += [
            f"self.{turns} += {speed} * tm_diff",
            f"self.{name}.measure(self.{turns}, {speed}, tm_diff)",
        ]
    for wheel, name in encoders:
        distance = text.name(f"{name}_distance")
        text.setup.append(f"self.{distance} = 0.0")
        speed = source.wheel_speed("wheels", wheel)
        text.update += [f"self.{distance} += {speed} * tm_diff", f"self.{name}.turn_to(self.{distance}, {speed})"]
    _gyros(text, gyros, "math.degrees(speeds.omega * tm_diff)")


def _wheel_encoders(text: ModuleText, layout: DrivetrainLayout) -> list[tuple[str, str]]:
    """Add the set-up of the wheels' encoders; return each one's wheel and name."""
    found = [(wheel, encoder) for wheel, encoders in layout.encoders.items() for encoder in encoders]
    if not found:
        return []
    if any(not encoder.counts for _, encoder in found):
        text.numbers.append(_UNITS.format(sets_distance=source.SETS_DISTANCE))
    if any(encoder.counts for _, encoder in found):
        text.numbers.append(_COUNTS.format(sets_distance=source.SETS_DISTANCE))
    text.setup.append("")
    return [
        (wheel, text.encoder(encoder, f"{wheel}_encoder", "ENCODER_COUNTS" if encoder.counts else "ENCODER_UNITS"))
        for wheel, encoder in found
    ]


def _about_signs(rule: str, *values: str) -> list[str]:
    negated = any(value.startswith("-") for value in values)
    return [f"# {rule}; a minus adapts this robot's signs." if negated else f"# {rule}."]


def _signed(sign: int, expression: str) -> str:
    return expression if sign > 0 else f"-{expression}"


# -- gyros and mechanisms ----------------------------------------------------------------------------------------


def _gyros(text: ModuleText, gyros: list[Gyro], turned: str) -> None:
    """Add the robot's gyros.

    :param turned: the expression for the robot's turn, in degrees counter-clockwise
    """
    if gyros:
        text.update += ["", f"turned = {turned}  # counter-clockwise"]
    for gyro in gyros:
        _gyro(text, gyro)


def _gyro(text: ModuleText, gyro: Gyro) -> None:
    name = str(gyro.name) or "gyro"
    sign = "-" if gyro.clockwise else "+"
    rate = f"{'-' if gyro.clockwise else ''}turned / tm_diff"
    text.update.append(f"# This gyro counts {'clockwise' if gyro.clockwise else 'counter-clockwise'}, in degrees.")
    if gyro.channel is not None:
        name = text.name(name)
        text.setup.append("")
        text.simulate(name, source.analog_gyro(gyro.channel))
        text.update += source.turned_gyro(f"self.{name}", f" {sign} turned", rate)
        return
    angle = text.name(f"{name}_angle")
    text.setup.append("")
    text.simulate(angle, source.number(gyro.device, gyro.angle))
    turned = f"self.{angle}.get() {sign} turned"
    text.update.append(f"self.{angle}.set({f'math.remainder({turned}, 360)' if gyro.wraps else turned})")
    if gyro.rate:
        rate_value = text.name(f"{name}_rate")
        text.simulate(rate_value, source.number(gyro.device, gyro.rate))
        text.update.append(f"self.{rate_value}.set({rate})")


def _mechanism(text: ModuleText, motor: Motor, encoder: Encoder) -> None:
    text.imports.add("from pyfrc.physics import motion")
    purpose = [
        word for word in re.split(r"[\W_]+", str(encoder.name or motor.name)) if word not in ("encoder", "motor")
    ]
    name = text.name("_".join(purpose) or "mechanism")
    number = name.upper()
    unit = "counts" if encoder.counts else f"the units of its {source.SETS_DISTANCE}"
    text.numbers.append(
        f"\n# TODO: how fast does {motor} turn {encoder}?\n"
        f"# At full power, in {unit} per second. It stands still at 0.\n"
        f"{number}_SPEED = 0.0\n"
        f"{number}_MIN, {number}_MAX = None, None  # its end stops; None if there are none\n"
    )
    text.setup += ["", f"# {motor} turns {encoder}"]
    output = text.motor(motor, f"{name}_motor")
    shaft = text.encoder(encoder, f"{name}_encoder", "1")
    text.setup.append(f'self.{name} = motion.LinearMotion("{name}", {number}_SPEED, 1, {number}_MAX, {number}_MIN)')
    if text.update:
        text.update.append("")
    text.update += [
        f"before = self.{name}.position_ft  # in the unit of {number}_SPEED",
        f"self.{name}.compute({_signed(-1 if motor.inverted else 1, output)}, tm_diff)",
        f"after = self.{name}.position_ft",
        f"self.{shaft}.turn_to(after, (after - before) / tm_diff)",
    ]
