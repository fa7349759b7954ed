"""What `pyfrc deploy --dry-run` checks on this computer, and what it says that it does not."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from loops import for_each

from pyfrc_core.deploy.errors import RefusedError
from pyfrc_core.deploy.local_checks import DeployOptions, prepare
from pyfrc_core.deploy.progress import DeployProgress, UserInterface
from pyfrc_core.project import find_project

ROBOT = "import wpilib\nimport arm\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
NOT_CHECKED = "not checked in a dry run: the tests, and whether the program can be imported\n"


def shown(root: Path, **files: bytes | str) -> str:
    for name, text in {"robot": ROBOT, "arm": "", **files}.items():
        (root / f"{name}.py").write_bytes(text if isinstance(text, bytes) else text.encode())
    output = io.StringIO()
    prepare(find_project(root), DeployOptions(dry_run=True), UserInterface(DeployProgress(output)))
    return output.getvalue()


def test_what_can_be_compiled(tmp_path: Path) -> None:
    text = shown(tmp_path, arm="# coding: latin-1\nx = 'é'\n".encode("latin-1"))
    assert text.endswith(NOT_CHECKED)
    assert "warning" not in text


@for_each(
    "name, text, expected",
    [
        ("robot", "def f()\n    pass\n", "robot.py:1: SyntaxError: expected ':'"),
        ("arm", "x = (1,\n\ny = 2\n", "arm.py:1: SyntaxError: '(' was never closed"),
        ("arm", b"x = '\xe9'\n", "arm.py:1: this line is not UTF-8"),
        ("arm", b"x = '\0'\n", "arm.py:1: this file contains null bytes"),
        ("arm", "return 1\n", "arm.py:1: SyntaxError: 'return' outside function"),
    ],
)
def test_an_error_in_the_program(tmp_path: Path, name: str, text: bytes | str, expected: str) -> None:
    with pytest.raises(RefusedError) as error:
        shown(tmp_path, **{name: text})
    assert str(error.value).startswith(expected)
    assert error.value.exit_code == 1


def test_an_error_in_a_file_that_the_program_does_not_import(tmp_path: Path) -> None:
    text = shown(tmp_path, unused="def f(:\n    pass\n")
    assert "warning: unused.py:1: SyntaxError: invalid syntax" in text
    assert "  No import of this file was found that runs when the program starts.\n" in text
    assert text.endswith(NOT_CHECKED)
