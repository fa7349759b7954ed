"""Parts of a simulation, of a live robot and of scripts, each by itself."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import fields
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from wpimath.geometry import Pose2d

from pyfrc_core.errors import UsageError
from pyfrc_core.log_records import Record, read_data_log
from pyfrc_core.processes.lent_streams import lent_streams
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.runtime.scripts.logged_inputs import LoggedInputs
from pyfrc_core.runtime.scripts.recorder import Recorder, _shortest
from pyfrc_core.runtime.scripts.script import InputScript, Step
from pyfrc_core.runtime.scripts.trace_lines import Change
from pyfrc_core.sim import view
from pyfrc_core.sim.engine import snapshot_builder
from pyfrc_core.sim.engine.changes import RecordedFeed, RunBegan
from pyfrc_core.sim.engine.history import History
from pyfrc_core.sim.engine.messages import Replayed, StationState, Update
from pyfrc_core.sim.engine.output_log import OutputLog
from pyfrc_core.sim.engine.recording import Recording
from pyfrc_core.sim.engine.robot_side import console, pace
from pyfrc_core.sim.engine.robot_side.pace import Pace
from pyfrc_core.sim.engine.robot_side.traces import Traces
from pyfrc_core.sim.engine.robot_side.user_renderer import UserRenderer
from pyfrc_core.sim.engine.robot_side.wpilog import WpiLog
from pyfrc_core.sim.engine.scene import Text, TextStyle
from pyfrc_core.sim.engine.topic_values import TopicValues
from pyfrc_core.sim.ui.models.wording import station_name
from pyfrc_core.wpi import station


def update(time_us: int, chosen: str = "", changes: Iterable[Change] = (), steps: Iterable[Step] = ()) -> Update:
    nothing: dict[str, Any] = dict.fromkeys(field.name for field in fields(Update))
    return Update(
        **{
            **nothing,
            "time_us": time_us,
            "changes": tuple(changes),
            "network_changes": (),
            "steps_from": 0,
            "steps": tuple(steps),
            "station": StationState(opmodes={"teleop": chosen}),
        }
    )


# -- recording --------------------------------------------------------------------------------------------------------


def changes(*moments: float) -> list[Change]:
    return [Change(moment, {"x": moment, "lists": (1.0, {"a": 2})}) for moment in moments]


def test_a_recording_is_cut_after_a_moment_and_grows_from_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pyfrc_core.sim.engine.history._BLOCK", 2)
    recording = Recording(InputScript((), 0))
    steps = [Step(20_000, {"a": 1}), Step(40_000, {"a": 2}), Step(60_001, {"a": 3})]
    recording.add(update(100_000, changes=changes(0.0, 0.02, 0.04, 0.06, 0.08, 0.1), steps=steps))
    part = recording.until(60_000)
    assert [change.time for _, change in part.changes] == [0.0, 0.02, 0.04, 0.06]
    assert [step.at_us for step in part.script().steps] == [20_000, 40_000]
    part.add(update(80_000, changes=changes(0.07)))
    assert [change.time for _, change in part.changes.since(3)] == [0.06, 0.07]
    assert len(recording.changes) == 6
    assert part.script().trace != recording.script().trace == recording.digest()


def test_what_is_chosen_while_time_stands_comes_after_that_moment() -> None:
    recording = Recording(InputScript((), 0))
    recording.add(update(0, "first"))
    recording.add(update(0, "second"))
    assert recording.until(0).station.opmodes == {"teleop": "first"}
    assert recording.until(1).station.opmodes == {"teleop": "second"}


def test_a_history_has_what_was_at_a_moment() -> None:
    history: History[str] = History()
    for at_us in (0, 10, 20):
        history.append(at_us, str(at_us))
    assert [item for _, item in history.until(10)] == ["0", "10"]
    assert [item for _, item in history.until(9)] == ["0"]
    assert history.until(10).last == "10"


# -- cursors ----------------------------------------------------------------------------------------------------------


def test_readers_get_what_a_run_begins_with_and_its_changes() -> None:
    recorded: History[Change] = History()
    feed = RecordedFeed(recorded)
    early = feed.cursor()

    def report(number: int, base: dict[str, Any] | None, *moments: float, new_code: bool = False) -> None:
        found = changes(*moments)
        for change in found:
            recorded.append(round(change.time * 1e6), change)
        feed.report(number, 1_000_000, base, found, new_code)

    report(1, None)  # of a replay whose changes are known
    assert early.read() == []
    report(1, {"x": [1.0]})
    report(1, {"x": [2.0]}, 1.02)
    began = RunBegan(1, 1.0, {"x": (1.0,)})
    assert early.read(1) == [began]
    assert early.read() == changes(1.02)
    assert feed.cursor().read() == [began, *changes(1.02)]
    feed.launch(recorded)  # which never comes up
    feed.launch(recorded)
    report(3, {"x": 1.0}, 1.04)
    assert early.read() == [RunBegan(3, 0.0, {}), *changes(1.04)]
    assert feed.cursor().read() == [*changes(1.02), RunBegan(3, 0.0, {}), *changes(1.04)]
    recorded = History()
    feed.launch(recorded)
    report(4, None, new_code=True)
    assert early.read() == []
    report(4, None, 0.0, new_code=True)
    assert early.read() == [RunBegan(4, 0.0, {}, new_code=True), *changes(0.0)]


def test_a_recording_that_is_open_gets_what_new_code_does() -> None:
    again = Recording(InputScript((), 0)).again()
    again.add(Replayed(time_us=20_000, changes=tuple(changes(0.0, 0.02))))
    assert (again.is_open, len(again.changes), again.digest()) == (True, 2, None)
    again.add(update(40_000))
    assert not again.is_open


def test_a_reader_learns_how_much_it_has_missed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pyfrc_core.sim.engine.output_log._PIECE", 1)
    monkeypatch.setattr("pyfrc_core.sim.engine.output_log._MOST", 4)
    log = OutputLog()
    for text in ("abc", "def", "ghi"):
        log.append(text)
    assert log.cursor().read() == "[pyfrc: 6 characters of output were dropped here]\nghi"
    assert log.cursor(from_start=False).read() == ""
    log.append("jklm")
    assert [log.read(0, most)[1] for most in (1, 2, 4, None)] == ["j", "jk", "jklm", "jklm"]


def test_stations_have_names_by_wpilibs_numbers() -> None:
    assert [station_name(number) for number in (1, 4, 6)] == ["Red 1", "Blue 1", "Blue 3"]
    assert [station_name(number) for number in (0, 7, "red", None)] == [""] * 4


def test_late_packets_are_counted_each() -> None:
    pace = Pace(1.0, False)
    pace.took(0.019, 2)
    pace.took(0.021, 3)
    assert (pace.late_packets, pace.packet_seconds, pace.worst_packet_seconds) == (3, 0.021, 0.021)


def test_robot_time_keeps_to_a_schedule_and_gives_up_what_is_too_late(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr(pace, "wall", lambda: now)
    twice = Pace(2.0, False)
    twice.begin(1_000_000)
    assert (twice.wait_for(3_000_000), Pace(0.0, False).wait_for(9_000_000)) == (1.0, 0.0)
    now = 101.25
    assert [twice.wait_for(2_000_000) for _ in range(2)] == [-0.75, -0.75]
    now = 101.75
    assert [twice.wait_for(2_000_000) for _ in range(2)] == [-1.25, 0.0]


def test_speeds_are_those_of_the_last_half_second_and_of_all_without_pauses(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr(pace, "wall", lambda: now)
    one = Pace(1.0, False)
    found = []
    for wall, robot_us in ((100.25, 500_000), (100.5, 500_000), (100.75, 600_000), (101.0, 700_000)):
        now = wall
        one.ran(robot_us)
        found.append((round(one.reached, 3), round(one.average, 3)))
    assert found == [(0.0, 2.0), (0.0, 1.0), (0.2, 0.8), (0.4, 0.7)]
    now = 111.0
    one.begin(700_000)
    assert (one.reached, one.average) == (0.0, 0.7)
    now = 111.25
    one.ran(1_000_000)
    now = 111.5
    one.ran(1_500_000)
    assert (one.reached, one.average) == (2.0, 1.0)
    one.paused = True
    assert one.reached == 0.0


# -- values -----------------------------------------------------------------------------------------------------------


def test_a_topic_that_comes_and_goes_between_two_looks_leaves_no_value() -> None:
    topics = TopicValues()
    topics.take("/x", "double", 1.0)
    topics.take("/x", "", None)
    assert topics.changes() == ({"type:/x": "double"}, [])
    topics.take("/x", "double", 2.0)
    assert topics.changes() == ({"nt:/x": 2.0}, [])
    topics.take("/x", "", None)
    assert topics.changes() == ({}, ["nt:/x"])


def test_a_font_has_a_size_a_family_and_a_weight() -> None:
    renderer = UserRenderer(lambda: None)
    renderer.draw_text("big", (1, 2), fontSize=10, font=("Arial", 24, "bold"))
    assert renderer.drawings() == (Text("big", 1, 2, size=24, style=TextStyle(family="Arial", bold=True)),)


def test_an_axis_is_written_with_the_fewest_digits_of_a_c_float() -> None:
    for wanted in (0.5, 0.1, -0.3, 0.123456, 0.1234567):
        (stored,) = struct.unpack("f", struct.pack("f", wanted))
        assert _shortest(stored) == pytest.approx(wanted, abs=1e-8)
        assert len(repr(_shortest(stored))) <= len(repr(wanted))


def test_a_match_time_that_is_set_back_is_recorded(run: RobotRun) -> None:
    station.set_match_time(0.0)
    recorder = Recorder(run)
    station.set_match_time(7.0)  # by what is not recorded
    recorder.begin_outside()
    station.set_match_time(0.0)
    recorder.end_outside()
    assert [dict(step.writes) for step in recorder.steps_from(0)] == [{"time.remaining": 0.0}]


def test_a_station_that_is_not_attached_sends_nothing() -> None:
    inputs = LoggedInputs()

    def take(name: str, value: object) -> None:
        inputs.take(Record(0, name, "", value))

    take("NT:/FMSInfo/FMSControlData", 0)
    take("DS:enabled", True)
    assert dict(inputs.changes()) == {"control.dsAttached": False}
    take("NT:/FMSInfo/FMSControlData", 33)
    assert dict(inputs.changes()) == {"control.dsAttached": True, "mode": "teleop"}


def test_a_long_trail_keeps_its_ends_and_fewer_and_fewer_points_between(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(snapshot_builder, "_RECENT_POINTS", 8)
    monkeypatch.setattr(snapshot_builder, "_OLDER_POINTS", 16)
    trail = snapshot_builder._Trail()
    for number in range(1000):
        trail.add([(float(number), 0.0)])
        assert len(trail.points) <= 16 + 12
    assert trail.points[0] == (0.0, 0.0)
    assert trail.points[-8:] == tuple((float(number), 0.0) for number in range(992, 1000))
    assert list(trail.points) == sorted(set(trail.points))
    steps = [after[0] - before[0] for before, after in pairwise(trail.points[:-12])]
    assert max(steps) <= 128


# -- files ------------------------------------------------------------------------------------------------------------


def test_a_data_log_is_written_through_a_link(tmp_path: Path) -> None:
    file, link = tmp_path / "there.wpilog", tmp_path / "link.wpilog"
    file.write_bytes(b"before")
    try:
        link.symlink_to(file)
    except OSError:
        pytest.skip("links need a right here")
    WpiLog(link).close()
    assert link.is_symlink()
    assert file.read_bytes().startswith(b"WPILOG")
    with pytest.raises(UsageError, match=r"cannot be written: .*\n  --wpilog names a file"):
        WpiLog(tmp_path)


def test_a_data_log_has_each_kind_of_value_and_every_place(tmp_path: Path) -> None:
    log = WpiLog(tmp_path / "new" / "a.wpilog")
    places = [Pose2d(x, 2, 0.5) for x in (1, 3)]
    values = {"control.enabled": True, "pwm[1].value": 0.5, "custom.name": "a", "joysticks[0].axes": (0.5, -1.0)}
    log.write(20_000, {**values, "robot.x": None}, [], {"nt:/a": 1}, places[0])
    log.write(40_000, {"joysticks[0].buttons": (False, True), "joysticks[0].povs": (90,)}, [], {}, places[1])
    log.write(60_000, {}, ["joysticks[0].axes", "custom.name"], {}, None)
    log.print(60_000, "said")
    log.close()
    found = read_data_log(tmp_path / "new" / "a.wpilog")
    entries = {entry.name: (entry.type_name, [moment / 1e6 for moment in entry.moments]) for entry in found.entries}
    wanted = {
        "DS:enabled": ("boolean", [0.02]),
        "/hal_data/pwm[1].value": ("double", [0.02]),
        "/hal_data/custom.name": ("string", [0.02]),
        "DS:joystick0/axes": ("double[]", [0.02, 0.06]),
        "DS:joystick0/buttons": ("boolean[]", [0.04]),
        "DS:joystick0/povs": ("int64[]", [0.04]),
        "/pose": ("struct:Pose2d", [0.02, 0.04]),
        "console": ("string", [0.06]),
    }
    assert {name: entries.get(name) for name in wanted} == wanted


def test_a_robot_without_an_address_is_that_of_this_computer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(view, "_no_project", lambda: view.Project(tmp_path / "robot.py"))
    assert view._robot(view.ViewRequest(robot=""), print).title == "this computer"


def test_what_is_printed_before_a_data_log_is_open_comes_first_and_after_its_end_nothing() -> None:
    clock, lines = SimpleNamespace(now_us=20_000), list[tuple[int, str]]()
    with lent_streams():
        printed = console.PrintedOutput(clock, "<{}>", keeps=True)  # type: ignore[arg-type]
        assert (printed.stamp_for("one\ntwo"), lines, printed.keeps) == ("<20000>", [], True)
        clock.now_us = 40_000
        printed.begin(lambda now_us, line: lines.append((now_us, line)))
        printed.stamp_for("three")
        assert lines == [(40_000, "one"), (40_000, "two"), (40_000, "three")]
        printed.end()
        assert (printed.stamp_for("four"), lines[3:], printed.keeps) == ("<40000>", [], False)


def test_of_a_replay_that_is_known_only_what_changes_after_it_is_noted() -> None:
    changed: dict[str, Any] = {}

    def look_at_values() -> tuple[dict[str, Any], list[str]]:
        found = dict(changed)
        changed.clear()
        return found, []

    hal_data: Any = SimpleNamespace(changes=lambda: SimpleNamespace(look_at_values=look_at_values))
    traces = Traces(hal_data, None)
    changed["dio[1].value"] = False
    traces.skip_hal(0.02)
    traces.look(0.04)
    assert traces.take(0.04) == ((), ()), "what was known is no change any more"
    changed["dio[2].value"] = False
    traces.look(0.06)
    assert traces.take(0.06) == ((Change(0.06, {"dio[2].value": False}),), ())
    traces.is_on = True
    changed["dio[3].value"] = False
    traces.skip_hal(0.08)
    traces.look(0.1)
    assert traces.take(0.1) == ((Change(0.1, {"dio[3].value": False}),), ()), "a replay that differs is reported"
    assert traces.network_values == {}
