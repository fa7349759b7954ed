"""What `pyfrc create-physics` has recognised, taken for granted and left out, in words."""

from __future__ import annotations

from .drivetrain import CORNERS, Layout, Mecanum, Side, Tank
from .survey import Motor, Survey


def listed(motors: list[Motor]) -> str:
    return ", ".join(map(str, motors))


def advice(layout: Layout) -> list[str]:
    """What there is left to do for the robot to drive."""
    if layout.swerve is not None:
        return [
            "A swerve drive's wheels cannot be told apart by its sticks, so the robot stays where it is. To drive it, "
            "let update_sim() give the outputs of the four drive motors and the angles of the four wheels to "
            "drivetrains.four_motor_swerve_drivetrain() of pyfrc.physics, and its answer to "
            "self.physics_controller.drive(): see docs/physics.md."
        ]
    if layout.drivetrain is None:
        return [
            "No drivetrain was recognised, so the robot stays where it is. To drive it, let update_sim() call "
            "self.physics_controller.drive() or move_robot(): see pyfrc.physics.drivetrains (for a swerve drive, its "
            "four_motor_swerve_drivetrain), pyfrc.physics.tankmodel and docs/physics.md."
        ]
    return []


def notes(found: Survey, layout: Layout) -> list[str]:
    """What is to be known of it: sentences for the file."""
    said = list(layout.assumptions)
    if found.problem:
        said.append(f"The robot's sticks could not be tried: {found.problem.splitlines()[0]}")
    said += advice(layout)
    still = found.gyros if layout.drivetrain is None else []
    left_out = [*map(str, [*layout.undriven, *still]), *found.others]
    if left_out:
        said.append(f"Left as they are, as nothing is known of what they do: {', '.join(left_out)}.")
    return said


def summary(layout: Layout, found: Survey) -> list[str]:
    """What was recognised, in a few lines for the terminal."""
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
    elif layout.swerve is not None:
        lines += ["swerve drive, which is left to you"]
        lines += [f"  drive: {listed(layout.swerve.drive)}", f"  steering: {listed(layout.swerve.steer)}"]
    else:
        lines.append("no drivetrain recognised")
    for wheel, encoders in layout.encoders.items():
        lines += [f"  {wheel.replace('_', ' ')} encoder: {encoder}" for encoder in encoders]
    lines += [f"gyro: {gyro}" for gyro in found.gyros]
    lines += [f"{motor} with {encoder}" for motor, encoder in layout.mechanisms]
    return lines


def _reversed(side: Side) -> str:
    return ", forward at -1" if side.forward < 0 else ""
