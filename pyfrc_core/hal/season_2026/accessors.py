"""How the functions of WPILib's simulated devices are named, for the rows of the tables: see `fields`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def getter_name(value: str) -> str:
    """Return the name of the functions that return a value, such as `Speed`."""
    return f"get{value}"


def getter(device: object, value: str | None) -> Callable[[], Any]:
    """Return the function that reads a value, such as `Speed`."""
    read: Callable[[], Any] = getattr(device, getter_name(value or ""))
    return read


def setter(device: object, value: str | None) -> Callable[[Any], object] | None:
    """Return the function that writes it, if there is one."""
    return getattr(device, f"set{value}", None)


def registrar(device: object, value: str | None) -> Callable[..., object] | None:
    """Return the function that registers a listener for it, if there is one."""
    return getattr(device, f"register{value}Callback", None)
