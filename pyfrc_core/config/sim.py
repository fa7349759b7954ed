"""``sim/config.json``: typed models of the content under its key ``pyfrc``.

Lengths are in feet, angles in degrees clockwise; x grows to the right, y grows downwards. This module has the keys,
their types and defaults; `sim_file` reads the file, and `resolve` adds the values of a season.
"""

from __future__ import annotations

import re
import sys
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict, Discriminator, Field, Tag, WithJsonSchema

from ..season import CURRENT, FIELDS
from . import tables

_FIELD = CURRENT.field

# Strict: a string or true is not a number. The bounds exclude infinity, which JSON Schema cannot express otherwise.
Number = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-sys.float_info.max, le=sys.float_info.max)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=sys.float_info.max)]
Flag = Annotated[bool, Field(strict=True)]


class _Part(BaseModel):
    # Unknown keys are not errors here: reading the file warns about them.
    model_config = ConfigDict(frozen=True, extra="ignore")


class StartPosition(_Part):
    """A place where the robot may start."""

    name: str = Field(description="What the user chooses it by.")
    x: Number = Field(description="Feet, to the right.")
    y: Number = Field(description="Feet, downwards.")
    angle: Number = Field(default=0.0, description="Which way the robot faces: degrees, clockwise.")


class RobotConfig(_Part):
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
    start_positions: Annotated[tuple[StartPosition, ...], tables.Array()] = Field(
        default=(),
        description="Places to choose from at the start of a simulation. A single one is taken without asking.",
    )


class Rectangle(_Part):
    """A rectangle drawn on the field."""

    model_config = ConfigDict(json_schema_extra={"not": {"required": ["points"]}})

    color: str = Field(description="Its colour, by name or as #rrggbb.")
    rect: tuple[Number, Number, Number, Number] = Field(description="[x, y, width, height], in feet.")


class Polygon(_Part):
    """A polygon drawn on the field."""

    model_config = ConfigDict(json_schema_extra={"not": {"required": ["rect"]}})

    color: str = Field(description="Its colour, by name or as #rrggbb.")
    points: Annotated[tuple[tuple[Number, Number], ...], tables.Array()] = Field(
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


class FieldConfig(_Part):
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
    objects: Annotated[tuple[FieldObject, ...], tables.Array()] = Field(
        default=(), description="What is drawn on the field."
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


class Joystick(_Part):
    """The names shown beside a joystick's controls."""

    axes: Annotated[dict[int, str], tables.AXES] = Field(
        default={}, description="Labels of the axes: by index from 0, or by letter: x, y, z, t (throttle)."
    )
    buttons: Annotated[dict[int, str], tables.BUTTONS] = Field(
        default={}, description="Labels of the buttons, from 1. 1 is 'Trigger' and 2 is 'Top' unless named otherwise."
    )


class SimConfig(_Part):
    """The settings of the robot and the field for tests, physics and the simulator."""

    robot: RobotConfig = RobotConfig()
    field: FieldConfig = FieldConfig()
    game_specific_messages: Annotated[tuple[str, ...], tables.Array()] = Field(
        default=_FIELD.messages,
        description="The messages that the field may send; test_autonomous runs once for each. "
        "Default: the season's, else none.",
    )
    analog: Annotated[dict[int, str], tables.ANALOG_CHANNELS] = Field(
        default={}, description="Labels of the analog inputs, by channel."
    )
    CAN: Annotated[dict[int, str], tables.CAN_DEVICES] = Field(
        default={}, description="Labels of the devices on the CAN bus, by device number."
    )
    dio: Annotated[dict[int, str], tables.DIO_CHANNELS] = Field(
        default={}, description="Labels of the digital inputs and outputs, by channel."
    )
    pwm: Annotated[dict[int, str], tables.PWM_CHANNELS] = Field(
        default={}, description="Labels of the PWM outputs, by channel."
    )
    relay: Annotated[dict[int, str], tables.RELAY_CHANNELS] = Field(
        default={}, description="Labels of the relays, by channel."
    )
    solenoid: Annotated[dict[int, str], tables.SOLENOID_CHANNELS] = Field(
        default={}, description="Labels of the solenoids, by channel."
    )
    joysticks: Annotated[dict[int, Joystick], tables.JOYSTICKS] = Field(
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


class SimConfigFile(_Part):
    """sim/config.json of a robot project. Keys beside pyfrc belong to other tools."""

    pyfrc: SimConfig = SimConfig()
