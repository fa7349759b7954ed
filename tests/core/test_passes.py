"""What counts as a change of a project: each file that a test may open, and nothing that a run writes itself."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from loops import for_each
from skips import missing_programs, require

from pyfrc_core.passes import memory
from pyfrc_core.passes.memory import Passes
from pyfrc_core.project import Project
from pyfrc_core.project.walk import LEFT_OUT
from pyfrc_core.test_support import remembered_passes
from pyfrc_core.test_support.options import TestOptions
from pyfrc_core.test_support.remembered_passes import RememberedPasses

needs_links = pytest.mark.skipif(sys.platform == "win32", reason="links need a privilege there")

TEST = "tests/test_robot.py"


def make(root: Path, *names: str) -> Project:
    for name in ("robot.py", TEST, *names):
        file = root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(b"# content\n")
    return Project(root / "robot.py")


def all_passed(project: Project, run: Callable[[], object] = lambda: None, written: Iterable[Path] = ()) -> str:
    """Keep that all tests have passed; return why that is not kept.

    :param run: what happens meanwhile
    :param written: the files that pyfrc has written in it
    """
    passes = Passes(project)
    run()
    passes.record("test_a", project.root / TEST)
    passes.set_green(True)
    return passes.save([], map(str, written))


def stands(project: Project) -> bool:
    passes = Passes(project)
    green, test = passes.green_since() is not None, passes.is_valid("test_a", project.root / TEST)
    assert green == test
    return green


# -- every file counts -------------------------------------------------------------------------------------------------

PLACES = [
    ".",
    "dist",
    "build",
    "deploy",
    "logs",
    "htmlcov",
    "ctre_sim",
    "venv",
    ".config",
    ".wpilib",
    "tests/data",
    "../tests",
]
NAMES = [
    ".hidden",
    "match.wpilog",
    "a.hoot",
    "x.pyc",
    "speeds.json",
    "sensor.py",
    "networktables.json",
    "coverage.xml",
    "no_end",
]
LETTERS = st.characters(codec="utf-8", exclude_characters='/\0\\:*?<>|"', exclude_categories=["C", "Z"])
ANY_NAME = st.text(LETTERS, min_size=1, max_size=12).filter(lambda name: name.strip(".") and name not in LEFT_OUT)


def write_as_long(file: Path) -> None:
    file.write_bytes(b"# CONTENT\n")


def append(file: Path) -> None:
    file.write_bytes(file.read_bytes() + b"\n")


def add_another(file: Path) -> None:
    file.with_name(f"{file.name}2").write_bytes(b"")


EDITS = [write_as_long, append, Path.unlink, add_another]


@settings(max_examples=40)  # each writes a project
@given(st.sampled_from(PLACES), st.sampled_from(NAMES) | ANY_NAME, st.sampled_from(EDITS))
@example("dist", "sensor.py", write_as_long)
@example("tests", "match.wpilog", write_as_long)
def test_any_edit_of_any_file_that_a_test_opens_is_noticed(
    place: str, name: str, edit: Callable[[Path], object]
) -> None:
    with TemporaryDirectory() as directory:
        root = Path(directory, "project")
        project = make(root, f"{place}/{name}")
        assert all_passed(project) == ""
        assert stands(project)
        edit(root / place / name)
        assert not stands(project)


@needs_links
@pytest.mark.parametrize("link", ["data.json", "linked", "tests/linked"])
def test_what_links_lead_to_counts(tmp_path: Path, link: str) -> None:
    project = make(tmp_path / "project", "data/a.json")
    make(tmp_path / "elsewhere", "b.json")
    here = project.root / link
    here.symlink_to(tmp_path / "elsewhere" / ("b.json" if "." in link else ""))
    (project.root / "data" / "circle").symlink_to(project.root)
    all_passed(project)
    assert stands(project)
    write_as_long(tmp_path / "elsewhere/b.json")
    assert not stands(project)


@needs_links
def test_a_link_to_nothing_counts_when_it_leads_somewhere(tmp_path: Path) -> None:
    project = make(tmp_path / "project")
    (project.root / "deploy.json").symlink_to(tmp_path / "later.json")
    all_passed(project)
    assert stands(project)
    (tmp_path / "later.json").write_bytes(b"1")
    assert not stands(project)


@for_each("name", ["conftest.py", "pytest.ini", "tox.ini", "setup.cfg", "pyproject.toml"])
def test_what_pytest_reads_above_the_project_counts(tmp_path: Path, name: str) -> None:
    project = make(tmp_path / "repository" / "project")
    all_passed(project)
    assert stands(project)
    (tmp_path / name).write_bytes(b"")
    assert not stands(Project(project.main_file))


@pytest.mark.parametrize("name", ["PYTEST_ADDOPTS", "PYTHONPATH", "PYTHONOPTIMIZE", "TZ"])
def test_variables_that_change_a_run_count(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.delenv(name, raising=False)
    project = make(tmp_path)
    all_passed(project)
    assert stands(project)
    monkeypatch.setenv(name, "1")
    assert not stands(project)


def test_a_large_file_counts_by_its_times(tmp_path: Path) -> None:
    project = make(tmp_path)
    video = tmp_path / "video.bin"
    video.write_bytes(bytes(2 << 20))
    all_passed(project)
    assert stands(project)
    with video.open("r+b") as stream:
        stream.write(b"1")
    os.utime(video, ns=(0, 0))
    assert not stands(project)


def test_what_cannot_matter_does_not_count(tmp_path: Path) -> None:
    project = make(tmp_path, ".venv/pyvenv.cfg")
    all_passed(project)
    for name in (
        "__pycache__/x.pyc",
        ".git/index",
        ".pytest_cache/v/x",
        ".mypy_cache/x",
        ".pyfrc/logs/x",
        ".venv/x.py",
    ):
        make(tmp_path, name)
    assert stands(project)


def test_what_git_tracks_counts_wherever_it_is(tmp_path: Path) -> None:
    require("files that git tracks", missing_programs("git"))
    project = make(tmp_path, "node_modules/speeds.json", "__pycache__/x.pyc")
    for command in (["init", "-q"], ["add", "-f", "."]):
        subprocess.run(["git", *command], cwd=tmp_path, check=True)
    all_passed(project)
    write_as_long(tmp_path / "__pycache__/x.pyc")
    assert stands(project)
    write_as_long(tmp_path / "node_modules/speeds.json")
    assert not stands(project)


def test_a_test_file_that_another_one_names_counts_for_all(tmp_path: Path) -> None:
    project = make(tmp_path, "tests/test_other.py", "tests/test_more.py")
    (tmp_path / TEST).write_text("from test_other import helper\n")
    all_passed(project)
    write_as_long(tmp_path / "tests/test_more.py")
    assert Passes(project).is_valid("test_a", tmp_path / TEST)
    write_as_long(tmp_path / "tests/test_other.py")
    assert not Passes(project).is_valid("test_a", tmp_path / TEST)


def test_a_home_directory_as_a_project_is_not_remembered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "MOST_FILES", 20)
    project = make(tmp_path, *(f"photos/{number}" for number in range(30)))
    assert all_passed(project) == "the project has more than 20 files"
    assert not stands(project)


# -- what a run writes itself ------------------------------------------------------------------------------------------


def test_a_log_that_a_run_creates_changes_nothing(tmp_path: Path) -> None:
    project, log = make(tmp_path), tmp_path / "logs" / "robot.wpilog"
    for number in range(3):

        def run(text: str = f"log {number}") -> None:
            log.parent.mkdir(exist_ok=True)
            log.write_text(text)

        assert all_passed(project, run, [log]) == ""
        assert stands(project)
    log.unlink()
    assert stands(project), "it is as before the first run"
    run()
    assert stands(project)
    log.write_text("ours")
    assert not stands(project), "written by another, and a test may read it"


def test_a_log_that_was_there_before_the_run_counts_once(tmp_path: Path) -> None:
    project, log = make(tmp_path, "robot.wpilog"), tmp_path / "robot.wpilog"
    assert all_passed(project, lambda: log.write_text("1"), [log]) == "robot.wpilog changed during the run"
    assert not stands(project)
    assert all_passed(project, lambda: log.write_text("2"), [log]) == ""
    assert stands(project)


@pytest.mark.parametrize("name", ["new.json", "parts/new.py"])
def test_what_another_saves_during_the_run_counts(tmp_path: Path, name: str) -> None:
    project = make(tmp_path)
    assert all_passed(project, lambda: make(tmp_path, name)) == f"{name} changed during the run"
    assert not stands(project)


def test_a_part_of_the_tests_keeps_what_all_have_passed_with(tmp_path: Path) -> None:
    project, log = make(tmp_path), tmp_path / "logs.wpilog"
    all_passed(project)
    part = Passes(project)
    log.write_text("a log")
    assert part.save([], [str(log)]) == ""
    assert stands(project)


# -- what else a pass depends on ---------------------------------------------------------------------------------------


def test_a_pass_counts_for_its_seed_and_its_choice_of_tests_only(tmp_path: Path) -> None:
    project = make(tmp_path)
    all_passed(project)
    for options, valid in (((0, False), True), ((5, False), False), ((0, True), False)):
        assert Passes(project, *options).is_valid("test_a", tmp_path / TEST) == valid, options


def test_what_is_imported_from_outside_the_project_counts(tmp_path: Path) -> None:
    (tmp_path / "project").mkdir()
    project, library = make(tmp_path / "project"), tmp_path / "teamlib.py"
    library.write_text("SPEED = 1\n")
    passes = Passes(project)
    passes.record("test_a", project.root / TEST)
    passes.set_green(True)
    assert passes.save([str(library)]) == ""
    assert stands(project)
    library.write_text("SPEED = 20\n")
    assert not stands(project)


def test_a_spoiled_memory_is_no_pass(tmp_path: Path) -> None:
    project = make(tmp_path)
    for content in ("", "{}", "[1]", "null", '{"format": 2, "tests": [7]}', '{"format": 3, "tests": [7]}'):
        all_passed(project)
        assert stands(project)
        (tmp_path / ".pyfrc" / "passes.json").write_text(content)
        assert not stands(project), content


def test_a_failure_takes_back_a_pass(tmp_path: Path) -> None:
    project = make(tmp_path)
    all_passed(project)
    failed = Passes(project)
    failed.forget("test_a")
    failed.set_green(False)
    failed.save([])
    assert not stands(project)


@pytest.fixture
def no_real_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a process that has no such library: this one may have loaded one for another test."""
    monkeypatch.setattr(remembered_passes, "real_time_libraries", tuple)


