"""How many processors a process may use."""

from __future__ import annotations

import os

import pytest

from pyfrc_core.processors import usable_processors


def test_it_may_use_those_that_it_is_bound_to(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PYTHON_CPU_COUNT", raising=False)
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 3, 5}, raising=False)
    assert usable_processors() == 3


@pytest.mark.parametrize(("chosen", "expected"), [("2", 2), ("default", 1), ("0", 1), ("", 1)])
def test_the_number_in_the_environment_comes_first(chosen: str, expected: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0}, raising=False)
    monkeypatch.setenv("PYTHON_CPU_COUNT", chosen)
    assert usable_processors() == expected
