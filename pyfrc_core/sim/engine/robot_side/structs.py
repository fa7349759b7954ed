"""Decodes the structs of NetworkTables, such as ``struct:Pose2d``, by the schemas that are published beside them.

Hand-written: WPILib's bindings decode only into classes that the program names, and a front end shows any struct.
Bit fields and enumerations are shown as the numbers that they are stored as; a schema with bit fields is not decoded.
"""

from __future__ import annotations

import re
import struct
from typing import Any

from ....wpi import network

_STRUCT, _SCHEMA = "struct:", "/.schema/struct:"
#: The formats of a schema's types, for the module `struct`, little-endian.
_FORMATS = {
    "bool": "?", "char": "c", "int8": "b", "int16": "h", "int32": "i", "int64": "q", "uint8": "B", "uint16": "H",
    "uint32": "I", "uint64": "Q", "float": "f", "float32": "f", "double": "d", "float64": "d",
}  # fmt: skip
_FIELD = re.compile(r"(?:(?:enum)?\s*\{[^}]*\}\s*)?(\w+)\s+(\w+)(?:\[(\d+)\])?")
#: How deep structs may contain each other: a schema that contains itself has no end.
_DEEPEST = 16


class _UnknownSchema(Exception):
    """A schema is missing, or cannot be decoded."""


class StructReader:
    """Decodes raw values of topics."""

    def __init__(self) -> None:
        self._fields: dict[str, list[tuple[str, str, int | None]]] = {}

    def read(self, name: str, type_name: str, data: bytes) -> Any:
        """Return a struct's value as plain data, marked with its type; of other data, only its size."""
        if not type_name.startswith(_STRUCT):
            return {"$": "bytes", "size": len(data)}
        kind, is_array = type_name.removeprefix(_STRUCT).removesuffix("[]"), type_name.endswith("[]")
        try:
            size = self._size(kind)
            if not is_array:
                return self._marked(kind, data)
            if size == 0 or len(data) % size:
                raise _UnknownSchema
            return [self._marked(kind, data[at : at + size]) for at in range(0, len(data), size)]
        except (_UnknownSchema, struct.error):
            return {"$": "struct", "type": kind, "size": len(data)}

    def _marked(self, kind: str, data: bytes) -> dict[str, Any]:
        return {"$": "struct", "type": kind, "value": self._decode(kind, data, 0)[0]}

    def _decode(self, kind: str, data: bytes, at: int) -> tuple[dict[str, Any], int]:
        found: dict[str, Any] = {}
        for name, field_kind, count in self._fields_of(kind):
            items: list[Any] = []
            for _ in range(1 if count is None else count):
                if (code := _FORMATS.get(field_kind)) is not None:
                    (item,) = struct.unpack_from(f"<{code}", data, at)
                    at += struct.calcsize(f"<{code}")
                else:
                    item, at = self._decode(field_kind, data, at)
                items.append(item)
            if field_kind == "char":
                found[name] = b"".join(items).rstrip(b"\0").decode("utf-8", "replace")
            else:
                found[name] = items[0] if count is None else items
        return found, at

    def _size(self, kind: str, depth: int = 0) -> int:
        if (code := _FORMATS.get(kind)) is not None:
            return struct.calcsize(f"<{code}")
        if depth > _DEEPEST:
            raise _UnknownSchema
        return sum(self._size(each, depth + 1) * (1 if count is None else count)
                   for _, each, count in self._fields_of(kind))  # fmt: skip

    def _fields_of(self, kind: str) -> list[tuple[str, str, int | None]]:
        if kind not in self._fields:
            text = network.data_of(_SCHEMA + kind).decode("utf-8", "replace")
            declarations = [each.strip() for each in text.split(";") if each.strip()]
            matches = [_FIELD.fullmatch(each) for each in declarations]
            if not matches or None in matches:
                raise _UnknownSchema
            self._fields[kind] = [
                (match[2], match[1], None if match[3] is None else int(match[3])) for match in matches if match
            ]
        return self._fields[kind]
