"""Front ends of the simulator that show nothing, or WPILib's own window, with a simulation that is played."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.config.settings import MatchSettings
from pyfrc_core.errors import UsageError
from pyfrc_core.sim.engine.robot_side.drawing_styles import line_style, text_style
from pyfrc_core.sim.engine.scene import LineStyle, TextStyle
from pyfrc_core.sim.engine.snapshot import Failure, Opmode
from pyfrc_core.sim.ui.choose import WpilibWindow
from pyfrc_core.sim.ui.headless import Headless
from pyfrc_core.sim.ui.models.joysticks import Joysticks, direction
from pyfrc_core.sim.ui.models.viewport import Viewport, is_on_robot


class Simulation:
    """A simulation that goes through some states, one for each look, and notes what it is to do."""

    def __init__(self, *states: str, failure: Failure | None = None, opmodes: tuple[str, ...] = (), end: float = 0.0):
        self.states = list(states)
        self.done: list[object] = []
        self.options = SimpleNamespace(opmodes=opmodes, script=None, start_at=0.0)
        project = SimpleNamespace(
            main_file=SimpleNamespace(name="robot.py"), settings=SimpleNamespace(match=MatchSettings()), files=None
        )
        self.project: Any = project
        self.output = iter(["a\n", "b"])
        published = (Opmode("Aim", "autonomous", "", ""), Opmode("Drive", "teleop", "", ""))
        self.snapshot: Any = SimpleNamespace(
            time=end,
            opmodes=published,
            mode_seconds={"teleop": 2.0},
            scene=SimpleNamespace(robot=object()),
            distance=3.0,
        )
        self.status: Any = SimpleNamespace(
            state="running",
            failure=failure,
            average=12.3,
            overruns=2,
            worst_loop_seconds=0.05,
            late_packets=1,
            note="",
            standstill=None,
        )

    def output_cursor(self) -> Any:
        return SimpleNamespace(read=lambda: next(self.output, ""))

    def wait_for(self, condition: Callable[[], bool], timeout: float | None = None) -> bool:
        if self.states:
            self.status.state = self.states.pop(0)
        if self.status.state == "interrupted":
            raise KeyboardInterrupt
        return condition()

    def __enter__(self) -> Simulation:
        self.start()
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def __getattr__(self, name: str) -> Callable[..., None]:
        return lambda *arguments: self.done.append((name, *arguments))


def run(simulation: Simulation, *options: Any, **named: Any) -> tuple[int, str]:
    said: list[str] = []
    played: Any = simulation
    return Headless(said.append, *options, **named).run(played), "".join(said)


def test_a_robot_runs_in_a_mode_for_some_time() -> None:
    simulation = Simulation("starting", "running", "paused", end=5.0)
    code, said = run(simulation, "teleop", 5.0)
    assert code == 0
    assert simulation.done == [("start",), ("choose_mode", "teleop"), ("enable",), ("run_until", 5.0), ("close",)]
    assert said == (
        "running robot.py in teleop mode, for 5 s of robot time; Ctrl-C ends it earlier\na\nb\n"
        "simulated 5.00 s of robot time, at 12 times real time\nmodes: teleop 2.0 s\n"
        "distance driven: 3.0 ft (0.9 m)\nloop overruns: 2, the longest turn 0.050 s of robot time\n"
        "packets that took this machine longer than 20 ms: 1\n"
    )


def test_without_physics_no_distance_is_known() -> None:
    simulation = Simulation("paused", end=5.0)
    simulation.snapshot.scene.robot = None
    assert (
        "\ndistance driven: not known without physics.py beside robot.py (pyfrc create-physics)\n"
        in run(simulation, "teleop", 5.0)[1]
    )


def test_what_it_says_and_does_without_a_mode_or_in_a_match() -> None:
    simulation = Simulation("interrupted")
    assert run(simulation, quiet=True)[0] == 0
    assert simulation.done == [("start",), ("resume",), ("close",)]
    assert "robot.py disabled, until a dashboard enables it, until you press Ctrl-C\n" in run(Simulation("failed"))[1]
    simulation = Simulation("paused", end=200.0)
    code, said = run(simulation, "practice")
    assert (code, simulation.done[1]) == (0, ("practice",))
    assert said.startswith("running robot.py through a practice match, for ")
    code, said = run(Simulation("paused", "interrupted", end=3.0), "disabled", 4.0)
    assert code == 2, "it was to last longer"
    assert said.endswith("\ninterrupted\n")
    assert said.startswith("running robot.py in disabled mode, for 4 s")


def test_a_failure_is_the_exit_code_and_is_said_even_quietly() -> None:
    failure = Failure("broken", "", 2.0)
    code, said = run(Simulation("running", "failed", failure=failure, end=1.0), "auto", quiet=True)
    assert code == failure.exit_code
    assert said == f"a\nb\n{failure}\n"
    said = run(Simulation("failed", failure=failure, end=1.0), "auto")[1]
    assert "simulated 2.00 s of robot time; the figures below are of the first 1.00 s, the last that" in said


def test_a_name_of_an_opmode_must_be_for_the_mode() -> None:
    assert run(Simulation("paused", opmodes=("Drive",), end=15.0), "teleop")[0] == 0
    assert run(Simulation("paused", opmodes=("None",), end=15.0), "teleop")[0] == 0
    simulation = Simulation("paused", opmodes=("Aim",), end=15.0)
    with pytest.raises(UsageError) as refused:
        run(simulation, "teleop")
    assert str(refused.value) == (
        "--mode runs opmodes for teleop, and 'Aim' is not for it\n"
        "  Choose one of those that the robot has published for it: 'Drive'."
    )
    assert simulation.done == [("start",), ("close",)]


@pytest.mark.parametrize("failure", [None, Failure("broken", "", 2.0)])
def test_wpilibs_window_ends_with_the_robot(failure: Failure | None, capsys: pytest.CaptureFixture[str]) -> None:
    simulation: Any = Simulation("running", "closed", failure=failure)
    assert WpilibWindow().run(simulation) == (0 if failure is None else failure.exit_code)
    assert capsys.readouterr().out == "a\nb" + ("" if failure is None else f"{failure}\n")
    assert simulation.done == [("start",), ("close",)]


# -- what front ends draw ----------------------------------------------------------------------------------------------


def test_styles_have_the_names_of_tkinter() -> None:
    line = {"width": 3, "dash": "4 2", "smooth": 1, "capstyle": "round", "joinstyle": "miter", "fill": "red", "tags": 1}
    assert line_style(line) == (LineStyle(3.0, (4, 2), True, "round", "miter"), "red", None, "")
    assert line_style({"dash": 5})[0] == LineStyle(dash=(5,))
    assert line_style({"dash": [5, 1]})[0] == LineStyle(dash=(5, 1))
    text = {"anchor": "nw", "angle": 90, "justify": "right", "width": 80, "font": "Arial -12 bold", "color": "#00ff00"}
    found = TextStyle("nw", 90.0, "right", 80.0, "Arial", bold=True)
    assert text_style(text) == (found, "#00ff00", 12, "")
    assert text_style({"font": ("Arial", "italic", "UNDERLINE")})[0] == TextStyle(
        family="Arial", italic=True, underline=True
    )
    assert line_style({"capstyle": "flat"})[3] == "draw_line: capstyle='flat': it is one of butt, projecting, round"
    assert text_style({"colour": "red", "angle": "up"})[3] == (
        "draw_text: there is no option 'colour': did you mean 'color'?; "
        "draw_text: angle='up': could not convert string to float: 'up'"
    )


def test_a_view_of_the_field_keeps_its_middle_on_another_screen() -> None:
    view = Viewport.whole(54, 27, 540, 300).zoomed(2, 100, 100)
    resized = view.resized(1080, 0)
    assert (resized.width, resized.height, resized.zoom) == (1080, 1, 2)
    assert (resized.center_x, resized.center_y) == (view.center_x, view.center_y)
    assert Viewport.whole(54, 27, 540, 300).scale == pytest.approx(9.3)
    assert view.resized(540, 300) == view
    assert Viewport.whole(54, 27, 540, 300).resized(1080, 200) == Viewport.whole(54, 27, 1080, 200)


def test_the_robot_is_within_reach_of_its_centre() -> None:
    field: Any = SimpleNamespace(robot_length=4, robot_width=2)
    robot: Any = SimpleNamespace(x=10, y=5)
    assert [is_on_robot(field, robot, place) for place in ((11.9, 5), (10, 3.1), (12, 5), (10, 7.5))] == [
        *[True] * 2,
        *[False] * 2,
    ]
    assert not is_on_robot(field, None, (10, 5))


def test_a_pov_is_turned_once_in_eight_directions() -> None:
    simulation: Any = Simulation()
    sticks = Joysticks(simulation)
    for angle in (90, 90, -1):
        sticks.turn(2, angle)
    assert simulation.done == [("set_pov", 2, 0, 90), ("set_pov", 2, 0, -1)]
    assert [direction(x, y) for x, y in ((0, -1), (1, -1), (1, 0), (0.1, 1), (-1, 1), (-1, -0.9))] == [
        *(0, 45, 90, 180, 225, 315)
    ]
