"""What `pip install pyfrc` brings, and what the command costs before it does anything."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import installed_wheel

from pyfrc_cli.main import COMMANDS

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


def test_each_command_is_tried_at_night_with_an_installed_wheel() -> None:
    assert COMMANDS.keys() <= installed_wheel.TRIED


#: Among them each command that a user types often, in one interpreter.
HELP = """
--help
--version
test --help
sim --help
init --help
init --list
add-tests --help
config --help
create-physics --help
deploy --help
deploy-info --help
undeploy --help
console --help
logs --help
"""


def test_help_waits_for_none_of_the_big_libraries() -> None:
    code = f"""
import sys
from pyfrc_cli.main import run
big = {{"wpilib", "hal", "pytest", "pydantic", "coverage", "numpy", "hypothesis", "commands2"}}
big |= {{"starlette", "uvicorn", "websockets", "asyncio", "tkinter", "paramiko", "rich"}}
for words in {HELP.strip().splitlines()!r}:
    sys.argv = ["pyfrc", *words.split()]
    try:
        run()
    except SystemExit as ended:
        assert not ended.code, words
    assert not big & set(sys.modules), (words, big & set(sys.modules))
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
