"""Run tests in an environment that is like another system's: ``on_another_system.py windows [options of pytest]``.

With ``--by-day``, only the files that the gate runs before each change.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

from other_systems import START, VARIABLE
from other_systems.files import is_open
from other_systems.imports import NAMES
from other_systems.install import DIRECTORY
from other_systems.typeshed import absent_names

_ROOT = Path(__file__).parents[1]
_PLATFORMS = {"windows": "win32", "macos": "darwin"}

_AUTOCRLF = {"GIT_CONFIG_KEY_0": "core.autocrlf", "GIT_CONFIG_VALUE_0": "true"}

#: What runs when no test is named: the files that are about what differs there.
FILES = {
    "windows": (
        *("core/test_crash_reports.py", "core/test_processes.py", "test_command_line.py", "test_deploy_connection.py"),
        *(
            "test_deploy_host_keys.py",
            "test_deploy_manifest.py",
            "test_failures.py",
            "test_init.py",
            "test_isolation.py",
        ),
        *("test_migrate.py", "test_odd_letters.py", "test_project.py", "test_sim_channel.py", "test_sim_session.py"),
        "test_virtual_robot.py",
    ),
    "macos": ("core/test_processes.py", "test_project.py", "test_sim_channel.py", "test_virtual_robot.py"),
}

#: Those of them that the gate runs by day: processes, pipes, files and letters.
BY_DAY = ("core/test_processes.py", "test_odd_letters.py", "test_project.py", "test_sim_channel.py")

#: Tests in these files that take long, and show no more than others do there.
LONG = (
    "test_isolation.py::test_another_isolation_gives_the_same",
    "test_isolation.py::test_plain_pytest_gives_the_same",
    "test_isolation.py::test_several_at_a_time_give_the_same_in_the_same_order",
    "test_migrate.py::test_five_thousand_lines_are_valid_afterwards",
)


def main() -> int:
    """Run the tests, and return pytest's exit code."""
    system, *arguments = sys.argv[1:]
    files = FILES[system]
    if "--by-day" in arguments:
        arguments.remove("--by-day")
        files = tuple(name for name in files if name in BY_DAY)
    with tempfile.TemporaryDirectory(prefix="pyfrc-tests-") as directory:
        environment = environment_of(system, Path(directory).resolve(), os.environ)
        environment.pop("PYFRC_NO_SKIPS", None)  # what is about Linux alone is skipped
        if not any(argument.partition("::")[0].endswith(".py") for argument in arguments):
            arguments += [f"tests/{name}" for name in files]
            arguments += [f"--deselect=tests/{name}" for name in LONG]
        return subprocess.call([sys.executable, "-m", "pytest", *arguments], cwd=_ROOT, env=environment)


def environment_of(system: str, directory: Path, environment: Mapping[str, str]) -> dict[str, str]:
    """Return the variables with which interpreters are in an environment like this system's.

    :param directory: an empty one, for temporary files, and for what interpreters read
    :param environment: what else they are to find
    """
    names = directory / NAMES
    names.write_text(json.dumps(absent_names(_PLATFORMS[system])), encoding="utf-8")
    with names.open("rb"):
        if not is_open(str(names)):
            sys.exit(f"{directory}: this file system does not say which files are open")
    return {
        **environment,
        VARIABLE: system,
        DIRECTORY: str(directory),
        "PYTHONPATH": str(START),
        "TMPDIR": str(_temporary(directory, system)),
        "LC_ALL": "C.UTF-8",
        # As Git for Windows is set up.
        **({} if system == "macos" else {"GIT_CONFIG_COUNT": "1", **_AUTOCRLF}),
    }


def _temporary(place: Path, system: str) -> Path:
    if system == "windows":
        temporary = place / "Temp"
        temporary.mkdir(exist_ok=True)
        return temporary
    real = place / "private" / "var"
    (real / "folders" / "zz").mkdir(parents=True, exist_ok=True)
    (place / "var").symlink_to(real)
    return place / "var" / "folders" / "zz"


if __name__ == "__main__":
    sys.exit(main())
