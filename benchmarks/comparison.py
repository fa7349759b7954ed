"""Compares this pyfrc with the pyfrc of the 2026 season, side by side on this machine: what the benchmarks share.

It needs nothing but Python's standard library and a pip that reaches a package index. The two sides get virtual
environments of their own, in a cache directory.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

CHECKOUT = Path(__file__).resolve().parents[1]

ROBOTPY_VERSION = "2026.2.2"
TODAYS = ("pyfrc==2026.0.3", f"robotpy=={ROBOTPY_VERSION}", "pytest")

#: What would make the children behave otherwise than a user's: a fixed hash seed, a path, options, coverage.
CLEANED_FROM_ENVIRONMENT = ("PYTHON", "PYTEST", "PY_COLORS", "COVERAGE", "COV_", "FORCE_COLOR", "VIRTUAL_ENV")


class BenchmarkError(Exception):
    """A side could not be set up, or failed at what was to be timed: there is no figure to give."""


# -- child processes ---------------------------------------------------------------------------------------------------


def run(command: list[str], directory: Path, ends_with: int = 0) -> str:
    """Run a child and answer what it printed, standard output only.

    :param ends_with: the exit code that means success
    :raises BenchmarkError: with all that it printed, when it ends otherwise
    """
    environment = {key: text for key, text in os.environ.items() if not key.startswith(CLEANED_FROM_ENVIRONMENT)}
    done = subprocess.run(
        command, cwd=directory, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False
    )
    if done.returncode != ends_with:
        what = f"{' '.join(command)}\nended with exit code {done.returncode}"
        raise BenchmarkError(f"{what}\n{done.stdout}{done.stderr}".rstrip())
    return done.stdout


def timed(command: list[str], directory: Path, expected: str, ends_with: int = 0) -> float:
    """The seconds that a child takes, from its start to its end.

    :param expected: what it prints when it has done its work
    """
    begin = time.perf_counter()
    output = run(command, directory, ends_with)
    seconds = time.perf_counter() - begin
    if expected not in output:
        raise BenchmarkError(f"{' '.join(command)}\ndid not print {expected!r}, but:\n{output}".rstrip())
    return seconds


def tell(text: str) -> None:
    """Tell of progress, apart from the figures."""
    print(text, file=sys.stderr, flush=True)


# -- the two sides -----------------------------------------------------------------------------------------------------


class Environment:
    """A virtual environment in the cache directory, made by this interpreter."""

    def __init__(self, cache: Path, name: str) -> None:
        version = ".".join(map(str, sys.version_info[:3]))
        self.directory = cache / f"{name}-{version}"
        self._scripts = self.directory / ("Scripts" if os.name == "nt" else "bin")

    @property
    def python(self) -> str:
        return self.script("python")

    def script(self, name: str) -> str:
        """The path of a command that is installed here."""
        return str(self._scripts / (f"{name}.exe" if os.name == "nt" else name))

    def provide(self, *requirements: str, always: bool = False) -> None:
        """Have `requirements` installed.

        :param always: install them even when that has been done before
        """
        stamp = self.directory / "installed.json"
        wanted = json.dumps(requirements)
        present = stamp.is_file() and stamp.read_text("utf-8") == wanted
        if present and not always:
            return
        tell(f"installing {' '.join(requirements)}")
        if not present:
            run([sys.executable, "-m", "venv", "--clear", str(self.directory)], self.directory.parent)
        pip = [self.python, "-m", "pip", "--disable-pip-version-check", "install", "--quiet"]
        run([*pip, *requirements], self.directory)  # pip installs a directory anew, whatever its version
        stamp.write_text(wanted, "utf-8")

    def versions(self, *packages: str) -> dict[str, str]:
        """What is installed of these packages."""
        code = "import sys, importlib.metadata as m; print(*map(m.version, sys.argv[1:]))"
        printed = run([self.python, "-c", code, *packages], self.directory)
        return dict(zip(packages, printed.split(), strict=True))


def make_cache(cache: Path) -> None:
    """Make the directory of the environments, which git ignores."""
    cache.mkdir(parents=True, exist_ok=True)
    (cache / ".gitignore").write_text("*\n", "utf-8")


def provide_environments(cache: Path) -> tuple[Environment, Environment]:
    """Ours and today's, ready to be used."""
    make_cache(cache)
    ours, todays = Environment(cache, "ours"), Environment(cache, "todays")
    todays.provide(*TODAYS)
    ours.provide(str(CHECKOUT), always=True)
    return ours, todays


# -- the cases ---------------------------------------------------------------------------------------------------------


