"""Parts of a deploy that a whole command seldom shows: files after a power cut, compiled forms, versions."""

from __future__ import annotations

import os
import stat
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from loops import for_each
from packaging.requirements import Requirement

from pyfrc_core.deploy import installing, logs, robot_packages
from pyfrc_core.deploy.agent import disk
from pyfrc_core.deploy.agent.compiling import CompiledForms
from pyfrc_core.deploy.agent.logs import RobotLogs
from pyfrc_core.deploy.agent.robot_paths import Refusal
from pyfrc_core.deploy.program_imports import ProgramImports
from pyfrc_core.deploy.progress import DeployProgress
from pyfrc_core.deploy.robot_packages import _same
from pyfrc_core.deploy.target_connection import _start_agent


def test_a_file_is_on_the_disk_before_it_has_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "record.json"
    file.write_text("old")
    there: list[tuple[str, int, bytes, int]] = []

    def fsync(descriptor: int) -> None:
        (beside,) = (each for each in tmp_path.iterdir() if each != file)
        about = os.fstat(descriptor)
        assert about.st_ino == beside.stat().st_ino
        there.append((beside.name, about.st_size, file.read_bytes(), stat.S_IMODE(file.stat().st_mode)))

    monkeypatch.setattr(disk.os, "fsync", fsync)
    file.chmod(0o600)
    disk.write_whole(file, "new \udcff", 0o755)
    assert there == [(".record.json.new", 5, b"old", 0o600)]
    assert (file.read_bytes(), stat.S_IMODE(file.stat().st_mode)) == (b"new \xff", 0o755)
    assert list(tmp_path.iterdir()) == [file]
    assert disk.text_of(file) == "new \udcff"
    assert disk.text_of(tmp_path) is None
    disk.write_whole(file, "")
    assert stat.S_IMODE(file.stat().st_mode) == 0o644


def test_compiled_forms_are_linked_beside_the_link_of_their_source(tmp_path: Path) -> None:
    old, new = tmp_path / "old", tmp_path / "new"
    cache = old / "__pycache__"
    cache.mkdir(parents=True)
    new.mkdir()
    names = ["arm.cpython-314.opt-1.pyc", "arm.cpython-314.pyc", "army.cpython-314.pyc"]
    for name in names:
        (cache / name).write_text(name)
    forms = CompiledForms()
    assert forms.of(f"{old}/arm.py") == [f"{cache}/{name}" for name in names[:2]]
    # A source without one, and what is no source, are complete.
    assert forms.link(f"{old}/leg.py", f"{new}/leg.py") is True
    assert forms.link(f"{old}/arm.json", f"{new}/arm.json") is True
    # Of damaged ones, none is linked, and the source is not complete.
    assert forms.link(f"{old}/arm.py", f"{new}/arm.py", lambda form: False) is False
    assert list(new.iterdir()) == []
    assert forms.link(f"{old}/arm.py", f"{new}/arm.py", lambda form: form != f"{cache}/{names[0]}") is False
    assert [each.name for each in (new / "__pycache__").iterdir()] == [names[1]]
    assert forms.link(f"{old}/arm.py", f"{new}/arm.py") is True
    assert sorted(each.name for each in (new / "__pycache__").iterdir()) == names[:2]
    # Where there are some already.
    assert CompiledForms().link(f"{old}/army.py", f"{new}/army.py") is True
    for name in names:
        assert (new / "__pycache__" / name).samefile(cache / name)


@for_each(
    "version, needed, fits",
    [
        ("1.2", "six>=1", True),
        ("1.2", "six>=2", False),
        ("1.2", "six", True),
        ("2.0b1", "six>=1", True),  # a preview that is installed was asked for
        ("2.0b1", "six>=2", False),
        ("as I like", "six>=2", True),  # unknown
    ],
)
def test_which_versions_fit_a_requirement(version: str, needed: str, fits: bool) -> None:
    assert robot_packages.fits(version, Requirement(needed)) is fits


@for_each(
    "one, other, same",
    [("1.0", "1", True), ("1.0", "1.0", True), ("1.0", "1.1", False), ("odd", "odd", True), ("odd", "1", False)],
)
def test_which_versions_are_the_same(one: str, other: str, same: bool) -> None:
    assert _same(one, other) is same


def test_modules_that_a_program_adds_to_its_path_are_its_own(tmp_path: Path) -> None:
    imports = ProgramImports.__new__(ProgramImports)
    imports._files = {"lib/arm.py": tmp_path, "lib/more/__init__.py": tmp_path}  # type: ignore[assignment]
    names = ("arm", "more", "lib", "rm", "arm.py")
    assert [imports._is_named_alike(name) for name in names] == [True, True, False, False, False]


def test_how_much_of_a_log_is_missing_here(tmp_path: Path) -> None:
    log: Any = SimpleNamespace(size=10)
    file = tmp_path / "a.wpilog"
    assert logs._missing(log, file) == 10
    (tmp_path / ".a.wpilog.part").write_bytes(b"1234")
    assert logs._missing(log, file) == 6
    file.write_bytes(b"12345678901")
    assert logs._missing(log, file) == 0


def test_a_log_is_removed_only_as_it_was_named(tmp_path: Path) -> None:
    paths: Any = SimpleNamespace(layout=SimpleNamespace(logs=("/logs",), home="/home"), of=lambda p: tmp_path / p[1:])
    (tmp_path / "logs").mkdir()
    file = tmp_path / "logs/a.wpilog"
    file.write_bytes(b"abc")
    robot_logs = RobotLogs(paths, SimpleNamespace())  # type: ignore[arg-type]
    request = {"path": "/logs/a.wpilog", "size": 3}
    with pytest.raises(Refusal, match="has just been written"):
        robot_logs.remove(request)
    os.utime(file, (0, file.stat().st_mtime - 31))
    with pytest.raises(Refusal, match="has just been written"):
        robot_logs.remove({**request, "size": 4})
    assert robot_logs.remove(request) == {}
    assert not file.exists()


def test_on_a_virtual_robot_no_environment_is_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    wanted, asked = object(), list[object]()
    robot = SimpleNamespace(facts=SimpleNamespace(wpilib="2026.2.2", image="none"))

    def start(connection: object, environment: object, *more: object) -> object:
        asked.append(environment)
        return robot

    monkeypatch.setattr(installing, "start_agent", start)
    monkeypatch.setattr(installing, "install", lambda *asked: "installed")
    results = []
    for is_virtual in (True, False):
        connection: Any = SimpleNamespace(is_virtual_robot=is_virtual)
        environment: Any = wanted
        results.append(_start_agent(connection, DeployProgress(StringIO()), (), environment, True))
    assert asked == [None, wanted]
    assert results == [robot, "installed"]
