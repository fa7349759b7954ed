"""The effective values of ``sim/config.json`` as the plain dict that physics modules of 2019 read."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .sim import SimConfig


def document_of(config: SimConfig, file: Mapping[str, object] | None = None) -> dict[str, Any]:
    """Return ``{"pyfrc": {"robot": {"w": 2.0, ...}, ...}}``: the file's content with every default filled in.

    :param config: the values in effect
    :param file: the file's content, including the keys of other tools
    """
    values = config.model_dump(mode="json")
    values["robot"]["h"] = config.robot.h  # the older name of `l`, which the model leaves out
    return _filled(file or {}, {"pyfrc": values})


def _filled(given: Mapping[str, object], resolved: Mapping[str, object]) -> dict[str, Any]:
    filled = dict(given)
    for key, value in resolved.items():
        before = given.get(key)
        if isinstance(value, dict):
            filled[key] = _filled(before if isinstance(before, Mapping) else {}, value)
        elif before != value or isinstance(before, bool) != isinstance(value, bool):
            filled[key] = value
    return filled
