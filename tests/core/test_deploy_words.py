"""What a deploy prints, what it knows of a start, and what it accepts from a robot: in this process."""

from __future__ import annotations

import io
import json
import os
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from loops import for_each

from pyfrc_core.deploy.agent import imports, release_record
from pyfrc_core.deploy.agent import program as agent_program
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.disk import fingerprint
from pyfrc_core.deploy.agent.logs import RobotLogs
from pyfrc_core.deploy.agent.program import Program, process_state
from pyfrc_core.deploy.agent.release_record import Boot, Standing
from pyfrc_core.deploy.agent.start_monitor import StartMonitor
from pyfrc_core.deploy.progress import DeployProgress, JsonProgress, progress_for, with_robot_option
from pyfrc_core.deploy.responses import Raw, ResponseError, parse
from pyfrc_core.deploy.starting import _known_of
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE
from pyfrc_core.errors import UsageError

# -- what is printed ---------------------------------------------------------------------------------------------------


def report_all(progress: DeployProgress) -> None:
    progress.add_robot_option = lambda text: with_robot_option(text, "10.0.0.2", None)
    with progress.phase("look") as phase:
        phase.detail = "found"
    progress.note("See pyfrc deploy-info.")
    progress.warning("odd\x07: pyfrc logs")
    progress.output("one\ntwo\n")
    progress.result({"release": 3}, "Deployed.")


def test_a_deploy_in_words() -> None:
    shown = io.StringIO()
    report_all(DeployProgress(shown))
    phase, *lines = shown.getvalue().splitlines()
    assert phase.split()[:2] == ["look", "found"]
    assert phase.endswith(" s")
    said = ["See pyfrc deploy-info --robot 10.0.0.2.", "warning: odd\\x07: pyfrc logs --robot 10.0.0.2"]
    assert lines == [*said, "  | one", "  | two", "Deployed."]
    shown.truncate(shown.seek(0))
    quiet = DeployProgress(shown, quiet=True)
    report_all(quiet)
    assert shown.getvalue().splitlines() == [said[1], "  | one", "  | two"]
    quiet.result({}, "As asked.", requested=True)
    assert shown.getvalue().endswith("\nAs asked.\n")


def test_a_deploy_as_json(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = io.StringIO()
    progress = JsonProgress(shown)
    report_all(progress)
    progress.failure(UsageError("no", where="a.py:1", remedy="Do\x7f."))
    assert "\x7f" not in shown.getvalue()
    first, *events = map(json.loads, shown.getvalue().splitlines())
    assert (first.pop("seconds") >= 0, first) == (True, {"event": "phase", "phase": "look", "detail": "found"})
    error = {"kind": "Usage", "message": "no", "where": "a.py:1", "remedy": "Do\x7f.", "exit_code": 2}
    assert events == [
        {"event": "note", "text": "See pyfrc deploy-info --robot 10.0.0.2."},
        {"event": "warning", "text": "odd\x07: pyfrc logs --robot 10.0.0.2"},
        {"event": "output", "text": "one\ntwo\n"},
        {"event": "result", "release": 3},
        {"event": "error", **error},
    ]
    # The output of tests must not be among the JSON.
    assert progress.child_output is sys.stderr
    assert DeployProgress(shown).child_output is shown
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(io.BytesIO(), encoding="ascii"))
    assert [type(progress_for(each)) for each in (True, False)] == [JsonProgress, DeployProgress]
    assert progress_for(as_json=False, quiet=True).quiet


@for_each(
    "state, known",
    [
        ({"age": 0}, "the robot has not started it yet"),
        ({"age": 0, "seen": True}, "the robot has not started it again yet"),
        ({"age": 3}, "its process has run for 3 s"),
        ({"age": 3, "cpu": 0.0}, "its process has run for 3 s, has used 0.0 s of processor time"),
        (
            {"age": 3, "network_tables": False},
            "its process has run for 3 s and does not serve NetworkTables yet",
        ),
        (
            {"age": 3, "cpu": 1.26, "network_tables": True},
            "its process has run for 3 s, has used 1.3 s of processor time and serves NetworkTables (its imports are"
            " complete)",
        ),
    ],
)
def test_what_is_known_of_a_start(state: dict[str, Any], known: str) -> None:
    assert _known_of(SimpleNamespace(**{"seen": False, "cpu": None, "network_tables": None, **state})) == known  # type: ignore[arg-type]


# -- what a robot sends ------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Inner:
    name: str


