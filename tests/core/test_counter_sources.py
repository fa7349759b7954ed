"""What a counter counts on: a channel, an input, another one later, nothing."""

from __future__ import annotations

import pytest
import wpilib
from wpilib.simulation import DIOSim

pytest.importorskip("pyfrc_core.hal.season_2026.counters")

from pyfrc_core.hal.season_2026.counters import EdgeCounter, EdgeInput


def pulse(channel: int) -> None:
    DIOSim(channel).setValue(False)
    DIOSim(channel).setValue(True)


def channel_of(source: EdgeInput | None) -> int | None:
    return None if source is None else source.channel


def test_a_channel_or_an_input_is_counted_up_or_down() -> None:
    counter = EdgeCounter(0)
    counter.connect("up", 24)
    counter.connect("down", wpilib.DigitalInput(25))
    assert (channel_of(counter.up), channel_of(counter.down)) == (24, 25)
    pulse(24)
    pulse(24)
    assert counter.count == 2
    pulse(25)
    assert (counter.count, counter.forward) == (1, False)


def test_another_source_takes_the_place_of_the_one_before() -> None:
    counter = EdgeCounter(0)
    counter.connect("up", 24)
    before = counter.up
    counter.connect("up", 26)
    assert before is not None
    assert before._callback is None  # it counts no more, although it is still there
    pulse(24)
    assert counter.count == 0
    pulse(26)
    assert counter.count == 1
    counter.connect("up", None)
    assert counter.up is None
    pulse(26)
    assert counter.count == 1
    counter.connect("down", object())  # such as an analog trigger
    assert counter.down is None
