"""The tables of the reference that are made from the code when the pages are built.

In a page, a comment such as ``<!-- generated: options deploy -->`` stands for each. `conf.py` puts the tables into the
pages; ``python docs/generated.py PAGE`` prints a page with them.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any, get_args

import click

MARK = re.compile(r"^<!-- generated: (\w+)((?: [\w.-]+)*) -->$", re.MULTILINE)

#: The options of many commands, which the page of the commands describes once.
COMMON = {"--project", "--main", "--robot-class", "--verbose", "--quiet", "--help"}


def expanded(text: str) -> str:
    """Return a page with its tables."""
    return MARK.sub(lambda mark: TABLES[mark[1]](*mark[2].split()), text)


def _table(head: str, rows: Iterable[tuple[str, ...]]) -> str:
    names = [name.strip() for name in head.split("|")]
    lines = [f"| {' | '.join(names)} |", "|" + " --- |" * len(names)]
    return "\n".join([*lines, *(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in row)} |" for row in rows)])


def _literal(text: str) -> str:
    """Return prose in which Markdown changes nothing; options are code, or they would lose one of their hyphens."""
    return re.sub(r"--[a-z][a-z-]*", r"`\g<0>`", re.sub(r"([*<_\[\]])", r"\\\1", text))


def options(*commands: str) -> str:
    """The options of commands, as their ``--help`` has them."""
    from pyfrc_cli.main import cli

    rows = []
    for name in commands:
        command = cli.get_command(click.Context(cli), name)
        assert command is not None, name
        context = click.Context(command)
        for each in command.params:
            record = each.get_help_record(context)
            if isinstance(each, click.Option) and record is not None and not COMMON & set(each.opts):
                rows.append((f"`{record[0]}`", _literal(record[1])))
    return _table("option | meaning", rows)


def commands() -> str:
    """Every command, with the first sentence of its help."""
    from pyfrc_cli.main import COMMANDS, cli

    first = {module: name for name, (module, _) in reversed(COMMANDS.items())}
    context = click.Context(cli)
    rows = []
    for name in reversed(first.values()):
        command = cli.get_command(context, name)
        assert command is not None, name
        sentence = " ".join((command.help or "").split("\n\n")[0].split())
        rows.append((f"`pyfrc {name}`", _literal(sentence)))
    return _table("command | what it does", rows)


def _comments(source: str) -> dict[tuple[str, str], str]:
    """Return the ``#:`` comments above the attributes of classes."""
    found, owner, comment = {}, "", []
    for line in source.splitlines():
        if line.startswith("class "):
            owner = re.split(r"[(:]", line.removeprefix("class "))[0]
        elif line.strip().startswith("#:"):
            comment.append(line.strip()[2:].strip())
            continue
        elif comment:
            found[owner, line.strip().partition(":")[0]] = " ".join(comment)
        comment = []
    return found


def settings() -> str:
    """The keys of ``[tool.pyfrc]`` with their defaults."""
    from pyfrc_core.config import settings as module

    comments = _comments(Path(str(module.__file__)).read_text("utf-8"))

    def rows(table: Any, prefix: str) -> Iterator[tuple[str, ...]]:
        below = []
        for each in fields(table):
            value = getattr(table, each.name)
            if hasattr(value, "__dataclass_fields__"):
                below.append((value, f"{prefix}{each.name}."))
                continue
            default = "" if value is None else f"`{json.dumps(value)}`"
            meaning = comments.get((type(table).__name__, each.name), "Its length.")
            yield f"`{prefix}{each.name}`", default, meaning.replace("``", "`")
        for value, name in below:
            yield from rows(value, name)

    return _table("key | default | meaning", rows(module.Settings(), ""))


