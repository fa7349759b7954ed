"""The walk over a project's files, and Python files that cannot be read: each is named, and none ends a command."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from pyfrc_core.project import Project
from pyfrc_core.project.walk import files_below, python_files, read_source, text_to_search, why_unreadable
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
@pytest.mark.parametrize("name", ["drive.py", "test_drive.py"])
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
