"""The field and what is drawn on it."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import pytest
from PIL import ImageColor

from pyfrc.sim import get_user_renderer
from pyfrc.sim.field.user_renderer import UserRenderer
from pyfrc_core.config.findings import SettingsWarning
from pyfrc_core.errors import PyfrcError, UsageError
from pyfrc_core.project import Project
from pyfrc_core.sim.engine.field import field_of
from pyfrc_core.sim.engine.robot_side.robot_process import tags_of
from pyfrc_core.sim.engine.scene import Field, Line, LineStyle, Pose, Shape, Text, TextStyle

DOWN = Pose(10.0, 5.0, math.pi / 2)


@pytest.fixture
def renderer() -> UserRenderer:
    """On a field with a robot that faces down."""
    return UserRenderer(lambda: DOWN)


def only_line(renderer: UserRenderer) -> Line:
    (line,) = renderer.drawings()
    assert isinstance(line, Line)
    return line


def points(line: Line) -> list[tuple[float, float]]:
    return [(round(x, 6), round(y, 6)) for x, y in line.points]


def test_nothing_draws_without_a_simulation() -> None:
    assert get_user_renderer() is None


def test_a_line_in_field_coordinates(renderer: UserRenderer) -> None:
    renderer.draw_line([(1, 2), (3, 4)])
    assert only_line(renderer) == Line(((1, 2), (3, 4)), "#ff0000", True, LineStyle())


@pytest.mark.parametrize(
    ("keywords", "expected"),
    [
        ({"robot_coordinates": True}, [(10, 5), (10, 7), (9, 7)]),
        ({"robot_coordinates": (0, 1)}, [(10, 6), (10, 8), (9, 8)]),
        ({"robot_coordinates": (1, 0)}, [(9, 5), (9, 7), (8, 7)]),
        ({"relative_to_first": True}, [(0, 0), (2, 0), (2, 1)]),
        ({"scale": (2, 3)}, [(6, 12), (10, 12), (10, 15)]),
        ({"scale": (2, 3), "robot_coordinates": True}, [(10, 5), (10, 9), (7, 9)]),
        ({"scale": (1, -1), "relative_to_first": True}, [(0, 0), (2, 0), (2, -1)]),
    ],
)
def test_a_line_in_other_coordinates(keywords: dict, expected: list, renderer: UserRenderer) -> None:
    renderer.draw_line([(3, 4), (5, 4), (5, 5)], **keywords)
    assert points(only_line(renderer)) == expected


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ({"no_such_option": 1}, "draw_line: there is no option 'no_such_option'"),
        ({"dashes": (4, 4)}, "did you mean 'dash'?"),
        ({"width": "thick"}, "draw_line: width='thick'"),
        ({"capstyle": "square"}, "it is one of butt, projecting, round"),
        ({"color": "notacolour"}, "draw_line: color='notacolour': there is no such colour: give a name, such as red"),
        ({"color": "gren"}, "did you mean 'green'?"),
        ({"fill": "#12"}, "draw_line: fill='#12': there is no such colour"),
        (
            {"color": "#12", "no_such_option": 1},
            "no such colour: give a name, such as red, or #rrggbb; draw_line: there",
        ),
    ],
)
def test_options_that_are_wrong_are_named(renderer: UserRenderer, options: dict[str, object], problem: str) -> None:
    """The console of each front end names it, with the line of the robot's code; the robot goes on."""
    with pytest.warns(UserWarning, match=re.escape(problem)) as by_line:
        renderer.draw_line([(0, 0), (1, 1)], **options)
    with pytest.warns(UserWarning, match=re.escape(problem)) as by_path:
        renderer.draw_pathfinder_trajectory([Segment(0, 0), Segment(1, 1)], **options)
    assert [each.filename for each in (*by_line, *by_path)] == [__file__] * 2
    for line in renderer.drawings():
        assert problem in line.problem
        assert isinstance(line, Line)
        assert line.color == "#ff0000"


