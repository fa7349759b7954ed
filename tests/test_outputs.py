"""No command overwrites what it reads, nor the project's code: of each option that writes."""

from __future__ import annotations

import os
from pathlib import Path

import click
import pytest
from conftest import MakeProject, RobotProject, sampled
from loops import for_each
from test_command_line import EVERY

from pyfrc_cli.file_options import ReadPath, WrittenDirectory, WrittenFile

ROBOT = "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
SCRIPT = '{"format": "pyfrc-input 1", "end": 0.1}\n'
SIM, LOG = ("sim", "--ui", "none"), ("sim", "--ui", "none", "--log", "in.jsonl")

#: Each option that writes a file, with a command and what that reads. `{}` is the option with its file.
FILES: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "coverage --xml": (("coverage", "{}", "replay", "in.jsonl"), ("in.jsonl", "in.trace.jsonl")),
    "coverage --json": (("coverage", "{}", *SIM, "--script", "in.jsonl"), ("in.jsonl",)),
    "profile --outfile": (("profile", "{}", "replay", "in.jsonl"), ("in.jsonl",)),
    "profile --json": (("profile", "{}", *LOG), ("in.jsonl", "in.trace.jsonl")),
    "replay --trace": (("replay", "{}", "in.jsonl"), ("in.jsonl", "in.trace.jsonl")),
    "replay --page": (("replay", "{}", "in.jsonl"), ("in.jsonl", "in.trace.jsonl")),
    "sim --record": ((*SIM, "--script", "in.jsonl", "{}"), ("in.jsonl", "in.trace.jsonl")),
    "sim --wpilog": ((*LOG, "{}"), ("in.jsonl", "in.trace.jsonl")),
    "sim --page": ((*SIM, "--log", "in.trace.jsonl", "{}"), ("in.jsonl", "in.trace.jsonl")),
    "test --coverage-xml": (("test", "{}"), ()),
    "view --page": (("view", "in.jsonl", "match.dslog", "{}"), ("in.jsonl", "in.trace.jsonl", "match.dsevents")),
}
#: Each option that writes into a directory, and each argument.
DIRECTORIES: dict[str, tuple[str, ...]] = {
    "coverage --html": ("coverage", "{}", "test"),
    "fuzz --pages": ("fuzz", "{}", "--runs", "1"),
    "logs --into": ("logs", "--robot", "127.0.0.1:1", "{}"),
    "test --coverage-html": ("test", "{}"),
    "test --record": ("test", "{}"),
    "test --trace": ("test", "{}"),
    "virtual-robot --directory": ("virtual-robot", "{}"),
}
#: Files of a project, by other names, too.
CODE = ("robot.py", "symbolic.html", "hard.png", "sim/config.json", "pyproject.toml", "deploy/path.txt")
#: `pyfrc init` leaves every file that exists as it is.
CHANGES_NOTHING = "init directory"


def of_type(kind: type[click.ParamType]) -> set[str]:
    """Return the parameters of all commands that have this type, such as ``sim --page``."""
    return {
        " ".join((*path, max(parameter.opts, key=len)))
        for path, command in EVERY.items()
        for parameter in command.params
        if isinstance(parameter.type, kind)
    }


def test_each_parameter_with_a_path_says_whether_it_is_read_or_written() -> None:
    said = of_type(ReadPath) | of_type(WrittenFile) | of_type(WrittenDirectory)
    assert of_type(click.Path) == said
    named = {
        " ".join((*path, max(parameter.opts, key=len)))
        for path, command in EVERY.items()
        for parameter in command.params
        if (parameter.metavar or "").strip("[].") in ("DIR", "DIRECTORY", "FILE", "LOG", "PATH")
    }
    assert named <= said


def test_each_that_writes_is_tried_here() -> None:
    older_names = ("profiler ", "create-tests ")
    assert {each for each in of_type(WrittenFile) if not each.startswith(older_names)} == FILES.keys()
    directories = {each for each in of_type(WrittenDirectory) if not each.startswith(older_names)}
    assert directories == {*DIRECTORIES, CHANGES_NOTHING}


