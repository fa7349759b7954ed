"""Columns of a log that ends before the other one on its time line."""

from array import array

from hypothesis import given
from hypothesis import strategies as st

from pyfrc_core.sim.engine.value_history import MISSING
from pyfrc_core.sim.logs.columns import Column, LogHistory

MOMENTS = st.lists(st.integers(0, 50), unique=True, max_size=6).map(sorted)


@given(MOMENTS, st.integers(0, 60), st.integers(0, 60))
def test_a_value_that_ends_is_gone_once(moments: list[int], first: int, last: int) -> None:
    column = Column(array("q", moments), lambda begin, end: moments[begin:end]).until(50)
    history = LogHistory({"hal:a": column}, begin=0, end=60)
    changes = [(moment / 1e6, moment) for moment in moments] + [(51 / 1e6, MISSING)]

    # As a page asks that follows the log: from one packet on, which may be after the last.
    assert list(history.since(first, "hal:a")) == [change for change in changes if change[0] * 1e6 >= first - 0.5]
    # As a plot asks: between two moments.
    times, values = history.changes("hal:a", first / 1e6, last / 1e6)
    assert list(zip(times, values, strict=True)) == [
        change for change in changes if first + 0.5 < change[0] * 1e6 < last + 0.5
    ]
