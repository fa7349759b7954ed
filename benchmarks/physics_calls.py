"""How many calls a second a physics helper takes: one measurement, in a process of its own.

``python physics_calls.py tank-calculate``. Part of physics_speed.py, which runs this, on either side: only what both
have in common is used. Where today's pyfrc lacks a method, its `calculate` is measured, which serves the same purpose.
"""

from __future__ import annotations

import json
import random
import sys
import time
from collections.abc import Callable
from typing import Any

from pyfrc.physics import drivetrains, motor_cfgs, tankmodel
from pyfrc.physics.units import units

STEP_SECONDS, STEPS, REPEATS = 0.02, 20_000, 5


def motor_values(count: int) -> list[list[float]]:
    """For each step, a value for each of `count` motors; the same on either side.

    A driver's: all motors held for ten steps each, straight in every other of these, turning in the rest.
    """
    chance = random.Random(2026)
    steps = []
    for hold in range(STEPS // 10):
        power = chance.uniform(-1, 1)
        values = [power if hold % 2 else chance.uniform(-1, 1) for _ in range(count)]
        # A right side's motor is the other way round: the first half of them is on the left.
        steps += [[value if number < count // 2 else -value for number, value in enumerate(values)]] * 10
    return steps


def tank_drive(method: str) -> tuple[Callable[..., Any], list[list[float]]]:
    """The documentation's robot: 90 lb, two CIM motors a side, six-inch wheels."""
    model = tankmodel.TankModel.theory(
        motor_cfgs.MOTOR_CFG_CIM,
        robot_mass=90 * units.lbs,
        gearing=10.71,
        nmotors=2,
        x_wheelbase=2.0 * units.feet,
        wheel_diameter=6 * units.inch,
    )
    return getattr(model, method, model.calculate), [[*values, STEP_SECONDS] for values in motor_values(2)]


def mecanum_drive(method: str) -> tuple[Callable[..., Any], list[list[float]]]:
    """A robot of 2 by 3 feet at up to 5 ft/s."""
    drivetrain = drivetrains.MecanumDrivetrain(2 * units.feet, 3 * units.feet, 5 * units.fps)
    return getattr(drivetrain, method, drivetrain.calculate), motor_values(4)


def main() -> None:
    """Measure, and tell the calls per second as JSON."""
    drive, _, method = sys.argv[1].partition("-")
    call, arguments = {"tank": tank_drive, "mecanum": mecanum_drive}[drive](method)
    times = []
    for _ in range(REPEATS):
        begin = time.perf_counter()
        for values in arguments:
            call(*values)
        times.append(time.perf_counter() - begin)
    print(json.dumps({"speed": STEPS / min(times)}))


if __name__ == "__main__":
    main()
