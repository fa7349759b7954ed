"""The records of WPILib's data logs, ``.wpilog``: WPILib specifies the format, in `wpilibsuite/allwpilib/datalog/doc`.

Hand-written: WPILib's reader makes an object of each record, which takes longer than this whole index, and it stops at
a damaged record. Of each record, its moment and its place are kept, and its value is decoded when it is looked at.
"""

from __future__ import annotations

import mmap
from array import array
from collections.abc import Callable, Iterator
from pathlib import Path
from struct import Struct
from typing import Any, NamedTuple

from .log_formats import as_wpilog

#: The most records that are kept, with 12 bytes each: about 300 MiB.
MOST_RECORDS = 24_000_000
#: The largest files that are read as a whole, in bytes; larger ones are mapped.
_LARGEST_READ = 256 << 20
_HEADER = 12
#: How far behind a damaged place the next record is looked for, in bytes; and how many records must follow each other
#: where the time is another one, or an entry has no name so far; four times as many behind a damage.
_SEARCHED, _IN_A_ROW, _IN_A_ROW_UNNAMED = 1 << 16, 2, 8
#: Moments of neighbouring records that are further apart, in microseconds, are damaged; near ones need no closer look.
_FARTHEST, _NEAR_UNNAMED, _NEAR = 86_400_000_000, 3_600_000_000, 60_000_000
#: No clock of a robot, in microseconds, comes here.
_LATEST = 1 << 53
#: The bit of a record's first byte that is never set.
_SPARE = 128
#: At a multiple of this, in microseconds, the time of a simulation begins on the HAL's clock: at 0 until 2026.
SIMULATED_BOOT = 10**12
#: The entries with the time of day, in microseconds since 1970; and the times that can be: a robot that does not know
#: it begins in 1970.
CLOCKS, TIMES = ("systemTime", "/SystemStats/EpochTimeMicros"), range(1_500_000_000_000_000, 4_000_000_000_000_000)


def _masks(head: int) -> tuple[int, int, int, int, int]:
    """Return how to take apart what follows a record's first byte.

    :returns: the mask of the entry; the shift and the mask of the size; the shift of the moment; the header's length
    """
    if head >= _SPARE:
        return 0, 0, 0, 0, 1  # an empty control record, which there is not
    entry, size, moment = (head & 3) + 1, (head >> 2 & 3) + 1, (head >> 4 & 7) + 1
    return (1 << 8 * entry) - 1, 8 * entry, (1 << 8 * size) - 1, 8 * (entry + size), 1 + entry + size + moment


_HEADS = [_masks(head) for head in range(256)]

_Bytes = bytes | mmap.mmap


class LogEntry:
    """One entry's records, in the order of their moments."""

    def __init__(self, name: str, type_name: str) -> None:
        self.name, self.type_name = name, type_name
        self.moments, self.places = array("q"), array("I")

    def sort(self) -> None:
        """Put the records in the order of their moments: several threads of a robot write them."""
        moments = self.moments.tolist()
        if sorted(moments) != moments:
            order = sorted(range(len(self.moments)), key=self.moments.__getitem__)
            self.moments = array("q", [self.moments[each] for each in order])
            self.places = array("I", [self.places[each] for each in order])


class Record(NamedTuple):
    """A value in a log.

    :param at_us: when it was logged, in microseconds of the robot's clock; in a simulation, of robot time
    :param type_name: the name of its type in the log, such as ``int64``
    :param value: of a type in `READERS`, what that reads; of others, the bytes
    """

    at_us: int
    name: str
    type_name: str
    value: Any


class DataLog:
    """A data log, as far as it is whole.

    :param entries: those that have values; the records of one are in the order of their moments
    :param problem: what is wrong with the file, as a sentence; empty: nothing
    """

    def __init__(self, data: _Bytes, entries: list[LogEntry], problem: str) -> None:
        self._data, self.entries, self.problem = data, entries, problem

    def payload(self, place: int) -> bytes:
        """Return the bytes of the value of the record at a place."""
        _, size_shift, size_mask, _, length = _HEADS[self._data[place]]
        header = int.from_bytes(self._data[place + 1 : place + length], "little")
        begin = place + length
        return self._data[begin : begin + (header >> size_shift & size_mask)]

    def records(self, wanted: Callable[[LogEntry], bool]) -> Iterator[Record]:
        """Yield the values of some entries by their moments, and at the same moment as the file has them.

        What does not fit its type is left out.
        """
        found = [
            (moment, place, entry)
            for entry in self.entries
            if wanted(entry)
            for moment, place in zip(entry.moments, entry.places, strict=True)
        ]
        found.sort()  # no two have the same place
        for moment, place, entry in found:
            value = READERS.get(entry.type_name, bytes)(self.payload(place))
            if value is not None:
                yield Record(moment % SIMULATED_BOOT, entry.name, entry.type_name, value)


