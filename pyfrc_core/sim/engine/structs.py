"""Unfolds structs, such as ``struct:Pose2d``, into named parts, by the schemas that are published or logged with them.

The parts of ``/pose`` are values of their own, such as ``/pose/translation/x``; those of an array of structs are
``/modules/0/speed`` and the like.

Hand-written: WPILib's bindings decode only into classes that the program names, and a front end shows any struct.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Sequence
from typing import Any

#: What the name of a struct's type begins with, and what stands before it in the name of its schema. AdvantageKit and
#: PyKit have schemas in a table of their own.
STRUCT, SCHEMA = "struct:", "/.schema/struct:"
#: The formats of a schema's types, for the module `struct`.
_FORMATS = {
    "bool": "?", "char": "c", "int8": "b", "int16": "h", "int32": "i", "int64": "q", "uint8": "B", "uint16": "H",
    "uint32": "I", "uint64": "Q", "float": "f", "float32": "f", "double": "d", "float64": "d",
}  # fmt: skip
_DECLARATION = re.compile(
    r"(?:(?:enum)?\s*\{[^}]*\}\s*)?(?P<type>\w+)\s+(?P<name>\w+)\s*"
    r"(?:\[\s*(?P<count>[0-9]{1,6})\s*\]|:\s*(?P<bits>[0-9]{1,2}))?"
)
#: How deep structs may contain each other, and how many parts a value may have: a schema may contain itself.
_DEEPEST, _MOST_PARTS = 16, 4096
_MOST_BYTES = 1 << 20


class _UnknownSchema(Exception):
    """A schema is missing, or cannot be read."""


class StructLayout:
    """How a struct is stored.

    :param names: those of its parts, such as ``/translation/x``
    """

    def __init__(self, codes: str, names: Sequence[str], readers: Sequence[Callable[[tuple[Any, ...]], Any] | None]):
        self._format = struct.Struct(f"<{codes}")
        self.names, self.size = tuple(names), self._format.size
        self._readers = None if all(reader is None for reader in readers) else readers

    def values(self, data: bytes, at: int = 0) -> Sequence[Any]:
        """Return the values of the parts, from the bytes that begin at an index."""
        raw = self._format.unpack_from(data, at)
        if self._readers is None:
            return raw
        return [raw[index] if read is None else read(raw) for index, read in enumerate(self._readers)]


class Structs:
    """Unfolds values.

    :param schema_of: returns the schema of a struct; empty: there is none yet
    """

    def __init__(self, schema_of: Callable[[str], str]) -> None:
        self._schema_of = schema_of
        self._layouts: dict[str, StructLayout] = {}
        self._paths: dict[tuple[str, int], list[str]] = {}

    def layout(self, kind: str) -> StructLayout | None:
        """Return how a struct is stored; None when its schema is missing or damaged."""
        found = self._layouts.get(kind)
        if found is None:
            builder = _Builder(self._schema_of)
            try:
                builder.add(kind, "", 0)
            except _UnknownSchema:
                return None
            self._layouts[kind] = found = builder.layout()
        return found if found.size else None

    def parts(self, name: str, type_name: str, data: bytes) -> dict[str, Any]:
        """Return the values of a struct's parts, by their paths.

        What is no struct, or does not fit its schema, is one value that says what it is.
        """
        if not type_name.startswith(STRUCT):
            return {name: {"$": "bytes", "size": len(data)}}
        kind, is_list = type_name.removeprefix(STRUCT).removesuffix("[]"), type_name.endswith("[]")
        layout = self.layout(kind)
        count = 0 if layout is None else len(data) // layout.size
        if (
            layout is None
            or count * layout.size != len(data)
            or (count != 1 and not is_list)
            or (count * len(layout.names) > _MOST_PARTS)
        ):
            return {name: {"$": "struct", "type": type_name.removeprefix(STRUCT), "size": len(data)}}
        if not count:
            return {name: []}
        paths = self._paths.get((name, count if is_list else -1))
        if paths is None:
            items = [f"{name}/{index}" for index in range(count)] if is_list else [name]
            paths = [item + part for item in items for part in layout.names]
            self._paths[name, count if is_list else -1] = paths
        values = [value for at in range(0, len(data), layout.size) for value in layout.values(data, at)]
        return dict(zip(paths, values, strict=True))


class _Builder:
    """Collects the parts of one struct, with those of the structs in it."""

    def __init__(self, schema_of: Callable[[str], str]) -> None:
        self._schema_of = schema_of
        self._codes: list[str] = []
        self._names: list[str] = []
        self._readers: list[Callable[[tuple[Any, ...]], Any] | None] = []
        #: How many items `struct` unpacks so far.
        self._items = 0
        #: The bit field that is being filled: its bytes, and the bits that are used.
        self._unit = self._used = 0

    def layout(self) -> StructLayout:
        return StructLayout("".join(self._codes), self._names, self._readers)

    def add(self, kind: str, prefix: str, depth: int) -> None:
        """Add the parts of a struct.

        :param prefix: of their names
        """
        text = self._schema_of(kind)
        declarations = [each.strip() for each in text.split(";") if each.strip()]
        matches = [_DECLARATION.fullmatch(each) for each in declarations]
        if depth > _DEEPEST or not matches:
            raise _UnknownSchema
        self._unit = 0
        for match in matches:
            if match is None:
                raise _UnknownSchema
            self._add_field(match, prefix, depth)
            if len(self._names) > _MOST_PARTS or self._items > _MOST_BYTES:
                raise _UnknownSchema
        self._unit = 0

    def _add_field(self, match: re.Match[str], prefix: str, depth: int) -> None:
        kind, name, count = match["type"], f"{prefix}/{match['name']}", match["count"]
        code = _FORMATS.get(kind)
        if match["bits"] is not None:
            self._add_bits(code, name, int(match["bits"]))
            return
        self._unit = 0
        if code is None:
            for item in (
                [name] if count is None else [f"{name}/{index}" for index in range(min(int(count), _MOST_PARTS))]
            ):
                self.add(kind, item, depth + 1)
        elif code == "c":
            self._add(f"{count or 1}s", name, 1, _text_reader(self._items))
        elif count is None:
            self._add(code, name, 1, _item_reader(self._items))
        else:
            self._add(f"{count}{code}", name, int(count), _list_reader(self._items, int(count)))

    def _add(self, code: str, name: str, items: int, reader: Callable[[tuple[Any, ...]], Any]) -> None:
        self._codes.append(code)
        # Without a reader, the part is the item with its own index.
        is_item = items == 1 and self._items == len(self._names) and code[-1] != "s" and len(code) == 1
        self._names.append(name)
        self._readers.append(None if is_item else reader)
        self._items += items

    def _add_bits(self, code: str | None, name: str, bits: int) -> None:
        """Add a bit field: it shares its bytes with the one before, if it fits there and its type has as many bytes."""
        if code is None or code in "cfd" or not 0 < bits <= 8 * struct.calcsize(code) or (code == "?" and bits != 1):
            raise _UnknownSchema
        size = struct.calcsize(f"<{code}")
        fits = self._unit and self._used + bits <= 8 * self._unit and (code == "?" or size == self._unit)
        if not fits:
            self._unit, self._used = size, 0
            self._codes.append({1: "B", 2: "H", 4: "I", 8: "Q"}[size])
            self._items += 1
        self._names.append(name)
        self._readers.append(_bits_reader(self._items - 1, self._used, bits, code))
        self._used += bits


def _item_reader(index: int) -> Callable[[tuple[Any, ...]], Any]:
    return lambda raw: raw[index]


def _list_reader(index: int, count: int) -> Callable[[tuple[Any, ...]], Any]:
    return lambda raw: list(raw[index : index + count])


def _text_reader(index: int) -> Callable[[tuple[Any, ...]], Any]:
    return lambda raw: raw[index].rstrip(b"\0").decode("utf-8", "replace")


def _bits_reader(index: int, shift: int, bits: int, code: str) -> Callable[[tuple[Any, ...]], Any]:
    def read(raw: tuple[Any, ...]) -> Any:
        value = (raw[index] >> shift) & ((1 << bits) - 1)
        if code == "?":
            return bool(value)
        return value - (1 << bits) if code.islower() and value >> (bits - 1) else value

    return read
