"""Other forms of data logs, as the bytes of a ``.wpilog``: compressed, ``.wpilogxz``; AdvantageKit's ``.rlog``.

AdvantageKit describes its format in its `RLOG-SPEC.md`. In revision 1, of 2022, each value says its type, one of ten.
In revision 2, each key does, by WPILib's name of it. Numbers are big-endian, in structs as WPILib has them.
"""

from __future__ import annotations

from array import array
from pathlib import Path
from struct import Struct, pack, unpack

_XZ, _NAME = b"\xfd7zXZ\0", b"WPILOG"
#: The header of a ``.wpilog`` of version 1.0 without further text.
_WPILOG = _NAME + b"\0\1" + bytes(4)
_RLOG = ".rlog"
#: The most bytes of a ``.wpilog`` that are made of another file, and how many are unpacked at once.
_MOST, _STEP = 1 << 30, 1 << 20
_VERY_LONG = f"it is very long: the first {_MOST >> 20:,} MB of what is in it are read"
#: A record of a ``.wpilog``: how long the numbers of its header are, entry, size, moment.
_RECORD, _LENGTHS = Struct("<BIIQ"), 3 | 3 << 2 | 7 << 4
#: No robot runs for so many seconds.
_LATEST = 1e9
#: The letters for numbers, in modules of Python, by their types.
_CODES = {"int64": "q", "int": "q", "float": "f", "double": "d"}
#: Of revision 1: the types by their numbers, with the bytes of one value. Each is followed by that of its arrays.
_TYPES = {1: ("boolean", 1), 3: ("int64", 4), 5: ("double", 8), 7: ("string", 0), 9: ("raw", 1)}
#: The endings of robots' logs that can be read, and of these with the driver station's.
ROBOT_LOGS = (".wpilog", ".wpilogxz", _RLOG)
LOGS = (*ROBOT_LOGS, ".dslog", ".dsevents")
#: Endings of logs that only their makers' tools can read, with what converts them.
FOREIGN_LOGS = {
    ".hoot": "CTRE's format is closed. Phoenix Tuner X (Log Extractor) or CTRE's command owlet writes it as a "
    ".wpilog: owlet -f wpilog FILE.hoot FILE.wpilog",
    ".revlog": "REV's format is not read here. REV's revlog-converter (github.com/REVrobotics/node-revlog-converter) "
    "writes it as a .wpilog: revlog-converter FILE.revlog -o FILE.wpilog",
}


class _DamagedError(Exception):
    """A message cannot be read. The text is the end of a sentence."""


def is_other_form(head: bytes, name: str) -> bool:
    """Return whether a file is a data log in another form.

    :param head: its beginning
    """
    if name.lower().endswith(_RLOG):
        return head[:1] in (b"\1", b"\2")
    if not head.startswith(_XZ):
        return False
    import lzma

    try:
        return lzma.LZMADecompressor().decompress(head, len(_NAME)) == _NAME
    except lzma.LZMAError:
        return False


def as_wpilog(file: Path) -> tuple[bytes, str] | None:
    """Return a log in another form as a ``.wpilog``, and what is wrong with it, as a sentence or an empty text.

    :return: None for other files, such as a ``.wpilog``
    """
    with file.open("rb") as opened:
        head = opened.read(len(_XZ))
        if head == _XZ:
            return _unpacked(file)
        return _Rlog(head + opened.read()).convert() if head[:1] in (b"\1", b"\2") else None


def _unpacked(file: Path) -> tuple[bytes, str]:
    import lzma

    data, problem = bytearray(), ""
    with lzma.open(file) as opened:
        try:
            while not problem and (piece := opened.read1(_STEP)):
                data += piece
                problem = _VERY_LONG if len(data) > _MOST else ""
        except EOFError:
            problem = f"it is cut: the first {len(data):,} bytes of what is packed in it are read"
        except lzma.LZMAError:
            problem = f"it is damaged: the first {len(data):,} bytes of what is packed in it are read"
    return bytes(data), problem


