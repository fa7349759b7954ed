"""Traces: which lines they have, and that the same run has the same hash."""

from __future__ import annotations

import io
import json
import math
import random
from typing import Any

from pyfrc_core.hal.change_reader import ChangeReader
from pyfrc_core.runtime.scripts.trace import FORMAT, Trace
from pyfrc_core.runtime.scripts.trace_lines import Change, lines_of, trace_line


class Tree:
    """As much of `hal_data` as a trace looks at."""

    def __init__(self) -> None:
        self.paths: list[str] = []
        self.values: list[Any] = []

    def read(self) -> tuple[list[str], list[Any]]:
        return self.paths, self.values

    def changes(self) -> ChangeReader:
        return ChangeReader(self)


def trace_of(*looks: dict[str, Any], digest: bool = False) -> list[Any]:
    """The lines of a trace of these values, a look for each; the paths stay one list while they are the same."""
    tree, out = Tree(), io.StringIO()
    trace = Trace(tree, out)  # type: ignore[arg-type]
    for number, values in enumerate(looks):
        if list(values) != tree.paths:
            tree.paths = list(values)
        tree.values = list(values.values())
        trace.look(number * 0.02)
    assert trace.finish() == trace.digest()
    lines = [json.loads(line) for line in out.getvalue().splitlines()]
    assert lines[0] == {"format": FORMAT}
    assert lines[-1] == {"sha256": trace.digest()}
    return [lines[-1]] if digest else lines[1:-1]


def test_each_packet_has_what_has_changed() -> None:
    assert trace_of({"a": 1, "b": 2}, {"a": 1, "b": 2}, {"a": 1, "b": 3}, {"a": 0, "b": 3}) == [
        {"t": 0.0, "set": {"a": 1, "b": 2}},
        {"t": 0.04, "set": {"b": 3}},
        {"t": 0.06, "set": {"a": 0}},
    ]


def test_what_comes_and_goes() -> None:
    assert trace_of({"a": 1}, {"a": 1, "b": 2}, {"b": 2}, {"b": 2}, {}, {}) == [
        {"t": 0.0, "set": {"a": 1}},
        {"t": 0.02, "set": {"b": 2}},
        {"t": 0.04, "set": {}, "gone": ["a"]},
        {"t": 0.08, "set": {}, "gone": ["b"]},
    ]


def test_nan_is_no_change_of_nan() -> None:
    nan, other = float("nan"), float("nan")
    lines = trace_of(
        {"a": nan, "b": 1},
        {"a": float("nan"), "b": 1},
        {"a": float("nan"), "b": 2},
        {"a": 1.0, "b": 2},
        {"a": nan, "b": 2},
    )
    assert [sorted(line["set"]) for line in lines] == [["a", "b"], ["b"], ["a"], ["a"]]
    assert math.isnan(lines[0]["set"]["a"])
    # Also where something else has come or gone.
    lines = trace_of({"a": nan}, {"a": other, "b": 1}, {"a": 2.0})
    assert [sorted(line["set"]) for line in lines] == [["a"], ["b"], ["a"]]


def test_the_hash_is_of_all_lines_in_their_order() -> None:
    def digest(*looks: dict[str, Any]) -> list[Any]:
        return trace_of(*looks, digest=True)

    assert digest({"a": 1}, {"a": 2}) == digest({"a": 1}, {"a": 2})
    assert digest({"a": 1}, {"a": 2}) == digest({"a": 1}, {"a": 2}, {"a": 2})
    assert digest({"a": 1}, {"a": 2}) != digest({"a": 2}, {"a": 1})
    assert digest({"a": 1}) != digest({"b": 1})


def test_a_trace_without_a_file_has_the_same_hash() -> None:
    tree, out = Tree(), io.StringIO()
    tree.paths, tree.values = ["a"], [1.5]
    quiet, written = Trace(tree), Trace(tree, out)  # type: ignore[arg-type]
    for trace in (quiet, written):
        trace.look(0.0199999999)
    assert quiet.finish() == written.finish()
    assert json.loads(out.getvalue().splitlines()[1]) == {"t": 0.02, "set": {"a": 1.5}}


def test_lines_are_json_that_returns_each_value() -> None:
    values: dict[str, Any] = {
        'CAN["b"].x': 1.5,
        "robot.\u00e9\n": -0.0,
        "pwm[10].value": 0.0,
        "pwm[9].value": math.nan,
        "custom.far": math.inf,
        "custom.deep": {"b": [1e16, -math.inf], "a": None},
        "custom.text": "\u00e9",
        "custom.half": "\ud800",
        "dio[0].value": True,
        "encoder[0].count": 2**70,
        "time.remaining": 1e-05,
    }
    for number in range(len(values) + 1):
        some = dict(list(values.items())[:number])
        for gone in ([], ["x"]):
            line = trace_line(0.02, some, gone)
            expected = {"t": 0.02, "set": some} | ({"gone": gone} if gone else {})
            assert repr(json.loads(line)) == repr(expected)
            marked = Change(0.02, some | {"CAN.z": [1.0, "}"]}, tuple(gone), frozenset({"CAN.z"}))
            hashed, whole = lines_of(marked)
            assert hashed == (line if some or gone else "")
            assert repr(json.loads(whole)) == repr({**expected, "unrepeatable": {"CAN.z": [1.0, "}"]}})
            assert lines_of(Change(0.02, some, tuple(gone))) == (line, line)


def test_floats_are_written_with_all_their_digits() -> None:
    chance = random.Random(7)
    some = [chance.uniform(-1, 1) * 10.0 ** chance.randrange(-20, 25) for _ in range(2000)]
    some += [sign * 10.0**exponent * near for exponent in range(-8, 24) for near in (1, 1 - 1e-16) for sign in (1, -1)]
    some += [2.0**exponent for exponent in range(-1074, 1024)]
    values: dict[str, object] = {f"p{number}": value for number, value in enumerate(some)}
    assert list(json.loads(trace_line(0.02, values))["set"].values()) == some
