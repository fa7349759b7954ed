"""Whether `pyfrc deploy --auto-rollback` sees that a program crashes at its start, and goes back then, and only then.

Run it as root on Linux with ``python benchmarks/deploy_crashes.py``, from an environment with pyfrc's development
requirements. Each program is deployed, over one that runs, to a look-alike of a roboRIO that starts a program again as
soon as it has ended; with a Driver Station, and without one, so that the console is silent.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(CHECKOUT / "tests"))
from roborio import Roborio, missing_here  # noqa: E402

PROGRAM = """\
import time

import wpilib


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        {init}

    def robotPeriodic(self):
        {periodic}
"""
CRASH = 'raise RuntimeError("no such gyro")'


@dataclass(frozen=True)
class Case:
    """One program.

    :param code: the exit code that a deploy of it is to have
    :param back: whether the release before is to run again afterwards
    """

    name: str
    init: str
    periodic: str = "pass"
    code: int = 3
    back: bool = True


CASES = [
    *(Case(f"crash in robotInit after {after:g} s", f"time.sleep({after}); {CRASH}") for after in (0.4, 1, 4, 6)),
    Case("crash in the first periodic call", "pass", CRASH),
    Case(
        "crash 0.5 s after the start", "self.end = time.monotonic() + 0.5", f"if time.monotonic() > self.end: {CRASH}"
    ),
    Case("a start that takes 20 s", "time.sleep(20)", code=0, back=False),
    Case(
        "an error that is caught",
        "import traceback\n        try: 1 / 0\n        except: traceback.print_exc()",
        code=0,
        back=False,
    ),
]


def deploy(project: Path, program: str, robot: Roborio) -> tuple[int, list[dict[str, object]]]:
    """Deploy a program; the exit code, and what was said."""
    (project / "robot.py").write_text(program)
    command = [sys.executable, "-m", "pyfrc", "deploy", "--skip-tests", "--auto-rollback", "--json"]
    done = subprocess.run([*command, "--robot", robot.where], cwd=project, capture_output=True, text=True, check=False)
    return done.returncode, [json.loads(line) for line in done.stdout.splitlines()]


def rows(console: bool) -> Iterator[str]:
    """Deploy each program to one robot; a line of the table for each."""
    with tempfile.TemporaryDirectory() as directory, Roborio(driver_station=console) as robot:
        project = Path(directory)
        good = PROGRAM.format(init="pass", periodic="pass")
        code, said = deploy(project, good, robot)
        assert code == 0, said
        for case in CASES:
            begin = time.monotonic()
            code, said = deploy(project, PROGRAM.format(init=case.init, periodic=case.periodic), robot)
            seconds = time.monotonic() - begin
            is_back = (robot.home / "py/robot.py").read_text() == good
            right = (code, is_back) == (case.code, case.back)
            found = next(str(each["detail"]) for each in said if each.get("phase") == "start")
            traceback = any("RuntimeError: no such gyro" in str(each.get("text")) for each in said)
            yield (
                f"{case.name:34} {'yes' if console else 'no':8} {'right' if right else 'WRONG':6} {code:4}  "
                f"{'yes' if is_back else 'no':5} {'yes' if traceback else 'no':10} {seconds:6.1f}  {found}"
            )
            if not is_back:
                deploy(project, good, robot)


if __name__ == "__main__":
    if missing := missing_here():
        sys.exit(f"error: a look-alike of a roboRIO needs {', '.join(missing)}")
    print(f"{'program':34} {'console':8} {'':6} {'code':4}  {'back':5} {'traceback':10} {'s':>6}  the first verdict")
    for console in (True, False):
        for line in rows(console):
            print(line, flush=True)
