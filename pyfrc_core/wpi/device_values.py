"""Sensors and values of simulated devices, as the seasons' `devices` name them. It imports no WPILib."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, Literal, NamedTuple


class Sensor(NamedTuple):
    """A sensor in `hal_data`.

    :param place: the parts of its path there
    :param where: where it is, if that is no part of the path, to be read after its name
    """

    place: tuple[str | int, ...]
    where: str = ""


def find_sensor(thing: object, sensors: Mapping[str, Callable[[Any], Sensor]]) -> Sensor | None:
    """Return what a sensor is in `hal_data`; None for other objects, and for one that is closed.

    :param sensors: what a sensor is, by the name of its class
    """
    for kind in type(thing).__mro__[:-1]:
        if (find := sensors.get(kind.__name__)) is not None:
            with suppress(Exception):  # it is closed, or of a class of the robot's with that name
                return find(thing)
            return None
    return None


SimValueKind = Literal["boolean", "number", "whole", "option"]


class SimValue(NamedTuple):
    """A value of a SimDevice.

    :param is_output: whether only the device itself writes it
    :param kind: its type; ``whole`` is a whole number
    :param options: what an option can be
    """

    name: str
    is_output: bool
    kind: SimValueKind
    options: tuple[str, ...] = ()
