"""The functions with which robot code reads entries of NetworkTables, preferences and dashboards."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping
from typing import Any, Protocol

import ntcore
import wpilib
from wpiutil import wpistruct

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


class Reads(Protocol):
    """What is told of each reading."""

    @property
    def found(self) -> Container[str]:
        """The names of the entries that need not be reported again."""

    def note(self, name: str, type_name: str, values: tuple[object, ...], named: dict[str, object]) -> None:
        """Note a reading. The caller's caller is the code that reads.

        :param name: the entry's full name
        :param type_name: the name of its type in NetworkTables
        :param values: the arguments of the call; the last one is the default
        :param named: the arguments that have names
        """


def replacements(reads: Reads, structs: Mapping[str, int]) -> Iterator[tuple[Any, str, Any]]:
    """Return the functions that read entries, with their owner and name: each reports what it reads.

    :param structs: the structs whose readings are reported, and of how many floating-point numbers each consists
    """
    for owner in (ntcore.NetworkTableEntry, ntcore.GenericSubscriber):
        for name, type_name in _TYPES.items():
            yield owner, f"get_{name}", _of_entry(vars(owner)[f"get_{name}"], type_name, reads)
    for name, type_name in _TABLE_TYPES.items():
        if f"get_{name}" in vars(ntcore.NetworkTable):
            real = vars(ntcore.NetworkTable)[f"get_{name}"]
            yield ntcore.NetworkTable, f"get_{name}", _of_table(real, type_name, reads)
    for name, type_name in _PREFERENCE_TYPES.items():
        for verb in ("get", "init"):
            if f"{verb}_{name}" in vars(wpilib.Preferences):
                yield _static(wpilib.Preferences, f"{verb}_{name}", "/Preferences/", type_name, reads)
    for owner, type_name in _TOPICS.items():
        for verb in ("subscribe", "get_entry"):
            yield owner, verb, _of_topic(vars(owner)[verb], lambda *_, known=type_name: known, reads)
    for struct_owner, ending in ((ntcore.StructTopic, ""), (ntcore.StructArrayTopic, "[]")):

        def struct_type(default: object, ending: str = ending) -> str:
            return _struct_type(default, ending, structs)

        for verb in ("subscribe", "get_entry"):
            yield struct_owner, verb, _of_topic(vars(struct_owner)[verb], struct_type, reads)


def _of_entry(real: Any, type_name: str, reads: Reads) -> Callable[..., Any]:
    call = _unbound(real)

    def get(self: Any, *args: Any, **kwargs: Any) -> Any:
        name = self.get_name() if isinstance(self, ntcore.NetworkTableEntry) else self.get_topic().get_name()
        if name not in reads.found:
            reads.note(name, type_name, args, kwargs)
        return call(self, *args, **kwargs)

    return get


def _of_table(real: Any, type_name: str, reads: Reads) -> Callable[..., Any]:
    call = _unbound(real)

    def get(self: Any, key: str, *args: Any, **kwargs: Any) -> Any:
        name = f"{self.get_path()}/{key}"
        if name not in reads.found:
            reads.note(name, type_name, args, kwargs)
        return call(self, key, *args, **kwargs)

    return get


def _static(owner: object, name: str, table: str, type_name: str, reads: Reads) -> tuple[Any, str, Any]:
    call = getattr(owner, name)

    def get(key: str, *args: object, **kwargs: object) -> Any:
        if table + key not in reads.found:
            reads.note(table + key, type_name, args, kwargs)
        return call(key, *args, **kwargs)

    return owner, name, staticmethod(get)


def _of_topic(real: Any, type_of: Callable[[Any], str], reads: Reads) -> Callable[..., Any]:
    call = _unbound(real)

    def subscribe(self: Any, *args: Any, **kwargs: Any) -> Any:
        name, default = self.get_name(), args[0] if args else kwargs.get("default_value")
        if name not in reads.found and (type_name := type_of(default)):
            reads.note(name, type_name, (default,), {})
        return call(self, *args, **kwargs)

    return subscribe


def _unbound(real: Any) -> Callable[..., Any]:
    """Return the function of a method: the bindings' methods cannot be called as their class has them."""
    function: Callable[..., Any] = getattr(real, "__func__", real)
    return function


def _struct_type(default: Any, ending: str, structs: Mapping[str, int]) -> str:
    """Return the name of a struct's type; empty when it cannot be written as numbers."""
    if ending:
        default = default[0] if default else None
    if default is None:
        return ""
    try:
        name, size = wpistruct.get_type_name(type(default)), wpistruct.get_size(type(default))
    except TypeError:
        return ""
    return f"struct:{name}{ending}" if name in structs and size == 8 * structs[name] else ""