def test_a_text_with_a_wrong_option_is_named(renderer: UserRenderer) -> None:
    with pytest.warns(UserWarning, match="draw_text: color='#12': there is no such colour") as warned:
        renderer.draw_text("here", (1, 2), color="#12")
    assert warned[0].filename == __file__


@pytest.mark.parametrize("color", ["red", "LightGoldenrodYellow", "#1a2B3c", "#fff"])
def test_colours_of_all_front_ends_are_known(renderer: UserRenderer, color: str) -> None:
    renderer.draw_line([(0, 0), (1, 1)], color=color)
    line = only_line(renderer)
    assert (line.color, line.problem) == (color, "")
    ImageColor.getrgb(color)


def test_a_text(renderer: UserRenderer) -> None:
    renderer.draw_text("here", (1, 2))
    renderer.draw_text("there", (2, 1), "#0000ff", fontSize=20, scale=(2, 2), arrow=True, anchor="w")
    renderer.draw_text("robot", (1, 0), robot_coordinates=True)
    renderer.draw_text("beside", (1, 0), robot_coordinates=(2, 0))
    first, second, third, fourth = renderer.drawings()
    assert first == Text("here", 1, 2, "#000000", 10, TextStyle())
    assert second == Text("there", 4, 2, "#0000ff", 20, TextStyle(anchor="w"))
    assert (third.x, third.y) == pytest.approx((10, 6))
    assert (fourth.x, fourth.y) == pytest.approx((8, 6))


def test_a_line_begins_at_the_robot_and_a_text_is_beside_it(renderer: UserRenderer) -> None:
    """As the text of 2019 says of a line: its first point is at the robot's centre, wherever the points begin."""
    renderer.draw_line([(3, 0), (5, 0)], robot_coordinates=True)
    renderer.draw_text("t", (3, 0), robot_coordinates=True)
    line, text = renderer.drawings()
    assert points(line) == [(10, 5), (10, 7)]
    assert (text.x, text.y) == pytest.approx((10, 8))


@dataclass
class Segment:
    """As of `robotpy-pathfinder`."""

    x: float
    y: float
    dt: float = 0.5


def test_a_trajectory(renderer: UserRenderer) -> None:
    path = [Segment(5, 5), Segment(6, 5), Segment(7, 6), Segment(8, 6), Segment(9, 6)]
    renderer.draw_pathfinder_trajectory(path, color="#0000ff", show_dt=1.0, dt_offset=2.0, width=2)
    line, *texts = renderer.drawings()
    # Forward is down; pathfinder's y grows to the robot's left, which is then to the right.
    assert points(line) == [(10, 5), (10, 6), (11, 7), (11, 8), (11, 9)]
    assert (line.color, line.style) == ("#0000ff", LineStyle(width=2))
    assert [(text.text, round(text.x), round(text.y)) for text in texts] == [
        ("t=2.00", 10, 5),
        ("t=3.00", 11, 7),
        ("t=4.00", 11, 9),
    ]


def test_a_trajectory_with_an_offset_and_a_scale(renderer: UserRenderer) -> None:
    renderer.draw_pathfinder_trajectory([Segment(0, 0), Segment(1, 0)], offset=(2, 0), scale=(3, 3))
    assert points(only_line(renderer)) == [(8, 5), (8, 8)]


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda renderer: renderer.draw_line([(1, 1)]), "two points"),
        (lambda renderer: renderer.draw_line([(1, 1), 3]), "no point"),
        (lambda renderer: renderer.draw_line([(1, 1), (math.nan, 1)]), "not finite"),
        (lambda renderer: renderer.draw_text("x", "here"), "no point"),
        (lambda renderer: renderer.draw_pathfinder_trajectory([]), "two segments"),
    ],
)
def test_what_cannot_be_drawn_is_said(call, told: str, renderer: UserRenderer) -> None:
    with pytest.raises(UsageError, match=told):
        call(renderer)
    assert renderer.drawings() == ()


# -- the field -------------------------------------------------------------------------------------------------------


def field(root: Path, text: str) -> Field:
    (root / "sim").mkdir(exist_ok=True)
    (root / "sim/config.json").write_text(text, encoding="utf-8")
    return field_of(Project(root / "robot.py"))


