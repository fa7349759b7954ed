"""Traces and input scripts as runs that a window shows: what was enabled when, what went, where a file is damaged."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from pyfrc_core.sim.engine.past_run import PastRun
from pyfrc_core.sim.logs import recordings
from pyfrc_core.sim.logs.recordings import SCRIPT, TRACE, format_of, read_recording

HEAD = {"format": TRACE}


def read(tmp_path: Path, *lines: Mapping[str, Any] | str, kind: str = TRACE) -> tuple[PastRun, str]:
    file = tmp_path / "drive.jsonl"
    file.write_text("".join(each if isinstance(each, str) else json.dumps(each) + "\n" for each in lines), "utf-8")
    return read_recording(file, "drive", kind)


def test_the_mode_of_a_trace_is_that_of_its_switches_and_changes_once(tmp_path: Path) -> None:
    on = {"control.enabled": True}
    run, problem = read(
        tmp_path,
        HEAD,
        {"t": 0.5, "set": {"pwm[0].value": 0.25}},
        {"t": 1.0, "set": on | {"control.autonomous": True}},
        {"t": 1.5, "set": {"pwm[0].value": 0.75}, "gone": ["relay[0].on"]},
        {"t": 2.0, "set": {"control.autonomous": False}},
    )
    assert (problem, run.happened, run.end, run.name) == ("", (), 2.0, "drive")
    network, hal = run.histories["network"], run.histories["hal"]
    assert [list(each) for each in network.changes("sim.mode", 0, 9)] == [
        [0.5, 1.0, 2.0],
        ["disabled", "autonomous", "teleop"],
    ]
    assert list(hal.changes("pwm[0].value", 0, 9)[0]) == [0.5, 1.5]


def test_values_of_the_network_are_apart_from_those_of_the_hal(tmp_path: Path) -> None:
    run, _ = read(tmp_path, HEAD, {"t": 1.0, "set": {"pwm[0].value": 1.0, "nt:/x": 2.0}, "unrepeatable": {"CAN.a": 3}})
    assert set(run.histories["hal"].now) == {"pwm[0].value", "CAN.a"}
    assert set(run.histories["network"].now) == {"nt:/x", "sim.mode"}


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ('{"t": 2.0, "se', "line 3 is cut"),
        ('{"t": 2.0, "se\n', "line 3 is damaged"),
        ('{"t": 0.5, "set": {}}\n', "line 3 is damaged"),  # before the one before
        ('{"t": 1e7, "set": {}}\n', "line 3 is damaged"),
        ('{"t": "x", "set": {}}\n', "line 3 is damaged"),
        ('{"set": {}}\n', "line 3 is damaged"),
        ("7\n", "line 3 is damaged"),
        ('{"t": 1.0, "set": {}}\n', ""),
        ('{"sha256": "0"}\n{', ""),  # behind the end
    ],
)
def test_a_damaged_line_ends_the_run_with_a_mark(tmp_path: Path, line: str, problem: str) -> None:
    run, found = read(tmp_path, HEAD, {"t": 1.0, "set": {"pwm[0].value": 1.0}}, line)
    assert (found, run.end) == (problem, 1.0)
    assert [(each.time, each.level, each.text, each.is_mark) for each in run.happened] == (
        [(1.0, "warning", f"drive: {problem}.", True)] if problem else []
    )
    assert "pwm[0].value" in run.histories["hal"].now


def test_a_script_without_its_trace_says_that_it_shows_inputs_only(tmp_path: Path) -> None:
    head = {"format": SCRIPT, "end": 3.0}
    run, problem = read(tmp_path, head, {"t": 1.0, "set": {"mode": "teleop"}}, kind=SCRIPT)
    assert problem == ""
    (note,) = run.happened
    assert (note.time, note.level, note.is_mark) == (0.0, "warning", False)
    assert note.text.startswith("drive: there is no trace beside it")
    trace = tmp_path / "drive.trace.jsonl"
    trace.write_text(json.dumps(HEAD) + "\n" + json.dumps({"t": 5.0, "set": {}}) + "\n", "utf-8")
    run, _ = read_recording(tmp_path / "drive.jsonl", "drive", SCRIPT)
    assert (run.end, run.happened) == (5.0, ())
    # A trace is shown as it is, also beside another one.
    run, _ = read_recording(trace, "drive", TRACE)
    assert run.end == 5.0


def test_a_very_long_run_is_shown_from_its_beginning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lines = [{"t": number / 10, "set": {"pwm[0].value": number}} for number in range(20)]
    monkeypatch.setattr(recordings, "_LOOKED_AT", 5)
    run, problem = read(tmp_path, HEAD, *lines)
    assert (problem, run.end) == ("", 1.9)
    monkeypatch.setattr(recordings, "MOST_BYTES", 1)
    run, problem = read(tmp_path, HEAD, *lines)
    assert (problem, run.end) == ("it is very long: its first 0 s are shown", 0.3)


def test_the_format_is_that_of_the_first_line() -> None:
    assert format_of(b'{"format": "%s"}\n{' % TRACE.encode()) == TRACE
    assert format_of(b'\xef\xbb\xbf{"format": "%s"}' % SCRIPT.encode()) == SCRIPT
    assert [format_of(head) for head in (b"", b"[]", b'{"format": "other"}', b"\xff", b"{}")] == [""] * 5
