"""The walk over a project's files, and Python files that cannot be read: each is named, and none ends a command."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from loops import for_each

from pyfrc_core.project import Project, robot_files
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.project.walk import SourceError, files_below, python_files, read_source, text_to_search, why_unreadable
from pyfrc_core.test_support.uncollected import find_uncollected

posix = pytest.mark.skipif(sys.platform == "win32", reason="links and pipes that Windows has not")


def make(root: Path, *names: str, content: bytes = b"x = 1\n") -> None:
    for name in names:
        file = root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)


#: What makes a file unreadable, and the error without its remedy.
UNREADABLE: dict[str, tuple[Callable[[Path], object], str]] = {
    "link": (lambda file: file.symlink_to("/nowhere/x.py"), "this is a link to /nowhere/x.py, which does not exist"),
    "directory": (Path.mkdir, "this is a directory, with the name of a Python file"),
    "pipe": (lambda file: os.mkfifo(file), "this is a pipe, a socket or a device"),
    "null": (lambda file: file.write_bytes(b"x = 1\ny = '\0'\n"), "this file contains null bytes, which no text has"),
    "latin": (
        lambda file: file.write_bytes(b"x = 1\ny = '\xe9'\n"),
        "this line is not UTF-8: it has the byte 0xe9, probably the character 'é' in Windows' encoding",
    ),
    "utf16": (
        lambda file: file.write_bytes("x = 1\n".encode("utf-16")),
        "this file is in UTF-16, and Python reads UTF-8",
    ),
    "cookie": (
        lambda file: file.write_bytes(b"# coding: nowhere\nx = 1\n"),
        "this is not in the encoding that its first line names",
    ),
}


@posix
@pytest.mark.parametrize("kind", UNREADABLE)
def test_what_cannot_be_read_is_named(tmp_path: Path, kind: str) -> None:
    make(tmp_path, "robot.py")
    spoil, expected = UNREADABLE[kind]
    (tmp_path / "parts").mkdir()
    spoil(tmp_path / "parts" / "drive.py")
    (error,) = Project(tmp_path / "robot.py").unreadable_sources()
    assert error.message == expected
    assert error.where == "parts/drive.py" + (":2" if kind in ("null", "latin") else "")
    assert error.remedy


@posix
@pytest.mark.parametrize("kind", UNREADABLE)
@for_each("name", ["drive.py", "test_drive.py"])
def test_it_stops_no_search_for_tests(tmp_path: Path, kind: str, name: str) -> None:
    make(tmp_path, "robot.py", "tests/test_a.py")
    make(tmp_path, "tests/arm_tests.py", content=b"def test_arm(): pass\n")
    UNREADABLE[kind][0](tmp_path / "tests" / name)
    project = Project(tmp_path / "robot.py")
    assert project.find_tests() == tmp_path / "tests"
    assert project.invariant_files == ()
    found = list(find_uncollected(tmp_path / "tests", {tmp_path / "tests/test_a.py"}, ["test_*.py"]))
    assert [each.partition(":")[0] for each in found] == ["tests/arm_tests.py"]


def test_a_file_without_permission_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(file: Path) -> None:  # root can read every file
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(file))

    make(tmp_path, "drive.py")
    monkeypatch.setattr("pyfrc_core.project.walk.open_file", refuse)
    error = why_unreadable(tmp_path / "drive.py")
    assert error is not None
    assert error.message == "this cannot be read: Permission denied"


def test_an_encoding_that_the_first_line_names_is_read(tmp_path: Path) -> None:
    make(tmp_path, "drive.py", content=b"# coding: latin-1\r\nx = '\xe9'\r\n")
    assert read_source(tmp_path / "drive.py") == "# coding: latin-1\nx = 'é'\n"


@posix
def test_a_search_in_what_cannot_be_read_finds_what_is_there(tmp_path: Path) -> None:
    for kind, (spoil, _) in UNREADABLE.items():
        spoil(tmp_path / f"{kind}.py")
    found = {file.stem for file in python_files(tmp_path) if "x = 1" in text_to_search(file)}
    assert found == {"latin", "null", "cookie"}


@posix
def test_links_are_followed_and_each_directory_is_read_once(tmp_path: Path) -> None:
    make(tmp_path, "project/robot.py", "project/parts/arm.py", "library/teamlib.py", "library/more/a.py")
    project = tmp_path / "project"
    for name, target in [("alike", "parts"), ("parts/up", ".."), ("here", "."), ("library", "../library")]:
        (project / name).symlink_to(project / target)
    names = sorted(file.relative_to(project).as_posix() for file in files_below(project))
    assert names == ["library/more/a.py", "library/teamlib.py", "parts/arm.py", "robot.py"]


@posix
def test_a_hidden_directory_hides_nothing_that_has_another_name(tmp_path: Path) -> None:
    make(tmp_path, ".lib/arm.py")
    (tmp_path / "lib").symlink_to(".lib")
    assert python_files(tmp_path) == [tmp_path / "lib" / "arm.py"]


def test_hidden_directories_have_no_sources_but_a_project_below_one_has(tmp_path: Path) -> None:
    root = tmp_path / ".config" / "robot"
    make(root, "robot.py", ".cache/x.py", ".#robot.py", "lib/site-packages/y.py", ".venv/pyvenv.cfg", ".venv/z.py")
    make(root, "tests/arm_tests.py", content=b"def test_arm(): pass\n")
    assert [file.relative_to(root).as_posix() for file in python_files(root)] == ["robot.py", "tests/arm_tests.py"]
    assert len(list(find_uncollected(root / "tests", set(), ["test_*.py"]))) == 1


def test_sources_that_cannot_be_read_are_those_of_the_robot_and_of_the_tests_beside_it(tmp_path: Path) -> None:
    for name in ("robot", "tests"):
        make(tmp_path, f"{name}/wrong.py", content=b"\xff = 1")
    for root, expected in (("robot", ["wrong.py", "../tests/wrong.py"]), ("tests", ["wrong.py"])):
        errors = Project(tmp_path / root / "robot.py").unreadable_sources()
        assert [str(each).partition(":")[0] for each in errors] == expected


def test_which_files_are_the_robots_and_how_they_are_shown(tmp_path: Path) -> None:
    files = RobotFiles(tmp_path / "robot")
    program, test, beside = (str(tmp_path / each) for each in ("robot/a.py", "robot/tests/a.py", "tests/b/a.py"))
    library = str(tmp_path / "robot/.venv/lib/site-packages/a.py")
    ours = robot_files.__file__
    names = (program, test, beside, library, ours)
    assert [files.is_robot_code(each) for each in names] == [True, False, False, False, False]
    assert [files.is_project_file(each) for each in names] == [True, True, True, False, False]
    assert [files.relative(each) for each in names[:3]] == [
        "a.py",
        str(Path("tests/a.py")),
        str(Path("../tests/b/a.py")),
    ]
    assert RobotFiles(tmp_path / "tests").is_robot_code(str(tmp_path / "tests/robot.py"))


def test_lines_of_a_call_and_of_an_error_are_the_users() -> None:
    here = RobotFiles(Path(__file__).parent)
    frame = sys._getframe()
    assert here.line_of_call(frame) == f"test_walk.py:{frame.f_lineno}"
    assert RobotFiles(Path("/no/such")).line_of_call(frame) is None
    assert here.line_of_call(None) is None
    with pytest.raises(SourceError) as raised:
        read_source(Path("/no/such.py"))
    entry: Any = raised.value.__traceback__
    assert here.innermost_line(entry) == f"test_walk.py:{entry.tb_lineno}"
    assert robot_files.past_pyfrc(entry) is entry
    last = robot_files.past_pyfrc(entry.tb_next)
    assert last is not None
    assert last.tb_next is None, "the last entry stays"
    assert robot_files.past_pyfrc(None) is None
