"""How robot code reads entries of NetworkTables: what the seasons' `network_reads` replace. It imports no WPILib."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from typing import Any, Protocol


class Reads(Protocol):
    """What gets each reading."""

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


def of_entry(real: Any, name_of: Callable[[Any], str], type_name: str, reads: Reads) -> Callable[..., Any]:
    """Return a method of entries that reports its reading.

    :param name_of: returns an entry's full name
    """
    call = unbound(real)

    def get(self: Any, *args: Any, **kwargs: Any) -> Any:
        name = name_of(self)
        if name not in reads.found:
            reads.note(name, type_name, args, kwargs)
        return call(self, *args, **kwargs)

    return get


def of_table(real: Any, path_of: Callable[[Any], str], type_name: str, reads: Reads) -> Callable[..., Any]:
    """Return a method of tables that reports its reading.

    :param path_of: returns a table's path
    """
    call = unbound(real)

    def get(self: Any, key: str, *args: Any, **kwargs: Any) -> Any:
        name = f"{path_of(self)}/{key}"
        if name not in reads.found:
            reads.note(name, type_name, args, kwargs)
        return call(self, key, *args, **kwargs)

    return get


def static(owner: object, name: str, table: str, type_name: str, reads: Reads) -> tuple[Any, str, Any]:
    """Return a static method that reads an entry of one table and reports it, with its owner and name."""
    call = getattr(owner, name)

    def get(key: str, *args: object, **kwargs: object) -> Any:
        if table + key not in reads.found:
            reads.note(table + key, type_name, args, kwargs)
        return call(key, *args, **kwargs)

    return owner, name, staticmethod(get)


def of_topic(
    real: Any, name_of: Callable[[Any], str], default_name: str, type_of: Callable[[Any], str], reads: Reads
) -> Callable[..., Any]:
    """Return a method of topics that reports what is subscribed to.

    :param name_of: returns a topic's full name
    :param default_name: the name of the parameter for the default
    :param type_of: returns the name of a default's type; empty when it is not reported
    """
    call = unbound(real)

    def subscribe(self: Any, *args: Any, **kwargs: Any) -> Any:
        name, default = name_of(self), args[0] if args else kwargs.get(default_name)
        if name not in reads.found and (type_name := type_of(default)):
            reads.note(name, type_name, (default,), {})
        return call(self, *args, **kwargs)

    return subscribe


def unbound(real: Any) -> Callable[..., Any]:
    """Return the function of a method: the bindings' methods cannot be called as their class has them."""
    function: Callable[..., Any] = getattr(real, "__func__", real)
    return function


def struct_type(
    default: Any, ending: str, describe: Callable[[type[Any]], tuple[str, int]], structs: Mapping[str, int]
) -> str:
    """Return the name of a struct's type; empty when it cannot be written as numbers.

    :param ending: ``[]`` for arrays
    :param describe: returns the type name and the size of a struct's class, in bytes; a TypeError for other classes
    :param structs: of how many floating-point numbers each consists
    """
    if ending:
        default = default[0] if default else None
    if default is None:
        return ""
    try:
        name, size = describe(type(default))
    except TypeError:
        return ""
    return f"struct:{name}{ending}" if name in structs and size == 8 * structs[name] else ""
