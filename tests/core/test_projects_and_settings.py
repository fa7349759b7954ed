"""What is found of a project, its settings and its robot, where commands as a whole seldom come."""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Iterator
from importlib import import_module, metadata
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from loops import for_each
from written_files import write_files

from pyfrc_core.config import toml_file
from pyfrc_core.config.packages import component_of, how_to_install, robot_line
from pyfrc_core.config.pictures import field_picture
from pyfrc_core.config.robotpy import _only_season, load_robot_packages, load_season_settings
from pyfrc_core.config.sim_file import load_sim_config
from pyfrc_core.config.toml_file import TomlFile, _with_quotes
from pyfrc_core.deploy.discovery import RobotNotFoundError
from pyfrc_core.deploy.errors import HostKeyError, OnTheFieldError
from pyfrc_core.doctor import robot, robot_project
from pyfrc_core.doctor.check_result import CheckResult, hint, ok, problem
from pyfrc_core.doctor.installed import Installed, find_installed
from pyfrc_core.doctor.steps import Step
from pyfrc_core.errors import ProjectError, PyfrcError, SettingsError
from pyfrc_core.project import Project
from pyfrc_core.project.hidden_libraries import (
    find_hidden_by_any_name,
    find_hidden_libraries,
    refuse_hidden_libraries,
)
from pyfrc_core.project.locate import projects_below
from pyfrc_core.project.project import _may_have_rules
from pyfrc_core.project.robot_files import RobotFiles, is_library, past_pyfrc
from pyfrc_core.project.walk import files_below, text_to_search
from pyfrc_core.season import CURRENT
from pyfrc_core.season.choice import SeasonSetting
from pyfrc_core.sync import pip_errors, resolve
from pyfrc_core.sync.addresses import PYTHON_VARIABLE, file_name_in, link_directories, replaced_python_url

#: The package has a function of this name.
examine = import_module("pyfrc_core.doctor.examine")

# -- a project ---------------------------------------------------------------------------------------------------------


@pytest.fixture
def project(tmp_path: Path) -> Project:
    (tmp_path / "robot.py").write_text("")
    return Project(tmp_path / "robot.py")


def test_robots_run_where_the_command_line_says_or_else_the_settings(project: Project) -> None:
    (project.root / "pyproject.toml").write_text('[tool.pyfrc.test]\nisolation = "reuse"\n')
    chosen = {each: Project(project.main_file, None, project.root / "pyproject.toml", each) for each in ("fork", None)}
    assert {given: each.isolation for given, each in chosen.items()} == {"fork": "fork", None: "reuse"}


def test_a_byte_that_is_not_utf_8_is_named_with_its_line(project: Project) -> None:
    (project.root / "sim").mkdir()
    for byte, written in ((b"\xf6", "'ö'"), (b"\x96", r"'\x96'")):
        (project.root / "sim/config.json").write_bytes(b'{\n  "field": "h' + byte + b'chstens"\n}\n')
        with pytest.raises(SettingsError) as raised:
            load_sim_config(project.root)
        text = f"the byte 0x{byte.hex()} is not UTF-8 text (in Latin-1 it would be {written})"
        assert (raised.value.message, raised.value.where) == (text, "sim/config.json:2")


def test_files_that_hide_libraries(project: Project) -> None:
    refuse_hidden_libraries(project.root, project.main_file)
    write_files(
        project.root,
        {"random.py": "", "wpilib/__init__.py": "", "turtle.py": "", "six.py": "", "tests/__init__.py": ""},
    )
    write_files(project.root, {"time.py": "", "data/readme.md": ""})
    found = {each.name: (each.text, each.remedy) for each in find_hidden_libraries(project.root)}
    assert found == {
        "random.py": ("random.py hides a library: import random finds it instead", "Give random.py another name."),
        "time.py": (
            "time.py has the name of a library: import time finds that, never this file",
            "Give time.py another name.",
        ),
        "wpilib/__init__.py": (
            "wpilib/__init__.py hides a library: import wpilib finds it instead",
            "Give wpilib/ another name.",
        ),
    }
    by_any = {each.library for each in find_hidden_by_any_name(project.root, project.main_file)}
    assert {"random", "time", "turtle", "wpilib"} <= by_any <= {"random", "time", "turtle", "wpilib", "six"}
    with pytest.raises(ProjectError) as error:
        refuse_hidden_libraries(project.root, project.main_file)
    assert error.value.message == (
        "random.py hides a library: import random finds it instead; and so do: time.py, wpilib/__init__.py"
    )
    (project.root / "time.py").unlink()
    (project.root / "wpilib/__init__.py").unlink()
    with pytest.raises(ProjectError) as error:
        refuse_hidden_libraries(project.root, project.main_file)
    assert error.value.message == "random.py hides a library: import random finds it instead"
    refuse_hidden_libraries(project.root, project.root / "random.py")
    assert list(find_hidden_by_any_name(project.root / "none")) == []


