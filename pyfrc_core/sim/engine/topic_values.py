"""The values of NetworkTables' topics by path, as front ends show them.

Paths are targets of input scripts (``nt:/SmartDashboard/kP``), and the same with ``type:`` for the topics' types.
Structs come as their parts, which have no type of their own.
"""

from __future__ import annotations

from typing import Any

from .messages import TYPE, VALUE
from .structs import SCHEMA, Structs


class TopicValues:
    """The values of all topics."""

    def __init__(self) -> None:
        #: The schemas of structs that were published so far, by the structs' names.
        self._schemas: dict[str, str] = {}
        self._structs = Structs(lambda kind: self._schemas.get(kind, ""))
        #: The paths of the parts of each topic that has any.
        self._parts: dict[str, tuple[str, ...]] = {}
        #: All values at the last `changes`, by path.
        self.values: dict[str, Any] = {}
        self._changed: dict[str, Any] = {}
        self._gone: dict[str, None] = {}

    def note(self, path: str, value: Any) -> None:
        """Take over a value that is no topic's."""
        self._changed[path] = value

    def take(self, name: str, type_name: str, value: Any) -> None:
        """Take over the value of a topic. A schema must come before what it describes.

        :param value: plain, or bytes; None: the topic has none, or is gone
        """
        if SCHEMA in name and isinstance(value, bytes):
            self._schemas[name.rpartition(SCHEMA)[2]] = value.decode("utf-8", "replace")
        before = self._parts.pop(name, (VALUE + name,))
        parts = {} if value is None else self._parts_of(name, type_name, value)
        for path in before:
            if path not in parts:
                self._gone[path] = None
                self._changed.pop(path, None)
        for path, part in parts.items():
            self._gone.pop(path, None)
            self._changed[path] = part
        if parts:
            self._changed[TYPE + name] = type_name

    def changes(self) -> tuple[dict[str, Any], list[str]]:
        """Return the values that have changed since the last call, and the paths of those that are gone."""
        values = self.values
        changed = {path: each for path, each in self._changed.items() if path not in values or values[path] != each}
        lost = [path for path in self._gone if values.pop(path, None) is not None]
        self._changed, self._gone = {}, {}
        values.update(changed)
        return changed, lost

    def _parts_of(self, name: str, type_name: str, value: Any) -> dict[str, Any]:
        """Return a topic's value; of a struct, the values of its parts, except where a topic has the same name."""
        path = VALUE + name
        if not isinstance(value, bytes):
            return {path: value}
        parts = self._structs.parts(path, type_name, value)
        if len(parts) > 1 or path not in parts:
            parts = {each: part for each, part in parts.items() if TYPE + each.removeprefix(VALUE) not in self.values}
            self._parts[name] = tuple(parts)
        return parts
