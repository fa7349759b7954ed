"""What the page shows of a source that is no simulation: a log, a robot elsewhere; branches from elsewhere."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

import pytest
from sim_robots import PATIENCE
from web_pages import served_source

from pyfrc_core.project import Project
from pyfrc_core.sim.engine.changes import Change, ChangeCursor, ChangeFeed, ReportSignal, RunBegan
from pyfrc_core.sim.engine.field import field_of
from pyfrc_core.sim.engine.output_log import OutputCursor, OutputLog
from pyfrc_core.sim.engine.past_run import Happened, PastRun
from pyfrc_core.sim.engine.scene import Scene
from pyfrc_core.sim.engine.snapshot import Snapshot, Status
from pyfrc_core.sim.engine.source import Abilities, Source
from pyfrc_core.sim.engine.value_history import ValueHistory
from pyfrc_core.sim.ui.web import page_client


class Elsewhere:
    """A robot elsewhere, whose values can be set."""

    title = "10.1.2.2"
    when: datetime | None = None
    recorded: PastRun | None = None
    wants_to_run = True

    def __init__(self, root: Path, abilities: Abilities) -> None:
        self.abilities, self.project = abilities, Project(root / "robot.py")
        self.field = field_of(self.project)
        self.reports = ReportSignal()
        self.branches: tuple[PastRun, ...] = ()
        self.status = Status(state="running")
        self.snapshot: Snapshot | None = None
        self.hal, self.network, self.output = ChangeFeed(), ChangeFeed(), OutputLog()
        self.written: list[Mapping[str, object]] = []
        self.people = 0
        self.started = threading.Event()

    def output_cursor(self) -> OutputCursor:
        return self.output.cursor()

    def change_cursor(self) -> ChangeCursor:
        return self.hal.cursor()

    def network_cursor(self) -> ChangeCursor:
        return self.network.cursor()

    def attach(self) -> Elsewhere:
        self.people += 1
        return self

    def write(self, values: Mapping[str, object]) -> None:
        self.written.append(values)

    def leave(self) -> None:
        with self.reports:
            self.people -= 1
            self.reports.notify_all()

    def start(self) -> None:
        if self.abilities.over:
            with self.reports:
                self.reports.notify_all()
            return
        for feed in (self.hal, self.network):
            feed.add(RunBegan(1, 0.0, {}))
        self.come(0.0)
        self.started.set()

    def close(self) -> None:
        pass

    def come(self, time: float, **values: Any) -> None:
        with self.reports:
            self.network.add(
                Change(time, {"sim.mode": "teleop"} | {f"nt:/{name}": each for name, each in values.items()})
            )
            self.snapshot = Snapshot(time, "teleop", Scene(self.field))
            self.reports.notify_all()


def a_run(name: str, **values: Any) -> PastRun:
    """Return a run of 2 s in which some values come after 1 s."""
    network = ValueHistory()
    network.add(0.0, {"sim.mode": "disabled"})
    network.add(1.0, {"sim.mode": "autonomous"} | {f"nt:/{name}": value for name, value in values.items()})
    happened = (Happened(0.5, "info", "hello"), Happened(1.5, "error", "it broke", is_mark=True))
    return PastRun(name, 2.0, {"hal": ValueHistory(), "network": network}, happened)


def test_a_robot_elsewhere_is_not_driven_but_its_values_can_be_set(tmp_path: Path) -> None:
    robot = Elsewhere(tmp_path, Abilities("robot", writes=True))
    source: Source = robot
    with served_source(source) as there:
        with there.page() as page:
            assert robot.started.wait(PATIENCE)  # a page may come before its source has started
            robot.come(1.0, kP=0.5)
            page.until(lambda: page.values.get("nt:/kP") == 0.5)
            assert page.hello["source"] == {
                "kind": "robot",
                "title": "10.1.2.2",
                "when": None,
                "drives": False,
                "rewinds": False,
                "writes": True,
                "over": False,
                "replays": False,
                "begins": None,
            }
            page.command("write", values={"nt:/kP": 0.25})
            assert robot.written == [{"nt:/kP": 0.25}]
            for name in ("enable", "rewind", "place", "save"):
                assert page.ask(type="command", name=name)["type"] == "error"
            curve = page.ask(type="plot", paths=["nt:/kP"], **{"from": 0, "to": 2, "points": 10})["series"]["nt:/kP"]
            assert (curve["t"], curve["v"]) == ([1.0], [0.5])
        with robot.reports:
            assert robot.reports.wait_for(lambda: robot.people == 0, 30)


def test_a_page_hears_of_its_server_while_an_answer_takes_long(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page_client, "_SIGN_INTERVAL", 0.001)
    goes_on = threading.Event()

    class Slow(Elsewhere):
        def write(self, values: Mapping[str, object]) -> None:
            assert goes_on.wait(PATIENCE)

    with served_source(Slow(tmp_path, Abilities("robot", writes=True))) as there, there.page() as page:
        page.socket.send('{"type": "command", "name": "write", "values": {"nt:/kP": 0.25}, "id": 1}')
        page.until_type("working")
        goes_on.set()
        page.until_type("answer")


def test_what_is_over_is_all_there_at_once(tmp_path: Path) -> None:
    log = Elsewhere(tmp_path, Abilities("log", over=True))
    log.recorded = a_run("lost.wpilog", voltage=7.0)
    with served_source(log) as there, there.page() as page:
        assert page.values["nt:/voltage"] == 7.0
        assert [(line["t"], line["level"], line["text"]) for line in page.console] == [
            (0.5, "info", "hello"),
            (1.5, "error", "it broke"),
        ]
        assert {(mark["t"], mark["kind"]) for mark in page.marks} >= {(1.0, "mode"), (1.5, "error")}
        assert page.ask(type="values", t=0.5)["values"] == {"sim.mode": "disabled"}


def test_a_run_from_elsewhere_is_a_branch_that_can_be_moved_in_time(tmp_path: Path) -> None:
    robot = Elsewhere(tmp_path, Abilities("robot"))
    with served_source(robot) as there, there.page() as page:
        with robot.reports:
            robot.branches = (a_run("practice.wpilog", speed=3.0),)
            robot.reports.notify_all()
        page.until(lambda: page.parts.get("branches"))
        (branch,) = page.parts["branches"]
        assert (branch["name"], branch["from"], branch["to"], branch["offset"]) == ("practice.wpilog", 0.0, 2.0, 0.0)

        def curve() -> Any:
            asked = {"from": 0, "to": 9, "points": 10, "branch": branch["id"]}
            return page.ask(type="plot", paths=["nt:/speed"], **asked)["series"]["nt:/speed"]["t"]

        assert curve() == [1.0]
        page.command("move_branch", branch=branch["id"], offset=3.5)
        assert curve() == [4.5]
        assert page.ask(type="values", t=4.4, branch=branch["id"])["values"] == {"sim.mode": "disabled"}
        page.until(lambda: page.parts["branches"][0]["offset"] == 3.5)
