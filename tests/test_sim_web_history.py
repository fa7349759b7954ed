"""The values of every packet in memory: any moment, curves, former runs, and a limit."""

from __future__ import annotations

import math
import random
from bisect import bisect

import pytest
from loops import for_each

from pyfrc_core.sim.engine.changes import Change, RunBegan
from pyfrc_core.sim.engine.value_history import MISSING, ValueHistory
from pyfrc_core.sim.ui.web.console import MOST_LINES, Console
from pyfrc_core.sim.ui.web.marks import Marks
from pyfrc_core.sim.ui.web.messages import json_text, read_value
from pyfrc_core.sim.ui.web.plots import series
from pyfrc_core.sim.ui.web.runs import Runs


def random_value(chance: random.Random) -> object:
    kinds = (
        lambda: chance.random(),
        lambda: chance.randrange(-5, 5),
        lambda: chance.random() < 0.5,
        lambda: chance.choice(("red", "blue", "")),
        lambda: tuple(chance.random() for _ in range(chance.randrange(1, 4))),
        lambda: (),
        lambda: (1, "x", (True, 2.5)),
        lambda: None,
        lambda: 1 << 60,
        lambda: math.inf,
    )
    return chance.choice(kinds)()


@for_each("seed", range(8))
def test_every_moment_has_the_values_that_it_had(seed: int) -> None:
    """Against a plain model: a list of all values at each packet."""
    chance = random.Random(seed)
    history, now, expected = ValueHistory(), {}, []
    paths = [f"pwm[{number}].value" for number in range(6)]
    for packet in range(60):
        steady = seed % 2 == 0
        changed = {path: chance.random() if steady else random_value(chance) for path in paths if chance.random() < 0.4}
        gone = [path for path in now if path not in changed and chance.random() < 0.05]
        history.add(packet * 0.02, changed, gone)
        now = {path: value for path, value in {**now, **changed}.items() if path not in gone}
        expected.append(dict(now))
    assert dict(history.now) == expected[-1]
    for packet, values in enumerate(expected):
        assert history.values_at(packet * 0.02 + 1e-6) == values
        for path in paths:
            assert history.value_at(path, packet * 0.02 + 1e-6) == values.get(path, MISSING)
    cut = chance.randrange(60)
    part = history.until(cut * 0.02 + 1e-6)
    assert dict(part.now) == expected[cut]
    part.add(9.0, {"new": 1.0})
    assert "new" not in history.now
    assert history.values_at(60) == expected[-1]
    assert part.values_at(cut * 0.02 + 1e-6) == expected[cut]
    assert part.values_at(9.0) == {**expected[cut], "new": 1.0}


def test_a_long_curve_keeps_its_peaks() -> None:
    history = ValueHistory()
    for packet in range(5000):
        history.add(
            packet * 0.02, {"a": 50.0 if packet == 3217 else -50.0 if packet == 4001 else math.sin(packet / 99)}
        )
    history.add(100, {"a": 0.3})  # for ten seconds, between many changes: neither lowest nor highest
    for packet in range(5500, 5600):
        history.add(packet * 0.02, {"a": math.sin(packet)})
    found = series(history, "a", 0, 200, 200)
    assert len(found["v"]) <= 204
    assert found["v"][bisect(found["t"], 105) - 1] == 0.3
    assert (max(found["v"]), min(found["v"])) == (50, -50)
    assert found["t"] == sorted(found["t"])
    assert (found["t"][0], found["t"][-1]) == (0, pytest.approx(5599 * 0.02))


def test_two_runs_differ_first_where_one_changed_alone_or_otherwise() -> None:
    for differing, expected, where in (
        ({7: {"a": 7.5}}, 7, ["a"]),
        ({5: {"b": 1.0}, 7: {"a": 7.5}}, 5, ["b"]),
        ({9: {"a": math.nan}}, 9, ["a"]),
        ({}, None, []),
    ):
        runs = Runs()

        def play(begin: int, changes: dict[int, dict[str, float]], runs: Runs = runs) -> None:
            for packet in range(begin, 12):
                values = {"a": float(packet), "nan": math.nan, **changes.get(packet, {})}
                runs.take("hal", [Change(packet, values)], lambda event: None)

        play(0, {})
        for source in ("hal", "network"):
            runs.take(source, [RunBegan(2, 3.0, {"a": 3.0, "nan": math.nan})], lambda event: None)
        play(4, differing)
        found = runs.first_difference(2, None)
        assert found is not None
        assert (found.time, found.paths) == (expected, where)
    assert runs.first_difference(3, None) is None


