"""Files that are no log, where one belongs: each command says in one sentence what it is and what was expected."""

from __future__ import annotations

import gzip
import os
import struct
import zipfile
from pathlib import Path

import pytest
from conftest import MakeProject, RobotProject

ROBOT = "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
SCRIPT = '{"format": "pyfrc-input 1", "end": 0.1}\n'
DS_LOG = struct.pack(">iqQ", 4, 3_800_000_000, 0)

#: Commands that read inputs, and one that shows logs.
INPUTS = {
    "sim --log": ("sim", "--ui", "none", "--log"),
    "sim --script": ("sim", "--ui", "none", "--script"),
    "replay": ("replay",),
    "fuzz --from": ("fuzz", "--runs", "1", "--from"),
}
VIEW = ("view", "--page", "page.html")

#: What the file is, by its name; of a log of the driver station, what it lacks.
WHAT = {
    "robot.py": "this is Python code",
    "settings.json": "this is JSON",
    "field.png": "this is a picture",
    "logs.zip": "this is a ZIP archive",
    "match.wpilog.gz": "this is a compressed file",
    "notes.log": "this is text",
    "settings.wpilog": "this is text",
    "page.html": "this is a web page",
    "random.bin": "this is binary data",
    "renamed.wpilog": "this is text",
    "empty.wpilog": "this file is empty",
    "logs": "this is a directory, not ",
    "missing.wpilog": "there is no file missing.wpilog",
    "match.hoot": "this log cannot be read directly",
    "match.revlog": "this log cannot be read directly",
}
INPUTS_ONLY = {
    "match.dslog": "the driver station's log does not have the joysticks",
    "renamed.log": "the driver station's log does not have the joysticks",
    "other.jsonl": "other.jsonl:1: the first line must be the header",
}
REMEDY = {
    "match.hoot": "owlet -f wpilog FILE.hoot FILE.wpilog",
    "match.revlog": "revlog-converter FILE.revlog -o FILE.wpilog",
    "logs.zip": "Unpack it first.",
    "logs": "Its newest logs: a.wpilog",
    "match.dslog": "Take the data log of the robot of the same match (.wpilog).",
    "missing.wpilog": None,
}


@pytest.fixture(scope="module")
def project(make_shared_project: MakeProject) -> RobotProject:
    made = make_shared_project(
        {
            "robot.py": ROBOT,
            "settings.json": '{"a": 1}',
            "notes.log": "first line\n",
            "settings.wpilog": "[tool.pyfrc]\n",
            "renamed.wpilog": "text",
            "empty.wpilog": "",
            "logs/a.wpilog": "",
            "other.jsonl": '{"a": 1}\n',
            "drive.jsonl": SCRIPT,
            "drive.trace.jsonl": '{"format": "pyfrc-trace 2"}\n',
        }
    )
    binary = {
        "field.png": b"\x89PNG\r\n\x1a\n\0\0",
        "match.wpilog.gz": gzip.compress(b"WPILOG"),
        "random.bin": bytes(range(256)),
        "match.hoot": b"HOOT\xff",
        "match.revlog": b"REVLOG\xff",
        "match.dslog": DS_LOG + b"\0" * 40,
        "renamed.log": DS_LOG,
        "page.html": b"<!DOCTYPE html><html></html>",
    }
    for name, content in binary.items():
        (made.path / name).write_bytes(content)
    with zipfile.ZipFile(made.path / "logs.zip", "w") as packed:
        packed.writestr("match.wpilog", b"WPILOG")
    return made


@pytest.mark.parametrize("command", INPUTS)
def test_what_has_no_inputs_is_named(command: str, project: RobotProject) -> None:
    for name, what in {**WHAT, **INPUTS_ONLY}.items():
        result = project.run_here(*INPUTS[command], name)
        assert result.code == 2, (name, result.output)
        assert what in result.first_error
        assert name in result.first_error
        lines = result.stderr.splitlines()
        assert len(lines) <= 2, lines
        remedy = REMEDY.get(name, "" if name in INPUTS_ONLY or name == "robot.py" else "(.wpilog)")
        if what.startswith("this is ") and name not in REMEDY:
            assert what == "this is a web page" or "neither an input script nor a data log" in lines[0]
        elif remedy:
            assert remedy in lines[1]


def test_logs_in_the_directories_of_a_directory_are_named(project: RobotProject) -> None:
    result = project.run_here(*INPUTS["sim --log"], ".")
    assert result.code == 2
    assert "Its newest logs: " in result.stderr
    assert "logs/a.wpilog" in result.stderr
    result = project.run_here(*VIEW, ".")
    assert (result.code, "Name what to show, such as " in result.stderr) == (2, True)


def test_a_misspelled_name_gets_the_right_one(project: RobotProject) -> None:
    for command in (*INPUTS.values(), VIEW):
        result = project.run_here(*command, "drive.jsnl")
        assert (result.code, result.first_error) == (2, "there is no file drive.jsnl")
        assert "Did you mean drive.jsonl?" in result.stderr


def test_a_trace_is_no_script(project: RobotProject) -> None:
    for command in ("sim --script", "replay", "fuzz --from"):
        result = project.run_here(*INPUTS[command], "drive.trace.jsonl")
        assert (result.code, result.first_error) == (2, "drive.trace.jsonl: a trace has no inputs")
        assert "Its input script is drive.jsonl." in result.stderr


def test_a_file_is_what_it_contains_whatever_its_name(project: RobotProject) -> None:
    (project.path / "script.txt").write_text(SCRIPT)
    result = project.run("replay", "script.txt")
    assert result.code == 0, result.output


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes are not on Windows")
def test_a_pipe_is_not_waited_for(project: RobotProject) -> None:
    os.mkfifo(project.path / "pipe")
    try:
        for command in (*INPUTS.values(), VIEW):
            result = project.run_here(*command, "pipe")
            assert "this is a pipe or a device, not " in result.first_error
            assert result.code in (1, 2)
    finally:
        Path(project.path / "pipe").unlink()
