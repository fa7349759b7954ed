"""``sim/config.json``: typed models of the content under its key ``pyfrc``.

Lengths are in feet, angles in degrees clockwise; x grows to the right, y grows downwards. This module has the keys,
their types and defaults; `sim_file` reads the file, and `resolve` adds the values of a season.
An editor completes and explains the keys with the JSON Schema.
"""

from __future__ import annotations

import json
import re
import sys
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    Tag,
    WithJsonSchema,
)
from pydantic.json_schema import GenerateJsonSchema
from pydantic_core import CoreSchema, core_schema

from ..season import CURRENT, FIELDS

#: The maximum number of items of an array, or of keys of a table.
MOST = 1000


@dataclass(frozen=True, eq=False)
class Numbered:
    """The allowed keys of a ``dict[int, ...]`` and the number that each means.

    :param allowed: a description of the keys, for the message about any other key
    """

    allowed: str
    numbers: dict[str, int]

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        schema: Any = handler(source)
        schema["keys_schema"] = core_schema.no_info_before_validator_function(self._number, core_schema.int_schema())
        return core_schema.no_info_before_validator_function(_not_too_many, schema)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {**handler(schema), "propertyNames": {"enum": list(self.numbers)}}

    def _number(self, key: object) -> int:
        number = self.numbers.get(str(key))
        if number is None:
            raise ValueError(f"the key should be {self.allowed}")
        return number


class Array:
    """An array of at most `MOST` items."""

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(_not_too_many, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {**handler(schema), "maxItems": MOST}


def _not_too_many(value: object) -> Any:
    # Checked before the items: a file with millions of them would otherwise give millions of errors.
    if isinstance(value, list | dict) and len(value) > MOST:
        raise ValueError(f"there should be at most {MOST} of them, not {len(value)}")
    return value


def _from_to(first: int, last: int) -> Numbered:
    return Numbered(f"a number from {first} to {last}", {str(number): number for number in range(first, last + 1)})


# As many channels as hal_data has.
ANALOG_CHANNELS = _from_to(0, 7)
DIO_CHANNELS = _from_to(0, 25)  # the roboRIO's own 10, and 16 of an expansion board
PWM_CHANNELS = _from_to(0, 19)  # its own 10, and 10 of an expansion board
RELAY_CHANNELS = _from_to(0, 3)
SOLENOID_CHANNELS = _from_to(0, 15)  # of a Pneumatic Hub; a Pneumatics Control Module has 8
CAN_DEVICES = _from_to(0, 62)
JOYSTICKS = _from_to(0, 5)
BUTTONS = _from_to(CURRENT.first_button, CURRENT.first_button + 31)

#: The axes that `wpilib.Joystick` has names for: x, y, z (or twist), throttle.
AXIS_LETTERS = {"x": 0, "y": 1, "z": 2, "t": 3}
AXES = Numbered(
    "a number from 0 to 11, or one of the letters x, y, z, t",
    _from_to(0, 11).numbers | AXIS_LETTERS | {letter.upper(): number for letter, number in AXIS_LETTERS.items()},
)


_FIELD = CURRENT.field

# Strict: a string or true is not a number. The bounds exclude infinity, which JSON Schema cannot express otherwise.
Number = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-sys.float_info.max, le=sys.float_info.max)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=sys.float_info.max)]
Flag = Annotated[bool, Field(strict=True)]


class _ConfigPart(BaseModel):
    # Unknown keys are not errors here: reading the file warns about them.
    model_config = ConfigDict(frozen=True, extra="ignore")


class StartPosition(_ConfigPart):
    """A place where the robot may start."""

    name: str = Field(description="What the user chooses it by.")
    x: Number = Field(description="Feet, to the right.")
    y: Number = Field(description="Feet, downwards.")
    angle: Number = Field(default=0.0, description="Which way the robot faces: degrees, clockwise.")