def test_what_the_field_is_without_and_with_a_file(project: Project) -> None:
    assert (project.auto_joysticks, project.game_specific_messages) == (
        CURRENT.field.auto_joysticks,
        CURRENT.field.messages,
    )
    given = {"game_specific_messages": ["LRL"], "field": {"auto_joysticks": not CURRENT.field.auto_joysticks}}
    write_files(project.root, {"sim/config.json": json.dumps({"pyfrc": given})})
    with_file = Project(project.main_file)
    assert with_file.auto_joysticks is not CURRENT.field.auto_joysticks
    assert with_file.game_specific_messages == ("LRL",)
    assert with_file.pyproject == project.root / "pyproject.toml"


@for_each(
    "text, may",
    [
        ("import pyfrc\n@pyfrc.invariant\ndef rule(): pass", True),
        ("from pyfrc import invarient", True),
        ("@ pyfrc . invarient", True),
        ("import pyfrc", False),
        ("invariant = 3", False),
        ("", False),
    ],
)
def test_which_files_may_have_rules(text: str, may: bool, tmp_path: Path) -> None:
    (tmp_path / "test_a.py").write_text(text)
    assert _may_have_rules(tmp_path / "test_a.py") is may


def test_lines_of_a_project(project: Project) -> None:
    files = RobotFiles(project.root)
    write_files(
        project.root,
        {"robot.py": "def wait(go, here):\n    here.set()\n    go.wait()\n\ndef fail():\n    raise KeyError\n"},
    )
    names: dict[str, Any] = {}
    exec(compile(project.main_file.read_text(), str(project.main_file), "exec"), names)
    go, here = threading.Event(), threading.Event()
    thread = threading.Thread(target=names["wait"], args=(go, here), daemon=True)
    thread.start()
    here.wait()
    while files.line_of_thread(thread.ident or 0) == "robot.py:2":
        pass
    assert files.line_of_thread(thread.ident or 0) == "robot.py:3"
    go.set()
    thread.join()
    assert files.line_of_thread(threading.get_ident()) is None
    try:
        names["fail"]()
    except KeyError as error:
        own = error.__traceback__
        assert past_pyfrc(own) is own
        assert files.innermost_line(own) == "robot.py:6"
    assert past_pyfrc(None) is None
    assert [is_library(each) for each in (os.__file__, pytest.__file__, "<frozen os>", __file__)] == [True] * 3 + [
        False
    ]


def test_a_traceback_without_our_own_entries() -> None:
    ours = compile("def call(function): function()", str(Path(robot.__file__)), "exec")
    names: dict[str, Any] = {}
    exec(ours, names)

    def fail() -> None:
        raise KeyError

    with pytest.raises(KeyError) as error:
        names["call"](fail)
    left = past_pyfrc(error.value.__traceback__.tb_next)  # type: ignore[union-attr]
    assert left is not None
    assert (left.tb_frame.f_code.co_name, left.tb_next) == ("fail", None)


def test_odd_places_of_files(tmp_path: Path) -> None:
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "a").mkdir()
    (tmp_path / "a/robot.py").write_text("x")
    (tmp_path / ".hidden").mkdir()
    (tmp_path / ".hidden/robot.py").write_text("x")
    assert [each.name for each in files_below(tmp_path, hidden=False)] == ["loop", "robot.py"]
    assert projects_below(tmp_path) == [Path("a")]
    assert projects_below(tmp_path / "a/robot.py/none") == []
    assert (text_to_search(tmp_path / "a/robot.py"), text_to_search(tmp_path / "none")) == ("x", "")


# -- settings ----------------------------------------------------------------------------------------------------------


@for_each(
    "requirement, season",
    [
        ("robotpy-rev==2026.0.1", 2026),
        ("wpilib>=2027.0.0a1,<2028", 2027),
        ("WPILib~=2026.1", 2026),
        ("wpilib>=2026", None),
        ("wpilib", None),
        ("wpilib==2019.1", None),
        ("wpilib==2026.*", 2026),
        ("wpilib==2027.0.0a7", 2027),
        ("numpy==2026.1", None),
        ("not a requirement!", None),
        (3, None),
    ],
)
def test_the_season_of_a_requirement(requirement: object, season: int | None) -> None:
    assert _only_season(requirement) == season


