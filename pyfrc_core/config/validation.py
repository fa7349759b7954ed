"""Checks plain data from a file against a dataclass, with errors that say where in the file, and what to do.

The schemas are plain dataclasses, so that a project that leaves everything at its default never waits
for pydantic to be imported; pydantic does the checking of those that do not.
"""

from __future__ import annotations

import dataclasses
import json
import re
import typing
from pathlib import Path
from typing import Any, TypeVar

from ..errors import SettingsError, nearest

T = TypeVar("T")

#: For a dataclass's ``__pydantic_config__``: keys it does not know are errors, and so is ``"15"`` for a number.
STRICT: Any = {"extra": "forbid", "strict": True}


def validated(schema: type[T], data: object, file: Path, prefix: str = "") -> T:
    """`data` as an instance of `schema`.

    :param prefix: where in the file `data` stands, such as ``tool.pyfrc``
    :raises SettingsError: naming the file, the line where it can be told, the key, and what is allowed
    """
    import pydantic

    try:
        # As JSON, since strict checking of Python data would ask for instances where files have tables.
        return pydantic.TypeAdapter(schema).validate_json(json.dumps(data, default=str))
    except pydantic.ValidationError as invalid:
        errors = invalid.errors(include_url=False)
        first = errors[0]
        path = _settings_path(first)
        # Of a key that may be one of several types, each says what is wrong with it.
        same = [str(error["msg"]) for error in errors if _settings_path(error) == path]
        first["msg"] = ", or ".join(dict.fromkeys(same))
        raise _explain(schema, first, path, file, prefix) from None


def _settings_path(error: Any) -> list[Any]:
    """Where the error is, without pydantic's own names for the types that it tried there."""
    return [part for part in error["loc"] if isinstance(part, int) or re.fullmatch(r"\w+", part)]


def _explain(schema: type[Any], error: Any, path: list[Any], file: Path, prefix: str) -> SettingsError:
    key = ".".join([prefix, *map(str, path)]).strip(".")
    where = f"{file.name}:{line}" if (line := _line_of(file, path)) else file.name
    if error["type"] in ("unexpected_keyword_argument", "extra_forbidden"):
        known = [field.name for field in dataclasses.fields(_schema_at(schema, path[:-1]))]
        return SettingsError(f"unknown key {key!r}", where=where, remedy=nearest(str(path[-1]), known))
    message = str(error["msg"]).replace("Value error, ", "").replace("an object", "a table")
    message = message[:1].lower() + message[1:]
    return SettingsError(f"{key} = {error['input']!r}: {message}", where=where)


def _schema_at(schema: type[Any], path: list[Any]) -> type[Any]:
    for part in path:
        hint = typing.get_type_hints(schema).get(part)
        if dataclasses.is_dataclass(hint) and isinstance(hint, type):
            schema = hint
    return schema


def _line_of(file: Path, path: list[Any]) -> int | None:
    """The line that sets the key, found by its name: the parsers of TOML and JSON do not tell."""
    names = [str(part) for part in path if isinstance(part, str)]
    if not names:
        return None
    setting = re.compile(rf"""^\s*[\["']*(?:[\w.]+\.)?{re.escape(names[-1])}["'\]]*\s*(?:[=:]|$)""")
    for number, text in enumerate(file.read_text("utf-8", "replace").splitlines(), 1):
        if setting.match(text):
            return number
    return None
