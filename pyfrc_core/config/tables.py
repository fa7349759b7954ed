"""Types of ``sim/config.json``: tables whose keys are numbers (strings in JSON), and arrays of limited length."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

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
BUTTONS = _from_to(1, 32)

#: The axes that `wpilib.Joystick` has names for: x, y, z (or twist), throttle.
AXIS_LETTERS = {"x": 0, "y": 1, "z": 2, "t": 3}
AXES = Numbered(
    "a number from 0 to 11, or one of the letters x, y, z, t",
    _from_to(0, 11).numbers | AXIS_LETTERS | {letter.upper(): number for letter, number in AXIS_LETTERS.items()},
)
