"""Several consumers of one session: each reads all of its output and every change, at its own pace."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from sim_robots import FILES, run, settle, wait

from pyfrc_core.project import find_project
from pyfrc_core.sim import SimOptions, Simulation
from pyfrc_core.sim.engine import history
from pyfrc_core.sim.engine.changes import Change, RunBegan
from pyfrc_core.sim.engine.output_log import OutputLog


def times(events: list[RunBegan | Change]) -> list[float]:
    return [event.time for event in events if isinstance(event, Change)]


def test_each_consumer_of_output_has_a_place_of_its_own() -> None:
    log = OutputLog()
    first = log.cursor()
    log.append("größer ")
    second = log.cursor(from_start=False)
    log.append("✓\ud83d done\n")
    assert first.read(3) == "grö"
    assert second.read() == "✓\ud83d done\n"
    assert first.read() == "ßer ✓\ud83d done\n"
    assert first.read() == second.read() == ""
    assert log.cursor().read_last(5) == "done\n"
    assert log.cursor().read() == "größer ✓\ud83d done\n"


def test_a_slow_and_a_quick_consumer_see_every_change(make_project, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history, "_BLOCK", 16)
    made = make_project(FILES)
    with Simulation(find_project(made.path), SimOptions(speed=0, paused=True)) as simulation:
        quick, slow = simulation.change_cursor(), simulation.change_cursor()
        simulation.choose_mode("autonomous")
        simulation.choose("/SmartDashboard/Auto", "Forward")
        simulation.enable()
        seen: list[RunBegan | Change] = []
        for _ in range(10):
            run(simulation, 0.4)
            seen += quick.read()
        simulation.save(made.path / "run.jsonl")
        late = simulation.change_cursor().read()
        slowly: list[RunBegan | Change] = []
        while some := slow.read(3):
            assert len(some) <= 3
            slowly += some
        assert simulation.snapshot is not None
        values = dict(simulation.snapshot.values)
    lines = [
        json.loads(line) for line in Path(made.path, "run.trace.jsonl").read_text(encoding="utf-8").splitlines()[1:-1]
    ]
    assert times(seen) == [line["t"] for line in lines]
    assert slowly == seen == late
    assert isinstance(seen[0], RunBegan)
    assert seen[0].number == 1
    assert replayed(seen) == values


def replayed(events: list[RunBegan | Change]) -> dict[str, object]:
    """The values after these events, as a consumer that has nothing else keeps them."""
    values: dict[str, object] = {}
    for event in events:
        if isinstance(event, RunBegan):
            values = dict(event.values)
        else:
            values.update(event.values)
            for path in event.gone:
                values.pop(path, None)
    return values


def test_consumers_learn_that_time_was_turned_back(make_project) -> None:
    """The slow one still gets the changes of the time that was given up, before the new beginning."""
    made = make_project(FILES)
    with Simulation(find_project(made.path), SimOptions(speed=0, paused=True)) as simulation:
        quick, slow = simulation.change_cursor(), simulation.change_cursor()
        simulation.enable()
        run(simulation, 2)
        simulation.set_axis(0, 1, -0.5)
        run(simulation, 1)
        seen = quick.read()
        given_up = times(seen)
        simulation.rewind(1)
        settle(simulation)
        simulation.set_axis(0, 1, 0.25)
        run(simulation, 0.5)
        seen += quick.read()
        assert slow.read() == seen
        late = simulation.change_cursor().read()
        assert simulation.snapshot is not None
        values = simulation.snapshot.values
        simulation.restart()
        wait(simulation, lambda: simulation.status.starts == 3 and simulation.status.state == "paused")
        again = quick.read()
    began = [event for event in seen if isinstance(event, RunBegan)]
    assert [(event.number, event.time) for event in began] == [(1, 0.0), (2, 1.0)]
    assert max(given_up) > 2
    after = times(seen)[len(given_up) :]
    assert after
    assert after[0] > 1
    assert after[-1] <= 1.52
    assert replayed(seen) == replayed(late) == dict(values)
    assert times(late) == [time for time in given_up if time <= 1] + after
    assert isinstance(again[0], RunBegan)
    assert (again[0].number, again[0].time) == (3, 0.0)
