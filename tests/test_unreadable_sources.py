"""Commands in a project with Python files that cannot be read: what they are is named, and the command goes on."""

from __future__ import annotations

import ast
import os
import sys
from pathlib import Path

import pytest

from pyfrc_core.project.walk import SourceError, read_source

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="links and pipes that Windows has not")

FILES = {
    "robot.py": "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n",
    "tests/test_a.py": "def test_a(robot):\n    pass\n",
}
LINK = "this is a link to /nowhere/x.py, which does not exist"
DIRECTORY = "this is a directory, with the name of a Python file"


def spoil(root: Path) -> None:
    (root / "tests" / "old.py").symlink_to("/nowhere/x.py")
    (root / "tests" / "drive.py").mkdir()
    os.mkfifo(root / "pipe.py")


def test_test_and_coverage(make_project) -> None:
    project = make_project(FILES)
    spoil(project.path)
    result = project.run("coverage", "test")
    assert result.code == 0, result.output
    section = result.stdout.partition("= files that cannot be read =")[2]
    assert f"tests/old.py: {LINK}\n" in section
    assert f"tests/drive.py: {DIRECTORY}\n" in section
    assert "robot.py       3      0   100%" in result.stdout
    assert "pipe.py" not in result.stdout.partition("Cover")[2]


@pytest.mark.slow
def test_doctor_and_others(make_project) -> None:
    project = make_project(FILES)
    spoil(project.path)
    assert f"hint    project: tests/old.py: {LINK}\n" in project.run("doctor", "--no-robot").stdout
    assert f"warning: tests/old.py: {LINK}\n" in project.run("sim", "--ui", "none", "--mode", "auto").stderr


def test_migrate(tmp_path: Path) -> None:
    migrate = pytest.importorskip("pyfrc_core.migrate.migration", exc_type=ImportError).migrate
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    spoil(tmp_path)
    (tmp_path / "latin.py").write_bytes(b"x = '\xe9'\n")
    done = migrate(tmp_path)
    places = [str(place) for each in done.report.by_hand() for place in each.places]
    assert sorted(places) == ["latin.py:1", "pipe.py", "tests/drive.py", "tests/old.py"]


def test_a_comment_may_have_any_bytes_as_in_an_import(tmp_path: Path) -> None:
    file = tmp_path / "robot.py"
    file.write_bytes(b"speed = 1  # h\xf6chstens\n")
    try:
        ast.parse(file.read_bytes())
    except SyntaxError:  # a late Python 3.14
        with pytest.raises(SourceError, match=r"robot\.py:1: this line is not UTF-8"):
            read_source(file)
    else:
        assert read_source(file) == "speed = 1  # h\ufffdchstens\n"
    file.write_bytes(b"name = 'h\xf6chstens'\n")
    with pytest.raises(SourceError, match=r"robot\.py:1: this line is not UTF-8"):
        read_source(file)
