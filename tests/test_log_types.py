"""Entries of data logs with well-known names, and types and values of any kind: either they are used, or left out."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from loops import for_each
from written_logs import Written, a_kit_log, a_match

from pyfrc_core.errors import PyfrcError
from pyfrc_core.hal import HalData
from pyfrc_core.project import Project
from pyfrc_core.runtime.scripts import kit_names
from pyfrc_core.runtime.scripts.data_log import script_from_log
from pyfrc_core.runtime.scripts.inputs_file import load_inputs
from pyfrc_core.runtime.scripts.script import InputScript, ScriptError
from pyfrc_core.runtime.scripts.sensors import HOLD
from pyfrc_core.runtime.scripts.targets import Targets
from pyfrc_core.sim.log_run import log_run
from pyfrc_core.sim.logs import LogError, open_log
from pyfrc_core.sim.logs.source import LogSource
from pyfrc_core.sim.ui.web.messages import json_text
from pyfrc_core.sim.ui.web.runs import Runs

HEIGHT = 27.0

STATION = [
    "ControlWord", "ControlWord/enabled", "ControlWord/robotMode", "EventName", "FMSControlData", "GameData",
    "GameSpecificMessage", "IsRedAlliance", "MatchNumber", "MatchType", "ReplayNumber", "StationNumber",
]  # fmt: skip
OWN = [
    "control.enabled", "control.dsAttached", "control.opmode", "alliance_station", "event.match_type", "event.name",
    "power.vin_voltage", "encoder[0].count", "encoder[0].period", "dio[3].value", 'CAN["a [1]"].Position', "[[", "",
    "pwm[0].value", "analog_in[99].voltage", "joysticks[0].axes", "time.remaining", "network_inputs",
]  # fmt: skip
SENT = ["enabled", "autonomous", "test", "estop", "controlWord", "controlWord/enabled", "opMode"]
NAMES = [
    *(f"DS:{name}" for name in SENT),
    *(f"DS:joystick{stick}/{sort}" for stick in (0, 5, 7) for sort in ("axes", "buttons", "povs", "more")),
    *(f"NT:/{table}/{name}" for table in ("FMSInfo", "DriverStation") for name in STATION),
    *kit_names.NAMES, *(f"NT:/AdvantageKit{name}" for name in kit_names.NAMES),
    *(name for pair in kit_names.BUTTONS for name in pair[:2]),
    *(f"/hal_data/{path}" for path in OWN),
    "/network_inputs", "systemTime", "/SystemStats/EpochTimeMicros", "/SystemStats/BrownedOut", "messages", "console",
    "/RealOutputs/Console", "/RealOutputs/Odometry/Robot", "/NetworkInputs/Tuning/gain", "/DashboardInputs/Auto",
    "NT:/SmartDashboard/Auto/selected", "NT:/SmartDashboard/Auto/options", "NT:/SmartDashboard/Auto/.type",
    "NT:/Preferences/kP", "NT:/Preferences/kP/x", "NT:/SmartDashboard/Field/Robot", "NT:/SmartDashboard/Field/.type",
    "NT:/limelight/tx", "NT:/limelight/botpose", "NT:/photonvision/front/pose", "NT:/.schema/struct:Pose2d",
    "/.schema/struct:Pose2d", "/pose", "/pose/translation/x", "/pose/translation/y", "/pose/rotation/value",
    "/Timestamp", "", "NT:", "DS:",
]  # fmt: skip
SIZES = {"boolean": 1, "int64": 8, "int": 8, "float": 4, "double": 8}
PLAIN = [*SIZES, *(f"{name}[]" for name in SIZES), "string", "string[]"]
TYPES = [*PLAIN, "json", "raw", "struct:Pose2d", "struct:Pose2d[]", "structschema", "struct:", "proto:x", "", "[]"]


@st.composite
def payloads(draw: st.DrawFn, type_name: str) -> bytes:
    """Return the bytes of a value of a type; now and then of none."""
    if draw(st.integers(0, 9)) == 0:
        return draw(st.binary(max_size=40))
    plain = type_name.removesuffix("[]")
    if plain in SIZES:
        numbers = st.sampled_from([0, 1, 2, 5, -1, 7, 255, 70_000, 1 << 40])
        floats = st.one_of(st.floats(width=32), st.sampled_from([0.0, 1.0, 33.0, -1.5]))
        code = {"boolean": "?", "float": "f", "double": "d"}.get(plain, "q")
        one = st.booleans() if code == "?" else numbers if code == "q" else floats
        count = draw(st.integers(0, 14)) if type_name.endswith("[]") else 1
        return struct.pack(f"<{count}{code}", *(draw(one) for _ in range(count)))
    if type_name == "string[]":
        texts = draw(st.lists(st.text(max_size=5), max_size=3))
        return struct.pack("<I", len(texts)) + b"".join(
            struct.pack("<I", len(text.encode())) + text.encode() for text in texts
        )
    if type_name.startswith("struct:Pose2d"):
        return struct.pack("<3d", *(draw(st.floats()) for _ in range(3)))
    some = st.sampled_from(["{}", "[1]", '{"nt:/a": 1}', "null", "double x;", "x" * 100])
    return draw(st.one_of(st.text(max_size=80), some)).encode("utf-8", "replace")


@st.composite
def logs(draw: st.DrawFn) -> Written:
    """Return a log of a match, or of nothing, with entries of well-known names and of any type."""
    log = draw(st.sampled_from([a_match, a_kit_log, Written]))()
    for _ in range(draw(st.integers(1, 6))):
        name, type_name = draw(st.sampled_from(NAMES)), draw(st.sampled_from(TYPES))
        moments = sorted(draw(st.lists(st.floats(0, 12), min_size=1, max_size=4)))
        log.values(name, type_name, "", *((moment, draw(payloads(type_name))) for moment in moments))
    return log


def an_entry(name: str, type_name: str, payload: bytes, log: Written | None = None) -> Written:
    log = a_match() if log is None else log
    log.values(name, type_name, "", (1.0, payload), (3.0, payload))
    return log


def directory_of(factory: pytest.TempPathFactory) -> Path:
    """Return the directory of all examples: making one for each takes longer than to read a log."""
    made = factory.getbasetemp() / "log-types"
    made.mkdir(exist_ok=True)
    return made


def steps_of(script: InputScript) -> Iterator[tuple[int, str, Any]]:
    for step in script.steps:
        yield from ((step.at_us, target, value) for target, value in step.writes.items())


FUZZED = settings(max_examples=25)


@FUZZED
@given(logs())
@example(an_entry("NT:/FMSInfo/FMSControlData", "double", struct.pack("<d", 33.0)))
@example(an_entry("NT:/FMSInfo/StationNumber", "string", b"two"))
def test_any_log_can_be_shown(tmp_path_factory: pytest.TempPathFactory, log: Written) -> None:
    assert_shown(log, directory_of(tmp_path_factory))


def assert_shown(log: Written, directory: Path) -> None:
    file = log.save(directory / "shown.wpilog")
    try:
        opened = open_log(file, HEIGHT)
    except LogError:  # of values, it has none
        return
    source = LogSource(Project(file.with_name("robot.py")), opened)
    assert source.snapshot is not None
    runs = Runs(opened.run)
    paths = [path for history in opened.run.histories.values() for path in history.paths()]
    for answer in (
        runs.values_at(opened.run.end / 2),
        runs.plots(paths, 0.0, opened.run.end, 100, None),
        runs.changes_around(1.0, 0.5),
        runs.packed(str),
        dict(source.snapshot.values),
    ):
        json.loads(json_text(answer))


@FUZZED
@given(logs())
@example(an_entry("NT:/FMSInfo/FMSControlData", "double", struct.pack("<d", 33.0)))
@example(an_entry("NT:/FMSInfo/MatchNumber", "int64", struct.pack("<q", 1 << 40)))
def test_any_log_gives_inputs_that_can_be_written(tmp_path_factory: pytest.TempPathFactory, log: Written) -> None:
    assert_written(log, directory_of(tmp_path_factory))


def assert_written(log: Written, directory: Path) -> None:
    file = log.save(directory / "inputs.wpilog")
    (directory / "robot.py").touch()
    try:
        script = load_inputs(file)
    except ScriptError:  # without a driver station, or what a simulation has written of itself is damaged
        return
    whole = log_run(Project(directory / "robot.py"), file).script
    for made in (script, whole):
        targets = Targets(HalData())
        try:
            for at_us, target, value in steps_of(made):
                json.dumps(value)
                targets.check(target)
                if not target.startswith(("nt:", HOLD)):
                    targets.write(target, value, at_us)
        finally:
            targets.close()


@for_each("type_name", TYPES)
@for_each("begin, number", [(Written, 1), (a_match, 3)])
def test_each_name_with_each_type(type_name: str, begin: Callable[[], Written], number: int, tmp_path: Path) -> None:
    """All names at once, with the same value, also before and beside those of a match."""
    plain = type_name.removesuffix("[]")
    code = {"boolean": "?", "int64": "q", "int": "q", "float": "f", "double": "d"}.get(plain)
    payload = struct.pack(f"<{number}{code}", *[number] * number) if type_name.endswith("[]") and code else b""
    payload = payload or (struct.pack(f"<{code}", number) if code else str(number).encode() * 24)
    log = begin()
    for name in sorted({*NAMES} - {"/network_inputs"}):  # without it, the log would be refused
        log.values(name, type_name, "", (0.5, payload), (12.0, payload))
    assert_shown(log, tmp_path)
    assert_written(log, tmp_path)


def test_integers_of_early_2023_and_control_data_of_2022(tmp_path: Path) -> None:
    log = Written()
    log.values("NT:/FMSInfo/FMSControlData", "double", "d", (0, 32.0), (2, 35.0), (8, 32.0))
    log.values("NT:/FMSInfo/IsRedAlliance", "boolean", "?", (0, False))
    log.values("NT:/FMSInfo/StationNumber", "int", "q", (0, 2))
    log.values("NT:/SmartDashboard/counts", "int[]", "", (0, struct.pack("<3q", 1, -2, 3)))
    log.values("NT:/SmartDashboard/speed", "double", "d", *((step / 10, step / 7) for step in range(90)))
    run = open_log(log.save(tmp_path / "old.wpilog"), HEIGHT).run
    network, hal = run.histories["network"], run.histories["hal"]
    assert list(network.changes("sim.mode")[1]) == ["disabled", "autonomous", "disabled"]
    assert list(hal.changes("alliance_station")[1]) == [5]
    assert network.value_at("nt:/SmartDashboard/counts", 1.0) == (1, -2, 3)
    assert network.value_at("type:/SmartDashboard/counts", 1.0) == "int[]"


def test_a_driver_station_whose_enabling_is_a_text_is_none(tmp_path: Path) -> None:
    log = Written()
    log.values("DS:enabled", "string", "", (0, b"yes"))
    with pytest.raises(PyfrcError, match="this data log has no data of a driver station"):
        script_from_log(log.save(tmp_path / "text.wpilog"))
