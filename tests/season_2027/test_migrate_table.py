"""The new names in the table of `pyfrc migrate` exist in WPILib 2027."""

from __future__ import annotations

import re
from pathlib import Path

import wpilib

from pyfrc_core.season.names.table import HERE, table
from tools.names.packages import Class, Packages


def test_every_new_name_exists() -> None:
    assert wpilib.__file__ is not None
    site = Path(wpilib.__file__).parents[1]
    installed = Packages(site)
    installed.read()
    wrong = []
    for path in re.findall(r'^"([\w.]+)": "', (HERE / "table.json").read_text("utf-8"), re.MULTILINE):
        name = table().name(path)
        new = None if name is None else name.new
        if new is None or not (site / new.partition(".")[0]).is_dir() or path in table().modules:
            continue
        outer, _, last = new.rpartition(".")
        owner = installed.entries.get(outer)
        inside = isinstance(owner, Class) and last in owner.members
        if not (new in installed.entries or new in installed.aliases or inside):
            wrong.append(f"{path} -> {new}")
    assert wrong == []
