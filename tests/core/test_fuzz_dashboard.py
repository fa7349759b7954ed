"""Which entries the generator of dashboards' inputs takes for the program's own: those that change without a write."""

from __future__ import annotations

import random
from typing import Any

import pytest

from pyfrc_core.fuzz.inputs import dashboard_generator
from pyfrc_core.fuzz.inputs.dashboard_generator import DashboardGenerator
from pyfrc_core.fuzz.inputs.network_values import NetworkRead


@pytest.fixture
def network(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """The values in NetworkTables."""
    values: dict[str, Any] = {}
    monkeypatch.setattr(dashboard_generator.network, "value_of", values.get)
    return values


def published(*reads: NetworkRead, generator: DashboardGenerator) -> set[str]:
    generator._reads = {read.name: read for read in reads}
    generator.set_inputs([])
    return set(generator._published)


def test_an_entry_that_changes_by_itself_is_the_programs(network: dict[str, Any]) -> None:
    generator = DashboardGenerator(random.Random(1), {}, published=frozenset({"/known"}))
    speed, name, lists = NetworkRead("/speed", "double"), NetworkRead("/name", "string"), NetworkRead("/l", "double[]")
    assert published(speed, name, lists, generator=generator) == {"/known"}  # none has a value yet
    network.update({"/speed": 1.0, "/l": [1.0]})
    assert published(speed, name, lists, generator=generator) == {"/known"}  # a first value is no change
    assert published(speed, name, lists, generator=generator) == {"/known"}
    network.update({"/speed": 2.0, "/l": [2.0], "/name": "a"})
    assert published(speed, name, lists, generator=generator) == {"/known", "/speed"}  # lists are not compared
    network["/name"] = "b"
    assert published(name, generator=generator) == {"/known", "/speed", "/name"}


def test_an_entry_that_has_what_was_written_is_not_the_programs(network: dict[str, Any]) -> None:
    generator = DashboardGenerator(random.Random(1), {})
    speed = NetworkRead("/speed", "double")
    network["/speed"] = 1.0
    assert published(speed, generator=generator) == set()
    generator._written["/speed"] = network["/speed"] = 5.0
    assert published(speed, generator=generator) == set()
    network["/speed"] = 1.0  # the program has written over it
    assert published(speed, generator=generator) == {"/speed"}
