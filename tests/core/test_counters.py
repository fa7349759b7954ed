"""`wpilib.Counter` on simulated digital inputs: which edges it counts, and when it has stopped."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest
import wpilib
from wpilib.simulation import DIOSim

from pyfrc_core.hal import HalData, counters
from pyfrc_core.hal.reset import forget_inputs
from pyfrc_core.hal.season_2026.counters import counted_channels
from pyfrc_core.patch_table import patched
from pyfrc_core.runtime.patches.season_2026.counters import patches

#: The first of some channels that no other test uses.
FIRST = 20


class Clock:
    def __init__(self) -> None:
        self.now = 1.0


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Iterator[Clock]:
    """Counters that measure with this clock."""
    clock = Clock()
    monkeypatch.setattr(counters, "_now", lambda: clock.now)
    monkeypatch.setattr(counters, "_not_in_use", {})  # what other tests of this process have written
    with patched(patches()):
        yield clock


def write(channel: int, *values: int, clock: Clock | None = None, seconds: float = 0.0) -> None:
    for value in values:
        if clock is not None:
            clock.now += seconds
        DIOSim(channel).setValue(bool(value))


def test_rising_edges_are_counted_until_it_is_reset(clock: Clock) -> None:
    counter = wpilib.Counter(FIRST)
    assert (counter.get(), FIRST in counted_channels()) == (0, True)
    write(FIRST, 0, 1, 1, 0, 1, 0)
    assert counter.get() == 2
    counter.setDistancePerPulse(0.5)
    assert counter.getDistance() == 1.0
    counter.reset()
    assert counter.get() == 0
    counter.setUpSourceEdge(True, True)
    write(FIRST, 1, 0)
    assert counter.get() == 2
    counter.clearUpSource()
    write(FIRST, 1, 0)
    assert (counter.get(), counted_channels()) == (2, frozenset())


def test_the_period_of_a_wheel_and_when_it_stands_still(clock: Clock) -> None:
    counter = wpilib.Counter(FIRST)
    assert (counter.getStopped(), counter.getPeriod(), counter.getRate()) == (True, math.inf, 0.0)
    write(FIRST, 0, 1, 0, 1, clock=clock, seconds=0.02)
    assert not counter.getStopped()
    assert counter.getPeriod() == pytest.approx(0.04)
    assert counter.getRate() == pytest.approx(25.0)
    clock.now += 0.6
    assert (counter.getStopped(), counter.getPeriod(), counter.getRate()) == (True, math.inf, 0.0)


def test_up_and_down_and_in_reverse(clock: Clock) -> None:
    up, down = wpilib.DigitalInput(FIRST + 1), wpilib.DigitalInput(FIRST + 2)
    counter = wpilib.Counter()
    counter.setUpSource(up)
    counter.setDownSource(source=down)
    counter.setDownSourceEdge(True, False)
    write(FIRST + 1, 0, 1, 0, 1)
    write(FIRST + 2, 0, 1)
    assert (counter.get(), counter.getDirection()) == (1, False)
    counter.setReverseDirection(True)
    write(FIRST + 1, 0, 1)
    assert (counter.get(), counter.getDirection()) == (0, False)


def test_the_direction_from_an_input_and_the_length_of_a_pulse(clock: Clock) -> None:
    counter = wpilib.Counter(wpilib.Counter.Mode.kExternalDirection)
    counter.setUpSource(FIRST + 1)
    counter.setDownSource(FIRST + 2)
    write(FIRST + 1, 0, 1, 0, 1)
    write(FIRST + 2, 0)
    write(FIRST + 1, 0, 1)
    assert counter.get() == 1
    pulses = wpilib.Counter(FIRST + 3)
    pulses.setSemiPeriodMode(True)
    write(FIRST + 3, 0, 1, 0, clock=clock, seconds=0.03)
    assert pulses.getPeriod() == pytest.approx(0.03)


def test_hal_data_has_the_counters_of_the_robot(clock: Clock) -> None:
    tree = HalData()
    changes = tree.changes()
    changes.look()
    entry = tree["counter"][0]
    entry["count"] = 5  # as tests do before the robot's code runs
    assert not entry["initialized"]
    counter = wpilib.Counter(FIRST)
    assert (entry["initialized"], counter.get()) == (True, 5)
    write(FIRST, 0, 1)
    assert entry["count"] == 6
    entry["count"] = 40
    assert counter.get() == 40
    found = {path: new for path, _, new in changes.look().changed}
    assert found["counter[0].count"] == 40
    second = wpilib.Counter(FIRST + 1)
    assert "counter[1].count" in {path for path, _, _ in changes.look().changed}
    assert (second.getFPGAIndex(), second.get(), tree["counter"][1]["count"]) == (1, 0, 0)
    del counter, second
    assert [each["initialized"] for each in tree["counter"]] == [False] * 8
    assert wpilib.Counter(FIRST).get() == 0


def test_a_count_that_one_test_writes_is_forgotten_before_the_next(clock: Clock) -> None:
    tree = HalData()
    tree["counter"][0]["count"] = 5
    forget_inputs()
    assert (tree["counter"][0]["count"], wpilib.Counter(FIRST).get()) == (0, 0)


def test_a_ninth_counter_is_an_error_as_on_the_roborio(clock: Clock) -> None:
    counters = [wpilib.Counter() for _ in range(8)]
    with pytest.raises(RuntimeError, match="no more than 8 counters"):
        wpilib.Counter()
    counters.pop()
    assert wpilib.Counter().get() == 0
