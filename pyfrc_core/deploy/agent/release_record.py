"""A release's record: reading it, and what it says of how the program runs.

A watch sees only the first seconds of a program. The process that it saw is therefore recorded, and the next agent
compares it with the process that runs then: another one means that the program has ended and was started again.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

Record = dict[str, Any]

#: Seconds after which a program counts as lasting. A new process that is younger counts as the end of the program, also
#: after a restart from the Driver Station. When it lasts, it proves the opposite.
LONG = 60.0
#: Seconds after its boot within which a robot has started its program.
_BOOT = 180.0


class Boot(NamedTuple):
    """One start of the robot's system.

    :param name: differs for each start; empty if unknown
    :param age:  seconds since then; None if unknown
    """

    name: str
    age: float | None = None


class Standing(NamedTuple):
    """How well a release runs; the best compares as the greatest.

    :param readable: whether its record can be read
    :param good:     whether a watch has seen it run, and nothing says otherwise
    :param lasted:   for how many seconds it was seen to run, at most `LONG`
    """

    readable: bool
    good: bool
    lasted: float


def standing(record: Mapping[str, Any]) -> Standing:
    """Return how well the release of a record runs."""
    good = bool(record.get("ran") and not record.get("ended"))
    return Standing(bool(record), good, record.get("lasted") or 0.0)


def after_watch(record: Record, runs: bool, ended: bool, process: int | None, age: float, boot: Boot) -> Record:
    """Return the record after a watched start.

    :param runs:    whether the watch has confirmed that the program runs
    :param ended:   whether it has ended
    :param process: its process, if it has one
    :param age:     for how many seconds that has run
    """
    seen = runs and process is not None and boot.name
    return {
        **record,
        "ran": runs or bool(record.get("ran")),
        "ended": ended,
        "lasted": max(record.get("lasted") or 0.0, min(age, LONG) if runs else 0.0),
        "process": {"boot": boot.name, "id": process} if seen else None,
    }


def now(record: Record, boot: Boot, processes: Collection[int], age: float | None) -> Record:
    """Return the record with what the program's current processes say.

    :param age: for how many seconds the program has run; None if unknown
    """
    seen = record.get("process")
    if not seen:
        return record  # no watch has seen it run since its last start
    if processes and age is not None and age >= LONG:
        return {**record, "ended": False, "lasted": LONG}
    if seen["boot"] == boot.name:
        is_restarted = seen["id"] not in processes
    else:
        is_restarted = boot.age is not None and age is not None and boot.age - age > _BOOT
    if is_restarted:
        return {**record, "ended": True}
    return {**record, "lasted": max(record.get("lasted") or 0.0, round(age or 0.0, 1))}


def record_text(record: Record) -> str:
    """Return the content of a record's file: its SHA-256, and the record."""
    text = json.dumps(record)
    return f"{_hash_of(text)}\n{text}"


def parse_record(text: str) -> Record:
    """Return the record in a file; empty if it is damaged."""
    sha256, _, content = text.partition("\n")
    return dict(json.loads(content)) if sha256 == _hash_of(content) else {}


def _hash_of(text: str) -> str:
    return hashlib.sha256(text.encode(errors="surrogateescape")).hexdigest()