class _Rlog:
    """A log of AdvantageKit.

    :param data: the file's content; its first byte is the revision
    """

    def __init__(self, data: bytes) -> None:
        self._data, self._place = data, 1
        self._has_types = data[:1] == b"\2"
        #: The names of keys and, in revision 2, their types.
        self._keys: dict[int, tuple[str, str]] = {}
        self._entries: dict[tuple[str, str], int] = {}
        self._written = bytearray(_WPILOG)
        self._moment = 0

    def convert(self) -> tuple[bytes, str]:
        """Return it as a ``.wpilog``, as far as it is whole, and what is wrong with it."""
        problem = ""
        while self._place < len(self._data) and not problem:
            begin = self._place
            try:
                self._message()
                problem = _VERY_LONG if len(self._written) > _MOST else ""
            except _DamagedError as error:
                problem = f"it is {error.args[0].format(f'byte {begin:,}')}"
        return bytes(self._written), problem

    def _message(self) -> None:
        kind = self._number(1)
        if kind == 0:
            (seconds,) = unpack(">d", self._take(8))
            if not 0 <= seconds < _LATEST:  # nor NaN
                raise _DamagedError("damaged at {}: a time is wrong")
            self._moment = round(seconds * 1_000_000)
            self._write("/Timestamp", "int64", self._moment.to_bytes(8, "little"))  # as in AdvantageKit's .wpilog
        elif kind == 1:
            number, name = self._number(2), self._text()
            self._keys[number] = (name, self._text() if self._has_types else "")
        elif kind == 2 and (found := self._keys.get(self._number(2))):
            name, type_name = found
            if self._has_types:
                self._write(name, type_name, _little_endian(type_name, self._take(self._number(2))))
            elif value := self._typed_value():
                self._write(name, *value)
        else:
            raise _DamagedError("damaged at {}")

    def _typed_value(self) -> tuple[str, bytes] | None:
        """Return the type and the bytes of a value in revision 1; None for one that has gone."""
        number = self._number(1)
        if number == 0:
            return None
        is_array = number % 2 == 0
        type_name, size = _TYPES.get(number - is_array, ("", 0))
        if not type_name:
            raise _DamagedError("damaged at {}: a type is wrong")
        if type_name == "string":
            if not is_array:
                return type_name, self._take(self._number(2))
            return "string[]", _text_array([self._take(self._number(2)) for _ in range(self._number(2))])
        count = self._number(2) if is_array else 1
        data = self._take(size * count)
        name = f"{type_name}[]" if is_array and type_name != "raw" else type_name
        if type_name == "int64":  # of four bytes
            return name, pack(f"<{count}q", *unpack(f">{count}i", data))
        return name, _little_endian(name, data)

    def _write(self, name: str, type_name: str, payload: bytes) -> None:
        entry = self._entries.get((name, type_name))
        if entry is None:
            entry = self._entries[name, type_name] = len(self._entries) + 1
            start = (
                b"\0" + entry.to_bytes(4, "little") + b"".join(map(_sized, (name.encode(), type_name.encode(), b"")))
            )
            self._written += _RECORD.pack(_LENGTHS, 0, len(start), self._moment) + start
        self._written += _RECORD.pack(_LENGTHS, entry, len(payload), self._moment) + payload

    def _take(self, size: int) -> bytes:
        taken = self._data[self._place : self._place + size]
        if len(taken) < size:
            raise _DamagedError("cut at {}, within a record")
        self._place += size
        return taken

    def _number(self, size: int) -> int:
        return int.from_bytes(self._take(size), "big")

    def _text(self) -> str:
        return self._take(self._number(2)).decode("utf-8", "replace")


def _little_endian(type_name: str, data: bytes) -> bytes:
    """Return a value as WPILib has it. What does not fit its type stays as it is, so that its reader leaves it out."""
    if type_name == "string[]":
        texts, place = [], 4
        for _ in range(min(int.from_bytes(data[:4], "big"), len(data))):
            size = int.from_bytes(data[place : place + 4], "big")
            texts.append(data[place + 4 : place + 4 + size])
            place += 4 + size
        return _text_array(texts) if place == len(data) else data
    code = _CODES.get(type_name.removesuffix("[]"))
    if code is None or len(data) % array(code).itemsize:
        return data
    numbers = array(code, data)
    numbers.byteswap()
    return numbers.tobytes()


def _text_array(texts: list[bytes]) -> bytes:
    return len(texts).to_bytes(4, "little") + b"".join(map(_sized, texts))


def _sized(text: bytes) -> bytes:
    return len(text).to_bytes(4, "little") + text
