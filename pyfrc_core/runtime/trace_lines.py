"""Formats the lines of a trace: the text of ``json.dumps(..., sort_keys=True)``, made in a fifth of the time.

Hand-written, because a trace has hundreds of megabytes an hour: the paths are the same from packet to packet, and
`json` formats and sorts them all again. The texts of floats are pydantic's, which has the same shortest digits as
Python in a tenth of the time; where it writes them in another form, they are Python's.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from operator import add
from typing import Any

#: The key of a line's values that do not repeat.
REAL_TIME = "real_time"

#: What a line has before its time.
_TIME = '"t": '

_encode = json.JSONEncoder(sort_keys=True).encode  # `json.dumps` would make an encoder for each value


def line_time(line: str) -> float:
    """Return the time of a line, which is its last item, without reading the values before it."""
    return float(line[line.rindex(_TIME) + len(_TIME) : line.rindex("}")])


class TraceLines:
    """Formats lines whose paths repeat."""

    def __init__(self) -> None:
        from pydantic_core import to_json  # only here: most commands trace nothing

        self._to_json = to_json
        #: The rank of each path in the order of the paths, and its beginning of an item.
        self._ranks: dict[str, int] = {}
        self._keys: dict[str, str] = {}

    def format(self, now: float, changed: dict[str, object], gone: list[str], marked: dict[str, object]) -> str:
        """Return the line of one packet.

        :param now: the robot time, rounded
        :param changed: the values by path
        :param gone: the paths that no longer exist
        :param marked: the values that do not repeat, by path
        """
        start = f'"gone": {json.dumps(gone)}, ' if gone else ""
        if marked:
            start += f'"{REAL_TIME}": {self._object(marked)}, '
        return f'{{{start}"set": {self._object(changed)}, "t": {now!r}}}'

    def _object(self, values: dict[str, object]) -> str:
        try:
            ordered = sorted(values, key=self._ranks.__getitem__)
        except KeyError:
            self._learn(values)
            ordered = sorted(values, key=self._ranks.__getitem__)
        keys = self._keys
        texts = self._texts([values[path] for path in ordered])
        return f"{{{', '.join(map(add, [keys[path] for path in ordered], texts))}}}"

    def _texts(self, values: list[Any]) -> Sequence[str]:
        others = {place: value for place, value in enumerate(values) if type(value) is not float}
        for place in others:
            values[place] = 0.0
        text = self._to_json(values).decode()
        texts = text[1:-1].split(",")
        if "e" in text or "0.0000" in text:
            for place, each in enumerate(texts):
                # Python has the form 1e-05, and begins with it at other numbers.
                if "e" in each or each.startswith(("0.0000", "-0.0000")):
                    texts[place] = repr(values[place])
        for place, value in others.items():
            texts[place] = _encode(value)
        return texts

    def _learn(self, paths: dict[str, object]) -> None:
        for path in paths:
            self._keys[path] = json.dumps(path) + ": "
        self._ranks = {path: rank for rank, path in enumerate(sorted(self._keys))}
