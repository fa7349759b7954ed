"""The driver station's log on the time line of the robot's log: where both say the same, and never by a guess."""

from __future__ import annotations

import struct
from bisect import bisect
from collections.abc import Callable
from datetime import datetime, timedelta, timezone
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from web_pages import send_log, served_source
from written_logs import SECOND, Written

from pyfrc_core.errors import UsageError
from pyfrc_core.project import Project
from pyfrc_core.sim.engine.value_history import MISSING
from pyfrc_core.sim.logs import open_log
from pyfrc_core.sim.logs.open import OpenedLog
from pyfrc_core.sim.logs.source import LogSource
from pyfrc_core.sim.logs.station import Alignment, align, join
from pyfrc_core.sim.view import ViewRequest, view

HEIGHT = 27.0
NOON = datetime(2026, 3, 7, 12, tzinfo=timezone.utc)
#: A match as all are, in seconds: disabled, autonomous, a pause, teleop, disabled.
MATCH = (20.0, 35.0, 38.0, 173.0)
#: The bits of a record's status, which are 0 where it is so.
DISABLED, AUTO = 1, 2


def robots_log(
    file: Path, edges: tuple[float, ...], end: float, clock: datetime | None = NOON, first: float = 0.0
) -> OpenedLog:
    """Write the log of a robot that is enabled and disabled in turn.

    :param edges: when, in seconds; `clock` is the time of day at 0
    :param first: the log begins then
    """
    log = Written()
    times = (first, *(edge for edge in edges if edge > first))
    states = [(time, sum(edge <= time for edge in edges) % 2 == 1) for time in times]
    log.values("DS:enabled", "boolean", "?", *states)
    log.values("DS:autonomous", "boolean", "?", *((time, True) for time, _ in states))
    steps = range(int(first * 10), int(end * 10))
    log.values("NT:/SmartDashboard/speed", "double", "d", *((step / 10, step / 7) for step in steps))
    if clock is not None:
        micros = round((clock + timedelta(seconds=end)).timestamp() * SECOND)
        log.values("systemTime", "int64", "q", (end, micros))
    return open_log(log.save(file), HEIGHT)


def stations_log(
    file: Path, edges: tuple[float, ...], seconds: float, clock: datetime = NOON, lost: Callable[[float], bool] = bool
) -> OpenedLog:
    """Write the log of a driver station that saw a robot enabled and disabled in turn.

    :param lost: whether the packet of a moment was lost; by default those at 0 are not
    """
    records = bytearray()
    for number in range(round(seconds * 50)):
        time = number / 50
        is_enabled = bisect(edges, time) % 2 == 1
        status = 0 if lost(time) and lost is not bool else AUTO if is_enabled else DISABLED
        volts = 0xFFFF if status == 0 else round((12 - time / 100) * 256)
        records += struct.pack(">BbHBBBBHI", 20, 0, volts, 100, 255 & ~status, 90, 0, 0, 0)
    since_1904 = (clock - datetime(1904, 1, 1, tzinfo=timezone.utc)).total_seconds()
    whole = int(since_1904)
    stamp = struct.pack(">qQ", whole, int((since_1904 - whole) * 2**64))
    file.write_bytes(struct.pack(">i", 4) + stamp + records)
    return open_log(file, HEIGHT)


def shifted(edges: tuple[float, ...], by: float) -> tuple[float, ...]:
    return tuple(edge + by for edge in edges if edge + by > 0)


@settings(max_examples=20)
@given(
    lengths=st.lists(st.integers(20, 200), min_size=2, max_size=9),
    begins=st.integers(-300, 300),
    late=st.integers(0, 5),
    has_clock=st.booleans(),
    wrong=st.floats(-20, 20),
)
def test_a_pair_is_put_where_it_belongs_or_nowhere(
    tmp_path_factory: pytest.TempPathFactory, lengths: list[int], begins: int, late: int, has_clock: bool, wrong: float
) -> None:
    """The station's log begins `begins` tenths of a second after the robot's; its clock is some seconds wrong.

    :param late: how many packets later the driver station notices what the robot does
    """
    directory = tmp_path_factory.getbasetemp()
    edges = tuple(sum(lengths[: number + 1]) / 10 + 1 for number in range(len(lengths)))
    end, begin = edges[-1] + 3, begins / 10
    assume(begin < edges[0])  # no edge is before the driver station's log
    robot = robots_log(directory / "a.wpilog", edges, end, NOON if has_clock else None)
    seen, clock = shifted(edges, late / 50 - begin), NOON + timedelta(seconds=wrong + begin)
    station = stations_log(directory / "b.dslog", seen, end - begin, clock)
    alignment = align(robot, station)
    if alignment.offset is None:
        assert not has_clock  # it fits in several places
    else:
        by_clock = alignment.how.startswith("by the time of day alone")
        assert alignment.offset == pytest.approx(begin - late / 50, abs=20.2 if by_clock else 0.06), alignment