class _Session:
    def __init__(self, **options: object) -> None:
        self.exitstatus: int = pytest.ExitCode.OK
        self.config = SimpleNamespace(option=SimpleNamespace(**options))


def run_of(project: Project, *tests: str, changed: bool = False, failed: str = "", args: tuple[str, ...] = ()) -> Any:
    """Run these tests of one file, as pytest calls the plugin; return the session and the plugin."""
    plugin = RememberedPasses(project, TestOptions(only_changed=changed), args)
    items: list[Any] = [SimpleNamespace(nodeid=name, path=project.root / TEST) for name in tests]
    plugin.pytest_collection_modifyitems(items)
    for item in items:
        outcome = "failed" if item.nodeid == failed else "passed"
        report: Any = SimpleNamespace(nodeid=item.nodeid, outcome=outcome)
        plugin.pytest_runtest_logreport(report)
    session: Any = _Session(xmlpath=str(project.root / "report.xml"))
    (project.root / "report.xml").write_text(str(len(items)))
    status = pytest.ExitCode.NO_TESTS_COLLECTED if not items else pytest.ExitCode.OK
    plugin.pytest_sessionfinish(session, pytest.ExitCode.TESTS_FAILED if failed else status)
    return session, plugin, [item.nodeid for item in items]


@pytest.mark.usefixtures("no_real_time")
def test_only_tests_run_again_that_have_not_passed(tmp_path: Path) -> None:
    project = make(tmp_path)
    assert run_of(project, "test_a", "test_b", failed="test_b")[2] == ["test_a", "test_b"]
    assert Passes(project).green_since() is None
    session, _, ran = run_of(project, "test_a", "test_b", changed=True)
    assert ran == ["test_b"]
    session, plugin, ran = run_of(project, "test_a", "test_b", changed=True)
    assert (ran, session.exitstatus) == ([], pytest.ExitCode.OK)
    said: list[str] = []
    plugin.pytest_terminal_summary(SimpleNamespace(write_line=lambda text, **style: said.append(text)))
    assert said[0].startswith("2 tests passed before; ")
    assert Passes(project).green_since() is None, "no run has passed with all of them"


