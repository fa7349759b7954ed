"""Add probes to code objects of CPython 3.11: instructions that look up a line in a dict when the line runs.

A trace function slows down all Python code of a thread, also libraries' that it ignores: a match of a competition robot
took 1.6 times as long. Probes cost something only on the lines that have one. From Python 3.12, `sys.monitoring` does
that. The format of 3.11's code objects is described in CPython's ``Objects/locations.md`` and
``Objects/exception_handling_notes.txt``, and fixed for that version.
"""

from __future__ import annotations

import dis
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby
from types import CodeType
from typing import Any

#: Whether this Python's code objects have the format that is known here.
SUPPORTED = sys.implementation.name == "cpython" and sys.version_info[:2] == (3, 11)

_CACHES: list[int] = getattr(dis, "_inline_cache_entries", [])
_WITH_TARGET = frozenset(dis.hasjrel)
_BACKWARD = frozenset(number for name, number in dis.opmap.items() if "JUMP_BACKWARD" in name)
#: These belong to the beginning of a function, or to the instruction before them.
_NO_PROBE_BEFORE = frozenset(
    dis.opmap[name] for name in ("RESUME", "MAKE_CELL", "COPY_FREE_VARS", "RETURN_GENERATOR") if name in dis.opmap
)

_Position = tuple["int | None", "int | None", "int | None", "int | None"]


