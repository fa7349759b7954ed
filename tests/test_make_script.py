"""`make.py`: the environment, the tasks, and what the Makefile passes on to it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from make_script import make_script
from next_preview import differences
from skips import missing_programs, require

ROOT = Path(__file__).parents[1]


@pytest.fixture
def ran(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[str]:
    """What it has run, with the Python of an environment that is there."""
    commands: list[str] = []
    python = Path(make_script.Environment(tmp_path).python)
    python.parent.mkdir()
    for file in (python, tmp_path / "installed", tmp_path / "installed-dev"):
        file.touch()
    monkeypatch.setattr(
        make_script, "run", lambda command: commands.append(" ".join(command).replace(str(python), "python"))
    )
    monkeypatch.chdir(ROOT)  # as the script does
    return commands


def test_the_demo_makes_a_project_once(ran: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(make_script, "ROOT", tmp_path)
    (tmp_path / "pyproject.toml").touch()
    os.utime(tmp_path / "pyproject.toml", (0, 0))
    make_script.main(["--venv", str(tmp_path), "demo"])
    (tmp_path / "demo").mkdir()
    make_script.main(["--venv", str(tmp_path), "demo"])
    first = "python -m pyfrc init demo"
    rest = [
        "python -m pyfrc test --project demo --coverage",
        "python -m pyfrc virtual-robot --directory demo/.pyfrc/virtual-robot --fresh -- python tests/demo.py demo",
    ]
    assert ran == [first, *rest, *rest]


def test_options_of_pytest_come_last(ran: list[str], tmp_path: Path) -> None:
    make_script.main(["--venv", str(tmp_path), "test", "-k", "joystick", "--lf"])
    (command,) = ran
    assert command.startswith("python -m pytest -n ")
    assert command.endswith(" --dist worksteal -k joystick --lf")


@pytest.mark.parametrize(
    ("missing", "task", "installed"),
    [
        ("installed-dev", "check", ". --group dev"),
        ("installed", "demo", "."),
        ("installed-dev", "demo", None),
    ],
)
def test_it_installs_what_is_missing(
    missing: str, task: str, installed: str | None, ran: list[str], tmp_path: Path
) -> None:
    (tmp_path / missing).unlink()
    make_script.main(["--venv", str(tmp_path), task])
    install = [f"python -m pip install --quiet --editable {installed}"] if installed else []
    if task == "check":
        install.insert(0, "python -m pip install --quiet --upgrade pip>=25.1")
    assert [command for command in ran if " pip " in command] == install
    if installed:
        assert (tmp_path / missing).exists()
        ran.clear()
        make_script.main(["--venv", str(tmp_path), task])
        assert not any(" pip " in command for command in ran)


def test_it_installs_again_when_the_requirements_have_changed(ran: list[str], tmp_path: Path) -> None:
    os.utime(tmp_path / "installed-dev", (0, 0))
    make_script.main(["--venv", str(tmp_path), "install"])
    assert ran[1:] == ["python -m pip install --quiet --editable . --group dev"]


def test_an_environment_that_could_not_be_made_is_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As on Debian without python3-venv, whose environment has no pip."""
    directory = tmp_path / "venv"

    def fails(command: list[str]) -> None:
        assert command == [sys.executable, "-m", "venv", str(directory)]
        (directory / "bin").mkdir(parents=True)
        sys.exit(1)

    monkeypatch.setattr(make_script, "run", fails)
    monkeypatch.chdir(ROOT)
    with pytest.raises(SystemExit):
        make_script.main(["--venv", str(directory), "install"])
    assert not directory.exists()


@pytest.mark.parametrize(("system", "other"), [("linux", "make PYTHON=python3.13"), ("win32", "py -3.13 make.py")])
def test_a_python_that_is_too_old(system: str, other: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    old = SimpleNamespace(version_info=(3, 9, 2), platform=system, exit=sys.exit)
    monkeypatch.setattr(make_script, "sys", old)
    monkeypatch.chdir(ROOT)
    with pytest.raises(SystemExit, match=f"^pyfrc needs Python 3.10 or newer; if you have one: {other}$"):
        make_script.main(["--venv", str(tmp_path / "venv"), "test"])
    assert not (tmp_path / "venv").exists()


def test_where_the_programs_are_on_windows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(make_script, "sys", SimpleNamespace(platform="win32"))
    environment = make_script.Environment(Path(".venv"))
    assert Path(environment.python) == Path(".venv/Scripts/python.exe")
    assert Path(environment.program("lint-imports")) == Path(".venv/Scripts/lint-imports.exe")


def test_a_command_that_fails_ends_it_with_its_exit_code(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        make_script.run([sys.executable, "-c", "raise SystemExit(3)"])
    assert ended.value.code == 3
    make_script.run([sys.executable, "-c", ""])
    assert "raise SystemExit(3)" in capsys.readouterr().out


INTERRUPTED = """
import sys
sys.path.insert(0, {tests!r})
from make_script import make_script
make_script.run([sys.executable, "-c", {command!r}])
"""

#: Needs its time after Ctrl-C, as pytest does.
ENDS_BY_ITSELF = """
try:
    print("started", flush=True)
    input()
except KeyboardInterrupt:
    print("interrupted", flush=True)
    print("reports", input())
raise SystemExit(2)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for a group of processes")
def test_ctrl_c_ends_the_command_in_its_own_way() -> None:
    program = INTERRUPTED.format(tests=str(ROOT / "tests"), command=ENDS_BY_ITSELF)
    with subprocess.Popen(
        [sys.executable, "-c", program],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        start_new_session=True,
        encoding="utf-8",
    ) as process:
        assert process.stdout is not None
        while process.stdout.readline() != "started\n":
            assert process.poll() is None
        os.killpg(process.pid, signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n"
        rest, _ = process.communicate("failures\n")
    assert (rest, process.returncode) == ("reports failures\n", 2)


@pytest.mark.parametrize("task", make_script.TASKS)
def test_the_makefile_passes_each_task_on(task: str) -> None:
    require("the Makefile", missing_programs("make"))
    line = ["make", "--no-print-directory", "--dry-run", task, "VENV=there", "DEV=more", "PYTHON=py", "ARGS=-k 'a b'"]
    done = subprocess.run(line, cwd=ROOT, capture_output=True, encoding="utf-8", check=True)
    arguments = " -k 'a b'" if task in make_script.WITH_OPTIONS else ""
    assert done.stdout == f"py make.py --venv there --group more {task}{arguments}\n"


def test_the_helps_names_are_those_of_the_makefile(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        make_script.main(["--help"])
    printed = capsys.readouterr().out
    assert all(f"  {task} " in printed for task in make_script.TASKS)


def test_the_names_that_a_preview_has_changed() -> None:
    before = {
        "wpilib.A": "(wpilib.B)",
        "wpilib.A.f": "(x)",
        "wpilib.Gone": "",
        "wpilib.Gone.f": "()",
        "hal.same": ": int",
    }
    after = {
        "wpilib.A": "(wpilib.C)",
        "wpilib.A.g": "(x, y)",
        "wpilib.New": "",
        "wpilib.New.f": "()",
        "hal.same": ": int",
    }
    assert differences(before, after) == [
        "~ wpilib.A(wpilib.B)  is now  (wpilib.C)",
        "- wpilib.A.f(x)",
        "+ wpilib.A.g(x, y)",
        "- wpilib.Gone",
        "+ wpilib.New",
    ]
