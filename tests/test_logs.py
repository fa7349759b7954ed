"""Logs from elsewhere: what readers find in them, and what they say about those that are damaged."""

from __future__ import annotations

import functools
import json
import struct
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from loops import for_each
from written_logs import BOOT, SECOND, Written, a_match

from pyfrc_core.errors import UsageError
from pyfrc_core.sim.engine.past_run import PastRun
from pyfrc_core.sim.engine.value_history import MISSING
from pyfrc_core.sim.logs import LogError, open_log
from pyfrc_core.sim.logs.align import moment_of, offset_of
from pyfrc_core.sim.logs.wpilog import read_wpilog
from pyfrc_core.sim.ui.web.plots import series

HEIGHT = 27.0


def network(run: PastRun, path: str) -> tuple[list[float], list[Any]]:
    times, values = run.histories["network"].changes(path)
    return list(times), list(values)


def test_a_log_has_values_modes_and_output(tmp_path: Path) -> None:
    opened = open_log(a_match().save(tmp_path / "match.wpilog"), HEIGHT)
    run = opened.run
    assert (opened.problem, run.name, run.end) == ("", "match.wpilog", 19.9)
    assert network(run, "sim.mode") == (
        [0.0, 1.0, 2.0, 8.0, 9.0, 10.0, 18.0],
        ["disabled", "disabled autonomous", "autonomous", "disabled autonomous", "disabled", "teleop", "disabled"],
    )
    assert network(run, "nt:/SmartDashboard/speed")[1][:3] == [0.0, 1 / 7, 2 / 7]
    assert run.histories["network"].values_at(0.15)["nt:/SmartDashboard/speed"] == 1 / 7
    assert run.histories["network"].now["type:/SmartDashboard/speed"] == "double"
    assert [(each.time, each.text) for each in run.happened] == [(3.0, "hello"), (4.0, "ValueError: it broke")]


def test_wpilibs_own_writer_is_read(tmp_path: Path) -> None:
    from pyfrc_core.wpi import geometry, logs

    log = logs.LogWriter(tmp_path / "ours.wpilog", "a test")
    number, texts = log.entry("/hal_data/pwm[0].value", "number"), log.entry("NT:/text", "text")
    flags, place = log.entry("NT:/flags", "booleans"), log.poses("/pose", log.stamp(20_000))
    number(0.5, log.stamp(20_000))
    place(geometry.pose(3.048, 3.048, 1.0), log.stamp(20_000))
    texts("one", log.stamp(40_000))
    flags([True, False], log.stamp(40_000))
    number(-0.5, log.stamp(60_000))
    log.close()
    run = open_log(tmp_path / "ours.wpilog", HEIGHT).run
    assert [list(each) for each in run.histories["hal"].changes("pwm[0].value")] == [[0.02, 0.06], [0.5, -0.5]]
    now = run.histories["network"].now
    assert (now["nt:/text"], now["nt:/flags"]) == ("one", (True, False))
    assert now["nt:/pose/translation/x"] == 3.048
    assert now["sim.pose"] == pytest.approx((10.0, HEIGHT - 10.0, -1.0))


def test_structs_and_their_arrays_unfold(tmp_path: Path) -> None:
    log = Written()
    log.values(".schema/struct:Rotation2d", "structschema", "", (0, b"double value"))
    schema = b"double speed;Rotation2d angle"
    log.values(".schema/struct:SwerveModuleState", "structschema", "", (0, schema))
    two, one = struct.pack("<4d", 1, 2, 3, 4), struct.pack("<2d", 5, 6)
    log.values("NT:/modules", "struct:SwerveModuleState[]", "", (1, two), (2, one))
    log.values("/raw", "struct:Unknown", "", (1, b"abc"), (2, b"def"))
    run = open_log(log.save(tmp_path / "a.wpilog"), HEIGHT).run
    assert network(run, "nt:/modules/0/speed") == ([0.0, 1.0], [1.0, 5.0])
    at_first = run.histories["network"].values_at(0.5)
    assert at_first["nt:/modules/1/angle/value"] == 4.0
    assert "nt:/modules/1/speed" not in run.histories["network"].now
    assert run.histories["network"].now["nt:/raw"]["type"] == "Unknown"


