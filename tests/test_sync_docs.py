"""The pages about `pyfrc sync`: their commands work one after the other, and what they say of each season is right."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from conftest import MakeProject
from package_index import WPILIB, package_index

from pyfrc_core.season import SEASONS
from pyfrc_core.sync import addresses

DOCS = Path(__file__).parents[1] / "docs"
GUIDE = "".join((DOCS / page).read_text("utf-8") for page in ("how_to/download_for_the_robot.md", "reference/sync.md"))


def blocks(kind: str) -> list[str]:
    return re.findall(rf"^```{kind}\n(.*?)^```$", GUIDE, re.MULTILINE | re.DOTALL)


@pytest.mark.slow
def test_the_guides_commands_work_one_after_the_other(make_project: MakeProject, tmp_path: Path) -> None:
    (settings,) = blocks("toml")
    assert f'robotpy_version = "{WPILIB}"' in settings
    robot = "import wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
    project = make_project({"robot.py": robot, "pyproject.toml": settings})
    commands = [line.removeprefix("$ ") for block in blocks("console") for line in block.splitlines()]
    assert len(commands) == 3
    with package_index(tmp_path / "index") as index:
        index.add_wpilib()
        index.add("robotpy-navx", "2026.0.1")
        for each in commands:
            program, *arguments = shlex.split(each)
            assert program == "pyfrc"
            done = project.run(*arguments, env=index.environment(tmp_path / "home"))
            assert done.code == 0, (each, done.output)
            if arguments == ["sync"]:
                assert "get       Python 3.14.2    " in done.stdout
            if "--check" in arguments:
                index.add("robotpy-navx", "2026.0.2")
            if "--upgrade" in arguments:
                assert done.stdout.startswith("get       robotpy-navx 2026.0.2 ")
                assert "has changed. Commit it.\n  robotpy-navx 2026.0.1 -> 2026.0.2\n" in done.stdout


def test_the_guide_lists_every_variable() -> None:
    for variable in (addresses.INDEX_VARIABLE, addresses.PYTHON_VARIABLE):
        assert f"`{variable}`" in GUIDE


def test_the_guide_has_what_each_season_downloads() -> None:
    for season in SEASONS.values():
        assert f"{season.downloads.python}, from" in GUIDE
        assert f"`{season.downloads.platforms[0]}`" in GUIDE
        assert f"`{season.downloads.marker_machine}`" in GUIDE
        assert f"`~/wpilib/{season.year}/robotpy`" in GUIDE
