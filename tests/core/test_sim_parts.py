"""Parts of a simulation, of a live robot and of scripts, each by itself."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import fields
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from pyfrc_core.log_records import Record
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
from pyfrc_core.sim.engine.robot_side.pace import Pace
from pyfrc_core.sim.engine.robot_side.user_renderer import UserRenderer
from pyfrc_core.sim.engine.robot_side.wpilog import WpiLog
from pyfrc_core.sim.engine.scene import Text, TextStyle
from pyfrc_core.sim.engine.topic_values import TopicValues
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


def test_late_packets_are_counted_each() -> None:
    pace = Pace(1.0, False)
    pace.took(0.019, 2)
    pace.took(0.021, 3)
    assert (pace.late_packets, pace.packet_seconds, pace.worst_packet_seconds) == (3, 0.021, 0.021)


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


def test_a_robot_without_an_address_is_that_of_this_computer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(view, "_no_project", lambda: view.Project(tmp_path / "robot.py"))
    assert view._robot(view.ViewRequest(robot=""), print).title == "this computer"
