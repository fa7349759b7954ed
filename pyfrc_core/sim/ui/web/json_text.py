"""JSON for a page: numbers that are not finite, which JSON does not have, are objects such as ``{"$": "NaN"}``."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any


def json_text(message: object) -> str:
    """Return a message as JSON."""
    try:
        return json.dumps(message, allow_nan=False, separators=(",", ":"), default=_plain)
    except ValueError:  # rare, so most messages are not looked through
        return json.dumps(_safe(message), allow_nan=False, separators=(",", ":"), default=str)


def _plain(value: object) -> object:
    # Most are of this type.
    return dict(value) if type(value) is MappingProxyType or isinstance(value, Mapping) else str(value)


def _safe(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return {"$": "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"}
    if isinstance(value, Mapping):
        return {str(key): _safe(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_safe(each) for each in value]
    return value


def read_value(value: Any) -> Any:
    """Return a value that a page has sent, with numbers that are not finite."""
    if isinstance(value, dict):
        if value.keys() == {"$"}:
            return {"NaN": math.nan, "Infinity": math.inf, "-Infinity": -math.inf}.get(value["$"], value)
        return {key: read_value(each) for key, each in value.items()}
    return [read_value(each) for each in value] if isinstance(value, list) else value
