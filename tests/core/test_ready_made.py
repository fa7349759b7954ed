"""The ready-made tests with a controller that notes what they do: modes, messages, and how long each runs."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.season import CURRENT
from pyfrc_core.tests import basic


class Control:
    """Runs a robot whose `robotInit` lasts until `starts_at`, in steps of 0.5 s."""

    def __init__(self, starts_at: float, *messages: str) -> None:
        self._starts_at = starts_at
        self.project = SimpleNamespace(game_specific_messages=messages)
        self.game_specific_message: str | None = "not set"
        self.done: list[object] = []
        self.robot_is_starting = True
        self.ended = 0.0

    def set_autonomous(self, enabled: bool) -> None:
        self.done.append(("autonomous", enabled))

    def set_operator_control(self, enabled: bool) -> None:
        self.done.append(("teleop", enabled))

    def set_practice_match(self) -> None:
        self.done.append("match")

    def run_test(self, on_step: Any = None) -> None:
        self.done.append("run")
        now = 0.0
        while on_step is not None:
            self.robot_is_starting = now <= self._starts_at
            if not on_step(now):
                break
            now += 0.5
        self.ended = now


@pytest.mark.parametrize(
    ("test", "mode", "seconds"),
    [
        (basic.test_autonomous, ("autonomous", True), CURRENT.match.autonomous),
        (basic.test_disabled, ("autonomous", False), 5.0),
        (basic.test_operator_control, ("teleop", True), 5.0),
    ],
)
def test_each_runs_its_mode_for_its_time_after_robot_init(test: Any, mode: object, seconds: float) -> None:
    for starts_at in (0.0, 2.0):
        control = Control(starts_at)
        test(control, None, None, **({"gamedata": "LRL"} if test is basic.test_autonomous else {}))
        assert control.done == [mode, "run"]
        assert control.ended == starts_at + seconds
        if test is basic.test_autonomous:
            assert control.game_specific_message == "LRL"


def test_the_match_is_played_with_the_first_message() -> None:
    for messages, first in (((), None), (("RRR", "LLL"), "RRR")):
        control: Any = Control(0.0, *messages)
        basic.test_practice(control, None, None)  # type: ignore[arg-type]
        assert control.done == ["match", "run"]
        assert control.game_specific_message == first