class RobotConfig(_ConfigPart):
    """The robot's size, and where it starts."""

    w: Positive = Field(default=2.0, description="Width of the robot, in feet.")
    l: Positive = Field(default=3.0, description="Length of the robot, in feet. Default: h, else 3.")  # noqa: E741
    h: Positive = Field(
        default=3.0, exclude=True, description="The older name of l.", json_schema_extra={"deprecated": True}
    )
    starting_x: Number = Field(default=0.0, description="Where the robot starts: feet, to the right.")
    starting_y: Number = Field(default=0.0, description="Where the robot starts: feet, downwards.")
    starting_angle: Number = Field(
        default=0.0, description="Which way the robot faces at the start: degrees, clockwise."
    )
    start_positions: Annotated[tuple[StartPosition, ...], Array()] = Field(
        default=(),
        description="Places to choose from at the start of a simulation. A single one is taken without asking.",
    )


class Rectangle(_ConfigPart):
    """A rectangle drawn on the field."""

    model_config = ConfigDict(json_schema_extra={"not": {"required": ["points"]}})

    color: str = Field(description="Its colour, by name or as #rrggbb.")
    rect: tuple[Number, Number, Number, Number] = Field(description="[x, y, width, height], in feet.")


class Polygon(_ConfigPart):
    """A polygon drawn on the field."""

    model_config = ConfigDict(json_schema_extra={"not": {"required": ["rect"]}})

    color: str = Field(description="Its colour, by name or as #rrggbb.")
    points: Annotated[tuple[tuple[Number, Number], ...], Array()] = Field(
        description="Its corners [x, y] one after the other, in feet."
    )


def _shape(value: object) -> str | None:
    """Return the tag of the model for an object, by the key that only one of the two has."""
    if isinstance(value, Rectangle | Polygon):
        return f"<{type(value).__name__}>"
    if not isinstance(value, dict) or ("rect" in value) == ("points" in value):
        return None
    return "<Rectangle>" if "rect" in value else "<Polygon>"


FieldObject = Annotated[
    Annotated[Rectangle, Tag("<Rectangle>")] | Annotated[Polygon, Tag("<Polygon>")],
    Discriminator(
        _shape,
        custom_error_type="shape",
        custom_error_message="input should be an object with either the key 'rect' or the key 'points'",
    ),
]


def _year(value: object) -> int | None:
    """Return a year written as a number or a string as an int."""
    if value is None:
        return None
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    if isinstance(value, str) and re.fullmatch("[1-9][0-9]{3}", value):
        value = int(value)
    if type(value) is int and 1000 <= value <= 9999:
        return value
    raise ValueError(f'input should be a year, such as {CURRENT.year} or "{CURRENT.year}"')


_YEAR_SCHEMA = {
    "anyOf": [
        {"enum": [*FIELDS, *map(str, FIELDS)]},
        {"type": "integer", "minimum": 1000, "maximum": 9999},
        # With a length, since some validators let a line break follow the end of a pattern.
        {"type": "string", "pattern": "^[1-9][0-9]{3}$", "maxLength": 4},
        {"type": "null"},
    ]
}


#: How the simulator's page writes places on the field.
Coordinates = Literal["pyfrc", "blue", "blue-feet", "alliance", "alliance-feet"]