@pytest.mark.usefixtures("no_real_time")
def test_a_run_of_all_tests_counts_for_a_deploy_and_one_of_some_does_not(tmp_path: Path) -> None:
    project = make(tmp_path)
    run_of(project, "test_a", args=("-k", "a"))
    assert Passes(project).green_since() is None
    run_of(project, "test_a", args=("-q", "--tb=short"))
    assert Passes(project).green_since() is not None


def test_robots_with_devices_in_real_time_are_not_remembered(tmp_path: Path) -> None:
    project = make(tmp_path)
    plugin = RememberedPasses(project, TestOptions(only_changed=True), ())
    plugin.pytest_collection_modifyitems([SimpleNamespace(nodeid="test_a", path=project.root / TEST)])  # type: ignore[list-item]
    plugin.record_real_time(["phoenix6"])
    plugin.pytest_runtest_logreport(SimpleNamespace(nodeid="test_a", outcome="passed"))  # type: ignore[arg-type]
    plugin.pytest_sessionfinish(_Session(), pytest.ExitCode.OK)  # type: ignore[arg-type]
    assert not Passes(project).is_valid("test_a", project.root / TEST)
    said: list[str] = []
    plugin.pytest_terminal_summary(SimpleNamespace(write_line=lambda text, **style: said.append(text)))
    assert said == [
        "pyfrc: the passes are not remembered, because phoenix6 simulates devices in real time, "
        "so this robot does not repeat exactly"
    ]
