"""The planted bugs and the correct robots of benchmarks/fuzz_exam.py fit to the robots as they are now."""

from __future__ import annotations

import functools
import importlib
import re
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from skips import missing_programs, requires

pytestmark = requires(
    "the exam of pyfrc fuzz", ["Python 3.11"] if sys.version_info < (3, 11) else missing_programs("patch")
)

sys.path.append(str(Path(__file__).parents[1] / "benchmarks"))
fuzz_exam: Any = importlib.import_module("fuzz_exam")

BUGS: dict[str, dict[str, Any]] = {bug["name"]: bug for bug in fuzz_exam.read("bugs.toml")["bug"]}
CORRECT: dict[str, str] = {robot["name"]: robot["robot"] for robot in fuzz_exam.read("correct.toml")["robot"]}

Made = Callable[[str], Path]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    """Makes the project of a robot, each once."""
    return functools.cache(lambda robot: fuzz_exam.make_project(robot, tmp_path_factory.mktemp("exam")))


def test_there_are_enough_of_each() -> None:
    assert len(BUGS) == 30
    assert len({bug["kind"] for bug in BUGS.values()}) >= 15
    assert len(CORRECT) >= 25


@pytest.mark.slow
def test_each_patch_fits_and_its_line_is_there(made: Made, tmp_path: Path) -> None:
    for name, bug in BUGS.items():
        project = Path(shutil.copytree(made(bug["robot"]), tmp_path / name))
        fuzz_exam.plant(name, project)
        assert not [*project.rglob("*.rej"), *project.rglob("*.orig")], name
        place = re.match(r"(\S+?)\\\.py:(\d+)", bug["finding"])
        if place is not None:
            (file,) = (file for file in project.rglob("*.py") if file.as_posix().endswith(f"/{place[1]}.py"))
            assert file.read_text("utf-8").splitlines()[int(place[2]) - 1].strip() == bug["code"], name
        assert (fuzz_exam.EXAM / "witnesses" / f"witness_{name}.py").is_file()


@pytest.mark.slow
def test_each_correct_robot_is_there(made: Made) -> None:
    for robot in CORRECT.values():
        assert (made(robot) / "robot.py").is_file()
