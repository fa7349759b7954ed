"""The functions with which robot code reads entries of NetworkTables, preferences and dashboards."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any

import ntcore
import tunables
import wpilib
from wpiutil import wpistruct

from ..entry_reads import Reads, of_entry, of_table, of_topic, static, struct_type
from . import network

__all__ = ["Reads", "replacements"]

#: The names that NetworkTables gives to types, by the names in its functions.
_TYPES = {
    "boolean": "boolean",
    "integer": "int",
    "float": "float",
    "double": "double",
    "string": "string",
    "boolean_array": "boolean[]",
    "integer_array": "int[]",
    "float_array": "float[]",
    "double_array": "double[]",
    "string_array": "string[]",
}
#: The names of types that differ in the tables' and the preferences' functions.
_TABLE_TYPES = {**_TYPES, "number": "double", "number_array": "double[]"}
_PREFERENCE_TYPES = {**_TYPES, "int": "int", "long": "int"}
#: The classes of topics.
_TOPICS: dict[Any, str] = {
    ntcore.BooleanTopic: "boolean",
    ntcore.IntegerTopic: "int",
    ntcore.FloatTopic: "float",
    ntcore.DoubleTopic: "double",
    ntcore.StringTopic: "string",
    ntcore.BooleanArrayTopic: "boolean[]",
    ntcore.IntegerArrayTopic: "int[]",
    ntcore.FloatArrayTopic: "float[]",
    ntcore.DoubleArrayTopic: "double[]",
    ntcore.StringArrayTopic: "string[]",
}


def replacements(reads: Reads, structs: Mapping[str, int]) -> Iterator[tuple[Any, str, Any]]:
    """Return the functions that read entries, with their owner and name: each reports what it reads.

    :param structs: the structs whose readings are reported, and of how many floating-point numbers each consists
    """
    for owner in (ntcore.NetworkTableEntry, ntcore.GenericSubscriber):
        for name, type_name in _TYPES.items():
            yield owner, f"get_{name}", of_entry(vars(owner)[f"get_{name}"], _name_of, type_name, reads)
    for name, type_name in _TABLE_TYPES.items():
        if f"get_{name}" in vars(ntcore.NetworkTable):
            real = vars(ntcore.NetworkTable)[f"get_{name}"]
            yield ntcore.NetworkTable, f"get_{name}", of_table(real, _path_of, type_name, reads)
    for name, type_name in _PREFERENCE_TYPES.items():
        for verb in ("get", "init"):
            if f"{verb}_{name}" in vars(wpilib.Preferences):
                yield static(wpilib.Preferences, f"{verb}_{name}", "/Preferences/", type_name, reads)
    topic_method = partial(of_topic, name_of=_topics_name, default_name="default_value", reads=reads)
    for owner, type_name in _TOPICS.items():
        for verb in ("subscribe", "get_entry"):
            yield owner, verb, topic_method(vars(owner)[verb], type_of=lambda *_, known=type_name: known)
    yield from _tunables(reads, structs)
    for struct_owner, ending in ((ntcore.StructTopic, ""), (ntcore.StructArrayTopic, "[]")):

        def type_of(default: object, ending: str = ending) -> str:
            return struct_type(default, ending, _describe, structs)

        for verb in ("subscribe", "get_entry"):
            yield struct_owner, verb, topic_method(vars(struct_owner)[verb], type_of=type_of)


#: The functions that publish a tunable value. Robot code reads it from an object, which does not know its name.
_PUBLISHING = re.compile("add|add_(boolean|double|float|int|long)|publish_.+")


def _tunables(reads: Reads, structs: Mapping[str, int]) -> Iterator[tuple[Any, str, Any]]:
    for name in filter(_PUBLISHING.fullmatch, dir(tunables.TunableTable)):
        yield tunables.TunableTable, name, _publishing(vars(tunables.TunableTable)[name], _table_path, reads, structs)
    for name in filter(_PUBLISHING.fullmatch, dir(tunables)):
        yield tunables, name, _publishing(vars(tunables)[name], None, reads, structs)


def _publishing(
    real: Any, path_of: Callable[[Any], str] | None, reads: Reads, structs: Mapping[str, int]
) -> Callable[..., Any]:
    """Return a function that publishes a tunable value and reports it.

    :param path_of: returns the path of a table, for its methods
    """
    call = getattr(real, "__func__", real)

    def publish(*args: Any, **kwargs: Any) -> Any:
        result = call(*args, **kwargs)
        given = args if path_of is None else args[1:]
        path = "" if path_of is None else path_of(args[0])
        entry = f"/Tunables/{path}{given[0] if given else kwargs['name']}"
        name = entry if network.exists(entry) else f"{entry}/value"
        type_name, properties = network.type_of(name), network.properties_of(name)
        written = f"{entry}/tune" if properties.get("robust") else entry
        known = type_name.removesuffix("[]").removeprefix("struct:") in structs or type_name in network.TYPES
        if known and properties.get("mutable") and written not in reads.found:
            reads.note(written, type_name, (network.value_of(name),), {})
        return result

    return publish


def _table_path(table: Any) -> str:
    path: str = table.get_path()
    return path.removeprefix("/")


def _name_of(entry: Any) -> str:
    name: str = entry.get_name() if isinstance(entry, ntcore.NetworkTableEntry) else entry.get_topic().get_name()
    return name


def _path_of(table: Any) -> str:
    path: str = table.get_path()
    return path


def _topics_name(topic: Any) -> str:
    name: str = topic.get_name()
    return name


def _describe(kind: type[Any]) -> tuple[str, int]:
    return wpistruct.get_type_name(kind), wpistruct.get_size(kind)
