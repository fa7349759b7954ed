"""sim/config.json: what holds, what is told of mistakes, and what docs/reference/sim_config.md says of it."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from conftest import LoadConfig as Load
from conftest import MakeProject
from loops import for_each
from test_generated_docs import expanded

from pyfrc_core.config.sim import Polygon, Rectangle, SimConfig, sim_config_schema
from pyfrc_core.config.sim_file import load_sim_config
from pyfrc_core.errors import SettingsError

ROBOT = "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"


def config_of(load: Load, **keys: Any) -> SimConfig:
    return load(json.dumps({"pyfrc": keys})).config


# -- the values that hold -------------------------------------------------------------------------------------------


def test_without_a_file_everything_is_at_its_default(tmp_path: Path) -> None:
    loaded = load_sim_config(tmp_path)
    robot, field = loaded.config.robot, loaded.config.field
    assert (robot.w, robot.l, robot.starting_x, robot.starting_y, robot.starting_angle) == (2, 3, 0, 0, 0)
    assert (field.season, field.image, field.objects) == (None, None, ())
    assert (field.w, field.h) == (54.25, pytest.approx(26 + 5 / 12))  # today's
    assert (field.auto_joysticks, field.disabled_joysticks) == (False, False)
    assert loaded.config.game_specific_messages == ()
    assert loaded.config.dio == {}
    assert {port: joystick.buttons for port, joystick in loaded.config.joysticks.items()} == {
        port: {1: "Trigger", 2: "Top"} for port in range(6)
    }
    assert loaded.warnings == ()


@for_each("robot, length", [({"h": 4}, 4), ({"l": 5}, 5), ({"l": 5, "h": 4}, 5), ({}, 3)])
def test_h_is_the_older_name_of_the_robots_length(load: Load, robot: dict[str, float], length: float) -> None:
    config = config_of(load, robot=robot)
    assert config.robot.l == length
    assert config.robot.h == length


@for_each(
    "season, w, h, messages, auto_joysticks",
    [
        (2017, 29, 31, (), False),
        (2018, 30, 27, ("RRR", "RLR", "LRL", "LLL"), False),
        (2019, 27, 27, (), True),
        (2026, 54.25, 26 + 5 / 12, (), False),
    ],
)
@for_each("written", [int, str])
def test_a_season_brings_its_field_and_defaults(
    load: Load,
    season: int,
    w: float,
    h: float,
    messages: tuple[str, ...],
    auto_joysticks: bool,
    written: Callable[[int], Any],
) -> None:
    config = config_of(load, field={"season": written(season), "w": 1, "h": 1, "px_per_ft": 1})
    assert config.field.season == season
    assert (config.field.w, config.field.h) == pytest.approx((w, h))
    assert config.field.px_per_ft > 1
    assert config.game_specific_messages == messages
    assert config.field.auto_joysticks is auto_joysticks


def test_what_the_file_says_comes_before_the_seasons_defaults(load: Load) -> None:
    config = config_of(load, field={"season": 2019, "auto_joysticks": False}, game_specific_messages=["A"])
    assert config.field.auto_joysticks is False
    assert config.game_specific_messages == ("A",)
    assert config_of(load, field={"season": 2018}, game_specific_messages=[]).game_specific_messages == ()


def test_of_an_unknown_season_the_rest_of_the_field_holds(load: Load) -> None:
    config = config_of(load, field={"season": 2005, "w": 48})
    assert (config.field.w, config.field.h) == (48, pytest.approx(26 + 5 / 12))


def test_the_only_start_position_is_taken(load: Load) -> None:
    left, right = {"name": "left", "x": 1, "y": 2, "angle": 90}, {"name": "right", "x": 5, "y": 6, "angle": 0}
    config = config_of(load, robot={"start_positions": [left], "starting_x": 7})
    assert (config.start.x, config.start.y, config.start.angle) == (1, 2, 90)
    assert config.says_start
    config = config_of(load, robot={"start_positions": [left, right], "starting_x": 7})
    assert (config.start.x, config.start.y, config.start.angle) == (7, 0, 0)
    assert [position.name for position in config.robot.start_positions] == ["left", "right"]
    assert not config_of(load, robot={"w": 3}).says_start
    assert all(config_of(load, robot={f"starting_{key}": 1}).says_start for key in ("x", "y", "angle"))


def test_objects_are_rectangles_and_polygons(load: Load) -> None:
    rectangle, polygon = (
        {"color": "red", "rect": [1, 2, 3, 4]},
        {"color": "#00ff00", "points": [[0, 0], [1, 0], [0, 1]]},
    )
    first, second = config_of(load, field={"objects": [rectangle, polygon]}).field.objects
    assert isinstance(first, Rectangle)
    assert (first.color, first.rect) == ("red", (1, 2, 3, 4))
    assert isinstance(second, Polygon)
    assert second.points == ((0, 0), (1, 0), (0, 1))


def test_labels_are_found_by_number_and_axes_have_letters_too(load: Load) -> None:
    stick = {"axes": {"x": "turn", "T": "speed", "5": "arm"}, "buttons": {"2": "shoot", "12": "climb"}}
    config = config_of(load, dio={"0": "limit"}, CAN={"62": "motor"}, joysticks={"1": stick})
    assert config.dio == {0: "limit"}
    assert config.CAN == {62: "motor"}
    assert config.joysticks[1].axes == {0: "turn", 3: "speed", 5: "arm"}
    assert config.joysticks[1].buttons == {1: "Trigger", 2: "shoot", 12: "climb"}
    assert config.joysticks[0].buttons == {1: "Trigger", 2: "Top"}


def test_other_tools_keys_and_the_schemas_are_left_alone(load: Load) -> None:
    text = '{"$schema": "config.schema.json", "other": {"robot": {"w": "x"}, "robt": 1, "a": 1, "a": 2}, "pyfrc": {}}'
    assert load(text).warnings == ()
    assert load('{"other": 1}').config == load("{}").config == load('{"pyfrc": {}}').config


# -- what has no effect ---------------------------------------------------------------------------------------------


@for_each(
    "text, expected",
    [
        ('{"pyfrc": {\n"robt": 1}}', "2: unknown key 'pyfrc.robt'\n  did you mean 'robot'?"),
        (
            '{"pyfrc": {"robot": {"start_positions": [{"name": "a", "x": 1, "y": 2},\n'
            '{"name": "b", "x": 1, "y": 2,\n"angel": 3}]}}}',
            "3: unknown key 'pyfrc.robot.start_positions[1].angel'\n  did you mean 'angle'?",
        ),
        ('{\n"PyFRC": {}}', "2: unknown key 'PyFRC'\n  did you mean 'pyfrc'?"),
        (
            '{\n"robot": {"w": 2}}',
            "2: 'robot' has no effect outside of 'pyfrc'\n  Write \"pyfrc\": {\"robot\": ...}.",
        ),
        (
            '{"pyfrc": {"field": {"season": 2018,\n"w": 30}}}',
            "2: pyfrc.field.w = 30: ignored, since field.season is 2018",
        ),
        (
            '{"pyfrc": {"field": {\n"season": "2005"}}}',
            '2: pyfrc.field.season = "2005": nothing is known of the season 2005',
        ),
        (
            '{"pyfrc": {"field": {\n"image": "no/such.png"}}}',
            '2: pyfrc.field.image = "no/such.png": there is no such file',
        ),
        ('{"pyfrc": {"robot": {"l": 3,\n"h": 4}}}', "2: pyfrc.robot.h = 4: ignored: it is the older name of robot.l"),
        (
            '{"pyfrc": {"robot": {"start_positions": [{"name": "a", "x": 1, "y": 2}],\n"starting_y": 3}}}',
            "2: pyfrc.robot.starting_y = 3: ignored: the only one of robot.start_positions is taken",
        ),
        (
            '{"pyfrc": {"robot": {"w": 1}},\n"pyfrc": {}}',
            "2: pyfrc stands here again, and replaces what line 1 says",
        ),
        (
            '{"pyfrc": {"joysticks": {"0": {"axes": {"x": "a",\n"0": "b"}}}}}',
            "2: pyfrc.joysticks.0.axes.0: this is the same axis as 'x', whose label it replaces",
        ),
    ],
)
def test_what_has_no_effect_is_warned_of_with_its_line(load: Load, text: str, expected: str) -> None:
    (warning,) = load(text).warnings
    assert str(warning).startswith(f"sim/config.json:{expected}")


# -- what is surely not meant ---------------------------------------------------------------------------------------


@for_each(
    "robot, expected",
    [
        ({"w": 0.4}, ["pyfrc.robot.w = 0.4: this is very small: is that in metres? Lengths are in feet"]),
        ({"h": 36}, ["pyfrc.robot.h = 36: the robot is larger than the field (54.25 by 26.4167 ft)"]),
        ({"starting_x": 55}, ["pyfrc.robot.starting_x = 55: this is off the field (54.25 by 26.4167 ft)"]),
        ({"starting_y": -0.1}, ["pyfrc.robot.starting_y = -0.1: this is off the field"]),
        ({"starting_angle": 3.14}, ["pyfrc.robot.starting_angle = 3.14: this looks like radians; angles are in deg"]),
        ({"starting_angle": -1.5708}, ["pyfrc.robot.starting_angle = -1.5708: this looks like radians"]),
        (
            {"start_positions": [{"name": "a", "x": 60, "y": 1, "angle": 0.785}]},
            ["pyfrc.robot.start_positions[0].x = 60: ", "pyfrc.robot.start_positions[0].angle = 0.785: "],
        ),
        (
            {"start_positions": [{"name": "a", "x": 1, "y": 1}, {"name": "b", "x": 1, "y": 40}]},
            ["pyfrc.robot.start_positions[1].y = 40: "],
        ),
    ],
)
def test_what_is_surely_not_meant_is_doubted(load: Load, robot: dict[str, Any], expected: list[str]) -> None:
    loaded = load(json.dumps({"pyfrc": {"robot": robot}}))
    assert loaded.warnings == ()
    doubts = loaded.lint()
    assert len(doubts) == len(expected)
    for doubt, start in zip(doubts, expected, strict=True):
        assert str(doubt).startswith(f"sim/config.json:1: {start}")


@for_each(
    "robot",
    [
        {"w": 0.5, "l": 4, "starting_x": 54.25, "starting_y": 26},
        {"starting_x": 0, "starting_y": 0, "starting_angle": 0},
        *({"starting_angle": angle} for angle in (90, -45.0, 3, 22.5, 5.5, 1.2, 157.08)),
    ],
)
def test_what_may_be_meant_is_not_doubted(load: Load, robot: dict[str, Any]) -> None:
    assert load(json.dumps({"pyfrc": {"robot": robot}})).lint() == ()


def test_a_season_names_those_that_are_known(load: Load) -> None:
    (warning,) = load('{"pyfrc": {"field": {"season": 2005}}}').warnings
    assert "there is: 2017, 2018, 2019, " in str(warning)


# -- mistakes -------------------------------------------------------------------------------------------------------


@for_each(
    "text, expected",
    [
        ('{"pyfrc": {"robot": {\n"w": "wide"}}}', '2: pyfrc.robot.w = "wide": input should be a valid number'),
        ('{"pyfrc":\n{"field": []}}', "2: pyfrc.field = []: input should be an object"),
        ('{"pyfrc": {"field": {"season":\n\n"last"}}}', '1: pyfrc.field.season = "last": input should be a year'),
        (
            '{"pyfrc": {"game_specific_messages": ["A",\n5]}}',
            "2: pyfrc.game_specific_messages[1] = 5: input should be a valid string",
        ),
        (
            '{"pyfrc": {"robot": {"start_positions": [\n{"name": "a", "x": 1}]}}}',
            "2: pyfrc.robot.start_positions[0]: the key 'y' is missing",
        ),
        (
            '{"pyfrc": {"field": {"objects": [\n{"color": "red",\n"rect": [1, 2, 3]}]}}}',
            "3: pyfrc.field.objects[0].rect: item 4 is missing",
        ),
        (
            '{"pyfrc": {"field": {"objects": [\n{"color": "red"}]}}}',
            '2: pyfrc.field.objects[0] = {"color": "red"}: input should be an object with either the key \'rect\' or',
        ),
        ('{"pyfrc": {"dio": {\n"26": "a"}}}', '2: pyfrc.dio.26 = "a": the key should be a number from 0 to 25'),
        ('{"pyfrc": {"relay": {\n"3": 4}}}', "2: pyfrc.relay.3 = 4: input should be a valid string"),
        ('{"pyfrc": {"joysticks": {\n"6": {}}}}', "2: pyfrc.joysticks.6 = {}: the key should be a number from 0 to 5"),
        (
            '{"pyfrc": {"joysticks": {"0": {"axes": {\n"w": "a"}}}}}',
            '2: pyfrc.joysticks.0.axes.w = "a": the key should be a number from 0 to 11, or one of the letters x',
        ),
        ("[\n]", "1: the whole file = [ ]: input should be an object"),
        ('{\n"a": 1,\n}', "2: not valid JSON: JSON allows no comma before a closing bracket"),
        ('{"a": "NaN",\n"b": NaN}', "2: not valid JSON: NaN is not a number that JSON has"),
        ('{"a": "[[",\n"b": ' + "[" * 101, "2: not valid JSON: objects and arrays are nested more than 100 deep"),
    ],
)
def test_a_mistake_is_told_with_its_line_its_value_and_what_is_allowed(load: Load, text: str, expected: str) -> None:
    with pytest.raises(SettingsError) as wrong:
        load(text)
    assert str(wrong.value).startswith(f"sim/config.json:{expected}")
    assert "\n" not in str(wrong.value)


def test_of_a_number_in_quotes_the_remedy_is_told(load: Load) -> None:
    with pytest.raises(SettingsError) as wrong:
        load('{"pyfrc": {"robot": {"w": "2.5"}}}')
    assert wrong.value.remedy == "Write it without quotes: 2.5"


def test_all_mistakes_are_told_in_the_files_order(load: Load) -> None:
    with pytest.raises(SettingsError) as wrong:
        load('{"pyfrc": {"field": {"w": 0},\n"dio": {"x": "y"},\n"robot": {"w": "a",\n"l": "b"}}}')
    lines = [line.partition(" = ")[0] for line in str(wrong.value).splitlines()]
    assert lines == [
        "sim/config.json:1: pyfrc.field.w",
        "sim/config.json:2: pyfrc.dio.x",
        "sim/config.json:3: pyfrc.robot.w",
        "sim/config.json:4: pyfrc.robot.l",
    ]


def test_of_very_many_mistakes_some_are_told_and_the_others_counted(load: Load) -> None:
    with pytest.raises(SettingsError) as wrong:
        load(json.dumps({"pyfrc": {"game_specific_messages": [5] * 500}}))
    lines = str(wrong.value).splitlines()
    assert len(lines) == 21
    assert lines[-1] == "sim/config.json: ... and 480 mistakes more"


SCHEMA = jsonschema.Draft202012Validator(json.loads(sim_config_schema()))


# -- the document ---------------------------------------------------------------------------------------------------

DOCUMENT = (Path(__file__).parents[1] / "docs/reference/sim_config.md").read_text("utf-8")
(EXAMPLE,) = re.findall(r"^```json\n(.*?)^```$", DOCUMENT, re.MULTILINE | re.DOTALL)
#: The table's keys (without the pyfrc before each), and their defaults as they stand there.
ROWS = dict(re.findall(r"^[|] `([^`]+)` [|] ([^|]*) [|] .+ [|]$", expanded(DOCUMENT), re.MULTILINE))


def schema_keys(schema: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Every key below, as the document names it, and its part of the schema."""
    if "$ref" in schema:
        schema = schema | SCHEMA.schema["$defs"][schema["$ref"].rpartition("/")[2]]
    for key, value in schema.get("properties", {}).items():
        yield f"{prefix}{key}", value
        yield from schema_keys(value, f"{prefix}{key}.")
    for below, mark in (("items", "[]."), ("additionalProperties", ".N.")):
        if isinstance(schema.get(below), dict):
            yield from schema_keys(schema[below], prefix.removesuffix(".") + mark)
    for alternative in [*schema.get("anyOf", []), *schema.get("oneOf", [])]:
        yield from schema_keys(alternative, prefix)


def test_the_documents_table_has_every_key_and_its_default() -> None:
    keys = {key.removeprefix("pyfrc."): value for key, value in schema_keys(SCHEMA.schema) if key != "pyfrc"}
    for table in ("robot", "field"):
        del keys[table]
    assert sorted(ROWS) == sorted(keys)
    for key, default in ROWS.items():
        if re.fullmatch("`[^`]+`", default):
            assert json.loads(default.strip("`")) == keys[key]["default"], key


def test_the_documents_example_is_without_mistakes_and_warnings(make_project: MakeProject) -> None:
    project = make_project(
        {"robot.py": ROBOT, "sim/config.json": EXAMPLE, "sim/field.png": "<svg xmlns='http://www.w3.org/2000/svg'/>"}
    )
    result = project.run_here("config", "check", "--strict")
    assert (result.code, result.output) == (0, "sim/config.json: no mistakes\n")
    commands = re.findall(r"^[$] pyfrc (.+)$", DOCUMENT, re.MULTILINE)
    assert "config check --strict" in commands
    for command in commands:
        assert project.run_here(*command.split()).code == 0, command
    assert SCHEMA.is_valid(json.loads(EXAMPLE))