def test_where_a_log_does_not_belong_it_is_not_put(tmp_path: Path) -> None:
    robot = robots_log(tmp_path / "a.wpilog", MATCH, 180.0)
    later = NOON + timedelta(minutes=12)
    another = align(robot, stations_log(tmp_path / "b.dslog", shifted(MATCH, -10.0), 170.0, later))
    assert another == Alignment(None, "by the time of day, there are 0:09:00 between them")
    soon = NOON + timedelta(minutes=2)
    overlapping = align(robot, stations_log(tmp_path / "c.dslog", shifted(MATCH, -10.0), 170.0, soon))
    assert overlapping.offset is None
    assert "the robot is enabled in one of them and disabled in the other" in overlapping.how
    without_clock = robots_log(tmp_path / "d.wpilog", MATCH, 180.0, None)
    practice = align(without_clock, stations_log(tmp_path / "e.dslog", (5.0, 60.0, 70.0, 95.0), 100.0))
    assert practice.offset is None
    assert practice.how.startswith("no enablings and disablings of both fit together")
    regular = tuple(float(each) for each in range(10, 100, 10))
    several = align(
        robots_log(tmp_path / "f.wpilog", regular, 100.0, None), stations_log(tmp_path / "g.dslog", (5.0, 15.0), 20.0)
    )
    assert several == Alignment(None, "its enablings fit in several places, and one does not have the time of day")


def test_how_sure_an_alignment_is_is_said(tmp_path: Path) -> None:
    station = stations_log(tmp_path / "b.dslog", shifted(MATCH, -10.02), 170.0, NOON + timedelta(seconds=10.5))
    sure = align(robots_log(tmp_path / "a.wpilog", MATCH, 180.0), station)
    assert sure.how == "4 enablings and disablings agree within 0.00 s, and the time of day within 0.5 s"
    without_clock = align(robots_log(tmp_path / "c.wpilog", MATCH, 180.0, None), station)
    assert without_clock.offset == pytest.approx(10.02)
    assert "so another match would fit, too" in without_clock.how
    disabled = align(robots_log(tmp_path / "d.wpilog", (), 180.0), stations_log(tmp_path / "e.dslog", (), 50.0))
    assert disabled == Alignment(0.0, "by the time of day alone, which may be up to 60 s wrong: no enabling says more")


def test_a_connection_that_is_lost_contradicts_nothing(tmp_path: Path) -> None:
    """The robot disables itself meanwhile, and the driver station knows nothing of it."""
    robot = robots_log(tmp_path / "a.wpilog", (20.0, 35.0, 38.0, 80.1, 91.0, 173.0), 180.0)
    station = stations_log(tmp_path / "b.dslog", MATCH, 180.0, lost=lambda time: 80 <= time < 91)
    assert align(robot, station).offset == pytest.approx(0.0, abs=0.03)
    # When it was enabled meanwhile, is not known: that is no enabling that both have.
    robot = robots_log(tmp_path / "c.wpilog", (20.0,), 60.0)
    station = stations_log(tmp_path / "d.dslog", (20.0,), 60.0, lost=lambda time: 19 <= time < 23)
    assert align(robot, station).how.startswith("by the time of day alone")