@dataclass(frozen=True)
class Outer:
    flag: bool
    count: int
    seconds: float | None
    raw: Raw
    names: tuple[str, ...]
    inner: Inner
    by_name: dict[str, Inner]
    record: Mapping[str, str]
    maybe: Inner | None


SENT = {
    "flag": True,
    "count": 3,
    "seconds": 1,
    "raw": "a\nb",
    "names": ["x\ny", "z"],
    "inner": {"name": "n", "more": 1},
    "by_name": {"k": {"name": "m"}},
    "record": '{"a": 1, "b": "c"}',
    "maybe": None,
}


def test_a_response_is_checked_and_converted_by_its_types() -> None:
    found = parse(Outer, SENT)
    assert (found.flag, found.count, found.seconds, found.raw, len(found.names)) == (True, 3, 1.0, "a\nb", 2)
    assert "\n" not in found.names[0]
    assert (found.inner, found.by_name, found.maybe) == (Inner("n"), {"k": Inner("m")}, None)
    assert found.record == {"a": "1", "b": "c"}
    assert parse(Outer, {**SENT, "seconds": None, "maybe": {"name": "q"}, "record": "{"}).maybe == Inner("q")
    assert [parse(Outer, {**SENT, "record": each}).record for each in ("[1]", 5, "{")] == [{}] * 3


@pytest.mark.parametrize(
    ("wrong", "problem"),
    [
        ({"flag": 1}, "'flag': 1 is not true or false"),
        ({"count": True}, "'count': true is not a number"),
        ({"count": -1}, "'count': -1 is out of range"),
        ({"count": 1 << 70}, f"'count': {1 << 70} is out of range"),
        ({"seconds": True}, "'seconds': true is not a time"),
        ({"seconds": -0.1}, "'seconds': -0.1 is not a time"),
        ({"seconds": "1"}, "'seconds': \"1\" is not a time"),
        ({"names": "xy"}, "'names': \"xy\" is not a list"),
        ({"names": ["x", None]}, "'names': null is not a text"),
        ({"by_name": []}, "'by_name': a list is not an object"),
        ({"by_name": {"k": {"name": {}}}}, "'by_name': 'name': an object is not a text"),
        ({"inner": {}}, "'inner': 'name' is missing"),
        ({"maybe": {}}, "'maybe': 'name' is missing"),
        ({"count": 10**5000}, "'count': a huge number is out of range"),
    ],
)
def test_a_wrong_field_of_a_response_is_named(wrong: dict[str, Any], problem: str) -> None:
    with pytest.raises(ResponseError) as error:
        parse(Outer, {**SENT, **wrong})
    assert str(error.value) == problem


# -- on the robot ------------------------------------------------------------------------------------------------------


def test_logs_are_named_newest_first_and_read_in_pieces(tmp_path: Path) -> None:
    robot = SimpleNamespace(layout=ROBORIO.layout, of=lambda path: tmp_path / path[1:])
    steps: list[str] = []
    activity = SimpleNamespace(begin=steps.append, step=lambda: steps.append("step"))
    usb, home = tmp_path / "u/logs", tmp_path / ROBORIO.layout.home[1:] / "logs"
    now = time.time()
    for directory, name, age in ((usb, "sub/old.wpilog", 500), (home, "new.WPILOG", 0), (home, "notes.txt", 0)):
        (directory / name).parent.mkdir(parents=True, exist_ok=True)
        (directory / name).write_bytes(b"0123456789")
        os.utime(directory / name, (now - age, now - age))
    logs = RobotLogs(robot, activity)  # type: ignore[arg-type]
    named = logs.named()
    assert named["older"] == 0
    assert [(each["name"], each["usb"], each["written"], each["size"]) for each in named["logs"]] == [
        ("new.WPILOG", False, True, 10),
        ("sub/old.wpilog", True, False, 10),
    ]
    path = named["logs"][1]["path"]
    assert path == "/u/logs/sub/old.wpilog"
    assert logs.piece({"path": path, "offset": 3, "count": 4}) == b"3456"
    assert logs.piece({"path": path, "offset": 8, "count": 4}) == b"89"
    hashed = logs.hashed({"path": path, "size": 4})
    assert hashed == {"sha256": "1be2e452b46d7a0d9656bbb1f768e8248eba1b75baed65f5d99eafa948899a6a", "size": 10}
    assert steps == ["hash", "step"]


