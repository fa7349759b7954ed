"""Paths of values in `hal_data`: ``joysticks[0].axes[1]``, ``CAN["SPARK MAX [3]"].Velocity``.

A key that is a plain name follows a dot, an index or number is in brackets, and any other key is a quoted string (as in
JSON) in brackets. `format_path` and `parse_path` are inverse functions.
"""

from __future__ import annotations

import json
import re
from ast import literal_eval
from collections.abc import Iterable
from functools import lru_cache

from .kinds import WrongPath

Segment = str | int

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*", re.ASCII)
_BRACKET = re.compile(
    r"""\[ \s*
    (?: (?P<number>-?[0-9]+) | (?P<double>"(?:[^"\\]|\\.)*") | (?P<single>'(?:[^'\\]|\\.)*') )
    \s* \]""",
    re.VERBOSE | re.ASCII | re.DOTALL,
)


@lru_cache(maxsize=4096)
def parse_path(path: str) -> tuple[Segment, ...]:
    """Return the keys and indices in `path`, in order.

    :raises ValueError: when it is not a path; the error shows the wrong part
    """
    segments: list[Segment] = []
    position = 0
    while position < len(path):
        dot = path[position] == "." and bool(segments)
        name = _NAME.match(path, position + dot) if dot or not segments else None
        bracket = None if dot else _BRACKET.match(path, position)
        if name:
            segments.append(name[0])
            position = name.end()
        elif bracket:
            try:
                segments.append(_bracketed(bracket))
            except ValueError:
                raise _wrong(path, position) from None
            position = bracket.end()
        else:
            raise _wrong(path, position)
    if not segments:
        raise WrongPath("a path is empty", remedy="it looks like pwm[3].value")
    return tuple(segments)


def _bracketed(match: re.Match[str]) -> Segment:
    if match["number"]:
        return int(match["number"])
    if match["double"]:
        return str(json.loads(match["double"], strict=False))
    return str(literal_eval(match["single"]))


def _wrong(path: str, position: int) -> WrongPath:
    return WrongPath(
        f"cannot read {path[position:]!r} in the path {path!r}",
        remedy='a path looks like pwm[3].value or CAN["SPARK MAX [3]"].Velocity',
    )


def format_path(segments: Iterable[Segment]) -> str:
    """Return the path of `segments`, in the form that `parse_path` reads."""
    path = ""
    for segment in segments:
        path = join(path, segment)
    return path


def join(path: str, segment: object) -> str:
    """Return `path` with one more key or index."""
    if isinstance(segment, str):
        if _NAME.fullmatch(segment):
            return f"{path}.{segment}" if path else segment
        return f"{path}[{json.dumps(segment, ensure_ascii=False)}]"
    return f"{path}[{segment}]"