@dataclass(eq=False)
class _Instruction:
    code: int
    argument: int
    position: _Position
    target: _Instruction | None = None
    #: The first instruction of the probe before this one, if there is one.
    probe: _Instruction | None = None
    #: Where it begins, in units of two bytes.
    begin: int = 0
    #: How many prefixes it has, for an argument of more than one byte. It only grows, so that `_arrange` ends.
    prefixes: int = 0

    def units(self) -> int:
        """Return the length with prefixes and caches."""
        self.prefixes = max(self.prefixes, (max(1, self.argument.bit_length()) - 1) // 8)
        return self.prefixes + 1 + _CACHES[self.code]


def with_probes(code: CodeType, keys: Mapping[int, object], found: Mapping[Any, Any]) -> CodeType:
    """Return the code with a probe where one of these lines begins to run: it evaluates ``found[key]``.

    :param keys: the keys of the lines by their numbers; keys can be hashed
    :param found: can be hashed; its lookup must not raise an error
    """
    instructions, by_begin = _parse(code)
    table = [
        (by_begin[start], by_begin[end], by_begin[target], depth)
        for start, end, target, depth in _exception_table(code)
    ]
    targets = {id(each.target) for each in instructions if each.target} | {id(target) for _, _, target, _ in table}
    constants: list[object] = [*code.co_consts, found]
    places: dict[int, int] = {}
    new: list[_Instruction] = []
    line_before: int | None = None
    for each in instructions:
        line = each.position[0]
        if line in keys and (line != line_before or id(each) in targets) and each.code not in _NO_PROBE_BEFORE:
            assert line is not None
            if line not in places:
                places[line] = len(constants)
                constants.append(keys[line])
            probe = [
                _Instruction(dis.opmap["LOAD_CONST"], len(code.co_consts), each.position),
                _Instruction(dis.opmap["LOAD_CONST"], places[line], each.position),
                _Instruction(dis.opmap["BINARY_SUBSCR"], 0, each.position),
                _Instruction(dis.opmap["POP_TOP"], 0, each.position),
            ]
            each.probe = probe[0]
            new += probe
        new.append(each)
        line_before = line
    _arrange(new)
    return code.replace(
        co_code=b"".join(_bytes_of(each) for each in new[:-1]),
        co_consts=tuple(constants),
        co_linetable=b"".join(_locations(new, code.co_firstlineno)),
        co_exceptiontable=b"".join(_exceptions(table)),
        co_stacksize=code.co_stacksize + 2,
    )


def _parse(code: CodeType) -> tuple[list[_Instruction], dict[int, _Instruction]]:
    """Return the instructions, and also by where they begin; an artificial last one stands for the end of the code."""
    raw, positions = code.co_code, list(code.co_positions())
    found: list[_Instruction] = []
    by_begin: dict[int, _Instruction] = {}
    unit, begin, argument = 0, 0, 0
    while unit < len(raw) // 2:
        number, argument = raw[2 * unit], argument << 8 | raw[2 * unit + 1]
        if number != dis.EXTENDED_ARG:
            each = _Instruction(number, argument, positions[unit], begin=begin)
            found.append(each)
            by_begin[begin] = each
            unit += _CACHES[number]
            argument, begin = 0, unit + 1
        unit += 1
    by_begin[begin] = _Instruction(dis.opmap["NOP"], 0, (None, None, None, None), begin=begin)
    found.append(by_begin[begin])
    ends = [each.begin for each in found[1:]]
    for each, end in zip(found, ends, strict=False):
        if each.code in _WITH_TARGET:
            each.target = by_begin[end - each.argument if each.code in _BACKWARD else end + each.argument]
    return found, by_begin


def _begin(each: _Instruction) -> int:
    """Return where an instruction begins, with its probe."""
    return (each.probe or each).begin


def _arrange(instructions: list[_Instruction]) -> None:
    """Set the places of all instructions and the arguments of jumps, which may need more units then."""
    changed = True
    while changed:
        changed = False
        unit = 0
        for each in instructions:
            each.begin = unit
            unit += each.units()
        for each in instructions:
            if each.target is not None:
                argument = abs(_begin(each.target) - each.begin - each.units())
                changed |= argument != each.argument
                each.argument = argument


def _bytes_of(each: _Instruction) -> bytes:
    *parts, last = each.argument.to_bytes(each.prefixes + 1, "big")
    prefixes = b"".join(bytes((dis.EXTENDED_ARG, part)) for part in parts)
    return prefixes + bytes((each.code, last)) + bytes(2 * _CACHES[each.code])


# -- where instructions come from ------------------------------------------------------------------------------------


def _locations(instructions: list[_Instruction], line: int) -> Iterator[bytes]:
    for position, together in groupby(instructions[:-1], key=lambda each: each.position):
        units = sum(each.units() for each in together)
        while units > 0:
            length = min(units, 8)
            units -= length
            begin, end, column, end_column = position
            if begin is None:
                yield bytes((0x80 | 15 << 3 | length - 1,))
                continue
            delta, line = begin - line, begin
            signed = _little((-delta << 1 | 1) if delta < 0 else delta << 1)
            if end is None or column is None or end_column is None:
                yield bytes((0x80 | 13 << 3 | length - 1,)) + signed
            else:
                rest = _little(end - begin) + _little(column + 1) + _little(end_column + 1)
                yield bytes((0x80 | 14 << 3 | length - 1,)) + signed + rest


def _little(number: int) -> bytes:
    """Return a number in groups of six bits, the lowest first."""
    found = bytearray()
    while number > 63:
        found.append(64 | number & 63)
        number >>= 6
    found.append(number)
    return bytes(found)


# -- exceptions ------------------------------------------------------------------------------------------------------


def _exception_table(code: CodeType) -> Iterator[tuple[int, int, int, int]]:
    """Return the beginning and end of each protected part, its handler, and the handler's depth of the stack."""
    values: list[int] = []
    number = 0
    for byte in getattr(code, "co_exceptiontable", b""):
        number = number << 6 | byte & 63
        if not byte & 64:
            values.append(number)
            number = 0
    for start, length, target, depth in zip(*[iter(values)] * 4, strict=True):
        yield start, start + length, target, depth


def _exceptions(table: list[tuple[_Instruction, _Instruction, _Instruction, int]]) -> Iterator[bytes]:
    for start, end, target, depth in table:
        numbers = (_begin(start), _begin(end) - _begin(start), _begin(target), depth)
        entry = bytearray(b"".join(map(_big, numbers)))
        entry[0] |= 128
        yield bytes(entry)


def _big(number: int) -> bytes:
    """Return a number in groups of six bits, the highest first."""
    found = [number & 63]
    while number := number >> 6:
        found.insert(0, 64 | number & 63)
    return bytes(found)
