"""What `pip install pyfrc` brings, and what the command costs before it does anything."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from skips import missing_programs, require

ROOT = Path(__file__).parents[1]


def python(*args: str) -> str:
    done = subprocess.run([sys.executable, *args], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_wheel_carries_the_packages_their_types_and_the_templates(tmp_path: Path) -> None:
    python("-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "-w", str(tmp_path), str(ROOT))
    (wheel,) = tmp_path.glob("pyfrc-*.whl")
    names = set(zipfile.ZipFile(wheel).namelist())
    assert {f"{package}/py.typed" for package in ("pyfrc", "pyfrc_cli", "pyfrc_core")} <= names
    for file in (ROOT / "templates").rglob("*"):
        if file.is_file() and "__pycache__" not in file.parts:
            assert f"pyfrc_cli/templates/{file.relative_to(ROOT / 'templates').as_posix()}" in names
    page = ROOT / "pyfrc_core" / "sim" / "ui" / "web" / "page"
    assert {file.relative_to(ROOT).as_posix() for file in page.rglob("*") if file.is_file()} <= names
    assert not [name for name in names if name.startswith(("tests/", "templates/"))]


@pytest.mark.parametrize(
    "command",
    [
        ["--help"],
        ["test", "--help"],
        ["init", "--help"],
        ["init", "--list"],
        ["add-tests", "--help"],
        ["config", "--help"],
        ["create-physics", "--help"],
        ["sim", "--help"],
        ["--version"],
    ],
)
def test_help_waits_for_none_of_the_big_libraries(command: list[str]) -> None:
    code = f"""
import sys
sys.argv = ["pyfrc", *{command!r}]
from pyfrc_cli.main import run
try:
    run()
except SystemExit:
    pass
big = {{"wpilib", "hal", "pytest", "pydantic", "coverage", "numpy", "hypothesis", "commands2"}}
big |= {{"starlette", "uvicorn", "websockets", "asyncio", "tkinter"}}
assert not big & set(sys.modules), big & set(sys.modules)
"""
    python("-c", code)


def test_a_run_with_default_settings_does_not_wait_for_pydantic(make_project) -> None:
    project = make_project(
        {
            "robot.py": "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n",
            "tests/test_it.py": """
            import sys

            def test_it(control, robot):
                control.run_test(lambda tm: tm < 1)
                assert "pydantic" not in sys.modules
            """,
        }
    )
    result = project.run("test", "--", "-q", cold=True)
    assert result.code == 0, result.output


@pytest.fixture
def make_with(tmp_path: Path):
    """Makes the environment with a Python that is a shell script."""
    require("the Makefile", missing_programs("make"))

    def make(script: str) -> subprocess.CompletedProcess[str]:
        python = tmp_path / "python"
        python.write_text(f"#!/bin/sh\n{script}", "utf-8")
        python.chmod(0o755)
        command = ["make", f"PYTHON={python}", f"VENV={tmp_path / 'venv'}", f"{tmp_path / 'venv'}/bin/python"]
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)

    return make


def test_make_removes_an_environment_that_could_not_be_made(make_with, tmp_path: Path) -> None:
    failing = (
        'test "$1" = -c && exit 0; mkdir -p "$3/bin"; touch "$3/bin/python"; echo ensurepip is missing >&2; exit 1\n'
    )
    done = make_with(failing)
    assert done.returncode != 0
    assert "ensurepip is missing" in done.stderr
    assert not (tmp_path / "venv").exists()


def test_make_says_when_python_is_too_old(make_with, tmp_path: Path) -> None:
    """The real check, run by a Python that says that it is an older one."""
    too_old = f"shift; exec {sys.executable} -c 'import sys; sys.version_info = (3, 9, 2)'\"\n$1\"\n"
    done = make_with(too_old)
    assert done.returncode != 0
    assert "pyfrc needs Python 3.10 or newer" in done.stderr
    assert not (tmp_path / "venv").exists()