def test_the_field_of_a_project_without_a_word_about_it(tmp_path: Path) -> None:
    found = field_of(Project(tmp_path / "robot.py"))
    assert (found.width, found.height, found.robot_width, found.robot_length) == (
        54.25,
        pytest.approx(26.417, 0.001),
        2,
        3,
    )
    assert found.starts == {"start": (0, 0, 0)}


def test_the_field_as_configured(tmp_path: Path) -> None:
    (tmp_path / "sim").mkdir()
    (tmp_path / "sim/field.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    found = field(
        tmp_path,
        """{"pyfrc": {"robot": {"w": 1, "l": 2, "starting_x": 3, "starting_angle": 180},
        "field": {"w": 20, "h": 10, "px_per_ft": 30, "image": "field.png", "objects": [
            {"color": "red", "rect": [1, 2, 3, 4]}, {"color": "#00ff00", "points": [[0, 0], [1, 0], [0, 1]]}]}}}""",
    )
    assert (found.width, found.height, found.px_per_ft) == (20, 10, 30)
    assert found.starts == {"start": (3, 0, pytest.approx(math.pi))}
    assert found.image == tmp_path / "sim/field.png"
    assert found.objects == (
        Shape("red", ((1, 2), (4, 2), (4, 6), (1, 6))),
        Shape("#00ff00", ((0, 0), (1, 0), (0, 1))),
    )


@pytest.mark.parametrize(("given", "log"), [("{}", "blue"), ('{"coordinates": "pyfrc"}', "pyfrc")])
def test_places_of_a_log_are_written_as_robot_code_has_them_unless_the_file_says_how(
    tmp_path: Path, given: str, log: str
) -> None:
    assert field(tmp_path, f'{{"pyfrc": {{"field": {given}}}}}').coordinates == "pyfrc"
    assert field_of(Project(tmp_path / "robot.py"), "blue").coordinates == log


def test_an_image_that_is_not_there_is_warned_of(tmp_path: Path) -> None:
    with pytest.warns(SettingsWarning, match="nowhere.png"):
        assert field(tmp_path, '{"pyfrc": {"field": {"image": "nowhere.png"}}}').image is None


def test_a_field_of_no_size_says_where(tmp_path: Path) -> None:
    with pytest.raises(PyfrcError, match=r"field\.w"):
        field(tmp_path, '{"pyfrc": {"field": {"w": 0}}}')


@pytest.mark.season_2026
def test_the_seasons_tags(tmp_path: Path) -> None:
    pytest.importorskip("robotpy_apriltag")
    project = Project(tmp_path / "robot.py")
    tags = tags_of(project.sim_config)
    assert len(tags) == 32
    assert all(-1 < tag.x < 55 and -1 < tag.y < 27 for tag in tags)
    field(tmp_path, '{"pyfrc": {"field": {"season": 2019}}}')
    assert tags_of(Project(tmp_path / "robot.py").sim_config) == ()


def test_what_is_wrong_with_a_drawing_is_in_the_console_once(make_project) -> None:
    """It is what the robot prints, which each front end shows."""
    project = make_project(
        {
            "robot.py": "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n",
            "physics.py": """
                from pyfrc.sim import get_user_renderer

                class PhysicsEngine:
                    def __init__(self, physics_controller):
                        self.renderer = get_user_renderer()

                    def update_sim(self, hal_data, now, tm_diff):
                        self.renderer.draw_line([(1, 1), (2, now)], nosuch=3, color="gren")
            """,
        }
    )
    result = project.run("sim", "--ui", "none", "--mode", "auto", "--seconds", "0.5")
    assert result.code == 0, result.output
    assert result.output.count("there is no option 'nosuch'") == 1
    (line,) = (line for line in result.output.splitlines() if "nosuch'" in line)
    said = "draw_line: color='gren': there is no such colour: did you mean 'green'?; draw_line: there is no option"
    assert f"physics.py:8: UserWarning: {said} 'nosuch'" in line
