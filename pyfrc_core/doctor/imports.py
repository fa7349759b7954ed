"""Checks whether installed libraries can be imported, in a separate process, since they may crash."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from ..config.packages import PACKAGES
from .check_result import CheckResult, ok, problem
from .installed import Installed

#: Seconds after which imports count as hanging.
TIME_LIMIT = 60.0

# Prints each module before its import: after a crash, the last line has the module that crashed.
_PROGRAM = """
import importlib, sys
sys.path[:] = sys.argv[1].split("\\n")
for name in sys.argv[2:]:
    print("import", name, flush=True)
    try:
        importlib.import_module(name)
    except BaseException as error:
        print("failed", type(error).__name__, " ".join(str(error).split()), flush=True)
"""


def check_imports(installed: Installed, path: list[str] | None = None) -> Iterator[CheckResult]:
    """Check whether each installed library that robots use can be imported.

    :param path: the module search path; default: `sys.path` without the current directory
    """
    of_robots = {package.name for package in installed.of_wpilib()}
    packages = {module: name for module, name in PACKAGES.items() if name in of_robots}
    # The others import it.
    packages = dict(sorted(packages.items(), key=lambda each: each[0] != "wpilib"))
    remaining = list(packages)
    failures = False
    while remaining:
        output, ended = _import(remaining, sys.path if path is None else path)
        reached = remaining[0]
        for line in output.splitlines():
            word, _, rest = line.partition(" ")
            if word == "import" and rest in packages:
                reached = rest
            elif word == "failed":
                failures = True
                yield _failed(packages[reached], reached, rest)
        if ended:
            failures = True
            yield _failed(packages[reached], reached, ended)
        # If a module has ended the process, the modules after it must still be tested.
        remaining = remaining[remaining.index(reached) + 1 :] if ended else []
    if packages and not failures:
        yield ok("imports", f"{', '.join(packages)} can be imported")


def _import(modules: list[str], path: list[str]) -> tuple[str, str]:
    """Return the output of the process, and what ended it early; empty if nothing did."""
    looked_in = [each for each in path if each and Path(each) != Path.cwd()]
    command = [sys.executable, "-c", _PROGRAM, "\n".join(looked_in), *modules]
    try:
        done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", timeout=TIME_LIMIT)
    except subprocess.TimeoutExpired as hanging:
        output = hanging.stdout or b""
        return output.decode("utf-8", "replace") if isinstance(
            output, bytes
        ) else output, f"no end after {TIME_LIMIT:g} s"
    if done.returncode < 0:
        try:
            return done.stdout, f"crashes Python ({signal.Signals(-done.returncode).name})"
        except ValueError:
            return done.stdout, f"crashes Python (signal {-done.returncode})"
    return done.stdout, f"ends Python with {done.returncode}" if done.returncode else ""


def _failed(package: str, module: str, how: str) -> CheckResult:
    remedy = f"pip install --force-reinstall --no-deps {package}"
    if sys.platform == "win32":
        remedy += "; or install Microsoft's Visual C++ Redistributable, which WPILib needs"
    elif "GLIBC" in how:
        remedy = "This system is too old for WPILib: it needs a newer release of your Linux."
    return problem("imports", f"import {module}: {how}", remedy)
