"""What cannot be compared with a log is said before what differs, and "no difference" only where most was compared."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import pytest
from loops import for_each
from written_logs import Written, a_kit_log

from pyfrc_core.project import Project
from pyfrc_core.runtime.scripts.data_log import script_from_log
from pyfrc_core.runtime.scripts.inputs_file import remarks
from pyfrc_core.runtime.scripts.script import InputScript
from pyfrc_core.sim.engine.past_run import Comparison, PastRun
from pyfrc_core.sim.engine.value_history import ValueHistory
from pyfrc_core.sim.log_report import LogReport
from pyfrc_core.sim.log_run import LogRun, log_run
from pyfrc_core.sim.logs import OpenedLog
from pyfrc_core.sim.logs.source import LogSource
from pyfrc_core.sim.ui.web.runs import Runs

# -- inputs that a log lacks ------------------------------------------------------------------------------------------


def a_log(
    enabled: list[tuple[float, bool]],
    autonomous: list[tuple[float, bool]] | None,
    sticks: float | None = None,
    name: str = "DS:joystick0/axes",
) -> Written:
    """Return a log of 20 s; its joysticks begin at a moment."""
    log = Written()
    log.values("DS:enabled", "boolean", "?", *enabled)
    if autonomous is not None:
        log.values("DS:autonomous", "boolean", "?", *autonomous)
    if sticks is not None:
        log.values(name, "float[]", "", (sticks, struct.pack("<2f", 0, 0)), (19.0, struct.pack("<2f", 0, 1)))
    log.values("NT:/SmartDashboard/speed", "double", "d", (0, 0.0), (20.0, 1.0))
    return log


MATCH = [(0.0, False), (2.0, True), (8.0, False), (10.0, True), (18.0, False)]
AUTONOMOUS = [(0.0, False), (1.0, True), (9.0, False)]
LACKING: dict[str, tuple[Written, list[str]]] = {
    "all": (a_log(MATCH, AUTONOMOUS, 0.0), []),
    "no joysticks": (a_log(MATCH, AUTONOMOUS), ["a.wpilog has no joysticks from 10 s on"]),
    "late joysticks": (a_log(MATCH, AUTONOMOUS, 12.0), ["a.wpilog has no joysticks from 10 s on until 12 s"]),
    "buttons alone": (a_log(MATCH, AUTONOMOUS, 0.0, "DS:joystick3/axes"), []),
    "autonomous alone": (a_log(MATCH[:3], AUTONOMOUS), []),
    "never enabled": (a_log(MATCH[:1], AUTONOMOUS, 0.0), ["a.wpilog has no enabled robot"]),
    "begins enabled": (
        a_log([(0.0, True), (8.0, False)], AUTONOMOUS[:1], 0.0),
        ["a.wpilog has no beginning, since the robot is enabled when it begins"],
    ),
    "modes": (a_log(MATCH, None, 0.0), ["a.wpilog has no modes but enabled and disabled"]),
    "joysticks of another type": (
        a_log(MATCH, AUTONOMOUS, 0.0, "DS:joystick0/other"),
        ["a.wpilog has no joysticks from 10 s on"],
    ),
    "of a kit": (a_kit_log(), []),
}


@for_each("case", LACKING)
def test_inputs_that_a_log_does_not_have_are_named(case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    log, sentences = LACKING[case]
    script = script_from_log(log.save(tmp_path / "a.wpilog"))
    assert [f"{script.file} has {lack}" for _, lack in script.lacks] == sentences
    assert list(remarks(script)) == [f"{sentence}." for sentence in sentences]
    (tmp_path / "robot.py").touch()
    limits = log_run(Project(tmp_path / "robot.py"), Path("a.wpilog")).run.compared
    assert limits is not None
    assert [text for _, text in limits.limits] == [
        f"{sentence}: what follows from that cannot be compared" for sentence in sentences
    ]


def test_a_cut_log_and_one_of_another_year_cannot_be_compared_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    log = a_log(MATCH, AUTONOMOUS, 0.0)
    log.values("systemTime", "int64", "q", (5, 1_678_000_000_000_000))
    log.data = log.data[:-2]
    log.save(tmp_path / "a.wpilog")
    (tmp_path / "robot.py").touch()
    compared = log_run(Project(tmp_path / "robot.py"), Path("a.wpilog")).run.compared
    assert compared is not None
    assert [text for _, text in compared.limits] == ["not all of a.wpilog can be read, so its rest cannot be compared"]
    log = a_log(MATCH, AUTONOMOUS, 0.0)
    log.values("systemTime", "int64", "q", (5, 1_678_000_000_000_000))
    log.save(tmp_path / "a.wpilog")
    compared = log_run(Project(tmp_path / "robot.py"), Path("a.wpilog")).run.compared
    assert compared is not None
    assert [text for _, text in compared.limits] == [
        "a.wpilog is of 2023: what is different since then cannot be compared"
    ]


# -- how much was compared --------------------------------------------------------------------------------------------

Values = dict[str, list[tuple[float, Any]]]


def a_run(network: Values, hal: Values, compared: Comparison | None = None) -> PastRun:
    histories = {}
    for stream, values in (("network", network), ("hal", hal)):
        history = histories[stream] = ValueHistory()
        for time in sorted({time for changes in values.values() for time, _ in changes}):
            now = {path: value for path, changes in values.items() for at, value in changes if at == time}
            types = {f"type:{path.removeprefix('nt:')}": "double" for path in now if path.startswith("nt:")}
            history.add(time, {**types, **now})
    return PastRun("q.wpilog", 20.0, histories, compared=compared)  # type: ignore[arg-type]


def report(tmp_path: Path, here: PastRun, log: PastRun) -> list[str]:
    source = LogSource(Project(tmp_path / "robot.py"), OpenedLog(here, tmp_path / "q.wpilog"), (log,))
    return list(LogReport(source, LogRun(InputScript((), 20_000_000), log)).lines())


def topics(*names: str, value: float = 1.0) -> Values:
    return {f"nt:/SmartDashboard/{name}": [(0.1, 0.0), (1.0, value), (20.0, value)] for name in names}


LOG, TEN = Comparison(True), tuple(f"Arm/{number}" for number in range(10))
SAME = "1 value that q.wpilog has, too, exactly the same"
NOTHING = "nothing to compare: q.wpilog has no value that the robot's code sets here, too"
#: What the code publishes here, and the outputs in `hal_data`; the same of the log; the first lines; mostly compared.
COMPARED: dict[str, tuple[Values, Values, Values, Values, list[str], bool]] = {
    "all": (topics("a", "b"), {}, topics("a"), {}, [f"no difference: {SAME}", "here only: b (0:01.00)"], True),
    "most": (topics("a", "b"), {}, topics("a", "b", "c"), {}, ["no difference: 2 values that"], True),
    "nothing": (topics("a"), {}, topics("b"), {}, [NOTHING, "in q.wpilog only: b (0:01.00)"], False),
    "half": (
        topics("a", "c"),
        {},
        topics("a", "b"),
        {},
        ["little can be compared: 1 of the 2 values of q.wpilog is not set here", "what was compared does not differ"],
        False,
    ),
    "another robot": (
        topics("a"),
        {},
        topics("a", *TEN),
        {},
        [
            "little can be compared: 10 of the 11 values of q.wpilog are not set here, "
            "so it seems to be of another robot",
        ],
        False,
    ),
    "a motor is gone": (
        {},
        {"pwm[1].value": [(0.1, 0.0), (2.0, 1.0), (20.0, 1.0)]},
        {},
        {f"pwm[{each}].value": [(0.1, 0.0), (2.0, 1.0), (20.0, 1.0)] for each in (1, 2, 3)},
        [
            "little can be compared: 2 of the 3 values",
            "what was",
            "in q.wpilog only: pwm[2] (0:02.00), pwm[3] (0:02.00)",
        ],
        False,
    ),
    "a motor that never moved is gone": (
        topics("a"),
        {"pwm[1].value": [(0.1, 0.0), (20.0, 0.0)]},
        topics("a"),
        {"pwm[1].value": [(0.1, 0.0), (20.0, 0.0)], "pwm[2].value": [(0.1, 0.0), (20.0, 0.0)]},
        ["no difference: 2 values"],
        True,
    ),
    "never at the same time": (
        topics("a") | {"nt:/b": [(15.0, 1.0), (20.0, 1.0)]},
        {},
        topics("a") | {"nt:/b": []},
        {},
        [f"no difference: {SAME}", "here only: b (0:15.00)"],
        True,
    ),
    "chosen by us": (
        topics("a") | {"nt:/SmartDashboard/Auto/selected": [(0.1, "x"), (20.0, "x")]},
        {},
        topics("b", "c") | {"nt:/SmartDashboard/Auto/selected": [(0.1, "x"), (20.0, "x")]},
        {},
        [NOTHING],
        False,
    ),
}


@for_each("case", COMPARED)
def test_no_difference_is_said_only_where_most_was_compared(case: str, tmp_path: Path) -> None:
    network, hal, log_network, log_hal, begins, mostly = COMPARED[case]
    by = Comparison(True, given=frozenset({"nt:/SmartDashboard/Auto/selected"}))
    here, log = a_run(network, hal), a_run(log_network, log_hal, by)
    said = report(tmp_path, here, log)
    assert [line[: len(begin)] for line, begin in zip(said, begins, strict=False)] == begins
    runs = Runs(here)
    plain = runs.plain_difference(runs.add_branch(log))
    assert plain is not None
    assert (plain["t"], plain["mostly"], plain["compared"] == 0) == (None, mostly, begins[0] == NOTHING)
    assert [limit.replace("the log", "q.wpilog") for limit in plain["limits"]] == [
        line for line in said if line.startswith("little")
    ]


def test_eight_names_are_named_and_then_how_many_more(tmp_path: Path) -> None:
    for names, rest in (("abcdefgh", ""), ("abcdefghi", " and 1 more (-v names all)")):
        said = report(tmp_path, a_run(topics("x", *names), {}), a_run(topics("x"), {}, LOG))
        assert said[-1] == f"here only: {', '.join(f'{name} (0:01.00)' for name in names[:8])}{rest}"


def test_what_is_gone_before_the_log_has_it_is_not_compared(tmp_path: Path) -> None:
    log = a_run(topics("a") | {"nt:/b": [(0.1, 1.0), (20.0, 1.0)]}, {}, LOG)
    here = a_run(topics("a"), {})
    history = here.histories["network"]
    history.add(20.01, {"nt:/b": 2.0, "type:/b": "double"})  # after the end of what is compared
    log.histories["network"].add(20.02, {}, ["nt:/b"])
    first, second, third = report(tmp_path, here, log)
    assert first == "little can be compared: 1 of the 2 values of q.wpilog is not set here"
    assert second == f"what was compared does not differ: {SAME}"
    assert third == "in both, but never at the same time: b"
