"""The functions with which robot code reads entries of NetworkTables, preferences and dashboards."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

import ntcore
import wpilib
from wpiutil import wpistruct

from ..entry_reads import Reads, of_entry, of_table, of_topic, static, struct_type

__all__ = ["Reads", "replacements"]

#: The names that NetworkTables gives to types, by the names in its functions.
_TYPES = {
    "Boolean": "boolean",
    "Integer": "int",
    "Float": "float",
    "Double": "double",
    "String": "string",
    "BooleanArray": "boolean[]",
    "IntegerArray": "int[]",
    "FloatArray": "float[]",
    "DoubleArray": "double[]",
    "StringArray": "string[]",
}
#: The names of types that differ in the tables' and the preferences' functions.
_TABLE_TYPES = {**_TYPES, "Number": "double", "NumberArray": "double[]"}
_PREFERENCE_TYPES = {**_TYPES, "Int": "int", "Long": "int"}


def replacements(reads: Reads, structs: Mapping[str, int]) -> Iterator[tuple[Any, str, Any]]:
    """Return the functions that read entries, with their owner and name: each reports what it reads.

    :param structs: the structs whose readings are reported, and of how many floating-point numbers each consists
    """
    for owner in (ntcore.NetworkTableEntry, ntcore.GenericSubscriber):
        for name, type_name in _TYPES.items():
            yield owner, f"get{name}", of_entry(vars(owner)[f"get{name}"], _name_of, type_name, reads)
    for name, type_name in _TABLE_TYPES.items():
        if f"get{name}" in vars(ntcore.NetworkTable):
            real = vars(ntcore.NetworkTable)[f"get{name}"]
            yield ntcore.NetworkTable, f"get{name}", of_table(real, _path_of, type_name, reads)
    for name, type_name in _TABLE_TYPES.items():
        if f"get{name}" in vars(wpilib.SmartDashboard):
            yield static(wpilib.SmartDashboard, f"get{name}", "/SmartDashboard/", type_name, reads)
    for name, type_name in _PREFERENCE_TYPES.items():
        for verb in ("get", "init"):
            if f"{verb}{name}" in vars(wpilib.Preferences):
                yield static(wpilib.Preferences, f"{verb}{name}", "/Preferences/", type_name, reads)
    topic_method = partial(of_topic, name_of=_topics_name, default_name="defaultValue", reads=reads)
    for name, type_name in _TYPES.items():
        owner = getattr(ntcore, f"{name}Topic")
        for verb in ("subscribe", "getEntry"):
            yield owner, verb, topic_method(vars(owner)[verb], type_of=lambda *_, known=type_name: known)
    for struct_owner, ending in ((ntcore.StructTopic, ""), (ntcore.StructArrayTopic, "[]")):

        def type_of(default: object, ending: str = ending) -> str:
            return struct_type(default, ending, _describe, structs)

        for verb in ("subscribe", "getEntry"):
            yield struct_owner, verb, topic_method(vars(struct_owner)[verb], type_of=type_of)


def _name_of(entry: Any) -> str:
    name: str = entry.getName() if isinstance(entry, ntcore.NetworkTableEntry) else entry.getTopic().getName()
    return name


def _path_of(table: Any) -> str:
    path: str = table.getPath()
    return path


def _topics_name(topic: Any) -> str:
    name: str = topic.getName()
    return name


def _describe(kind: type[Any]) -> tuple[str, int]:
    return wpistruct.getTypeName(kind), wpistruct.getSize(kind)