@for_each("table", ["/DriverStation", "NT:/AdvantageKit/DriverStation"])
def test_layouts_of_advantagekit_and_pykit(tmp_path: Path, table: str) -> None:
    log = Written()
    log.values(f"{table}/Enabled", "boolean", "?", (0, False), (1, True))
    log.values(f"{table}/Autonomous", "boolean", "?", (0, True))
    log.values("/DriverStation/Joystick0/AxisValues", "float[]", "", (1, struct.pack("<2f", 0.5, -1)))
    log.values("/DriverStation/Joystick0/ButtonCount", "int64", "q", (0, 3))
    log.values("/DriverStation/Joystick0/ButtonValues", "int64", "q", (0, 0), (2, 0b101))
    log.values("/DriverStation/AllianceStation", "int64", "q", (0, 5))
    log.values("/RealOutputs/Console", "string", "", (1, b"first\nError: second\n"))
    log.values("/SystemStats/BrownedOut", "boolean", "?", (0, False), (2, True))
    run = open_log(log.save(tmp_path / "akit.wpilog"), HEIGHT).run
    assert network(run, "sim.mode")[1] == ["disabled autonomous", "autonomous"]
    now = run.histories["hal"].now
    assert now["joysticks[0].axes"] == (0.5, -1.0)
    assert now["joysticks[0].buttons"][-3:] == (True, False, True)
    assert now["alliance_station"] == 5
    assert [each.text for each in run.happened] == ["first\nError: second", "brownout"]


def test_a_log_of_2027(tmp_path: Path) -> None:
    """Its driver station is one word, a POV has a bit for each direction, and the robot is in a list."""
    log = Written()
    word = b"uint64 opModeHash:56;enum{unknown=0,autonomous=1,teleoperated=2,utility=3}uint64 robotMode:2;"
    word += b"bool enabled:1;bool eStop:1;bool fmsAttached:1;bool dsAttached:1;"
    log.values("/.schema/struct:ControlWord", "structschema", "", (0, word))
    words = [
        (time, struct.pack("<Q", mode << 56 | enabled << 58))
        for time, mode, enabled in ((0, 2, 0), (1, 1, 1), (2, 2, 1))
    ]
    log.values("DS:controlWord", "struct:ControlWord", "", *words)
    log.values("DS:joystick0/povs", "int64[]", "", (0, struct.pack("<q", 0)), (1, struct.pack("<q", 3)))
    log.values("NT:/DriverStation/IsRedAlliance", "boolean", "?", (0, False))
    run = open_log(log.save(tmp_path / "a.wpilog"), HEIGHT).run
    assert network(run, "sim.mode") == ([0.0, 1.0, 2.0], ["disabled", "autonomous", "teleop"])
    assert list(run.histories["hal"].changes("joysticks[0].povs")[1]) == [(-1,), (45,)]
    assert run.histories["hal"].now["alliance_station"] == 4


def test_logs_are_aligned_by_what_the_robot_did(tmp_path: Path) -> None:
    match = open_log(a_match().save(tmp_path / "match.wpilog"), HEIGHT).run.histories["network"]
    practice = Written()
    practice.values("DS:enabled", "boolean", "?", (0, False), (3, True), (4, False), (5, True), (7, False))
    practice.values("DS:autonomous", "boolean", "?", (0, False), (3.5, True), (6.5, False))
    other = open_log(practice.save(tmp_path / "practice.wpilog"), HEIGHT).run.histories["network"]
    assert (moment_of(match, "enabled"), moment_of(other, "enabled")) == (2.0, 3.0)
    assert (moment_of(match, "match"), moment_of(other, "match")) == (2.0, 5.0)
    assert (offset_of(other, match, "enabled"), offset_of(other, match, "match")) == (-1.0, -3.0)
    assert offset_of(other, match, "start") == 0.0


