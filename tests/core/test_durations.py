"""Which test `pyfrc test` starts first."""

from __future__ import annotations

from pyfrc_core.test_support.isolation.durations import longest_first


def test_the_longest_comes_first_and_equal_ones_keep_their_order():
    assert longest_first(["a", "b", "c", "d"], {"a": 1, "b": 3.5, "c": 1, "d": 2}) == [1, 3, 0, 2]


def test_what_is_not_known_comes_before_what_is():
    assert longest_first(["known", "new", "spoiled"], {"known": 9, "spoiled": "9"}) == [1, 2, 0]


def test_at_first_nothing_is_known():
    assert longest_first(["a", "b"], {}) == [0, 1]
