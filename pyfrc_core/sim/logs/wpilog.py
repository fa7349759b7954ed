"""WPILib's data logs, ``.wpilog``, as columns: a value is decoded when it is looked at (`log_records`)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...log_records import MOST_RECORDS, READERS, DataLog, LogEntry, read_data_log, text_of
from ..engine.changes import frozen
from ..engine.structs import STRUCT, Structs
from ..engine.value_history import MISSING
from .columns import Column, ReadLog

#: How many records of an array of structs are looked at for its length.
_LOOKED_AT = 2000
#: The most parts of an array of structs.
_MOST_PARTS = 512
#: What NetworkTables call the types that a log names differently.
_NETWORK_TYPES = {"int64": "int", "int64[]": "int[]"}


def read_wpilog(file: Path, most: int = MOST_RECORDS) -> ReadLog:
    """Read a data log, as far as it is whole.

    :param most: the most records that are kept
    """
    log = read_data_log(file, most)
    found = ReadLog(problem=log.problem)
    schemas = {entry.name: _last_text(log, entry) for entry in log.entries if entry.type_name == "structschema"}
    structs = Structs(
        lambda kind: next((text for name, text in schemas.items() if name.endswith(f"/struct:{kind}")), "")
    )
    for entry in log.entries:
        if entry.type_name != "structschema":
            name = f"{entry.name} ({entry.type_name})" if entry.name in found.types else entry.name  # with another type
            found.types[name] = _NETWORK_TYPES.get(entry.type_name, entry.type_name)
            found.columns.update(_columns(log, entry, name, structs))
    return found


def _json(raw: bytes) -> str:
    text = text_of(raw)
    return text if len(text) < 4096 else text[:4096] + "..."


def _unknown(raw: bytes) -> Any:
    return {"$": "bytes", "size": len(raw)}


def _columns(log: DataLog, entry: LogEntry, name: str, structs: Structs) -> dict[str, Column]:
    """Return the columns of an entry: its own, or those of a struct's parts.

    :param name: how they are called
    """
    places, type_name = entry.places, entry.type_name
    if type_name.startswith(STRUCT):
        return _parts(log, entry, name, structs)
    read = _json if type_name == "json" else READERS.get(type_name, _unknown)

    def decode(begin: int, end: int) -> list[Any]:
        values = (read(log.payload(place)) for place in places[begin:end])
        return [MISSING if value is None else value for value in values]

    return {name: Column(entry.moments, decode)}


def _parts(log: DataLog, entry: LogEntry, name: str, structs: Structs) -> dict[str, Column]:
    """Return the columns of a struct's parts; of an array, those of the longest of its records that were looked at."""
    type_name, places = entry.type_name, entry.places
    looked_at = {*places[:: max(len(places) // _LOOKED_AT, 1)], places[-1]}
    longest = max((log.payload(place) for place in looked_at), key=len)
    paths = list(structs.parts(name, type_name, longest))[:_MOST_PARTS]

    def column_of(path: str) -> Column:
        def decode(begin: int, end: int) -> list[Any]:
            records = (structs.parts(name, type_name, log.payload(place)) for place in places[begin:end])
            return [frozen(parts.get(path, MISSING)) for parts in records]

        return Column(entry.moments, decode)

    return {path: column_of(path) for path in paths}


def _last_text(log: DataLog, entry: LogEntry) -> str:
    return text_of(log.payload(entry.places[-1]))