@dataclass
class Case:
    """One comparison, and what came of it.

    :param ours: takes one sample of our side
    :param other: takes one sample of what we are compared with
    :param target: the wording of the target
    :param is_met: decides it, by our median and the ratio of medians
    """

    number: int
    name: str
    unit: str
    ours: Callable[[], float]
    other: Callable[[], float]
    target: str
    is_met: Callable[[float, float], bool]
    our_samples: list[float] = field(default_factory=list)
    other_samples: list[float] = field(default_factory=list)

    def sample(self, rounds: int) -> None:
        """One run of each to warm up, then both in turn: what slows the machine down meets both."""
        tell(f"case {self.number}: {self.name}")
        self.ours()
        self.other()
        for _ in range(rounds):
            self.our_samples.append(self.ours())
            self.other_samples.append(self.other())

    def result(self) -> dict[str, Any]:
        """The samples and what follows from them, for `--json` and for the table."""
        ours, other = statistics.median(self.our_samples), statistics.median(self.other_samples)
        ratios = [mine / others for mine, others in zip(self.our_samples, self.other_samples, strict=True)]
        return {
            "case": self.number,
            "name": self.name,
            "unit": self.unit,
            "our_samples": self.our_samples,
            "other_samples": self.other_samples,
            "our_median": ours,
            "other_median": other,
            "ratio": ours / other,
            "ratio_min": min(ratios),
            "ratio_max": max(ratios),
            "target": self.target,
            "met": self.is_met(ours, ours / other),
        }


def print_table(machine: dict[str, Any], results: list[dict[str, Any]], rounds: int) -> None:
    """The figures, for people."""
    host = f"{machine['cores']} cores (load {machine['load']}), Python {machine['python']}, {machine['platform']}"
    print(f"{host}; {rounds} rounds, medians")
    for side in ("ours", "todays"):
        print(f"{side}: " + ", ".join(f"{name} {version}" for name, version in machine[side].items()))
    print(f"\n{'case':<43}{'ours':>16}{'other':>16}{'ratio':>8}   min..max of rounds")
    for each in results:
        digits = 3 if each["unit"] == "s" else 0
        mine, others = (f"{each[key]:.{digits}f} {each['unit']}" for key in ("our_median", "other_median"))
        span = f"{each['ratio_min']:.3f}..{each['ratio_max']:.3f}"
        print(f"{each['case']}  {each['name']:<40}{mine:>16}{others:>16}{each['ratio']:>8.3f}   {span}")
    print()
    for each in results:
        print(f"case {each['case']}: {'met' if each['met'] else 'MISSED'} ({each['target']})")


def parse_arguments(description: str, cases: int) -> argparse.Namespace:
    """The command line of a comparison of so many cases."""
    numbers = range(1, cases + 1)
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--only", type=int, choices=numbers, action="append", help="this case; may be repeated")
    parser.add_argument("--rounds", type=int, default=5, metavar="N", help="samples of each side (default: 5)")
    parser.add_argument("--cache", type=Path, default=Path(__file__).with_name(".cache"), help="for the environments")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all samples there")
    arguments = parser.parse_args()
    if arguments.rounds < 1:
        parser.error("--rounds must be 1 or more")
    return arguments


def compare(description: str, cases: int, make_cases: Callable[[Environment, Environment, Path], list[Case]]) -> None:
    """Measure, print; the exit code tells of errors only, not of targets missed.

    :param cases: how many there are
    :param make_cases: makes them, of our environment, today's, and a directory that is there while they are sampled
    """
    arguments = parse_arguments(description, cases)
    try:
        _compare(arguments, make_cases)
    except BenchmarkError as error:
        sys.exit(f"error: {error}")


def _compare(arguments: argparse.Namespace, make_cases: Callable[[Environment, Environment, Path], list[Case]]) -> None:
    ours, todays = provide_environments(arguments.cache.resolve())
    machine = {
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        "platform": platform.system(),
        # Of what else goes on here, before anything is measured; Windows does not know it.
        "load": round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else None,
        "ours": ours.versions("pyfrc", "wpilib", "pytest"),
        "todays": todays.versions("pyfrc", "robotpy", "wpilib", "pytest"),
    }
    with tempfile.TemporaryDirectory(prefix="pyfrc-speed-") as directory:
        cases = make_cases(ours, todays, Path(directory).resolve())
        chosen = [case for case in cases if not arguments.only or case.number in arguments.only]
        for case in chosen:
            case.sample(arguments.rounds)
    results = [case.result() for case in chosen]
    print_table(machine, results, arguments.rounds)
    if arguments.json:
        arguments.json.write_text(json.dumps({"machine": machine, "cases": results}, indent=2) + "\n", "utf-8")