def test_a_plot_that_goes_on_has_the_gap_of_a_value_that_is_gone_as_one_that_is_loaded_has() -> None:
    runs = Runs()
    changes = (
        Change(0.0, {"nt:/x": 1.0, "nt:/list": (5.0, 6.0)}),
        Change(1.0, {}, ("nt:/x", "nt:/list")),
        Change(2.0, {"nt:/x": "a text now"}),
    )
    paths = ("nt:/x", "nt:/list[1]")
    begin = runs.position()
    runs.take("network", changes, lambda event: None)
    assert runs.samples(paths, begin)[0] == {
        "nt:/x": [0.0, 1.0, 1.0, None, 2.0, "a text now"],
        "nt:/list[1]": [0.0, 6.0, 1.0, None],
    }
    loaded = runs.plots(paths, -1.0, 3.0, 100, None) or {}
    assert loaded["nt:/x"]["v"] == [1.0, None, "a text now"]
    assert loaded["nt:/list[1]"]["v"] == [6.0, None]


VALUES = {f"pwm[{number}].value": 0.5 for number in range(20)}


def play(runs: Runs, first: int, after: int) -> None:
    """Add packets to both histories."""
    for source in ("hal", "network"):
        changes = [Change(packet * 0.02, {**VALUES, "t": float(packet)}) for packet in range(first, after)]
        runs.take(source, changes, lambda event: None)


def test_memory_is_limited_by_forgetting_former_runs_and_then_the_oldest_values() -> None:
    runs = Runs(most_bytes=1_000_000)
    play(runs, 0, 500)
    for source in ("hal", "network"):
        runs.take(source, [RunBegan(2, 4.0, {**VALUES, "t": 200.0})], lambda event: None)
    assert [branch.end for branch in runs.branches] == [499 * 0.02]
    play(runs, 201, 1000)
    assert runs.known_from == 0
    for packet in (0, 1, 199, 200, 201, 999):
        assert (runs.values_at(packet * 0.02) or {})["t"] == packet
    assert (runs.values_at(499 * 0.02, 2) or {})["t"] == 499
    play(runs, 1000, 20_000)
    assert runs.size < 1_500_000
    assert runs.branches == ()
    first = round(runs.known_from / 0.02)
    assert 10_000 < first < 19_900
    for packet in (first, first + 1, 19_999):
        found = runs.values_at(packet * 0.02)
        assert found is not None
        assert (found["t"], found["pwm[3].value"]) == (packet, 0.5)
    assert 10_000 < (runs.values_at(5.0) or {})["t"] <= first  # the first that is known
    curve = (runs.plots(["t"], 0, 1000, 20_000, None) or {})["t"]
    assert 10_000 < curve["v"][0] <= first
    assert (curve["v"][0] * 0.02, curve["v"][-1]) == (pytest.approx(curve["t"][0]), 19_999)


def test_a_value_that_has_not_changed_for_long_is_still_known_when_its_change_is_forgotten() -> None:
    history = ValueHistory()
    history.add(0.0, {"steady": "x", "gone": 1.0})
    history.add(0.02, {}, ["gone"])
    for packet in range(2, 1000):
        history.add(packet * 0.02, {"t": float(packet)})
    while history.known_from < 10:
        assert history.forget_oldest()
    assert history.values_at(15.0) == {"steady": "x", "t": 750.0}
    assert series(history, "steady", 0, 100, 100) == {"kind": "text", "t": [history.known_from], "v": ["x"]}
    assert list(history.since(998, "t")) == [(998 * 0.02, 998.0), (999 * 0.02, 999.0)]
    assert history.until(15.0).values_at(99) == {"steady": "x", "t": 750.0}


