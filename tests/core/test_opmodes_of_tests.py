"""A test that runs once for each opmode, without a run of pytest."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.errors import RobotCodeError, UsageError
from pyfrc_core.test_support.opmodes import run_for_each, value_of
from pyfrc_core.wpi.opmodes import PublishedOpmode

PUBLISHED = (PublishedOpmode("Aim", "autonomous", 1), PublishedOpmode("Drive", "teleop", 2))


def parameters(
    *names: str, fixtures: tuple[str, ...] = ("opmode",), own: str = "", published: Any = PUBLISHED
) -> list[tuple[Any, str]] | None:
    """Return the values and names of a test's parameters; None if it has none."""
    marks = {"opmode": [SimpleNamespace(args=names)] if names else [], "parametrize": [SimpleNamespace(args=(own, []))]}
    definition = SimpleNamespace(
        iter_markers=marks.__getitem__,
        get_closest_marker=lambda name: next(iter(marks[name]), None),
        location=("tests/test_a.py", 6, "test_a"),
    )
    found: list[tuple[Any, str]] = []

    def parametrize(name: str, values: list[Any], indirect: bool) -> None:
        assert (name, indirect) == ("opmode", True)
        found.extend((value.values[0], value.id) for value in values)

    def test_a() -> None:
        pass

    def publish() -> Any:
        if isinstance(published, Exception):
            raise published
        return published

    metafunc: Any = SimpleNamespace(
        definition=definition, fixturenames=fixtures, function=test_a, parametrize=parametrize
    )
    run_for_each(metafunc, publish)
    return found or None


def test_a_test_runs_for_each_opmode_or_for_those_that_it_names() -> None:
    assert parameters() == [(PUBLISHED[0], "autonomous-Aim"), (PUBLISHED[1], "teleop-Drive")]
    assert parameters("Drive") == [(PUBLISHED[1], "teleop-Drive")]
    assert parameters(fixtures=("robot",)) is None
    assert parameters(own="opmode,x") is None
    with pytest.raises(UsageError) as wrong:
        parameters("Drive", "Drve")
    assert str(wrong.value) == (
        "tests/test_a.py:7: test_a is marked with the opmode 'Drve': the robot has published 'Aim', 'Drive'"
    )
    with pytest.raises(UsageError, match="the robot has published none"):
        parameters("Drive", published=())
    with pytest.raises(UsageError) as wrong:
        parameters("Drive", fixtures=("robot",))
    assert str(wrong.value).startswith("tests/test_a.py:7: test_a has the mark opmode, but no argument opmode\n  Give")


def test_an_error_of_the_robot_is_one_of_this_test_only() -> None:
    error = RobotCodeError("broken")
    assert parameters(published=error) == [(error, "?")]
    with pytest.raises(RobotCodeError, match="broken"):
        value_of(error)
    assert value_of(PUBLISHED[0]) is PUBLISHED[0]