def test_records_of_several_threads_are_put_in_order(tmp_path: Path) -> None:
    log = Written()
    log.values("/a", "int64", "q", (1, 1), (3, 3), (2, 2))
    run = open_log(log.save(tmp_path / "a.wpilog"), HEIGHT).run
    assert network(run, "nt:/a") == ([0.0, 1.0, 2.0], [1, 2, 3])


def test_the_time_of_day_is_that_of_the_robot(tmp_path: Path) -> None:
    log = a_match()
    noon = datetime(2026, 3, 7, 12, tzinfo=timezone.utc)
    log.values("systemTime", "int64", "q", (0, 1_000), (5, round(noon.timestamp() * 1e6) + 5 * SECOND))
    assert open_log(log.save(tmp_path / "a.wpilog"), HEIGHT).when == noon


def test_a_field_that_is_never_set_is_no_place(tmp_path: Path) -> None:
    log = a_match()
    log.values("NT:/SmartDashboard/Field/Robot", "double[]", "", (0, struct.pack("<3d", 0, 0, 0)))
    file = log.save(tmp_path / "a.wpilog")
    assert "sim.pose" not in open_log(file, HEIGHT).run.histories["network"].now
    log.values("NT:/SmartDashboard/Field/Robot", "double[]", "", (1, struct.pack("<3d", 3.048, 3.048, 90)))
    now = open_log(log.save(file), HEIGHT).run.histories["network"].now
    assert now["sim.pose"] == pytest.approx((10, HEIGHT - 10, -1.5708), abs=1e-4)
    # Another one moves, and is the robot.
    moved = [(step, struct.pack("<3d", step * 0.3048, 3.048, 0)) for step in range(1, 16)]
    log.values("NT:/SmartDashboard/Field/fused_pose", "double[]", "", *moved)
    now = open_log(log.save(file), HEIGHT).run.histories["network"].now
    assert now["sim.pose"] == pytest.approx((15, HEIGHT - 10, 0), abs=1e-4)


def test_times_before_the_robots_clock_began_are_those_of_the_log(tmp_path: Path) -> None:
    """A dashboard that was there before has negative times."""
    log = a_match()
    log.values("NT:/SmartDashboard/Auto/selected", "string", "", (1, b"one"))
    log.data += bytes([3 | 3 << 2 | 7 << 4]) + struct.pack("<IIq", 5, 3, -517 * SECOND) + b"two"
    opened = open_log(log.save(tmp_path / "a.wpilog"), HEIGHT)
    assert (opened.problem, opened.run.end) == ("", 19.9)
    assert opened.run.histories["network"].now["nt:/SmartDashboard/Auto/selected"] in ("one", "two")


def test_a_file_that_goes_on_with_another_one_has_records_before_their_names(tmp_path: Path) -> None:
    """WPILib begins a new file when one is large."""
    log = a_match()
    head, first, name = (Written() for _ in range(3))
    first.record(9, struct.pack("<d", 4.5), BOOT)
    for _ in range(8):
        name.start("NT:/early", "double")
    begin = len(head.data)
    before = len(name.data)
    name.start("NT:/late", "double")
    log.data = first.data + log.data[begin:] + name.data[before:]
    opened = open_log(log.save(tmp_path / "a.2.wpilog"), HEIGHT)
    assert opened.problem == ""
    assert opened.run.histories["network"].now["nt:/late"] == 4.5


def test_an_entry_that_begins_again_goes_on(tmp_path: Path) -> None:
    log = Written()
    log.values("/a", "int64", "q", (1, 1))
    log.record(0, b"\x01" + struct.pack("<I", 1), BOOT + SECOND)
    log.values("/a", "int64", "q", (2, 2))
    log.values("/a", "string", "", (3, b"text"))
    run = open_log(log.save(tmp_path / "a.wpilog"), HEIGHT).run
    assert network(run, "nt:/a")[1] == [1, 2]
    assert network(run, "nt:/a (string)")[1] == ["text"]