def test_numbers_that_are_not_finite_arrive_and_come_back() -> None:
    text = json_text({"a": [math.nan, -math.inf, 1.5], "b": {"c": math.inf}})
    assert text == '{"a":[{"$":"NaN"},{"$":"-Infinity"},1.5],"b":{"c":{"$":"Infinity"}}}'
    assert read_value({"$": "-Infinity"}) == -math.inf
    assert math.isnan(read_value([{"$": "NaN"}])[0])
    assert read_value({"$": "other"}) == {"$": "other"}


def test_console_lines_have_levels_places_and_a_limit(tmp_path) -> None:
    (tmp_path / "robot.py").write_text("pass")
    console = Console(tmp_path)
    console.add("hello\nWarning: low\nTraceback (most recent call last):\n", 1.0)
    console.add(
        f'  File "{tmp_path}/robot.py", line 7, in x\n    1 / 0\nZeroDivisionError: division by zero\nfine\nhal', 2.0
    )
    console.add("f\n\x1b[31mred\x1b[0m robot.py:12: x\n../robot.py:3\n/etc/passwd.py:1\n", 3.0)
    assert [(line.text, line.level, line.file, line.line) for line in console.since(0)][:3] == [
        ("hello", "info", "", 0),
        ("Warning: low", "warning", "", 0),
        ("Traceback (most recent call last):", "error", "", 0),
    ]
    found = console.since(3)
    assert [line.level for line in found] == ["error", "error", "error", "info", "info", "info", "info", "info"]
    assert (found[0].file, found[0].line) == ("robot.py", 7)
    assert [line.text for line in found[3:6]] == ["fine", "half", "red robot.py:12: x"]
    assert (found[5].file, found[5].line) == ("robot.py", 12)
    assert [line.file for line in found[6:]] == ["", ""]
    for number in range(3):
        console.add(f"{number}\n" * 100_000, 4.0)
    assert console.count == 300_011
    assert [line.n for line in console.since(0)] == [2, 3, 4, 5, 6, *range(300_012 - MOST_LINES, 300_012)]
    console.add("x" * 1_000_000 + "\n", 5.0)
    assert len(console.since(console.count - 1)[0].text) < 5000


def test_a_flood_evicts_no_warnings_and_warnings_no_errors(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pyfrc_core.sim.ui.web.console.MOST_LINES", 100)
    monkeypatch.setattr("pyfrc_core.sim.ui.web.console.MOST_IMPORTANT", 50)
    console = Console(tmp_path)
    console.add("Warning: one\nValueError: two\n", 1.0)
    for number in range(20):
        console.add("flood\n" * 200 + f"Warning: after {number}\n", 2.0)
    important = [line.text for line in console.since(0) if line.level != "info"]
    assert important == ["Warning: one", "ValueError: two", *(f"Warning: after {number}" for number in range(20))]
    assert console.count == 2 + 20 * 201
    console.add("Warning: again\n" * 100, 3.0)
    lines = console.since(0)
    assert [line.text for line in lines if line.level == "error"] == ["ValueError: two"]
    assert sum(line.level == "warning" for line in lines) == 50


def test_marks_forget_what_another_run_leaves_and_keep_the_persons_own() -> None:
    marks = Marks()
    marks.add(1.0, "own", "mine")
    for number in range(3000):
        marks.add(1.0 + number / 1000, "warning", "w")
    assert len(marks.all()) == 2000
    assert marks.all()[0].text == "mine"
    assert [mark.n for mark in marks.since(2999)] == [3000, 3001]
    marks.forget_after(1.0)
    assert [mark.kind for mark in marks.all()] == ["own"]
    marks.look_at_buttons(1.1, "joysticks[2].buttons", (False, False, False))
    marks.look_at_buttons(1.2, "joysticks[2].buttons", (False, True, False))
    assert marks.all()[-1].text == "joystick 2, button 1"
    marks.add(1.23456, "own", "here")
    assert marks.all()[-1].plain() == {"n": 3003, "t": 1.235, "kind": "own", "text": "here"}