def test_settings_for_robotpy(tmp_path: Path) -> None:
    file = tmp_path / "pyproject.toml"
    assert (load_season_settings(file), load_robot_packages(file).requires) == ([], ())
    file.write_text('[tool.robotpy]\nrobotpy_version = "2025.1"\nrequires = ["robotpy-rev==2027.1", 3]\n')
    old, rev = load_season_settings(file)
    assert (old.text, old.year, old.where) == ("robotpy_version is 2025.1", 2026, "pyproject.toml:2")
    assert (rev.text, rev.year, rev.where) == ("requires has 'robotpy-rev==2027.1'", 2027, "pyproject.toml:3")
    packages = load_robot_packages(file)
    assert (packages.version, [str(each) for each in packages.requires]) == ("2025.1", ["robotpy-rev==2027.1"])
    assert packages.lines == {"robotpy_version": "pyproject.toml:2", "requires": "pyproject.toml:3"}
    assert robot_line("six", file) == 'for the robot, add "six" to requires in pyproject.toml:3'
    assert robot_line("wpilib", file) == ""
    assert component_of("robotpy-commands-v2") == "commands2"
    assert component_of("six") is None
    line = 'For the robot, write components = ["commands2"] under [tool.robotpy] in pyproject.toml.'
    assert how_to_install("robotpy-commands-v2", file).endswith(f"\n  {line}")
    file.write_text("[tool.robotpy]\nrequires = ['!']\n")
    assert robot_line("six", file) == ""
    with pytest.raises(SettingsError, match=r"pyproject.toml:2: requires = '!': "):
        load_robot_packages(file)


@for_each(
    "line, quoted",
    [
        ("main = robot.py", 'main = "robot.py"'),
        ("a = [rev, 3, true]  # x", 'a = ["rev", 3, true]'),
        ('a = "x', 'a = "x'),
        ("[tool.pyfrc", "[tool.pyfrc"),
        ("a = 2026-01-02", "a = 2026-01-02"),
    ],
)
def test_quotes_that_a_line_of_toml_lacks(line: str, quoted: str) -> None:
    assert _with_quotes(line) == quoted


def test_a_mistake_in_toml_is_named(tmp_path: Path) -> None:
    file = tmp_path / "pyproject.toml"
    file.write_text("[tool.pyfrc]\nmain = robot.py\n")
    with pytest.raises(SettingsError) as error:
        TomlFile(file)
    assert (error.value.where, error.value.remedy) == (
        "pyproject.toml:2",
        'A text needs quotes: write main = "robot.py"',
    )
    file.write_text("[[a]]\nx = 1\n[[a]]\nx = 2\n[b]\ny = 1\ny = 2\n")
    with pytest.raises(SettingsError, match=r"pyproject.toml:7: .*b.y.* 6"):
        TomlFile(file)


def test_a_byte_order_mark_is_accepted_also_when_another_library_reads_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(toml_file.tomllib, "loads", toml_file.tomllib.loads)  # what it was is restored
    file = tmp_path / "pyproject.toml"
    file.write_text("\ufeffa = 1\n", "utf-8")
    assert TomlFile(file).table_at() == {"a": 1}
    assert toml_file.tomllib.loads(file.read_text("utf-8")) == {"a": 1}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file is empty (column 1)"),
        ('{"a": 1,}', "JSON allows no comma before a closing bracket (column 8)"),
        ('{"a": [1, ,]}', "JSON allows no comma before a closing bracket (column 11)"),
        ('{"a": 1', "the file ends too early, with something still open (column 8)"),
        ('{"a": 1 // b\n}', "JSON has no comments (column 9)"),
        ("{'a': 1}", "JSON has its strings in double quotes (column 2)"),
        ('{"a" 1}', "expected ':', found '1' (column 6)"),
        ('{"a": hello}', "expected a value, found 'hello' (column 7)"),
        ('{"a": 1 "b": 2}', "expected a comma or the closing bracket, found '\"' (column 9)"),
        ('{"a": "b}', "a string begins here that does not end (column 7)"),
        ("{} {}", "expected the end of the file, found '{' (column 4)"),
        ('{"a": "\\x"}', "invalid \\escape (column 8)"),
    ],
)
def test_what_is_no_json_is_named_with_its_column(text: str, message: str, project: Project) -> None:
    write_files(project.root, {"sim/config.json": text})
    with pytest.raises(SettingsError) as error:
        load_sim_config(project.root)
    assert error.value.message == f"not valid JSON: {message}"
    assert str(error.value.where).startswith("sim/config.json:")


