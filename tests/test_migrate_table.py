"""The table of `pyfrc migrate` agrees with the WPILib that is installed, and the corrections with the table."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import pytest
from loops import for_each

from pyfrc_core.collector import collector_paused
from pyfrc_core.season.names.table import HERE, corrections, table
from pyfrc_core.season.spelling import snake_case
from tools.names.packages import Class, Packages


@pytest.fixture(scope="module")
def installed() -> Packages:
    spec = importlib.util.find_spec("wpilib")
    assert spec is not None
    assert spec.origin is not None
    packages = Packages(Path(spec.origin).parents[1])
    with collector_paused():  # it keeps what it reads
        packages.read()
    return packages


def test_every_old_name_exists(installed: Packages) -> None:
    """A new release of WPILib 2026 that takes a name away, or gives one, needs `make_table`."""
    names = table()
    known = {path for path in installed.entries if not path.startswith(("romi", "xrp")) and ".version." not in path}
    assert {path for path in known if names.name(path) is None and not isinstance_of_value(installed, path)} == set()
    here = {path.partition(".")[0] for path in known}
    for path in re.findall(r'^"([\w.]+)": "', (HERE / "table.json").read_text("utf-8"), re.MULTILINE):
        if path.partition(".")[0] in here and names.name(path) is not None:
            assert path in known or path in installed.aliases or path in names.modules, path


def isinstance_of_value(packages: Packages, path: str) -> bool:
    return not isinstance(packages.entries[path], Class) and type(packages.entries[path]).__name__ == "Value"


@for_each(
    "old, new",
    [
        ("getRate", "get_rate"),
        ("kRed", "RED"),
        ("isFMSAttached", "is_fms_attached"),
        ("toPose2d", "to_pose2d"),
        ("kP", "P"),
        ("Encoder", "Encoder"),
        ("snake_case", "snake_case"),
        ("kitchen", "kitchen"),
        ("_simulationInit", "_simulation_init"),
    ],
)
def test_the_rule(old: str, new: str) -> None:
    assert snake_case(old) == new


def test_every_correction_is_about_a_name_of_the_table() -> None:
    names, wrong = table(), []
    for section in ("templates", "buttons", "povs", "pov_arguments", "channel_arguments", "channels", "notes"):
        for path in corrections()[section]:
            outer, _, last = path.rpartition(".")
            if names.name(path) is None and names.member(outer, last) is None:
                wrong.append(f"[{section}] {path}")
    assert wrong == []


def test_what_migrate_removes_is_not_left_to_be_removed() -> None:
    """The advice of a removed call follows "is gone, and removed here."; it is said of calls that stay, too."""
    known = corrections()
    for path in known["not_needed"]["calls"]:
        assert not re.search("[Rr]emove|is gone", known["gone"].get(path, "")), path
