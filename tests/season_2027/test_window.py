"""The simulator's window with a robot of 2027: opmodes are chosen in a list beside the modes."""

from __future__ import annotations

from conftest import MakeProject
from test_sim_window import Sit, display, sit  # noqa: F401 - fixtures

from .test_simulator import MOTOR, ROBOT


def test_an_opmode_is_chosen_in_the_window(make_project: MakeProject, sit: Sit) -> None:  # noqa: F811
    user = sit(make_project(ROBOT).path)
    station = user.window.station
    assert station.mode_buttons["test"].cget("text") == "Utility"
    user.until(lambda: station.opmode.get() == "Drive")
    user.click(station.mode_buttons["autonomous"])
    user.until(lambda: station.opmode.get() == "Forward")
    assert station.opmode.cget("values") == ("No opmode", "Forward", "Left")
    user.choose(station.opmode, 2)
    user.until(lambda: user.snapshot.opmode == "Left")
    user.press("ctrl+e")  # keys drive again
    user.until(lambda: user.snapshot.values[MOTOR] == -0.5)
    user.choose(station.opmode, 0)
    user.until(lambda: (user.snapshot.mode, user.snapshot.opmode) == ("disabled autonomous", ""))
