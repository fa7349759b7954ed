"""Formats the lines of a trace: the text of ``json.dumps(..., sort_keys=True)``, made in half the time.

Hand-written, because a trace has hundreds of megabytes an hour: the paths are the same from packet to packet, and
robots have many equal numbers in a packet, such as the voltage at each motor. `json` formats and sorts them all again.
"""

from __future__ import annotations

import json

#: The key of a line's values that do not repeat.
REAL_TIME = "real_time"

#: What a line has before its time.
_TIME = '"t": '

#: How JSON has the numbers that are not finite.
_NOT_FINITE = {"nan": "NaN", "inf": "Infinity", "-inf": "-Infinity"}

_encode = json.JSONEncoder(sort_keys=True).encode  # `json.dumps` would make an encoder for each value


def line_time(line: str) -> float:
    """Return the time of a line, which is its last item, without reading the values before it."""
    return float(line[line.rindex(_TIME) + len(_TIME) : line.rindex("}")])


class TraceLines:
    """Formats lines whose paths repeat."""

    def __init__(self) -> None:
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
        texts: dict[float, str] = {}
        items = []
        for path in ordered:
            value = values[path]
            if type(value) is not float:
                text = _encode(value)
            elif value in texts and value:  # 0.0 equals -0.0
                text = texts[value]
            else:
                text = repr(value)
                texts[value] = text = _NOT_FINITE.get(text, text)
            items.append(keys[path] + text)
        return f"{{{', '.join(items)}}}"

    def _learn(self, paths: dict[str, object]) -> None:
        for path in paths:
            self._keys[path] = json.dumps(path) + ": "
        self._ranks = {path: rank for rank, path in enumerate(sorted(self._keys))}
