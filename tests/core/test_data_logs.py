"""Data logs that robot code starts: their files, when they are flushed, and that they are complete."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
import wpilib
from wpiutil.log import DataLogReader, StringLogEntry

from pyfrc_core.runtime.clock import KICKOFF
from pyfrc_core.runtime.patches import data_logs
from pyfrc_core.runtime.patches.active_run import active_run
from pyfrc_core.runtime.patches.data_logs import DataLogs, LogPlace
from pyfrc_core.runtime.patches.season_2026 import log_names

from .timeline import Timeline


def place(tmp_path: Path, name: str | None = "run", kept: int = 10) -> LogPlace:
    return LogPlace(tmp_path / ".pyfrc/logs", name, kept)


def entries(file: Path) -> dict[str, list[object]]:
    """The numbers and texts of a log, by entry."""
    names: dict[int, tuple[str, str]] = {}
    found: dict[str, list[object]] = {}
    for record in DataLogReader(str(file)):
        if record.isStart():
            data = record.getStartData()
            names[data.entry] = data.name, data.type
        elif not record.isControl():
            name, kind = names[record.getEntry()]
            read = {"int64": record.getInteger, "string": record.getString}.get(kind)
            if read is not None:  # others are what an earlier test has left in NetworkTables
                found.setdefault(name, []).append(read())
    return found


def files(tmp_path: Path) -> list[str]:
    return sorted(each.name for each in (tmp_path / ".pyfrc/logs").glob("*.wpilog"))


def test_the_time_of_day_is_logged_every_five_seconds(tmp_path: Path, timeline: Timeline) -> None:
    logs = DataLogs(timeline.clock, place(tmp_path))
    logs.start()
    timeline.run_until(15_100)
    logs.close()
    times = entries(tmp_path / ".pyfrc/logs/run.wpilog")["systemTime"]
    assert [time - KICKOFF * 1_000_000 for time in times] == [250_000, 5_000_000, 10_000_000, 15_000_000]  # type: ignore[operator]


def test_a_log_is_on_the_disk_while_the_run_goes_on(tmp_path: Path, timeline: Timeline) -> None:
    logs = DataLogs(timeline.clock, place(tmp_path))
    entry = StringLogEntry(logs.open("", "arm", period=1.0), "words")
    file = tmp_path / ".pyfrc/logs/run.arm.wpilog"
    timeline.run_until(900)
    before = file.stat().st_size
    entry.append("x" * 10_000)
    timeline.run_until(999)
    assert file.stat().st_size == before
    timeline.run_until(1_000)
    assert file.stat().st_size > before + 5_000
    logs.close()
    timeline.run_until(5_000)  # a log that is complete is flushed no more


def test_names_and_directories(tmp_path: Path, timeline: Timeline, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wpilib, "getOperatingDirectory", lambda: str(tmp_path))
    logs = DataLogs(timeline.clock, place(tmp_path))
    own = tmp_path / ".pyfrc/logs"
    opened = [
        logs._file("", ""),
        logs._file("", "arm.wpilog"),
        logs._file("mine", ""),
        logs._file("mine", "arm.wpilog"),
    ]
    assert opened == [
        own / "run.wpilog",
        own / "run.arm.wpilog",
        tmp_path / "mine/run.wpilog",
        tmp_path / "mine/arm.wpilog",
    ]
    for _ in range(2):
        logs.open("", "")
    assert files(tmp_path) == ["run-2.wpilog", "run.wpilog"]
    logs.close()
    # Another run's log of this name is replaced; without a name, it is the time of day, and none is.
    assert DataLogs(timeline.clock, place(tmp_path))._file("", "") == own / "run.wpilog"
    assert not (own / "run.wpilog").exists()
    nameless = DataLogs(timeline.clock, place(tmp_path, None))
    assert nameless._file("", "arm") == own / "arm.wpilog"
    assert nameless._file("", "").name.startswith("FRC_20")
    assert DataLogs(timeline.clock, None)._file("x", "y") == Path(os.devnull)


def test_so_many_logs_are_kept(tmp_path: Path) -> None:
    directory = tmp_path / ".pyfrc/logs"
    directory.mkdir(parents=True)
    for number in range(5):
        file = directory / f"{number}.wpilog"
        file.touch()
        os.utime(file, (number, number))
    place(tmp_path, kept=3).make_room()  # for one more
    assert files(tmp_path) == ["3.wpilog", "4.wpilog"]
    assert LogPlace.of_run(tmp_path) == LogPlace(directory, None, 10)
    assert LogPlace.of_test(tmp_path, "a") == LogPlace(directory / "test", "a", 200)


def test_a_log_that_cannot_be_written_or_completed_is_said(
    tmp_path: Path, timeline: Timeline, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / ".pyfrc").write_text("")
    logs = DataLogs(timeline.clock, place(tmp_path))
    logs.log("not kept")
    assert "cannot be written: " in capsys.readouterr().err
    logs.close()
    other = DataLogs(timeline.clock, LogPlace(tmp_path / "logs", "a"))
    other.open("", "")
    monkeypatch.setattr(data_logs, FULL_DISK, lambda file: "the disk is full")
    other.close()
    assert capsys.readouterr().err.endswith("a.wpilog is not complete: the disk is full\n")


#: The name under which the module looks for room on the disk.
FULL_DISK = next(name for name in ("check_disk_space", "lack_of_room") if hasattr(data_logs, name))


def test_a_log_that_is_not_kept_has_a_file_for_code_that_renames_it(tmp_path: Path, timeline: Timeline) -> None:
    """As PyKit does. The file has nothing in it, and goes with the run; files of others stay."""
    (tmp_path / "other.wpilog").touch()
    kept = tmp_path / "log_1.wpilog"
    logs = DataLogs(timeline.clock, None)
    for name in ("log_1", "log_2", "other"):
        StringLogEntry(logs.open_file(str(tmp_path / f"{name}.wpilog")), "words").append("x" * 10_000)
    kept.rename(tmp_path / "log_1_event.wpilog")
    timeline.run_until(1_000)
    assert [file.stat().st_size for file in tmp_path.iterdir()] == [0, 0, 0]
    logs.close()
    assert [file.name for file in tmp_path.iterdir()] == ["other.wpilog"]


def test_outside_a_run_a_log_begins_with_the_next_run_and_all_else_is_wpilibs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(active_run, "run", None)
    monkeypatch.setattr(log_names, "started_at_import", started := [])
    for name in ("start", "stop"):
        monkeypatch.setattr(wpilib.DataLogManager, name, staticmethod(lambda *args, name=name: f"WPILib's {name}"))
    replaced = {each.name: each.value for each in log_names.patches() if each.owner is wpilib.DataLogManager}
    assert replaced["start"].__func__("logs", period=1.0) is None
    assert started == [(("logs",), {"period": 1.0})]
    assert replaced["stop"].__func__() == "WPILib's stop"
