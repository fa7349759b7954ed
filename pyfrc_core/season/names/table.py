"""The names of 2026 and what became of them: `table.json` with the corrections.

`compare` describes the table's text. Nothing here imports WPILib, so a machine with
either season, or none, can migrate.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Mapping, Set
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from ..spelling import snake_case

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

#: Where the data are.
HERE = Path(__file__).parent
_ENTRY = re.compile(
    r"(?P<new>[^(:{;]*)(?P<bases>\([^)]*\))?(?P<type>:[^{;]*)?(?P<parameters>\{[^}]*\})?(?P<members>;.*)?"
)
_MEMBER = re.compile(r"(?P<name>\w+)(?P<new>=[^:{]+)?(?P<type>:[^{]*)?(?P<parameters>\{[^}]*\})?")


@dataclass(frozen=True)
class Member:
    """A member of a class.

    :param new: its new name; a path of another class's member; None if it is gone
    :param is_value: a method has become a property
    :param type: the path of its type, or of what it returns; `[path]` for a container; `self`
    """

    name: str
    new: str | None
    type: str = ""
    parameters: Mapping[str, str] = field(default_factory=dict)
    is_value: bool = False

    def keyword(self, name: str) -> str:
        """Return the new name of a keyword argument."""
        return self.parameters.get(name, snake_case(name))


@dataclass(frozen=True)
class Name(Member):
    """A class, function or constant of a module; `name` and `new` are paths."""

    is_class: bool = False
    bases: tuple[str, ...] = ()
    members: Mapping[str, Member] = field(default_factory=dict)


class Table:
    """What became of each name of the old season.

    :param data: the content of `table.json`
    :param corrections: the content of `corrections.toml`
    """

    def __init__(self, data: Mapping[str, Any], corrections: Mapping[str, Any]) -> None:
        ours: Mapping[str, str] = corrections["own_types"]
        homes = {path.rpartition(".")[0] for path in ours}
        self.modules: Mapping[str, str] = {**data["modules"], **{home: home for home in homes}}
        self.corrections = corrections
        self._aliases: Mapping[str, str] = {**data["aliases"], **corrections["old_aliases"]}
        self._lines: Mapping[str, str] = {**data["names"], **{path: f"();{members}" for path, members in ours.items()}}
        self._names: dict[str, Name | None] = {}
        self._members: dict[str, frozenset[str]] = {}
        self._camel: frozenset[str] | None = None
        self._new_names: dict[str, list[str]] = {}

    def canonical(self, path: str) -> str:
        """Return the first path of a name that has several."""
        head, _, tail = path.rpartition(".")
        return self._aliases.get(path) or (f"{self._aliases[head]}.{tail}" if head in self._aliases else path)

    def name(self, path: str) -> Name | None:
        """Return a class, function or constant of a module; None if there is no such name."""
        path = self.canonical(path)
        if path not in self._names:
            line = self._lines.get(path)
            self._names[path] = None if line is None else _read_name(path, line)
        return self._names[path]

    def ancestors(self, path: str) -> list[str]:
        """Return a class and all its bases, in the order of lookup."""
        found = [self.canonical(path)]
        for each in found:
            name = self.name(each)
            found += [base for base in (name.bases if name is not None else ()) if base not in found]
        return found

    def member(self, path: str, name: str) -> tuple[str, Member] | None:
        """Return a member of a class or of its bases, with the class where it was found."""
        for each in self.ancestors(path):
            known = self.name(each)
            if known is not None and name in known.members:
                return each, known.members[name]
        return None

    def member_names(self, path: str) -> frozenset[str]:
        """Return the names of all members of a class and of its bases."""
        if path not in self._members:
            known = [self.name(each) for each in self.ancestors(path)]
            self._members[path] = frozenset(name for each in known if each is not None for name in each.members)
        return self._members[path]

    def classes_with(self, names: Set[str]) -> list[str]:
        """Return the classes that have members of all these names; of classes that are derived, the first base."""
        every = [path for path in self._lines if (known := self.name(path)) is not None and known.is_class]
        found = {each for each in every if names <= self.member_names(each)}
        first = [each for each in found if found.isdisjoint(self.ancestors(each)[1:])]

        def rank(path: str) -> tuple[bool, bool, bool, int, str]:
            gone = self.new_path(path) is None
            return gone, "simulation" in path, not path.startswith("wpi"), len(path), path

        return sorted(first, key=rank)

    def new_path(self, path: str) -> str | None:
        """Return the new path of a module, class, function or constant; None if it is gone."""
        if path in self.modules:
            return self.modules[path] or None
        known = self.name(path)
        if known is not None:
            return known.new
        module, _, last = path.rpartition(".")
        return f"{self.modules[module]}.{last}" if self.modules.get(module) else path

    def before(self, name: str) -> list[str]:
        """Return the classes, functions and constants of modules whose new path ends in a name."""
        if not self._new_names:
            for path in self._lines:
                new = self.new_path(path) or ""
                self._new_names.setdefault(new.rpartition(".")[2], []).append(path)
        return self._new_names.get(name, [])

    def inside(self, outer: str) -> list[tuple[str, str | None]]:
        """Return the classes inside a class: the path and the new one of each; None if it is gone."""
        return [(path, self.new_path(path)) for path in self._lines if path.rpartition(".")[0] == outer]

    def homes(self, name: str, *, new: bool) -> list[str]:
        """Return the modules that have a class, function or constant of a name, the ones with short names first.

        :param new: ask of the new season
        """
        paths = self.before(name) if new else [path for path in self._lines if path.rpartition(".")[2] == name]
        found = {(self.new_path(path) or "" if new else path).rpartition(".")[0] for path in paths}
        known = {*self.modules.values()} if new else {*self.modules}
        return sorted(found & known - {""}, key=lambda each: (each.count("."), len(each), each))

    def advice(self, *paths: str) -> str:
        """Return what `corrections.toml` says about the first of the paths that it knows."""
        gone: Mapping[str, str] = self.corrections["gone"]
        for path in paths:
            parts = path.split(".")
            for end in range(len(parts), 0, -1):
                if ".".join(parts[:end]) in gone:
                    return gone[".".join(parts[:end])]
        return ""

    def camel_names(self) -> frozenset[str]:
        """Return all names of members that are spelled differently now."""
        if self._camel is not None:
            return self._camel
        found = set()
        for line in self._lines.values():
            members = line.partition(";")[2].split(" ")
            found |= {each for member in members if (each := re.split("[=:{]", member)[0]) != snake_case(each)}
        self._camel = frozenset(found - {""})
        return self._camel


def corrections() -> dict[str, Any]:
    """Return what was written by hand: `corrections.toml`, where a key can have several paths with spaces between."""
    found = _read("corrections.toml")
    for section in ("gone", "notes", "templates", "other_arguments"):
        found[section] = _separate(found[section])
    for outer, pairs in found.pop("moved_together").items():
        found["moved"] |= {f"{outer}.{name}": new for name, _, new in (pair.partition("=") for pair in pairs.split())}
    return found


@cache
def earlier_names() -> Mapping[str, str]:
    """Return the names of the seasons before 2026, alone or after their class, and what to write instead in 2026."""
    found = _read("earlier.toml")
    once = "MOTOR.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)"
    return _separate(found["names"]) | {
        name: f"config = rev.SparkMaxConfig(); config.{setting}; and once, with all settings: {once}"
        for name, setting in _separate(found["spark"]).items()
    }


def _read(name: str) -> dict[str, Any]:
    return tomllib.loads((HERE / name).read_text(encoding="utf-8"))


def _separate(section: Mapping[str, Any]) -> dict[str, Any]:
    return {path: value for paths, value in section.items() for path in paths.split()}


@cache
def table() -> Table:
    """Return the table from 2026 to 2027."""
    data = json.loads((HERE / "table.json").read_text(encoding="utf-8"))
    return Table(data, corrections())


def _read_name(path: str, line: str) -> Name:
    found = _ENTRY.fullmatch(line)
    assert found is not None, line
    new = found["new"]
    return Name(
        path,
        None if new == "-" else new or path,
        (found["type"] or "")[1:],
        _read_parameters(found["parameters"]),
        is_class=found["bases"] is not None,
        bases=tuple((found["bases"] or "()")[1:-1].split()),
        members={member.name: member for member in map(_read_member, (found["members"] or ";")[1:].split())},
    )


def _read_member(text: str) -> Member:
    found = _MEMBER.fullmatch(text)
    assert found is not None, text
    new = (found["new"] or "")[1:] or snake_case(found["name"])
    return Member(
        found["name"],
        None if new == "-" else new.removesuffix("!"),
        (found["type"] or "")[1:],
        _read_parameters(found["parameters"]),
        is_value=new.endswith("!"),
    )


def _read_parameters(text: str | None) -> dict[str, str]:
    pairs = (text or "{}")[1:-1].split(",")
    return {name: new for name, _, new in (pair.partition("=") for pair in pairs if pair)}
