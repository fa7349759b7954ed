"""sim/config.json and its JSON Schema agree, whatever the file holds."""

from __future__ import annotations

import json
from typing import Any

import jsonschema
from conftest import LoadConfig as Load
from conftest import MakeProject
from hypothesis import given, settings
from hypothesis import strategies as st

from pyfrc_core.config.sim import sim_config_schema
from pyfrc_core.errors import SettingsError

SCHEMA = jsonschema.Draft202012Validator(json.loads(sim_config_schema()))


def test_the_schema_tells_an_editor_keys_meanings_and_defaults(make_project: MakeProject) -> None:
    result = make_project({}).run_here("config", "schema")
    assert result.code == 0, result.output
    schema = json.loads(result.stdout)
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    jsonschema.Draft202012Validator.check_schema(schema)
    for name, table in schema["$defs"].items():
        for key, meaning in table["properties"].items():
            assert meaning.get("description") or meaning.get("$ref") or meaning.get("allOf"), f"{name}.{key}"
    assert schema["$defs"]["RobotConfig"]["properties"]["w"]["default"] == 2
    assert "feet" in schema["$defs"]["RobotConfig"]["properties"]["w"]["description"]


NUMBERS = st.floats(-1e6, 1e6) | st.integers(-(10**6), 10**6)
POSITIVE = st.floats(1e-3, 1e6) | st.integers(1, 10**6)
SEASONS = st.integers(2015, 2030) | st.integers(2015, 2030).map(str) | st.none()
# What is right at some places, and wrong at most.
ANYTHING = st.sampled_from(
    [None, True, 0, -1, 0.5, 2018, "2018", "x", "", [], {}, [1, 2], ["x"], {"0": "x"}, {"x": {}}]
)


def configs(valid_only: bool) -> st.SearchStrategy[dict[str, Any]]:
    """Contents of sim/config.json: valid ones, or with anything anywhere."""

    def here(strategy: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
        return strategy if valid_only else st.integers(0, 9).flatmap(lambda n: strategy if n else ANYTHING)

    def table(**keys: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
        return here(st.fixed_dictionaries({}, optional={key: here(value) for key, value in keys.items()}))

    def labels(*names: str, last: int, first: int = 0) -> st.SearchStrategy[Any]:
        numbers = st.integers(first, last) if valid_only else st.integers(first - 1, last + 1)
        return st.dictionaries(numbers.map(str) | st.sampled_from(["0" if not first else "1", *names]), here(st.text()))

    def array(items: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
        return st.lists(here(items), max_size=3)

    def record(**keys: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
        required = {key: here(value) for key, value in keys.items()}
        full = st.fixed_dictionaries(required)
        return full if valid_only else full | st.fixed_dictionaries({}, optional=required)

    def point(count: int) -> st.SearchStrategy[Any]:
        return st.lists(here(NUMBERS), min_size=count, max_size=count if valid_only else count + 1)

    shapes = record(color=st.text(), rect=point(4)) | record(color=st.text(), points=array(point(2)))
    if not valid_only:
        shapes |= record(color=st.text(), rect=point(4), points=array(point(2)))
    pyfrc = table(
        robot=table(
            w=POSITIVE,
            l=POSITIVE,
            h=POSITIVE,
            starting_x=NUMBERS,
            starting_y=NUMBERS,
            starting_angle=NUMBERS,
            start_positions=array(record(name=st.text(), x=NUMBERS, y=NUMBERS, angle=NUMBERS)),
        ),
        field=table(
            season=SEASONS,
            w=POSITIVE,
            h=POSITIVE,
            px_per_ft=POSITIVE,
            image=st.text() | st.none(),
            objects=array(shapes),
            coordinates=st.sampled_from(["pyfrc", "blue", "blue-feet", "alliance", "alliance-feet"]),
            auto_joysticks=st.booleans(),
            disabled_joysticks=st.booleans(),
        ),
        game_specific_messages=array(st.text()),
        analog=labels(last=7),
        CAN=labels(last=62),
        dio=labels(last=25),
        pwm=labels(last=19),
        relay=labels(last=3),
        solenoid=labels(last=15),
        joysticks=st.dictionaries(
            st.integers(0, 5).map(str),
            table(axes=labels(*"xyztXYZT", last=11), buttons=labels(first=1, last=32)),
            max_size=2,
        ),
        unknown=ANYTHING,
    )
    return st.fixed_dictionaries({}, optional={"pyfrc": pyfrc, "other": ANYTHING, "$schema": ANYTHING})


@settings(max_examples=25)
@given(document=configs(valid_only=True), indent=st.none() | st.integers(0, 4), ascii_only=st.booleans())
def test_what_is_valid_loads(load: Load, document: dict[str, Any], indent: int | None, ascii_only: bool) -> None:
    loaded = load(json.dumps(document, indent=indent, ensure_ascii=ascii_only))
    given_robot = document.get("pyfrc", {}).get("robot", {})
    assert loaded.config.robot.l == given_robot.get("l", given_robot.get("h", 3))


@settings(max_examples=25)
@given(document=configs(valid_only=False))
def test_the_schema_accepts_what_the_loader_accepts(load: Load, document: dict[str, Any]) -> None:
    try:
        load(json.dumps(document))
        loads = True
    except SettingsError:
        loads = False
    assert SCHEMA.is_valid(document) == loads, [error.message for error in SCHEMA.iter_errors(document)]
