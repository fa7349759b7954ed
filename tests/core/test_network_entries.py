"""What scripts, fuzz and the simulator's pages write to NetworkTables has the type that the entry has."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any

import ntcore
import pytest
from loops import for_each

from pyfrc_core.errors import UsageError
from pyfrc_core.runtime.scripts.network_entries import NetworkEntries

#: A topic keeps its type as long as this process lives: each test has one of its own.
NAMES = (f"/values/{number}" for number in itertools.count())


@pytest.fixture(name="network")
def network_of_its_own() -> Iterator[ntcore.NetworkTableInstance]:
    """The network of this process, which no client can reach."""
    network = ntcore.NetworkTableInstance.getDefault()
    network.startLocal()
    yield network
    network.stopLocal()


def written(network: ntcore.NetworkTableInstance, kind: str, first: object, value: object) -> tuple[str, Any]:
    """Publish a first value as robot code does, write another one, return the entry's type and value."""
    name = next(NAMES)
    publisher = getattr(network, f"get{kind}Topic")(name).publish()
    entries = NetworkEntries()
    try:
        publisher.set(first)
        entries.write(f"nt:{name}", value)
        entry = network.getEntry(name)
        return entry.getTopic().getTypeString(), entry.getValue().value()
    finally:
        entries.close()
        publisher.close()


@for_each(
    "kind, first, value, expected",
    [
        ("Double", 1.0, 3, ("double", 3.0)),
        ("Float", 1.5, 2.5, ("float", 2.5)),
        ("Integer", 1, 3, ("int", 3)),
        # JSON writes a list of doubles with numbers that look whole.
        ("DoubleArray", [1.0], [3, 4.5], ("double[]", [3.0, 4.5])),
        ("DoubleArray", [1.0], [3, 4], ("double[]", [3.0, 4.0])),
        ("DoubleArray", [1.0], [], ("double[]", [])),
        ("IntegerArray", [1], (3, 4), ("int[]", [3, 4])),
        ("BooleanArray", [True], [True, False], ("boolean[]", [True, False])),
        ("BooleanArray", [True], [], ("boolean[]", [])),
        ("StringArray", ["a"], ["b", "c"], ("string[]", ["b", "c"])),
    ],
)
def test_a_value_gets_the_type_of_its_entry(network, kind, first, value, expected) -> None:
    assert written(network, kind, first, value) == expected


@pytest.mark.parametrize(
    ("kind", "first", "value"),
    [
        ("IntegerArray", [1], [3, 4.5]),
        ("DoubleArray", [1.0], ["a"]),
        ("DoubleArray", [1.0], [1, "a"]),
        ("BooleanArray", [True], [1.0]),
        ("StringArray", ["a"], [1]),
    ],
)
def test_a_list_of_another_kind_is_an_error_that_names_both(network, kind, first, value) -> None:
    with pytest.raises(UsageError, match=r"^/values/\d+ is \w+\[\], and cannot be \["):
        written(network, kind, first, value)


def test_numbers_of_a_new_entry_are_doubles_and_a_mixed_list_is_an_error(network) -> None:
    entries = NetworkEntries()
    entries.write("nt:/values/new", [1, 2.5])
    assert network.getEntry("/values/new").getTopic().getTypeString() == "double[]"
    for value in ([1, "a"], [[1]]):
        with pytest.raises(UsageError, match=r"^/values/other cannot be"):
            entries.write("nt:/values/other", value)
    entries.close()
