"""Add probes to code objects of CPython 3.11: instructions that look up a key in a dict when a line or a branch runs.

A trace function slows down all Python code of a thread, also libraries' that it ignores: a match of a competition robot
took 1.6 times as long. Probes cost something only at the places that have one. From Python 3.12, `sys.monitoring` does
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

_CONDITIONAL = frozenset(
    number
    for name, number in dis.opmap.items()
    if name.startswith(("POP_JUMP_", "JUMP_IF_")) and number in _WITH_TARGET
)
#: The forward version of each conditional jump: a jump to a branch's probe goes to the end of the code.
_FORWARD = {number: dis.opmap[dis.opname[number].replace("BACKWARD", "FORWARD")] for number in _CONDITIONAL}

#: Where a probe is: a line's number; or where a conditional jump begins, in units of two bytes, with whether it jumps,
#: or with None for the comparison before it.
Place = int | tuple[int, bool | None]

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


def with_probes(code: CodeType, keys: Mapping[Place, Any], found: Mapping[Any, Any]) -> CodeType:
    """Return the code with a probe at each of these places.

    The probe of a line or a branch evaluates ``found[key]`` when it runs, that of a comparison ``key[left, right]``.

    :param keys: the keys of the places; keys can be hashed
    :param found: can be hashed; lookups must not raise errors
    """
    return _Prober(code, keys, found).code()


def conditional_jumps(code: CodeType) -> Iterator[tuple[int, int, bool]]:
    """Return where each conditional jump begins, its line, and whether it depends on the comparison just before it."""
    before = None
    for each in _parse(code)[0]:
        if each.code in _CONDITIONAL and each.position[0] is not None:
            yield each.begin, each.position[0], before == dis.opmap["COMPARE_OP"]
        before = each.code


class _Prober:
    def __init__(self, code: CodeType, keys: Mapping[Place, Any], found: Mapping[Any, Any]) -> None:
        self._code = code
        self._keys = keys
        self._constants: list[object] = [*code.co_consts, found]
        self._indices: dict[Place, int] = {}
        self._new: list[_Instruction] = []
        #: Probes of branches that jump, which continue with the jump's target.
        self._detours: list[_Instruction] = []

    def code(self) -> CodeType:
        instructions, by_begin = _parse(self._code)
        table = [
            (by_begin[start], by_begin[end], by_begin[target], depth)
            for start, end, target, depth in _exception_table(self._code)
        ]
        targets = {id(each.target) for each in instructions if each.target} | {id(target) for _, _, target, _ in table}
        line_before: int | None = None
        for each, following in zip(instructions, [*instructions[1:], None], strict=True):
            line = each.position[0]
            begins = line != line_before or id(each) in targets
            if line is not None and line in self._keys and begins and each.code not in _NO_PROBE_BEFORE:
                self._add_before(each, self._lookup(line, each.position))
            if following is not None and following.code in _CONDITIONAL and (following.begin, None) in self._keys:
                self._add_before(each, self._measurement((following.begin, None), each.position))
            self._new.append(each)
            if each.code in _CONDITIONAL:
                self._add_branches(each)
            line_before = line
        new = self._new
        if self._detours:  # behind the end of the exception table's last entry
            new = [*new, *self._detours, _Instruction(dis.opmap["NOP"], 0, (None, None, None, None))]
        _arrange(new)
        return self._code.replace(
            co_code=b"".join(_bytes_of(each) for each in new[:-1]),
            co_consts=tuple(self._constants),
            co_linetable=b"".join(_locations(new, self._code.co_firstlineno)),
            co_exceptiontable=b"".join(_exceptions(table)),
            co_stacksize=self._code.co_stacksize + 3,
        )

    def _add_before(self, each: _Instruction, probe: list[_Instruction]) -> None:
        each.probe = each.probe or probe[0]
        self._new += probe

    def _add_branches(self, jump: _Instruction) -> None:
        if (jump.begin, False) in self._keys:
            self._new += self._lookup((jump.begin, False), jump.position)
        if (jump.begin, True) in self._keys:
            detour = self._lookup((jump.begin, True), jump.position)
            # Only loops need to be interruptible.
            back = "JUMP_BACKWARD" if jump.code in _BACKWARD else "JUMP_BACKWARD_NO_INTERRUPT"
            detour.append(_Instruction(dis.opmap[back], 0, jump.position, jump.target))
            self._detours += detour
            jump.code, jump.target = _FORWARD[jump.code], detour[0]

    def _constant(self, place: Place) -> int:
        if place not in self._indices:
            self._indices[place] = len(self._constants)
            self._constants.append(self._keys[place])
        return self._indices[place]

    def _lookup(self, place: Place, position: _Position) -> list[_Instruction]:
        return _instructions(
            position,
            ("LOAD_CONST", len(self._code.co_consts)),
            ("LOAD_CONST", self._constant(place)),
            ("BINARY_SUBSCR", 0),
            ("POP_TOP", 0),
        )

    def _measurement(self, place: Place, position: _Position) -> list[_Instruction]:
        return _instructions(
            position,
            ("LOAD_CONST", self._constant(place)),
            ("COPY", 3),
            ("COPY", 3),
            ("BUILD_TUPLE", 2),
            ("BINARY_SUBSCR", 0),
            ("POP_TOP", 0),
        )


def _instructions(position: _Position, *parts: tuple[str, int]) -> list[_Instruction]:
    return [_Instruction(dis.opmap[name], argument, position) for name, argument in parts]


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