@for_each(
    "record, standing",
    [
        ({}, Standing(False, False, 0.0)),
        ({"files": 1}, Standing(True, False, 0.0)),
        ({"ran": True, "lasted": 2.5}, Standing(True, True, 2.5)),
        ({"ran": True, "ended": True, "lasted": None}, Standing(True, False, 0.0)),
        ({"ran": False, "ended": False}, Standing(True, False, 0.0)),
    ],
)
def test_how_well_a_release_runs(record: dict[str, Any], standing: Standing) -> None:
    assert release_record.standing(record) == standing


def test_a_record_says_what_was_seen_of_its_program() -> None:
    boot, long = Boot("now", 100.0), release_record.LONG
    watched = release_record.after_watch({"a": 1}, True, False, 7, 12.0, boot)
    assert watched == {"a": 1, "ran": True, "ended": False, "lasted": 12.0, "process": {"boot": "now", "id": 7}}
    ended = release_record.after_watch(watched, False, True, 8, 90.0, boot)
    assert ended == {"a": 1, "ran": True, "ended": True, "lasted": 12.0, "process": None}
    assert release_record.after_watch({}, True, False, 7, long + 9, Boot("", None))["process"] is None
    assert release_record.after_watch({}, True, False, 7, long + 9, boot)["lasted"] == long
    now: Callable[..., Any] = release_record.now
    assert now(ended, boot, {8}, 500.0) == ended, "no watch has seen it run"
    assert now(watched, boot, {7}, long) == {**watched, "lasted": long}
    assert now(watched, boot, {7}, 13.04) == {**watched, "lasted": 13.0}
    assert now(watched, boot, {7}, 3.0) == now(watched, boot, {7}, None) == watched
    assert now(watched, boot, {9}, 13.0) == {**watched, "ended": True}
    # After another boot, only one that begins late is a restart.
    later = Boot("later", 500.0)
    assert now(watched, later, {9}, 20.0)["ended"] is True
    assert now(watched, Boot("later", 30.0), {9}, 20.0)["ended"] is False
    assert now(watched, later, set(), None)["ended"] is False


def test_a_program_and_its_console() -> None:
    ended: list[bool] = []
    console = SimpleNamespace(disconnect=lambda: ended.append(True))
    host: Any = SimpleNamespace(console=lambda: console, serves_network_tables=lambda process: process == os.getpid())
    state = process_state(host, os.getpid())
    assert (state["network_tables"], state["cpu"] > 0, sorted(state)) == (True, True, ["cpu", "network_tables"])
    assert process_state(host, 1 << 30) == {}
    Program(host).close()
    assert ended == [True]


def test_processes_are_listed_seldom_while_the_program_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(agent_program, "_REPORT_SECONDS", 1000.0)
    listed, running = list[int](), [True]

    def processes() -> set[int]:
        listed.append(len(listed))
        return {len(listed)}

    console = SimpleNamespace(receive=lambda seconds: "")
    host: Any = SimpleNamespace(console=lambda: console, processes=processes, is_running=lambda process: running[0])
    program, monitor = Program(host), StartMonitor(())
    monitor.restarted(0.0)
    for expected in (1, 1):
        program._poll(monitor)
        assert (len(listed), monitor.process) == (expected, 1)
    running[0] = False
    program._poll(monitor)
    assert len(listed) == 2


def test_how_an_administrator_types_a_command() -> None:
    assert ROBORIO.layout.by_administrator == "as admin on the robot:"
    assert SYSTEMCORE.layout.by_administrator == "on the robot: sudo"


def test_packages_are_known_by_the_names_of_their_directories(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = tmp_path / "first", tmp_path / "second"
    for place, name in ((first, "Robot.Py__x-1.2.dist-info"), (first, "six"), (second, "robot_py_x-3.dist-info")):
        (place / name).mkdir(parents=True)
    (second / "old-2.0-py3.14.egg-info").mkdir()
    monkeypatch.setattr(sys, "path", ["", str(tmp_path / "none"), str(first), str(second)])
    assert imports.installed_packages() == {"robot-py-x": "1.2", "old": "2.0"}


def test_a_link_is_known_by_its_target_and_a_file_by_its_content(tmp_path: Path) -> None:
    activity = Activity(lambda **said: None)
    (tmp_path / "file").write_bytes(b"0123")
    (tmp_path / "link").symlink_to("file")
    assert fingerprint(str(tmp_path / "file"), activity).startswith("1be2e452b46d7a0d")
    assert fingerprint(str(tmp_path / "link"), activity) == "-> file"