def test_both_are_on_one_line_and_what_one_lacks_is_a_gap(tmp_path: Path) -> None:
    """The robot restarts in autonomous: its log begins after that of the driver station, which ends later, too."""
    robot = robots_log(tmp_path / "a.wpilog", MATCH, 175.0, first=30.0)
    station = stations_log(tmp_path / "b.dslog", MATCH, 180.0)
    alignment = align(robot, station)
    run = join(robot, station, alignment, HEIGHT).run
    history = run.histories["network"]
    assert (run.name, run.end) == ("a.wpilog and b.dslog", pytest.approx(180.0, abs=0.15))
    before, during, after = (history.values_at(time) for time in (10.0, 100.0, 178.0))
    assert before["nt:/DSLog/BatteryVoltage"] == pytest.approx(11.9, abs=0.01)
    assert "nt:/SmartDashboard/speed" not in before
    assert during["nt:/SmartDashboard/speed"] == pytest.approx(1000 / 7, abs=0.2)
    assert "nt:/SmartDashboard/speed" not in after
    assert [before["sim.mode"], during["sim.mode"], after["sim.mode"]] == ["disabled", "autonomous", "disabled"]
    assert history.now["nt:/SmartDashboard/speed"] > 200  # the end of the log still lists it
    assert history.changes("nt:/SmartDashboard/speed")[1][-1] is MISSING
    assert run.happened[0].text == f"b.dslog is on the time line of a.wpilog: {alignment.how}."


def test_a_directory_of_a_match_is_shown_on_one_line(tmp_path: Path) -> None:
    robots_log(tmp_path / "z.wpilog", MATCH, 180.0)
    stations_log(tmp_path / "a.dslog", MATCH, 180.0)
    said: list[str] = []
    page = tmp_path / "both.html"
    assert view(ViewRequest((tmp_path,), page=page), said.append) == 0
    assert said[0].startswith("a.dslog is on the time line of z.wpilog: 4 enablings and disablings agree within 0.0")
    robots_log(tmp_path / "y.wpilog", MATCH, 180.0)
    with pytest.raises(UsageError, match="has 2 logs of a robot, and a directory is shown as one match"):
        view(ViewRequest((tmp_path,), page=page), said.append)
    stations_log(tmp_path / "a.dslog", (3.0,), 30.0, NOON + timedelta(days=1))
    said.clear()
    view(ViewRequest((tmp_path / "a.dslog", tmp_path / "z.wpilog"), page=page), said.append)
    assert said[0].startswith("a.dslog is not put on the time line of z.wpilog: by the time of day, there are 23:57:00")
    said.clear()
    view(ViewRequest((tmp_path / "z.wpilog", tmp_path / "a.dslog"), offsets=(17.0,), page=page), said.append)
    assert said[0] == "a.dslog is on the time line of z.wpilog: you have given --offset.\n"
    said.clear()
    view(ViewRequest((tmp_path / "z.wpilog", tmp_path / "a.dslog"), align="enabled", page=page), said.append)
    assert said == [f"wrote {page}\n"]  # a branch, as asked for


def test_a_log_that_is_dropped_on_a_page_is_put_where_pyfrc_view_puts_it(tmp_path: Path) -> None:
    """The driver station's log begins later, so the first enabling of each is another one."""
    robot = robots_log(tmp_path / "a.wpilog", (2.0, 4.0, *MATCH), 180.0)
    station = stations_log(tmp_path / "b.dslog", shifted(MATCH, -10.0), 170.0, NOON + timedelta(seconds=12))
    for shown, dropped, name, offset in ((robot, station, "b.dslog", 10.0), (station, robot, "a.wpilog", -10.0)):
        source = LogSource(Project(tmp_path / "robot.py"), shown)
        with served_source(source) as server, server.page() as page:
            _, answer = send_log(server, name, dropped.file.read_bytes())
            page.until(lambda page=page: page.parts.get("branches"))
            assert page.parts["branches"][0]["offset"] == pytest.approx(offset, abs=0.03)
        assert "both show the same moment: 4 enablings and disablings agree within 0.0" in answer["text"]
    elsewhere = stations_log(tmp_path / "c.dslog", shifted(MATCH, -10.0), 170.0, NOON + timedelta(days=1))
    with served_source(LogSource(Project(tmp_path / "robot.py"), robot)) as server:
        _, answer = send_log(server, "c.dslog", elsewhere.file.read_bytes())
    assert "aligned at their start: by the time of day, there are 23:57:00 between them" in answer["text"]
