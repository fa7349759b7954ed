"""What a SimDevice's values are, by the names that vendors and WPILib give them: a SimDevice does not say it."""

from __future__ import annotations

import re

from .fields import Quantity

#: Patterns for a SimDevice and its numeric value, as ``device/value``; the first match counts.
_OF_DEVICES: tuple[tuple[str, Quantity], ...] = (
    (r"^SPARK.*(?<!ABSOLUTE ENCODER)(?<!ANALOG SENSOR)/Position$", "rotations"),
    (r"^SPARK.*/Velocity$", "rpm"),
    (r"(CANcoder|Talon FX).*/rawPosition", "rotations"),
    (r"Pigeon.*/rawYaw", "angle"),
    (r"Pigeon.*/angularVel", "turning"),
    (r"ANALOG SENSOR/.*(?i:voltage)", "volts"),
)
#: Patterns for the names of other numeric values; the first match counts.
_NAMED: tuple[tuple[str, Quantity], ...] = (
    (r"rate|velocity", "turning"),
    (r"yaw|pitch|roll", "half turns"),
    (r"heading", "heading"),
    (r"angle", "angle"),
    (r"accel|^[xyz]$", "acceleration"),
    (r"range|distance", "range"),
    (r"voltage", "battery"),
    (r"current", "amperes"),
)


def quantity_of(device: str, value: str, sort: str) -> Quantity:
    """Return what a value of a SimDevice is.

    :param device: the device's name
    :param value: the value's name
    :param sort: the kind of its type: "boolean", "option", "number", "whole" or "long"
    """
    if sort == "boolean":
        return "connected" if re.search("connected|valid", value, re.IGNORECASE) else "switch"
    if sort == "option":
        return "option"
    if sort != "number":
        return "celsius" if re.search("temperature", value, re.IGNORECASE) else "whole"
    for pattern, quantity in _OF_DEVICES:
        if re.search(pattern, f"{device}/{value}"):
            return quantity
    return next((quantity for pattern, quantity in _NAMED if re.search(pattern, value, re.IGNORECASE)), "turns")
