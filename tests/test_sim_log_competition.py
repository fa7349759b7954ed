"""`pyfrc sim --log` with competition robots: unchanged code does the same, and a changed line differs where it acts."""

from __future__ import annotations

import json
import random
import re
from pathlib import Path
from typing import Any

import pytest
from conftest import MakeProject, RobotProject
from skips import missing_python, requires
from test_sim_log import SIM, change, log_of

pytestmark = [
    pytest.mark.slow,
    requires("robots with vendors' packages", missing_python()),
]

ROBOTS = Path(__file__).parent / "robots" / "competition"
#: The driver drives from 2 s on; the operator raises the elevator, or lets the shooter idle, at 3 s.
DRIVE = """{"format": "pyfrc-input 1", "end": 5.0}
{"t": 0.5, "set": {"mode": "autonomous", "match_time": 1.0}}
{"t": 1.5, "set": {"mode": "teleop", "match_time": 3.1}}
{"t": 2.0, "set": {"joysticks[0].axes[1]": -0.6}}
{"t": 2.8, "set": {"joysticks[0].axes[1]": 0.0}}
{"t": 3.0, "set": {"joysticks[1].buttons[4]": true, "joysticks[1].buttons[6]": true}}
{"t": 3.2, "set": {"joysticks[1].buttons[4]": false}}
{"t": 4.6, "set": {"mode": "disabled", "match_time": 0.0}}
"""


def drive(made: RobotProject, name: str, *options: str, script: str = DRIVE) -> None:
    made.copy(ROBOTS / name)
    (made.path / "drive.jsonl").write_text(script, encoding="utf-8")
    result = made.run(*SIM, "--script", "drive.jsonl", *options)
    assert result.code == 0, result.output


def whole_match() -> str:
    """Return a script of a match of 150 s, in which sticks and buttons of both controllers change all the time."""
    chance, end = random.Random(7), 151.5
    steps: dict[float, dict[str, Any]] = {
        0.5: {"mode": "autonomous", "match_time": 15.0},
        15.5: {"mode": "disabled", "match_time": 0.0},
        16.5: {"mode": "teleop", "match_time": end - 16.5},
        end: {"mode": "disabled", "match_time": 0.0},
    }

    def at(time: float) -> dict[str, Any]:
        return steps.setdefault(round(min(time, end - 0.1), 2), {})

    time = 17.0
    while time < end - 0.5:
        for pad in (0, 1):
            axis, button = chance.choice((0, 1, 4)), chance.randint(1, 10)
            at(time)[f"joysticks[{pad}].axes[{axis}]"] = chance.choice((0.0, 0.4, -0.4, 1.0, -1.0))
            at(time)[f"joysticks[{pad}].buttons[{button}]"] = True
            at(time + 0.3)[f"joysticks[{pad}].buttons[{button}]"] = False
        time += chance.choice((0.3, 0.6, 1.0))
    lines = ({"t": time, "set": values} for time, values in sorted(steps.items()))
    return "\n".join(map(json.dumps, ({"format": "pyfrc-input 1", "end": end + 1}, *lines)))


def test_a_changed_line_differs_where_it_acts(make_project: MakeProject) -> None:
    """On an output, and in what the robot publishes, which data logs have, too. It shoots in autonomous."""
    project = make_project({})
    drive(project, "rev_swerve", "--record", "match.jsonl", "--wpilog", "match.wpilog")
    for log in ("match.jsonl", "match.wpilog"):
        assert "no difference: " in log_of(project, log)
    change(project, "constants.py", "MAX_ACCELERATION = 4.0", "MAX_ACCELERATION = 2.0")
    said = log_of(project, "match.jsonl")
    moments = {path: float(time) for path, time in re.findall(r"^  (.+?) \(0:(\d\d\.\d\d)\): ", said, re.MULTILINE)}
    assert 0.5 <= min(moments.values()) < 1.0, said
    assert any("SPARK MAX [21]" in path for path in moments), said
    differing = log_of(project, "match.wpilog")
    assert re.search(r"differs in \d+ values?", differing)
    assert "SPARK MAX [21]" in differing
    assert "Elevator/Controller/maxAcceleration" in differing


def test_unchanged_code_does_the_same_in_a_whole_match(make_project: MakeProject) -> None:
    # The noise of SPARKs lets each run drive a little differently, and the cameras see the robot there.
    project = make_project({})
    drive(project, "magic_swerve", "--wpilog", "match.wpilog", script=whole_match())
    assert "no difference: " in log_of(project, "match.wpilog")


def test_a_robot_whose_devices_are_simulated_in_real_time_is_compared_by_what_it_publishes(
    make_project: MakeProject,
) -> None:
    # Not its autonomous routine: when that raises the elevator depends on when a wheel is fast enough, in real time.
    script = "".join(line for line in DRIVE.splitlines(keepends=True) if "autonomous" not in line)
    project = make_project({})
    drive(project, "ctre_swerve", "--record", "match.jsonl", "--wpilog", "match.wpilog", script=script)
    (log,) = (project.path / ".pyfrc" / "logs").glob("*.wpilog")
    log.rename(project.path / "robot.wpilog")
    assert "no difference: " in log_of(project, "match.jsonl")  # which has no more than devices
    logs = ("robot.wpilog", "match.wpilog")
    for name in logs:
        assert "Elevator/Goal" not in log_of(project, name)
    change(project, "constants.py", "SCORE_HIGH = 0.0, 0.05, 0.45, 1.1", "SCORE_HIGH = 0.0, 0.05, 0.45, 0.9")
    for name in logs:
        said = log_of(project, name)
        assert re.search(r"Elevator/Goal \(0:03\.\d\d\)", said), said
