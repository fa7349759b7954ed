"""`pyfrc sim` without a window."""

from __future__ import annotations

import json
import re
import sys
from dataclasses import replace

import pytest
from loops import for_each
from sim_robots import FILES

from pyfrc_core.errors import UsageError
from pyfrc_core.season import CURRENT
from pyfrc_core.sim.engine.extensions import check_installed

pytestmark = pytest.mark.bare

#: As on a machine without a screen.
NO_DISPLAY = {"DISPLAY": "", "WAYLAND_DISPLAY": ""}


@pytest.fixture(scope="module")
def project(make_shared_project):
    return make_shared_project(FILES)


def test_a_practice_match(project) -> None:
    """--mode needs no person, so neither a page nor a window is opened."""
    result = project.run("sim", "--mode", "practice", env={"DISPLAY": ":0", "BROWSER": "no-such-browser"})
    assert result.code == 0, result.output
    assert "The simulator is at" not in result.stdout
    assert "the robot is there" in result.stdout
    assert re.search(r"simulated 3\.90 s of robot time, at \d+ times real time", result.stdout), result.stdout
    assert "autonomous 1.0 s, teleop 2.0 s" in result.stdout
    assert "distance driven: 0.0 ft" in result.stdout


@pytest.mark.season_2026
def test_what_is_recorded_is_replayed(project) -> None:
    project.write({"drive.jsonl": SCRIPT})
    result = project.run(
        *("sim", "--ui", "none", "--script", "drive.jsonl"),
        *("--record", "again.jsonl", "--wpilog", "log.wpilog"),
    )
    assert result.code == 0, result.output
    assert "simulated 3.00 s" in result.stdout
    assert "distance driven: 9.9 ft (3.0 m)" in result.stdout
    for file in ("again.jsonl", "log.wpilog"):
        assert f"wrote {file}" in result.stdout
        assert (project.path / file).is_file()
    result = project.run("replay", "again.jsonl")
    assert "The trace equals the recorded one." in result.stdout, result.output
    # The steps are the script's own.
    lines = (project.path / "again.jsonl").read_text().splitlines()
    assert [json.loads(line) for line in lines[1:]] == [json.loads(line) for line in SCRIPT.strip().splitlines()[1:]]
    check_log(project.path / "log.wpilog")


SCRIPT = """
{"format": "pyfrc-input 1", "end": 3.0}
{"t": 0.5, "set": {"mode": "teleop"}}
{"t": 1.0, "set": {"joysticks[0].axes[1]": -1.0}}
"""


def check_log(file) -> None:
    """WPILib's own reader finds the drive in it."""
    from wpimath.geometry import Pose2d
    from wpiutil import wpistruct
    from wpiutil.log import DataLogReader

    names: dict[int, tuple[str, str]] = {}
    values: dict[str, list] = {}
    for record in DataLogReader(str(file)):
        if record.isStart():
            start = record.getStartData()
            names[start.entry] = (start.name, start.type)
        elif not record.isControl():
            name, kind = names[record.getEntry()]
            read = {
                "boolean": record.getBoolean,
                "double": record.getDouble,
                "double[]": record.getDoubleArray,
                "struct:Pose2d": lambda record=record: wpistruct.unpack(Pose2d, record.getRaw()),
            }.get(kind, lambda: None)
            values.setdefault(name, []).append((record.getTimestamp() / 1e6, read()))
    assert [enabled for enabled in values["DS:enabled"] if enabled[1]] == [(0.5, True)]
    assert values["DS:joystick0/axes"][-1][0] == 1.0
    assert values["DS:joystick0/axes"][-1][1][1] == -1.0
    assert values["/hal_data/pwm[0].value"][-1] == (1.0, 1.0)
    at, pose = values["/pose"][-1]
    assert at == pytest.approx(2.98)
    assert pose.X() == pytest.approx((10 + 5 * 2) * 0.3048, abs=0.1)


def test_a_part_of_a_script(project) -> None:
    project.write({"drive.jsonl": SCRIPT})
    result = project.run("sim", "--ui", "none", "--script", "drive.jsonl", "--from", "1.5", "--seconds", "2")
    assert "simulated 2.00 s" in result.stdout, result.output
    assert "distance driven: 5.1 ft" in result.stdout


@for_each(
    "arguments, told",
    [
        (["--script", "drive.jsonl", "--seconds", "9"], "drive.jsonl: --seconds 9 is after the script's end, at 3 s"),
        (["--script", "nowhere.jsonl"], "there is no file nowhere.jsonl"),
        (["--script", "cut.jsonl"], "cut.jsonl:3: not valid JSON"),
        (["--seconds", "1", "--speed", "-2"], "the speed cannot be -2"),
        (["--seconds", "1", "--ext", "nonsense"], "there is no extension 'nonsense'"),
        (["--seconds", "1", "--start", "lft"], "there is no start position 'lft': did you mean 'left'?"),
    ],
)
def test_wrong_usage(arguments: list[str], told: str, project) -> None:
    project.write({"drive.jsonl": SCRIPT, "cut.jsonl": SCRIPT.strip()[:-10]})
    result = project.run_here("sim", "--ui", "none", *arguments)
    assert result.code == 2, result.output
    assert told in result.first_error


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="there is always a display")
def test_windows_need_a_display(project) -> None:
    for ui in ("tk", "wpilib"):
        result = project.run_here("sim", "--ui", ui, env=NO_DISPLAY)
        assert result.code == 2
        assert result.first_error == f"--ui {ui} needs a display, and there is none"
        assert "--ui none" in result.stderr
    result = project.run_here("sim", "--ui", "tk", "--mode", "auto", env={"DISPLAY": ":99"})
    assert (result.code, result.first_error) == (2, "--mode is for simulations without a window")


@pytest.mark.parametrize(("name", "package"), [("gui", "robotpy-halsim-gui"), ("ws-server", "robotpy-halsim-ws")])
def test_what_is_not_installed_is_said(name: str, package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda module: None)
    with pytest.raises(UsageError, match=f"pip install {package}"):
        check_installed([name])


def test_an_extension_that_does_nothing_in_a_season_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pyfrc_core.sim.engine.extensions.CURRENT", replace(CURRENT, year=2027))
    with pytest.raises(UsageError, match="ds-socket does nothing with WPILib 2027"):
        check_installed(["ds-socket"])


def test_a_robot_that_fails(project, make_project) -> None:
    broken = FILES["robot.py"].replace("self.left.set(speed)", "self.left.set(self.missing)")
    made = make_project(FILES | {"robot.py": broken})
    result = made.run("sim", "--ui", "none", "--mode", "auto", "--record", "crash.jsonl")
    assert result.code == 1, result.output
    place = made.place("robot.py", "self.missing")
    assert re.search(rf"failed at 0\.0\d s: {place}: AttributeError: .*missing", result.stdout), result.stdout
    # The way to it is a file: that of a fuzzed failure.
    result = made.run("replay", "crash.jsonl")
    assert f"{place}: AttributeError" in result.output
