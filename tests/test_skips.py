"""A run's last line: what was not tested on this machine, and what brings it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
import runs
import skips
from conftest import sampled

pytestmark = pytest.mark.bare

HERE = Path(__file__).parent

TESTS = """
    import pytest
    from skips import require

    @pytest.mark.parametrize("number", range(3))
    def test_robots(number):
        require("robots", ["root", "sshd"])

    @pytest.mark.skipif(True, reason="there are no whistles")
    def test_whistles():
        pass

    def test_all_there():
        require("robots", [])

    def test_vendors():
        require("vendors", ["Python 3.11"])

    @pytest.mark.slow
    @pytest.mark.parametrize("number", range(2))
    def test_slow(number):
        pass
"""

WINDOWS = """
    from skips import require

    require("windows", ["Xvfb"])

    def test_one():
        pass

    def test_another():
        pass
"""


def run(directory: Path, *args: str, **env: str) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if name != "PYFRC_NO_SKIPS"}
    command = [sys.executable, "-m", "pytest", "-p", "skips", "-p", "no:cacheprovider", "-m", "not slow", *args]
    return subprocess.run(
        command,
        cwd=directory,
        env=environment | {"PYTHONPATH": str(HERE)} | env,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture
def suite(make_project) -> Path:
    path: Path = make_project({"test_robots.py": TESTS, "test_windows.py": WINDOWS}).path
    return path


@pytest.mark.parametrize("args", sampled([[], ["-n", "2"]], []))
def test_everything_that_was_skipped_is_in_the_last_line_by_kind_and_counted(suite: Path, args: list[str]) -> None:
    done = run(suite, *args)
    assert done.returncode == 0, done.stdout + done.stderr
    last = done.stdout.splitlines()[-1]
    assert last.startswith(
        "Not tested on this machine: robots (3 tests; needs root, sshd), windows (at least 2 tests; needs Xvfb),"
        " there are no whistles (1 test), vendors (1 test; needs Python 3.11). To test this, too: "
    )
    assert last.endswith(". Left for the nightly run: 2 tests. To run them now: make test ARGS=--run-slow")
    assert "sudo make" not in last


def test_what_runs_nightly_is_in_the_last_line_where_nothing_else_is_missing() -> None:
    assert skips.summarize(Counter(), nightly=1) == (
        "Left for the nightly run: 1 test. To run them now: make test ARGS=--run-slow"
    )
    assert skips.summarize(Counter()) == ""


def test_in_the_gate_each_is_a_failure_but_what_a_newer_python_tests(suite: Path) -> None:
    done = run(suite, "--continue-on-collection-errors", PYFRC_NO_SKIPS="1")
    assert done.returncode != 0
    assert "Not tested on this machine: vendors (1 test; needs Python 3.11). To test" in done.stdout
    counted = "^=+ 3 failed, 1 passed, 1 skipped, .*2 errors in "  # one is the module
    assert re.search(counted, done.stdout, re.MULTILINE)


REASONS = Counter({"robots: needs root, sshd": 7, "windows: needs Xvfb, tkinter, xdotool": 5})


@pytest.mark.parametrize(
    ("manager", "command"),
    [
        ("apt-get", "sudo apt-get install openssh-server python3-tk xdotool xvfb"),
        ("dnf", "sudo dnf install openssh-server python3-tkinter xdotool xorg-x11-server-Xvfb"),
        ("pacman", "sudo pacman -S openssh tk xdotool xorg-server-xvfb"),
        ("none", "install Xvfb, sshd, tkinter, xdotool"),
    ],
)
def test_the_one_command_is_of_the_systems_package_manager(
    manager: str, command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / manager).touch(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    remedy = skips.summarize(REASONS).rpartition(": ")[2]
    assert remedy == f"{command}; run them as root in a container or a virtual machine"


def test_no_test_is_skipped_by_a_guard_of_its_own() -> None:
    """A part that may be missing goes by `require`, so that the last line can say what brings it."""
    own = re.compile(r"importorskip\(\"tkinter|shutil\.which\(.*\) is None\b.*reason|PYFRC_NO_SKIPS")
    found = [
        file.name for file in HERE.glob("test_*.py") if file != Path(__file__) and own.search(file.read_text("utf-8"))
    ]
    assert found == []


def test_each_worker_begins_with_some_of_the_longest_files(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "LONGEST", {"b", "d", "f"})
    tests = [f"{file}{number}" for file in "abcdefgh" for number in range(3)]
    # 24 tests: pytest-xdist deals them in as many parts as there are workers.
    for workers, begin in {1: ["b0"], 2: ["b0", "d0"], 4: ["b0", "d0", "f0", "g0"], 40: ["b0"]}.items():
        ordered = runs.longest_first(tests, lambda test: test[0], workers)
        assert sorted(ordered) == tests
        assert ordered[:: 24 // len(begin)] == begin
