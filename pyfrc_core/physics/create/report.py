"""Describe what `pyfrc create-physics` has recognised, assumed and left out."""

from __future__ import annotations

import re

from .drivetrain import CORNERS, DrivetrainLayout, Mecanum, MotorGroup, Tank
from .motors import Motor
from .survey import Survey


def listed(motors: list[Motor]) -> str:
    return ", ".join(map(str, motors))


def advice(found: Survey, layout: DrivetrainLayout) -> list[str]:
    """Return the remaining work: until the robot drives, and for the devices that are not simulated."""
    return [*_advice_for_driving(layout), *_not_simulated(found, layout)]


def _advice_for_driving(layout: DrivetrainLayout) -> list[str]:
    if layout.drivetrain is not None or layout.modules:
        return []
    return [
        "No drivetrain was recognised, so the robot does not move. Motors of a tank or mecanum drive are recognised by "
        "names such as left_motor or front_left. Or let update_sim() call "
        "self.physics_controller.drive() or move_robot(): see pyfrc.physics.drivetrains (for a swerve drive, its "
        "four_motor_swerve_drivetrain), pyfrc.physics.tankmodel and docs/how_to/simulate_a_drivetrain.md."
    ]


#: A sensor of a vendor's motor controller, such as ``SPARK MAX [11] RELATIVE ENCODER``.
_PART = re.compile(r".+ \[[\d,]+\] [A-Z]")


def _not_simulated(found: Survey, layout: DrivetrainLayout) -> list[str]:
    still = [] if layout.drivetrain is not None or layout.modules else found.gyros
    left_out = [*map(str, [*layout.undriven, *still]), *found.others]
    left_out = [device for device in left_out if not _PART.match(device)]
    return [f"Not simulated, since their purpose is unknown: {', '.join(left_out)}."] if left_out else []


def notes(found: Survey, layout: DrivetrainLayout) -> list[str]:
    """Return the notes for the written file, as sentences."""
    sentences = list(layout.assumptions)
    if found.problem:
        sentences.append(f"The robot's joysticks could not be tested: {found.problem.splitlines()[0]}")
    questions = [f"TODO: {sentence}" for sentence in _advice_for_driving(layout)]
    return [*sentences, *questions, *_not_simulated(found, layout)]


def summary(layout: DrivetrainLayout, found: Survey) -> list[str]:
    """Return a summary for the terminal, in a few lines."""
    lines = []
    drivetrain = layout.drivetrain
    if isinstance(drivetrain, Tank):
        lines.append("tank drive")
        sides = {"left": drivetrain.left, "right": drivetrain.right}
        lines += [f"  {name}: {listed(side.motors)}{_reversed(side)}" for name, side in sides.items()]
    elif isinstance(drivetrain, Mecanum):
        lines.append("mecanum drive")
        wheels = {corner.replace("_", " "): drivetrain.wheels[corner] for corner in CORNERS}
        lines += [f"  {name}: {listed(wheel.motors)}{_reversed(wheel)}" for name, wheel in wheels.items()]
    elif layout.modules:
        lines.append("swerve drive")
        lines += [
            f"  {module.drive} drives, {module.steer} steers: {module.x:+.2f} m, {module.y:+.2f} m"
            for module in layout.modules
        ]
    else:
        lines.append("no drivetrain recognised")
    for wheel, encoders in layout.encoders.items():
        lines += [f"  {wheel.replace('_', ' ')} encoder: {encoder}" for encoder in encoders]
    lines += [f"gyro: {gyro}" for gyro in found.gyros]
    lines += [f"{motor} with {encoder}, which you need to complete" for motor, encoder in layout.mechanisms]
    lines += [f"mechanism: {motor}" for motor in layout.can_mechanisms]
    return lines


def _reversed(side: MotorGroup) -> str:
    return ", forward at -1" if side.forward < 0 else ""
