"""Each season's packages have what the rest of pyfrc asks of a season, whichever WPILib is installed."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

from loops import for_each

import pyfrc_core

CORE = Path(pyfrc_core.__file__).parent


def package_of(statement: ast.ImportFrom, file: Path) -> Path:
    """Return the directory of what a relative import is from."""
    parts = (statement.module or "").split(".")
    return file.parents[statement.level - 1].joinpath(*filter(None, parts)) if statement.level else Path(*parts)


#: What may be an import of a season's module.
IMPORT = re.compile(r"from [.\w]*\b(wpi|hal|patches) import|from \.+ import")


@cache
def modules() -> list[tuple[Path, list[ast.ImportFrom], set[tuple[str, str]]]]:
    """Return all modules but the seasons' own: imports, and attributes of names as name and attribute."""
    found = []
    for file in (each for each in CORE.rglob("*.py") if "season_2" not in each.parent.name):
        text = file.read_text("utf-8")
        if IMPORT.search(text) is None:
            continue
        tree = list(ast.walk(ast.parse(text)))
        attributes = (each for each in tree if isinstance(each, ast.Attribute))
        named = {(each.value.id, each.attr) for each in attributes if isinstance(each.value, ast.Name)}
        found.append((file, [each for each in tree if isinstance(each, ast.ImportFrom)], named))
    return found


@cache
def asked(room: Path) -> set[tuple[str, str]]:
    """Return what other modules name of a season's modules, as module and name."""
    found = set()
    for file, imports, named in modules():
        froms = [each for each in imports if package_of(each, file) == room]
        topics = {alias.asname or alias.name: alias.name for each in froms for alias in each.names}
        found |= {(topics[name], attribute) for name, attribute in named if name in topics}
    return {(topic, name) for topic, name in found if (room / "season_2026" / f"{topic}.py").exists()}


def names_in(source: Path) -> set[str]:
    """Return what a module has at its top: functions, classes, constants, and what it imports."""
    found: set[str] = set()
    for each in ast.parse(source.read_text("utf-8")).body:
        if isinstance(each, (ast.FunctionDef, ast.ClassDef)):
            found.add(each.name)
        elif isinstance(each, (ast.Assign, ast.AnnAssign)):
            targets = each.targets if isinstance(each, ast.Assign) else [each.target]
            found |= {name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)}
        elif isinstance(each, ast.ImportFrom):
            found |= {name.asname or name.name for name in each.names}
    return found


@for_each("room", ["wpi", "hal", "runtime/patches"])
@for_each("season", [2026, 2027])
def test_a_season_has_what_is_asked_of_it(room: str, season: int) -> None:
    wanted = asked(CORE / room)
    assert wanted
    package = CORE / room / f"season_{season}"
    assert [f"{topic}.{name}" for topic, name in sorted(wanted) if name not in names_in(package / f"{topic}.py")] == []
