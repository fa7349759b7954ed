"""How fast pyfrc's physics is, against the pyfrc of the 2026 season, side by side on this machine.

Run it with ``python benchmarks/physics_speed.py``; its options are those of test_speed.py.

Cases 1 to 4 are 20,000 steps of 20 ms in a process of their own (physics_calls.py), the best of five passes. Motor
values are random, the same on either side, and change every tenth step.
Cases 5 and 6 are whole processes that import `units`, and use a unit in case 6: ours imports pint only then.
"""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

from comparison import Case, Environment, compare, run, timed

PHYSICS_CALLS = Path(__file__).resolve().with_name("physics_calls.py")

IMPORT_UNITS = "from pyfrc.physics.units import units; print('imported')"
USE_UNITS = "from pyfrc.physics.units import units; print(5 * units.feet)"


def make_cases(ours: Environment, todays: Environment, directory: Path) -> list[Case]:
    """All of the cases."""

    def calls(environment: Environment, which: str) -> float:
        printed = run([environment.python, str(PHYSICS_CALLS), which], directory)
        return float(json.loads(printed.splitlines()[-1])["speed"])

    def case(number: int, name: str, which: str, times: int) -> Case:
        our_calls, todays_calls = partial(calls, ours, which), partial(calls, todays, which)
        return Case(number, name, "calls/s", our_calls, todays_calls, f"ratio >= {times}", lambda _, r: r >= times)

    def start(number: int, name: str, code: str, expected: str, most: float) -> Case:
        our_start, todays_start = (
            partial(timed, [side.python, "-c", code], directory, expected) for side in (ours, todays)
        )
        return Case(number, name, "s", our_start, todays_start, f"ratio <= {most}", lambda _, r: r <= most)

    return [
        case(1, "TankModel.calculate", "tank-calculate", 5),
        case(2, "TankModel.get_distance / .calculate", "tank-get_distance", 5),
        case(3, "MecanumDrivetrain.calculate", "mecanum-calculate", 2),
        case(4, "MecanumDrivetrain.get_vector / .calculate", "mecanum-get_vector", 2),
        start(5, "importing units, second start", IMPORT_UNITS, "imported", 0.5),
        start(6, "importing and using units, second start", USE_UNITS, "5 foot", 1),
    ]


if __name__ == "__main__":
    compare((__doc__ or "").partition("\n")[0], 6, make_cases)