def test_a_cut_log_is_shown_until_there(tmp_path: Path) -> None:
    log = a_match()
    whole = len(log.data)
    log.values("NT:/late", "double", "d", (19, 1.0))
    file = log.save(tmp_path / "cut.wpilog")
    file.write_bytes(log.data[:-3])
    opened = open_log(file, HEIGHT)
    assert opened.problem.startswith("it is cut at byte ")
    assert int(opened.problem.split()[5].rstrip(",").replace(",", "")) > whole
    assert opened.run.happened[-1].text == f"cut.wpilog: {opened.problem}."
    assert len(network(opened.run, "nt:/SmartDashboard/speed")[0]) == 200


def test_zeros_after_a_loss_of_power_and_damage_in_the_middle(tmp_path: Path) -> None:
    log = a_match()
    file = tmp_path / "a.wpilog"
    file.write_bytes(log.data + bytes(5000))
    opened = open_log(file, HEIGHT)
    assert opened.problem == f"from byte {len(log.data):,} on, it has only zeros, as after a loss of power"
    place = log.data.index(struct.pack("<d", 100 / 7)) - 17
    file.write_bytes(log.data[:place] + b"\xff" * 40 + log.data[place:])
    opened = open_log(file, HEIGHT)
    assert opened.problem == f"it is damaged at byte {place:,}"
    assert len(network(opened.run, "nt:/SmartDashboard/speed")[0]) == 200
    assert [each.text for each in opened.run.happened][:2] == ["hello", "ValueError: it broke"]


def test_a_very_long_log_is_shown_as_far_as_memory_allows(tmp_path: Path) -> None:
    file = a_match().save(tmp_path / "long.wpilog")
    found = read_wpilog(file, most=100)
    assert sum(len(column.moments) for column in found.columns.values()) == 100
    assert "its first 100 records are read" in found.problem


@functools.cache
def _whole(kind: str) -> bytes:
    """Return a log of each kind, whole."""
    if kind == "wpilog":
        log = a_match()
        log.values("systemTime", "int64", "q", (0, 1_750_000_000_000_000), (5, 1_750_000_005_000_000))
        log.values("DS:joystick0/axes", "float[]", "", (1, struct.pack("<2f", 0.5, -1)))
        return log.data
    if kind == "dslog":
        return struct.pack(">i", 4) + _stamp(0) + ds_record(DISABLED) * 20 + ds_record(AUTO) * 20
    if kind == "dsevents":
        event = b"<TagVersion>1 <time> 00.100 <message> Warning: low battery"
        return struct.pack(">i", 4) + _stamp(0) + (_stamp(0.4) + struct.pack(">i", len(event)) + event) * 5
    lines = ({"t": step / 50, "set": {"pwm[0].value": step, "control.enabled": step > 3}} for step in range(40))
    return "".join(json.dumps(each) + "\n" for each in ({"format": "pyfrc-trace 2"}, *lines)).encode()


@settings(max_examples=120, deadline=None)
@given(st.data())
def test_no_damage_is_more_than_a_sentence(tmp_path_factory: pytest.TempPathFactory, data: st.DataObject) -> None:
    """Cut anywhere, with bytes changed anywhere: either a run comes of it, or an error for people."""
    kind = data.draw(st.sampled_from(["wpilog", "wpilog", "dslog", "dsevents", "jsonl"]))
    whole = bytearray(_whole(kind))
    for _ in range(data.draw(st.integers(0, 4))):
        whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    file = tmp_path_factory.getbasetemp() / f"damaged.{kind}"
    file.write_bytes(whole[: data.draw(st.integers(0, len(whole)))])
    try:
        run = open_log(file, HEIGHT).run
    except LogError:
        return
    for history in run.histories.values():
        assert history.values_at(run.end / 2) is not None
        for path in history.paths():
            times, values = history.changes(path)
            assert len(times) == len(values)
            assert list(times) == sorted(times)