@pytest.fixture
def project(make_project: MakeProject) -> RobotProject:
    made = make_project(
        {
            "robot.py": ROBOT,
            "components/arm.py": "",
            "deploy/path.txt": "0 0",
            "tests/test_a.py": "def test_nothing(): pass\n",
            "pyproject.toml": "[tool.pyfrc]\n",
            "sim/config.json": "{}",
            "in.jsonl": SCRIPT,
            "in.trace.jsonl": '{"format": "pyfrc-trace 1"}\n',
            "match.dslog": "",
            "match.dsevents": "",
        }
    )
    (made.path / "symbolic.html").symlink_to("robot.py")
    os.link(made.path / "components/arm.py", made.path / "hard.png")
    return made


def contents(project: RobotProject) -> dict[Path, bytes]:
    return {file: file.read_bytes() for file in project.path.rglob("*") if file.is_file()}


def refused(project: RobotProject, name: str, arguments: tuple[str, ...], path: str, why: str) -> None:
    before, option = contents(project), name.split(" ")[1]
    words = [word for each in arguments for word in ((option, path) if each == "{}" else (each,))]
    result = project.run_here(*words)
    assert (result.code, result.first_error) == (2, f"{option} {Path(path)} cannot be written: {why}"), words
    assert "Traceback" not in result.output
    assert contents(project) == before


@pytest.mark.parametrize("how_many", sampled(["a third of them", "all"], "a third of them"))
@for_each("name", FILES)
def test_a_file_that_is_read_is_not_overwritten(name: str, how_many: str, project: RobotProject) -> None:
    """By day, each file in one spelling and two of the project's files, which are others for the next option."""
    arguments, read = FILES[name]
    places = [
        (spelled, "this command reads it")
        for file in read
        for spelled in (file, f"components/../{file}", str(project.path / file))
    ]
    places += [(file, "it is a file of your robot project") for file in CODE]
    for path, why in places if how_many == "all" else places[list(FILES).index(name) % 3 :: 3]:
        refused(project, name, arguments, path, why)
    refused(project, name, arguments, "components", "it is a directory")
    refused(project, name, arguments, "robot.py/out", "robot.py is a file")


@for_each("name", [each for each in DIRECTORIES if not each.startswith("virtual-robot")])
def test_a_directory_of_the_project_is_not_written_into(name: str, project: RobotProject) -> None:
    for directory in (".", "components", str(project.path)):
        refused(project, name, DIRECTORIES[name], directory, "your robot's code is in it")


@for_each("name", list(DIRECTORIES))
def test_a_file_is_no_directory_to_write_into(name: str, project: RobotProject) -> None:
    before = contents(project)
    words = [
        word for each in DIRECTORIES[name] for word in ((name.split(" ")[1], "robot.py") if each == "{}" else (each,))
    ]
    result = project.run_here(*words)
    assert (result.code, "robot.py" in result.stderr) == (2, True), result.output
    assert contents(project) == before


def test_a_virtual_robot_does_not_live_in_a_project(project: RobotProject) -> None:
    before = contents(project)
    result = project.run_here("virtual-robot", "--fresh", "--directory", ".")
    assert result.code == 2
    assert "this directory has files that are not from a virtual robot" in result.first_error
    assert contents(project) == before


def test_earlier_recordings_are_outputs_too(project: RobotProject) -> None:
    (project.path / "in-1.jsonl").write_bytes((project.path / "in.jsonl").read_bytes())
    (project.path / "in.jsonl").unlink()
    result = project.run_here("sim", "--ui", "none", "--script", "in-1.jsonl", "--record", "in.jsonl")
    assert result.first_error == "--record in-1.jsonl cannot be written: this command reads it"


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (("--page", "a.png", "--wpilog", "./a.png"), "--page a.png cannot be written: --wpilog writes it, too"),
        (("--record", "a.jsonl", "--wpilog", "a.trace.jsonl"), "a.trace.jsonl cannot be written: --"),
    ],
)
def test_two_outputs_are_two_files(arguments: tuple[str, ...], error: str, project: RobotProject) -> None:
    result = project.run_here("sim", "--ui", "none", "--script", "in.jsonl", *arguments)
    assert result.code == 2
    assert error in result.first_error
    assert not (project.path / "a.png").exists()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a file for which there is never room is Linux's")
def test_a_full_disk_is_said_with_the_file(project: RobotProject) -> None:
    (project.path / "full").symlink_to("/dev/full")
    result = project.run("replay", "in.jsonl", "--trace", "full")
    assert (result.code, result.first_error) == (1, "full: No space left on device")