def test_pictures_of_fields(tmp_path: Path) -> None:
    root = tmp_path / "robot"
    (root / "sim").mkdir(parents=True)
    (root / "sim/a.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    (root / "sim/a.txt").write_bytes(b"x")
    (tmp_path / "out.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    (root / "sim/link.png").symlink_to(tmp_path / "out.png")
    assert field_picture(root, "a.png") == (root / "sim/a.png", "")
    assert field_picture(root, "a.txt") == (None, "it is no picture (PNG, JPEG, GIF, WebP, BMP or SVG)")
    for name in ("../../out.png", "link.png"):
        assert field_picture(root, name) == (None, "it is outside of the project, and is not shown")
    for name in ("none.png", "a\0b", "sim"):
        assert field_picture(root, name) == (None, "there is no such file")


# -- sync --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("pip", "message"),
    [
        (None, "pip is not installed in this environment, and finds the packages"),
        ("19.3", "pip 19.3 is too old: this needs 22.2 or newer"),
        (".".join(map(str, resolve._OLDEST_PIP)), None),
        ("99.0.dev0", None),
    ],
)
def test_which_pip_is_too_old(pip: str | None, message: str | None, monkeypatch: pytest.MonkeyPatch) -> None:
    def version(name: str) -> str:
        if pip is None:
            raise metadata.PackageNotFoundError(name)
        return pip

    monkeypatch.setattr(metadata, "version", version)
    if message is None:
        resolve._refuse_old_pip()
        return
    with pytest.raises(PyfrcError) as error:
        resolve._refuse_old_pip()
    assert error.value.message == message.replace("22.2", ".".join(map(str, resolve._OLDEST_PIP)))
    assert "pip" in (error.value.remedy or "")


def test_addresses_that_the_environment_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for named in ("", "https://a/python.tar", "file:///a"):
        monkeypatch.setenv(PYTHON_VARIABLE, named)
        assert replaced_python_url() == (named or None)
    monkeypatch.setenv(PYTHON_VARIABLE, "here/a b.tar")
    monkeypatch.chdir(tmp_path)
    assert replaced_python_url() == (tmp_path / "here/a b.tar").as_uri()
    assert file_name_in("https://a/b/c%20d.whl?x#y") == "c d.whl"
    (tmp_path / "wheels").mkdir()
    monkeypatch.setenv("PIP_FIND_LINKS", f"{tmp_path}/none {tmp_path}/wheels")
    assert link_directories(["wheels", "https://a"]) == [Path("wheels"), tmp_path / "wheels"]


def test_requirements_that_contradict_each_other() -> None:
    most = pip_errors._MOST_REASONS
    for count, more in ((most, ""), (most + 2, "; and 2 more")):
        lines = "\n".join(f"  The user requested a=={number}" for number in range(count))
        shown = "; ".join(f"[tool.robotpy] has a=={number}" for number in range(most))
        assert pip_errors._conflicting(lines).message == f"the requirements contradict each other: {shown}{more}"


# -- doctor ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("error", "finding", "step"),
    [
        (
            OnTheFieldError("x"),
            ok("robot", "not checked: the Driver Station is connected to a competition field"),
            None,
        ),
        (RobotNotFoundError("x"), problem("robot", "team 3: no robot found", robot._REMEDY), Step.CONTROLLER),
        (
            HostKeyError("another key"),
            problem("robot", "another key", "If this is your robot, pyfrc deploy-info shows how to accept its key."),
            Step.CONTROLLER,
        ),
        (PyfrcError("odd", where="a.py:1"), problem("robot", "a.py:1: odd", "Correct it there."), None),
        (ImportError("no x"), hint("robot", "cannot be checked: no x", "Solve the problems with pyfrc first."), None),
    ],
)
def test_a_search_for_the_robot_that_fails(
    error: Exception, finding: CheckResult, step: Step | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    def search(self: Any, *asked: object) -> Iterator[CheckResult]:
        self._whose = "team 3"
        raise error
        yield

    monkeypatch.setattr(robot.RobotSearch, "_search", search)
    searched = robot.RobotSearch(None, team=3)
    assert searched.findings() == [finding]
    missing = searched.missing_step()
    assert (missing and missing[0]) == step


def test_a_search_for_the_robot_that_takes_long(monkeypatch: pytest.MonkeyPatch) -> None:
    go, found = threading.Event(), ok("robot", "found")

    def search(self: Any, *asked: object) -> Iterator[CheckResult]:
        if asked[1] is not None:
            self._found = True
            yield found
        go.wait()

    monkeypatch.setattr(robot.RobotSearch, "_search", search)
    monkeypatch.setattr(robot, "SEARCH_SECONDS", 0.05)
    monkeypatch.setattr(robot, "CHECK_SECONDS", 0.05)
    try:
        (nothing,) = robot.RobotSearch(None).findings()
        assert (nothing.status, nothing.text) == ("hint", "the robot: no robot found")
        unfinished = hint("robot", "the check is not finished yet", "To see the robot's state: pyfrc deploy-info")
        assert robot.RobotSearch(None, "10.0.0.2").findings() == [found, unfinished]
    finally:
        go.set()


def test_all_checks_in_their_order(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    def checks(topic: str) -> Any:
        return lambda *about: iter([ok(topic, "")])

    for name in ("check_python", "check_pyfrc", "check_wpilib", "check_imports", "check_window", "check_project"):
        monkeypatch.setattr(examine, name, checks(name.removeprefix("check_")))
    monkeypatch.setattr(examine, "check_downloads", checks("sync"))
    monkeypatch.setattr(examine, "find_installed", lambda: Installed([]))
    monkeypatch.setattr(examine, "why_no_browser", lambda: "")
    search = SimpleNamespace(findings=lambda: [ok("robot", "")], missing_step=lambda: (Step.DRIVE, ""))
    monkeypatch.setattr(examine, "RobotSearch", lambda *asked: search)
    of_computer = ["python", "pyfrc", "wpilib", "imports", "browser", "window"]

    def topics(**wanted: Any) -> list[str]:
        return [each.topic for each in examine.examine(examine.DoctorOptions(**wanted))]

    assert topics(directory=project.root) == [*of_computer, "project", "robot", "next step"]
    assert topics(directory=project.root, look_for_robot=False) == [*of_computer, "project"]
    wpilib = SimpleNamespace(get=lambda name: SimpleNamespace(version="2026.2.2"))
    monkeypatch.setattr(examine, "find_installed", lambda: wpilib)
    assert topics(directory=project.root, look_for_robot=False)[-2:] == ["project", "sync"]
    write_files(project.root, {"pyproject.toml": '[tool.robotpy]\nrobotpy_version = "2027.1.1"\n'})
    assert topics(directory=project.root, look_for_robot=False)[-1] == "project"
    monkeypatch.chdir(project.root / "..")
    monkeypatch.setattr(examine, "why_no_browser", lambda: "no display")
    monkeypatch.setattr(search, "missing_step", lambda: None)
    found = list(examine.examine(examine.DoctorOptions(directory=project.root / "none")))
    assert [each.topic for each in found] == [*of_computer, "project", "robot"]
    assert found[4].text == "pyfrc sim cannot open one: no display"
    assert found[-2].status == "problem"


def test_results_about_a_project(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    write_files(
        project.root,
        {"tests/test_a.py": "", "bad.py": "def f(:\n", "sim/config.json": '{"pyfrc": {"robt": {}, "x": 1}}'},
    )
    looked = ("MyRobot", [SimpleNamespace(remedy="Write it.", __str__=lambda: "x")], ("phoenix6",))
    monkeypatch.setattr(
        robot_project, "run_in_subprocess", lambda look, *about: looked if "class" in look.__name__ else None
    )
    monkeypatch.setattr(robot_project, "left_over", lambda project: "a thread")
    (project.root / "bad.py").write_bytes(b"\xff\xfe")
    found = {(each.topic, each.status): each for each in robot_project.check_project(project, find_installed())}
    assert found["program", "ok"].text == f"class MyRobot in {project.main_file}"
    assert found["program", "problem"].remedy == "Write it."
    assert found["program", "hint"].text.startswith("phoenix6 simulates its devices in real time")
    assert found["project", "hint"].text.startswith("bad.py: ")
    assert found["sim/config.json", "hint"].text.endswith(", and 1 more")
    assert found["tests", "ok"].text == str(project.root / "tests")
    assert found["tests", "hint"].text.endswith("because one had left a thread")
    assert found["physics", "hint"].remedy == "pyfrc create-physics"
    other = SeasonSetting("robotpy_version is 2020.1.1", 2020, "pyproject.toml:2")
    found = {
        (each.topic, each.status): each for each in robot_project.check_project(project, find_installed(), [other])
    }
    assert "robotpy_version is 2020.1.1" in found["project", "problem"].text, (
        "the program of another season is not imported"
    )
    assert not any(topic == "program" for topic, _ in found)
