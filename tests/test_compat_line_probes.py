"""Probes in code objects of Python 3.11: they find the lines that a trace function finds, and change nothing else."""

from __future__ import annotations

import os
import signal
import sys
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path
from types import CodeType, FrameType, FunctionType
from typing import Any

import pytest

from pyfrc_core.compat import line_probes

pytestmark = pytest.mark.skipif(not line_probes.SUPPORTED, reason="Python 3.12 has sys.monitoring, 3.10 other code")

MODULES = ("argparse", "_pydecimal", "asyncio/base_events", "contextlib", "dataclasses", "fractions", "textwrap")


class Found(dict[Any, Any]):
    """Adds each key that is looked up."""

    __hash__ = object.__hash__

    def __missing__(self, key: object) -> None:
        self[key] = None


def with_nested(code: CodeType) -> Iterator[CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from with_nested(constant)


def lines_of(code: CodeType) -> set[int]:
    return {line for _, _, line in code.co_lines() if line} - {code.co_firstlineno}


@pytest.mark.parametrize("name", MODULES)
def test_code_without_probes_stays_as_it_is(name: str) -> None:
    file = Path(os.__file__).parent / f"{name}.py"
    for code in with_nested(compile(file.read_text("utf-8"), str(file), "exec")):
        copy = line_probes.with_probes(code, {}, Found())
        assert copy.co_code == code.co_code
        assert copy.co_exceptiontable == code.co_exceptiontable  # type: ignore[attr-defined,unused-ignore]
        assert list(copy.co_positions()) == list(code.co_positions())  # type: ignore[attr-defined,unused-ignore]


def branches(number: int) -> list[object]:
    found: list[object] = []
    for each in range(number):
        try:
            if each % 3 == 0:
                found.append(1 / (each % 2))
            elif each % 3 == 1:
                found.append(
                    [
                        other * each
                        for other in range(each)
                        if other != 2
                    ]
                )  # fmt: skip
            else:
                raise KeyError(each)
        except ZeroDivisionError:
            found.append("zero")
        except KeyError as error:
            found.append(error.args)
            continue
        finally:
            found.append(each)
    while True:
        number -= 1
        if number < 0:
            break
    return found


def generators(number: int) -> list[object]:
    def inner(most: int) -> Iterator[int]:
        for each in range(most):
            got = yield each
            if got:
                yield -1

    def outer(most: int) -> Iterator[int]:
        yield from inner(most)
        with pytest.raises(ZeroDivisionError):
            raise ZeroDivisionError

    return [*outer(number), (lambda x: x + 1)(number)]


def many_jumps(number: int) -> int:
    # The bodies are long, so that jumps with probes need prefixes that they did not need before.
    total = 0
    for each in range(number):
        if each % 2:
            total += each + each * each - each // 2 + each % 7 + each * 3 - each // 5 + each % 11
            total += each + each * each - each // 2 + each % 7 + each * 3 - each // 5 + each % 11
            total += each + each * each - each // 2 + each % 7 + each * 3 - each // 5 + each % 11
            total += each + each * each - each // 2 + each % 7 + each * 3 - each // 5 + each % 11
            total += each + each * each - each // 2 + each % 7 + each * 3 - each // 5 + each % 11
            total += each + each * each - each // 2 + each % 7 + each * 3 - each // 5 + each % 11
        else:
            total -= 1
    return total


@pytest.mark.parametrize("function", [branches, generators, many_jumps], ids=lambda each: each.__name__)
def test_they_find_the_lines_that_a_trace_function_finds(function: Callable[[int], object]) -> None:
    assert isinstance(function, FunctionType)
    codes = set(with_nested(function.__code__))
    traced: set[int] = set()

    def on_event(frame: FrameType, event: str, argument: object) -> Any:
        if frame.f_code not in codes:
            return None
        if event == "line" and frame.f_lineno in lines_of(frame.f_code):
            traced.add(frame.f_lineno)
        return on_event

    before = sys.gettrace()
    sys.settrace(on_event)
    try:
        result = function(9)
    finally:
        sys.settrace(before)

    found = Found()

    def probed(code: CodeType) -> CodeType:
        parts = tuple(probed(each) if isinstance(each, CodeType) else each for each in code.co_consts)
        return line_probes.with_probes(code.replace(co_consts=parts), {line: line for line in lines_of(code)}, found)

    copy = FunctionType(probed(function.__code__), globals(), function.__name__)
    assert repr(copy(9)) == repr(result)
    assert set(found) == traced


def test_an_exception_names_the_same_place() -> None:
    found = Found()
    code = line_probes.with_probes(branches.__code__, {line: line for line in lines_of(branches.__code__)}, found)
    with pytest.raises(TypeError) as real:
        branches("x")  # type: ignore[arg-type]
    with pytest.raises(TypeError) as copied:
        FunctionType(code, globals())("x")
    assert copied.traceback[-1].lineno == real.traceback[-1].lineno


def decisions(number: int) -> list[object]:
    found: list[object] = []
    left = number
    while left > 0 and found is not None:
        left -= 1
        if left == 3 or (left > 5 and not left % 2):
            found.append(left)
        found.append(left or "zero")
        found.append(left and "more")
        try:
            if left < 2:
                raise ValueError(left)
        except ValueError as error:
            found.append(error.args)
            if left is None:
                break
    return found


@pytest.mark.parametrize("function", [branches, generators, many_jumps, decisions], ids=lambda each: each.__name__)
def test_probes_of_branches_change_nothing_else(function: Callable[[int], object]) -> None:
    assert isinstance(function, FunctionType)
    found = Found()
    ways = {}

    def probed(code: CodeType) -> CodeType:
        parts = tuple(probed(each) if isinstance(each, CodeType) else each for each in code.co_consts)
        jumps = list(line_probes.conditional_jumps(code))
        keys = {(at, way): (code.co_name, line, way) for at, line, _ in jumps for way in (False, True)}
        ways.update(dict.fromkeys(keys.values()))
        lines = {line: line for line in lines_of(code)}
        return line_probes.with_probes(code.replace(co_consts=parts), {**keys, **lines}, found)

    copy = FunctionType(probed(function.__code__), globals(), function.__name__)
    assert repr(copy(9)) == repr(function(9))
    assert len([way for way in ways if way in found]) >= len(ways) / 2


def test_a_module_with_all_probes_does_the_same() -> None:
    found = Found()

    def probed(code: CodeType) -> CodeType:
        parts = tuple(probed(each) if isinstance(each, CodeType) else each for each in code.co_consts)
        places: list[Any] = list(lines_of(code))
        for at, _, compared in line_probes.conditional_jumps(code):
            places += [(at, False), (at, True), *([(at, None)] if compared else [])]
        keys = {place: found if isinstance(place, tuple) and place[1] is None else (code, place) for place in places}
        return line_probes.with_probes(code.replace(co_consts=parts), keys, found)

    file = Path(os.__file__).parent / "textwrap.py"
    module = {"__name__": "textwrap"}
    exec(probed(compile(file.read_text("utf-8"), str(file), "exec")), module)
    text = file.read_text("utf-8")
    for width in (10, 40, 200):
        assert module["fill"](text, width) == textwrap.fill(text, width)  # type: ignore[operator]
    assert module["dedent"](text) == textwrap.dedent(text)  # type: ignore[operator]
    assert len(found) > 200


def test_both_ways_of_a_branch_are_told_apart() -> None:
    def decide(number: int) -> str:
        return "low" if number < 5 else "high"

    ((at, _, compared),) = line_probes.conditional_jumps(decide.__code__)
    assert compared
    for number, way in ((1, False), (9, True)):
        found = Found()
        code = line_probes.with_probes(decide.__code__, {(at, False): False, (at, True): True}, found)
        assert FunctionType(code, globals())(number) == decide(number)
        assert list(found) == [way]


def test_a_probe_of_a_comparison_reads_both_operands() -> None:
    def decide(number: int) -> str:
        return "low" if number * 2 < 5 else "high"

    class Pairs(list[Any]):
        __hash__ = object.__hash__  # type: ignore[assignment]

        def __getitem__(self, pair: Any) -> None:
            self.append(pair)

    ((at, _, _),) = line_probes.conditional_jumps(decide.__code__)
    pairs = Pairs()
    code = line_probes.with_probes(decide.__code__, {(at, None): pairs}, Found())
    assert FunctionType(code, globals())(7) == "high"
    assert pairs == [(14, 5)]


def test_a_loop_with_a_probe_of_its_branch_can_be_interrupted() -> None:
    def loop(going: list[int]) -> None:
        while going:
            pass

    keys = {(at, way): way for at, _, _ in line_probes.conditional_jumps(loop.__code__) for way in (False, True)}
    function = FunctionType(line_probes.with_probes(loop.__code__, keys, Found()), globals())

    def interrupt(number: int, frame: object) -> None:
        raise KeyError

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.1)
    try:
        with pytest.raises(KeyError):
            function([1])
    finally:
        signal.signal(signal.SIGALRM, before)
