"""How names are spelled in both seasons."""

from __future__ import annotations

import re


def snake_case(name: str) -> str:
    """Return a camelCase name as 2027 spells it: constants in capitals and without their `k`."""
    if re.match(r"k[A-Z0-9]", name):
        return _split(name[1:]).upper()
    if name[:1].isupper() or "_" in name.strip("_"):
        return name
    return _split(name).lower()


def normalized(name: str) -> str:
    """Return a name without what the seasons spell differently: what was a speed is a velocity."""
    if re.match(r"k[A-Z0-9]", name):
        name = name[1:]
    name = name.replace("_", "").lower()
    return name.replace("speed", "velocity").replace("velocitys", "velocities")


def _split(name: str) -> str:
    name = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name)
    return re.sub(r"([A-Z]+)([A-Z][a-z])", r"\1_\2", name)