class FieldConfig(_ConfigPart):
    """The field: its size, its drawing, and the season's rules."""

    season: Annotated[int | None, BeforeValidator(_year), WithJsonSchema(_YEAR_SCHEMA)] = Field(
        default=None,
        description="The year whose field this is, as number or string. It decides w, h and px_per_ft, "
        "and brings that season's messages and auto_joysticks.",
    )
    w: Positive = Field(default=_FIELD.w, description="Size of the field along x, in feet. Default: today's field.")
    h: Positive = Field(default=_FIELD.h, description="Size of the field along y, in feet. Default: today's field.")
    px_per_ft: Positive = Field(default=_FIELD.px_per_ft, description="Scale of the drawing, in pixels per foot.")
    image: str | None = Field(default=None, description="A picture under the robot; a path relative to sim/.")
    objects: Annotated[tuple[FieldObject, ...], Array()] = Field(default=(), description="What is drawn on the field.")
    coordinates: Coordinates = Field(
        default="pyfrc",
        description="How the simulator's page writes places. pyfrc: feet, y downwards, clockwise. blue: metres, x away "
        "from the blue wall, y to its left, counterclockwise, as in WPILib. alliance: the same from the alliance's own "
        "wall. blue-feet and alliance-feet: likewise, in feet.",
    )
    walls: Flag = Field(
        default=False,
        description="Whether walls around the field stop the robot. Without them, it drives on.",
    )
    auto_joysticks: Flag = Field(
        default=_FIELD.auto_joysticks,
        description="Whether the robot gets joystick data in autonomous. Default: the season's, else false.",
    )
    disabled_joysticks: Flag = Field(default=False, description="Whether the robot gets joystick data while disabled.")


class Joystick(_ConfigPart):
    """The names shown beside a joystick's controls."""

    axes: Annotated[dict[int, str], AXES] = Field(
        default={}, description="Labels of the axes: by index from 0, or by letter: x, y, z, t (throttle)."
    )
    buttons: Annotated[dict[int, str], BUTTONS] = Field(
        default={},
        description="Labels of the buttons, by the number that robot code gives them. The first two are 'Trigger' and "
        "'Top' unless named otherwise; the simulator shows that where all joysticks are of the class Joystick.",
    )


class SimConfig(_ConfigPart):
    """The settings of the robot and the field for tests, physics and the simulator."""

    robot: RobotConfig = RobotConfig()
    field: FieldConfig = FieldConfig()
    game_specific_messages: Annotated[tuple[str, ...], Array()] = Field(
        default=_FIELD.messages,
        description="The messages that the field may send; test_autonomous runs once for each. "
        "Default: the season's, else none.",
    )
    analog: Annotated[dict[int, str], ANALOG_CHANNELS] = Field(
        default={}, description="Labels of the analog inputs, by channel."
    )
    CAN: Annotated[dict[int, str], CAN_DEVICES] = Field(
        default={}, description="Labels of the devices on the CAN bus, by device number."
    )
    dio: Annotated[dict[int, str], DIO_CHANNELS] = Field(
        default={}, description="Labels of the digital inputs and outputs, by channel."
    )
    pwm: Annotated[dict[int, str], PWM_CHANNELS] = Field(
        default={}, description="Labels of the PWM outputs, by channel."
    )
    relay: Annotated[dict[int, str], RELAY_CHANNELS] = Field(
        default={}, description="Labels of the relays, by channel."
    )
    solenoid: Annotated[dict[int, str], SOLENOID_CHANNELS] = Field(
        default={}, description="Labels of the solenoids, by channel."
    )
    joysticks: Annotated[dict[int, Joystick], JOYSTICKS] = Field(
        default={}, description="Labels of each joystick's axes and buttons, by the joystick's port."
    )

    @property
    def start(self) -> StartPosition:
        """The start position of the robot."""
        robot = self.robot
        return StartPosition(name="start", x=robot.starting_x, y=robot.starting_y, angle=robot.starting_angle)

    @property
    def says_start(self) -> bool:
        """Whether the file gives a start position."""
        return not self.robot.model_fields_set.isdisjoint({"starting_x", "starting_y", "starting_angle"})


class SimConfigFile(_ConfigPart):
    """sim/config.json of a robot project. Keys beside pyfrc belong to other tools."""

    pyfrc: SimConfig = SimConfig()


def sim_config_schema() -> str:
    """Return the schema as text (JSON Schema, draft 2020-12; ASCII, so that any redirection keeps it).

    With ``"$schema": "config.schema.json"`` at the top of ``sim/config.json``, editors use the file of that name.
    """
    schema = {"$schema": GenerateJsonSchema.schema_dialect, **SimConfigFile.model_json_schema()}
    schema["title"] = "sim/config.json"
    return json.dumps(schema, indent=2)
