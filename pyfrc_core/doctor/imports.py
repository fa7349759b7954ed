"""Whether the libraries that are installed can be imported; found out in a process apart, which they may crash."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from .findings import Finding, ok, problem
from .installed import Installed

#: Packages, and the module of each that is imported.
MODULES = {
    "wpilib": "wpilib",
    "robotpy-commands-v2": "commands2",
    "robotpy-wpilib-utilities": "magicbot",
    "robotpy-apriltag": "robotpy_apriltag",
    "robotpy-rev": "rev",
    "phoenix6": "phoenix6",
    "robotpy-ctre": "phoenix5",
    "robotpy-navx": "navx",
    "photonlibpy": "photonlibpy",
    "robotpy-pathplannerlib": "pathplannerlib",
}

#: Seconds until imports count as hanging.
PATIENCE = 60.0

# What is said before an import is the last that is said, when it crashes.
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


def examine_imports(installed: Installed, path: list[str] | None = None) -> Iterator[Finding]:
    """Whether each library that robots use can be imported.

    :param path: where modules are looked for; default: where this process looks, but not in the current directory
    """
    packages = {module: name for name, module in MODULES.items() if installed.get(name)}
    remaining = list(packages)
    failures = False
    while remaining:
        said, ended = _import(remaining, sys.path if path is None else path)
        reached = remaining[0]
        for line in said.splitlines():
            word, _, rest = line.partition(" ")
            if word == "import" and rest in packages:
                reached = rest
            elif word == "failed":
                failures = True
                yield _failed(packages[reached], reached, rest)
        if ended:
            failures = True
            yield _failed(packages[reached], reached, ended)
        # Behind one that has ended the process the others have still to be tried.
        remaining = remaining[remaining.index(reached) + 1 :] if ended else []
    if packages and not failures:
        yield ok("imports", f"{', '.join(packages)} can be imported")


def _import(modules: list[str], path: list[str]) -> tuple[str, str]:
    """What was said, and what ended it; nothing, when it came to its end."""
    looked_in = [each for each in path if each and Path(each) != Path.cwd()]
    command = [sys.executable, "-c", _PROGRAM, "\n".join(looked_in), *modules]
    try:
        done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", timeout=PATIENCE)
    except subprocess.TimeoutExpired as hanging:
        said = hanging.stdout or b""
        return said.decode("utf-8", "replace") if isinstance(said, bytes) else said, f"no end after {PATIENCE:g} s"
    if done.returncode < 0:
        try:
            return done.stdout, f"crashes Python ({signal.Signals(-done.returncode).name})"
        except ValueError:
            return done.stdout, f"crashes Python (signal {-done.returncode})"
    return done.stdout, f"ends Python with {done.returncode}" if done.returncode else ""


def _failed(package: str, module: str, how: str) -> Finding:
    remedy = f"pip install --force-reinstall --no-deps {package}"
    if sys.platform == "win32":
        remedy += "; or install Microsoft's Visual C++ Redistributable, which WPILib needs"
    elif "GLIBC" in how:
        remedy = "This system is too old for WPILib: it needs a newer release of your Linux."
    return problem("imports", f"import {module}: {how}", remedy)