def read_data_log(file: Path, most: int = MOST_RECORDS) -> DataLog:
    """Find the records of a data log, also in another form (`log_formats`), as far as it is whole.

    :param most: the most records that are kept
    """
    data, problem = as_wpilog(file) or (_content(file), "")
    if len(data) < _HEADER:
        return DataLog(data, [], problem or "it ends within its header")
    index = _Index(data, most)
    index.read()
    entries = [entry for entry in index.entries if entry.moments]
    for entry in entries:
        entry.sort()
    return DataLog(data, entries, problem or index.problem)


def _content(file: Path) -> _Bytes:
    with file.open("rb") as opened:
        # Another program may overwrite the file while it is looked at: what is mapped would be gone, and this process.
        if file.stat().st_size <= _LARGEST_READ:
            return opened.read()
        return mmap.mmap(opened.fileno(), 0, access=mmap.ACCESS_READ)


class _Index:
    """Where the records of a log are."""

    def __init__(self, data: _Bytes, most: int) -> None:
        self._data, self._most = data, most
        self._open: dict[int, LogEntry] = {}
        self._named: dict[tuple[str, str], LogEntry] = {}
        #: Entries without a name so far: in a file that goes on with another one, records come before what names them.
        self._unnamed: dict[int, LogEntry] = {}
        #: The moments that need no closer look.
        self._window = (0, -1)
        self.problem = ""

    @property
    def entries(self) -> list[LogEntry]:
        return list(self._named.values())

    def read(self) -> None:
        """Find all records; what is damaged is skipped, and `problem` says where it begins."""
        place = _HEADER + int.from_bytes(self._data[8:12], "little")
        end = min(len(self._data), (1 << 32) - 1)
        while (place := self._records(place, end)) < end:
            if sum(len(entry.moments) for entry in self._named.values()) >= self._most:
                share = f"{place / len(self._data):.0%}"
                self.problem = f"it is very long: its first {self._most:,} records are read, {share} of the file"
                return
            self.problem = self.problem or self._why(place, end)
            place = self._next_record(place + 1, end)

    def _records(self, place: int, end: int) -> int:
        """Add records, and return the place of the first one that cannot be read."""
        data, heads, from_bytes = self._data, _HEADS, int.from_bytes
        adders: dict[int, tuple[Callable[[int], None], Callable[[int], None]]] = {}
        get = adders.get
        left = self._most - sum(len(entry.moments) for entry in self._named.values())
        low, high = self._window
        last = max(low, 0)
        while place < end and left:
            entry_mask, size_shift, size_mask, moment_shift, length = heads[data[place]]
            header = from_bytes(data[place + 1 : place + length], "little")
            after = place + length + (header >> size_shift & size_mask)
            adder = get(header & entry_mask)
            moment = header >> moment_shift
            if adder is None or after > end or not low <= moment <= high:
                number = header & entry_mask
                if after > end:
                    break
                if not number:
                    record = _control_of(data[place + length : after])
                    if record is None:
                        break
                    self._control(record)
                    adders.pop(record.entry, None)
                    place = after
                    continue
                if number not in self._open:
                    if not self._is_record(place, end, _IN_A_ROW_UNNAMED, needs_names=False):
                        break
                    self._open[number] = self._unnamed[number] = LogEntry("", "")
                moment = _signed(moment)
                if moment < 0:  # of a dashboard that was there before the robot's clock began
                    moment = last
                if not low <= moment <= high:
                    if not self._is_record(place, end, _IN_A_ROW, needs_names=number not in self._unnamed):
                        break
                    low, high = self._window = moment - _NEAR, moment + _NEAR
                entry = self._open[number]
                adder = adders[number] = entry.moments.append, entry.places.append
            adder[0](moment)
            last = moment
            adder[1](place)
            left -= 1
            place = after
        return place

    def _is_record(self, place: int, end: int, count: int, may_be_cut: bool = True, needs_names: bool = True) -> bool:
        """Return whether there are this many records in a row at a place, or until the end, at about the same time.

        :param may_be_cut: whether the end may be within one of them, but not within the first
        :param needs_names: whether their entries must have begun; otherwise, their times must be closer to each other
        """
        farthest = _FARTHEST if needs_names else _NEAR_UNNAMED
        first: int | None = None
        started = set(self._open)
        for checked in range(count):
            if place == end:
                return True
            entry_mask, size_shift, size_mask, moment_shift, length = _HEADS[self._data[place]]
            header = int.from_bytes(self._data[place + 1 : place + length], "little")
            number, size = header & entry_mask, header >> size_shift & size_mask
            moment = _signed(header >> moment_shift)
            after = place + length + size
            if after > end:
                return may_be_cut and checked > 0
            if not number:
                start = _control_of(self._data[place + length : after])
                if start is None:
                    return False
                started.add(start.entry)
            elif (needs_names and number not in started) or abs(moment) > _LATEST:
                return False
            elif moment >= 0:
                first = moment if first is None else first
                if abs(moment - first) > farthest:
                    return False
            place = after
        return True

    def _control(self, record: _Control) -> None:
        if record.name is not None:
            key = record.name, record.type_name
            self._open[record.entry] = entry = self._named.setdefault(key, LogEntry(*key))
            if (unnamed := self._unnamed.pop(record.entry, None)) is not None:
                entry.moments.extend(unnamed.moments)
                entry.places.extend(unnamed.places)

    def _next_record(self, place: int, end: int) -> int:
        """Return where records go on after a damaged place; the end, if they do not."""
        for each in range(place, min(place + _SEARCHED, end - 1)):
            if self._data[each] and self._is_record(each, end, 4 * _IN_A_ROW, may_be_cut=False):
                return each
        return end

    def _why(self, place: int, end: int) -> str:
        """Return what is wrong at a place, as the end of a sentence."""
        rest = self._data[place : place + _SEARCHED]
        if not any(rest):
            return f"from byte {place:,} on, it has only zeros, as after a loss of power"
        length = _HEADS[rest[0]][-1]
        header = int.from_bytes(rest[1:length], "little")
        known = rest[0] < _SPARE and (header & _HEADS[rest[0]][0]) in {0, *self._open}
        is_near = abs((header >> _HEADS[rest[0]][3]) - sum(self._window) // 2) <= _FARTHEST
        if end - place < length or (known and is_near and len(rest) < _SEARCHED):
            return f"it is cut at byte {place:,}, within a record"
        return f"it is damaged at byte {place:,}"


def _signed(moment: int) -> int:
    return moment - (1 << 64) if moment >> 63 else moment


class _Control(NamedTuple):
    """A control record.

    :param name: None: it starts no entry
    """

    entry: int
    name: str | None = None
    type_name: str = ""


def _control_of(payload: bytes) -> _Control | None:
    """Return a control record; None for another content."""
    if len(payload) < 5 or payload[0] > 2:
        return None
    entry = int.from_bytes(payload[1:5], "little")
    if payload[0]:
        return _Control(entry)
    texts, place = [], 5
    for _ in range(3):  # name, type, metadata
        size = int.from_bytes(payload[place : place + 4], "little")
        text = payload[place + 4 : place + 4 + size]
        if len(text) != size or place + 4 > len(payload):
            return None
        texts.append(text.decode("utf-8", "replace"))
        place += 4 + size
    type_name = _FORMER_TYPES.get(texts[1], texts[1])
    return _Control(entry, texts[0], type_name) if entry and place == len(payload) else None


# -- values -----------------------------------------------------------------------------------------------------------


def _number(code: str) -> Callable[[bytes], Any]:
    unpack, size = Struct(f"<{code}").unpack, Struct(f"<{code}").size
    return lambda raw: unpack(raw)[0] if len(raw) == size else None


def _list(code: str) -> Callable[[bytes], Any]:
    size = Struct(f"<{code}").size
    return lambda raw: Struct(f"<{len(raw) // size}{code}").unpack(raw) if len(raw) % size == 0 else None


def text_of(raw: bytes) -> str:
    return raw.decode("utf-8", "replace")


def _text_list(raw: bytes) -> tuple[str, ...] | None:
    texts, place = [], 4
    for _ in range(min(int.from_bytes(raw[:4], "little"), len(raw))):
        size = int.from_bytes(raw[place : place + 4], "little")
        texts.append(text_of(raw[place + 4 : place + 4 + size]))
        place += 4 + size
    return tuple(texts) if place == len(raw) else None


#: What WPILib called types of entries of NetworkTables, until March 2023 and January 2024.
_FORMER_TYPES = {"int": "int64", "int[]": "int64[]"}
#: What reads the values of plain types; None: the bytes do not fit.
READERS: dict[str, Callable[[bytes], Any]] = {
    "boolean": _number("?"),
    "int64": _number("q"),
    "float": _number("f"),
    "double": _number("d"),
    "string": text_of,
    "boolean[]": _list("?"),
    "int64[]": _list("q"),
    "float[]": _list("f"),
    "double[]": _list("d"),
    "string[]": _text_list,
}