def sim_config() -> str:
    """The keys of ``sim/config.json``, from its schema."""
    from pyfrc_core.config.sim import sim_config_schema

    schema = json.loads(sim_config_schema())

    def rows(part: dict[str, Any], prefix: str) -> Iterator[tuple[str, ...]]:
        if "$ref" in part:
            part = schema["$defs"][part["$ref"].rpartition("/")[2]] | {k: v for k, v in part.items() if k != "$ref"}
        for key, value in part.get("properties", {}).items():
            if "description" in value and "$ref" not in value:
                default = f"`{json.dumps(value['default'])}`" if "default" in value else "required"
                allowed = [json.dumps(each) for each in value.get("enum", ())]
                allowed += [f"{names[0]} to {names[-1]}" for names in [_numbers(value)] if names]
                meaning = value["description"] + (f" One of {', '.join(allowed)}." if "enum" in value else "")
                meaning += f" Keys: {allowed[0]}." if allowed and "enum" not in value else ""
                yield f"`{prefix}{key}`", "" if value.get("default") in ({}, []) else default, _literal(meaning)
            yield from rows(value, f"{prefix}{key}.")
        for below, mark in (("items", "[]."), ("additionalProperties", ".N.")):
            if isinstance(part.get(below), dict):
                yield from rows(part[below], prefix.removesuffix(".") + mark)
        for alternative in [*part.get("anyOf", []), *part.get("oneOf", [])]:
            yield from rows(alternative, prefix)

    found = dict.fromkeys(rows(schema["properties"]["pyfrc"], ""))
    return _table("key under `pyfrc` | default | meaning", found)


def _numbers(value: dict[str, Any]) -> list[str]:
    return [name for name in value.get("propertyNames", {}).get("enum", ()) if name.isdecimal()]


def hal_data() -> str:
    """The devices of `hal_data` with the keys that WPILib's simulation has, and what may be written to them."""
    from pyfrc_core.hal import device_table

    rows = []
    for kind in sorted(device_table.KINDS, key=lambda kind: kind.count is None):
        live = [each for each in kind.fields if each.hal or each.get]
        if live and kind.name and not kind.by_number:
            numbers = "" if kind.count is None else f"[0]` to `[{kind.count - 1}]"
            rows.append((f'`["{kind.name}"]{numbers}`', _fields(live)))
    return _table("place | keys", rows)


def _fields(found: Iterable[Any]) -> str:
    kinds: dict[str, list[str]] = {}
    for each in found:
        expected = re.sub(r" from -\d{5,} to \d+", "", each.kind.expected)  # that of 32 bits says nothing
        kinds.setdefault(expected, []).append(f"`{each.name}`")
    return "; ".join(f"{', '.join(names)}: {_literal(expected)}" for expected, names in kinds.items())


def errors() -> str:
    """The errors of libraries that pyfrc explains."""
    from pyfrc_core.explain.libraries import ROWS

    def shown(text: str) -> str:
        named = re.sub(r"(?<!\{)\{(\w+)\}(?!\})", r"<\1>", text)
        return _literal(re.sub(r"\{\{(\w+)\}\}", r"{\1}", named))

    rows = [(shown(row.text.replace("{since}", "")), shown(row.remedy)) for row in ROWS if row.text]
    return _table("message | what to do", dict.fromkeys(rows))


def templates() -> str:
    """The project templates of the installed season."""
    from pyfrc_core.scaffold import TEMPLATES

    return _table("template | what it is", ((f"`{name}`", each.description) for name, each in TEMPLATES.items()))


def widgets() -> str:
    """The keys of a widget in `sim/dashboards.json`."""
    from pyfrc_core.config.dashboards import Kind, Widget

    kinds = f" One of {', '.join(f'`{kind}`' for kind in get_args(Kind))}."
    return _table(
        "key of a widget | meaning",
        (
            (f"`{key}`", f"{each.description}{kinds if key == 'kind' else ''}")
            for key, each in Widget.model_fields.items()
        ),
    )


def api(*modules: str) -> str:
    """The documented names of modules, each below its own heading."""
    return "\n\n".join(f"## `{each}`\n\n```{{eval-rst}}\n.. automodule:: {each}\n```" for each in modules)


TABLES: dict[str, Callable[..., str]] = {
    each.__name__: each for each in (options, commands, settings, sim_config, hal_data, errors, templates, widgets, api)
}

if __name__ == "__main__":
    for page in sys.argv[1:]:
        print(expanded(Path(page).read_text("utf-8")))