@for_each(
    "name, content, says",
    [
        ("empty.wpilog", b"", "empty.wpilog: this file is empty"),
        ("only_a_head.wpilog", b"WPILOG\x00\x01", "there is nothing in it: it ends within its header"),
        ("nothing.wpilog", b"WPILOG\x00\x01\x00\x00\x00\x00", "there is nothing in it: it has no values"),
        ("photo.wpilog", b"\x89PNG\r\n\x1a\n" * 9, "this is a picture, not a log"),
        ("match.hoot", b"CTRE", "owlet -f wpilog"),
        ("match.revlog", b"REV", "revlog-converter FILE.revlog"),
        ("match.rlog", b"\x00\x00", "this is binary data, not a log"),
        ("a.jsonl", b'{"format": "another"}\n', "this is JSON, not a log"),
    ],
)
def test_what_is_no_log_is_said_in_a_sentence(tmp_path: Path, name: str, content: bytes, says: str) -> None:
    file = tmp_path / name
    file.write_bytes(content)
    with pytest.raises(LogError, match=says.replace(".", r"\.")):
        open_log(file, HEIGHT)


def test_a_directory_names_its_newest_logs(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="There are no logs in it"):
        open_log(tmp_path, HEIGHT)
    a_match().save(tmp_path / "a.wpilog")
    with pytest.raises(UsageError, match=r"this is a directory, not a log\n  Its newest logs: a\.wpilog"):
        open_log(tmp_path, HEIGHT)


# -- the driver station's logs ----------------------------------------------------------------------------------------


def _stamp(seconds: float) -> bytes:
    since_1904 = (
        datetime(2026, 3, 7, 12, tzinfo=timezone.utc) - datetime(1904, 1, 1, tzinfo=timezone.utc)
    ).total_seconds()
    return struct.pack(">qQ", int(since_1904 + seconds), 0)


#: Bits of a record's status, which are 0 where it is so.
DISABLED, AUTO, TELEOP, BROWNOUT = 1, 2, 4, 128


def ds_record(status: int, volts: float = 12.5, kind: int = 0, power: bytes = b"") -> bytes:
    return (
        struct.pack(">BbHBBBBH", 20, 0, round(volts * 256), 100, 255 & ~status, 90, 0, 0)
        + bytes([0, 0, 0, kind])
        + power
    )


def test_the_driver_stations_log(tmp_path: Path) -> None:
    records = [ds_record(DISABLED)] * 10 + [ds_record(AUTO)] * 5 + [ds_record(0)] * 2 + [ds_record(AUTO)] * 3
    records += [ds_record(TELEOP | BROWNOUT, 6.5)] * 10 + [ds_record(DISABLED, 200.0)]
    (tmp_path / "match.dslog").write_bytes(struct.pack(">i", 4) + _stamp(0) + b"".join(records) + b"\x01\x02")
    event = b"<TagVersion>1 <time> 00.100 <message> Warning: low battery <TagVersion>1 <time> 1 <details> joystick 0"
    (tmp_path / "match.dsevents").write_bytes(
        struct.pack(">i", 4) + _stamp(0) + _stamp(0.4) + struct.pack(">i", len(event)) + event + b"\x00" * 7
    )
    opened = open_log(tmp_path / "match.dslog", HEIGHT)
    assert opened.when == datetime(2026, 3, 7, 12, tzinfo=timezone.utc)
    assert opened.problem.startswith("it is cut at byte ")
    run = opened.run
    # A packet that is lost says no mode.
    assert network(run, "sim.mode") == ([0.0, 0.2, 0.4, 0.6], ["disabled", "autonomous", "teleop", "disabled"])
    assert network(run, "nt:/DSLog/BatteryVoltage")[1] == [12.5, 6.5, MISSING]
    assert [each.text for each in run.happened][:3] == ["Warning: low battery", "joystick 0", "brownout"]
    events = open_log(tmp_path / "match.dsevents", HEIGHT)
    assert [each.text for each in events.run.happened][:2] == ["Warning: low battery", "joystick 0"]
    assert "cut at byte" in events.problem


