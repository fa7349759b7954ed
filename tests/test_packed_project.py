"""A project's files on their way to another computer."""

from __future__ import annotations

from pathlib import Path

import pytest

from pyfrc_core.fuzz.campaign.packed_project import PackedProject, pack
from pyfrc_core.project.locate import find_project


@pytest.fixture
def packed(make_project) -> PackedProject:
    files = {
        "pyproject.toml": "[tool.pyfrc]\nmain = 'code/src/robot.py'\n[tool.pyfrc.fuzz]\nmatch_seconds = 2.5\n",
        "code/src/robot.py": "import helper\n",
        "code/src/helper.py": "",
        "code/src/deploy/paths/one.json": "{}",
        "code/src/.venv/hidden.py": "",
        "code/src/FRC_1.wpilog": "",
        "code/tests/rules.py": "import pyfrc\n\n@pyfrc.invariant\ndef rule(robot): pass\n",
        "code/tests/test_robot.py": "",
    }
    return pack(find_project(make_project(files).path))


def test_all_files_of_a_match_are_there(packed: PackedProject, tmp_path: Path) -> None:
    project = packed.unpack(tmp_path / "unpacked")
    assert project.main_file.is_relative_to(tmp_path / "unpacked")
    names = {file.relative_to(project.root).as_posix() for file in project.root.rglob("*") if file.is_file()}
    assert names == {"robot.py", "helper.py", "deploy/paths/one.json"}
    assert project.settings.fuzz.match_seconds == 2.5
    assert [file.name for file in project.invariant_files] == ["rules.py"]
    assert (project.root.parent / "tests" / "test_robot.py").is_file()