def test_no_data_of_the_driver_station_is_a_gap(tmp_path: Path) -> None:
    """Without a robot, the voltage is 0xFFFF, about 256 V; without a power distribution, there are no currents."""
    none = ds_record(DISABLED, 0xFFFF / 256)
    ctre = ds_record(0, 12.0, 25, bytes(25))
    records = [none] * 50 + [ds_record(0, 12 + step / 256) for step in range(500)] + [none] * 50 + [ctre] * 50
    (tmp_path / "match.dslog").write_bytes(struct.pack(">i", 4) + _stamp(0) + b"".join(records))
    run = open_log(tmp_path / "match.dslog", HEIGHT).run
    history = run.histories["network"]
    times, volts = network(run, "nt:/DSLog/BatteryVoltage")
    assert times[0] == pytest.approx(1.0)
    assert volts.index(MISSING) == 500
    assert volts[-1] == 12.0
    assert "nt:/DSLog/BatteryVoltage" not in history.values_at(11.5)
    assert "nt:/DSLog/Currents/0" not in history.values_at(11.5)
    assert history.value_at("nt:/DSLog/Currents/0", 12.5) == 0.0
    for points in (50, 2000):
        curve = series(history, "nt:/DSLog/BatteryVoltage", 0.0, run.end, points)
        assert curve["kind"] == "number"
        assert curve["v"].count(None) == 1
        assert dict(zip(curve["t"], curve["v"], strict=True))[12.0] == 12.0  # where the gap ends


def test_the_currents_of_both_kinds_of_power_distribution(tmp_path: Path) -> None:
    rev = sum(channel * 8 << channel // 3 * 32 + channel % 3 * 10 for channel in range(20)).to_bytes(27, "little")
    rev = b"\x01" + rev + bytes(16 * each for each in (1, 2, 3, 4)) + b"\x00"
    ctre = sum(channel * 8 << 158 - channel // 6 * 64 - channel % 6 * 10 for channel in range(16)).to_bytes(21, "big")
    ctre = b"\x01" + ctre + b"\x00" * 3
    for kind, power, channels, last in ((33, rev, 24, 4.0), (25, ctre, 16, 15.0)):
        file = tmp_path / f"{kind}.dslog"
        file.write_bytes(struct.pack(">i", 4) + _stamp(0) + ds_record(DISABLED, 12, kind, power) * 3)
        now = open_log(file, HEIGHT).run.histories["network"].now
        assert now["nt:/DSLog/Currents/7"] == 7.0
        assert now[f"nt:/DSLog/Currents/{channels - 1}"] == last
    (tmp_path / "old.dslog").write_bytes(struct.pack(">i", 2) + _stamp(0) + bytes(100))
    with pytest.raises(LogError, match="versions 3 and 4 can be read"):
        open_log(tmp_path / "old.dslog", HEIGHT)


# -- pyfrc's own files ------------------------------------------------------------------------------------------------


def test_recordings_and_traces(tmp_path: Path) -> None:
    script, trace = tmp_path / "drive.jsonl", tmp_path / "drive.trace.jsonl"
    steps = [{"format": "pyfrc-input 1", "end": 2.0}, {"t": 1.0, "set": {"mode": "teleop"}}]
    script.write_text("".join(json.dumps(each) + "\n" for each in steps))
    opened = open_log(script, HEIGHT)
    assert network(opened.run, "sim.mode") == ([1.0], ["teleop"])
    assert "inputs only" in opened.run.happened[0].text
    lines: list[dict[str, Any]] = [
        {"format": "pyfrc-trace 2"},
        {"t": 0.02, "set": {"pwm[0].value": 0.0, "control.enabled": False}},
        {"t": 1.0, "set": {"pwm[0].value": 0.5, "control.enabled": True, "control.autonomous": True}},
        {"t": 1.5, "set": {}, "gone": ["pwm[0].value"]},
        {"sha256": "0"},
    ]
    trace.write_text("".join(json.dumps(each) + "\n" for each in lines))
    run = open_log(script, HEIGHT).run
    assert network(run, "sim.mode") == ([0.02, 1.0], ["disabled", "autonomous"])
    assert list(run.histories["hal"].changes("pwm[0].value", 0, 1.2)[1]) == [0.0, 0.5]
    assert "pwm[0].value" not in run.histories["hal"].now
    trace.write_text("".join(json.dumps(each) + "\n" for each in lines[:3]) + '{"t": 1.2, "se')
    assert open_log(trace, HEIGHT).problem == "line 4 is cut"
