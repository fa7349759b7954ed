"""What the benchmarks share: samples taken in turn, and this pyfrc beside the pyfrc of the 2026 season.

It needs nothing but Python's standard library and a pip that reaches a package index. The two sides get virtual
environments of their own, in a cache directory.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[1]
CACHE = Path(__file__).resolve().with_name(".cache")

ROBOTPY_VERSION = "2026.2.2"
TODAYS = ("pyfrc==2026.0.3", f"robotpy=={ROBOTPY_VERSION}", "pytest")

#: What would make the children behave otherwise than a user's: a fixed hash seed, a path, options, coverage.
CLEANED_FROM_ENVIRONMENT = ("PYTHON", "PYTEST", "PY_COLORS", "COVERAGE", "COV_", "FORCE_COLOR", "VIRTUAL_ENV")


class BenchmarkError(Exception):
    """A side could not be set up, or failed at what was to be measured: there is no figure."""


# -- samples -----------------------------------------------------------------------------------------------------------


def sample_in_turn(takes: Mapping[str, Callable[[], float]], rounds: int) -> dict[str, list[float]]:
    """Take samples of everything in turn, so that what slows the machine down affects all alike."""
    samples: dict[str, list[float]] = {name: [] for name in takes}
    for _ in range(rounds):
        for name, take in takes.items():
            samples[name].append(take())
    return samples


def run(command: list[str], directory: Path, ends_with: int = 0) -> str:
    """Run a child process and return its standard output.

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
    """Return the seconds that a child process takes, from its start to its end.

    :param expected: what it prints when it has done its work
    """
    begin = time.perf_counter()
    output = run(command, directory, ends_with)
    seconds = time.perf_counter() - begin
    if expected not in output:
        raise BenchmarkError(f"{' '.join(command)}\ndid not print {expected!r}, but:\n{output}".rstrip())
    return seconds


# -- the two sides -----------------------------------------------------------------------------------------------------


class Environment:
    """A virtual environment in the cache directory, made by this interpreter."""

    def __init__(self, name: str) -> None:
        version = ".".join(map(str, sys.version_info[:3]))
        self.directory = CACHE / f"{name}-{version}"
        self._scripts = self.directory / ("Scripts" if os.name == "nt" else "bin")

    @property
    def python(self) -> str:
        return self.script("python")

    def script(self, name: str) -> str:
        """Return the path of a command that is installed here."""
        return str(self._scripts / (f"{name}.exe" if os.name == "nt" else name))

    def provide(self, *requirements: str, always: bool = False) -> None:
        """Install `requirements`.

        :param always: install them even when that has been done before
        """
        CACHE.mkdir(parents=True, exist_ok=True)
        (CACHE / ".gitignore").write_text("*\n", "utf-8")
        stamp = self.directory / "installed.json"
        wanted = json.dumps(requirements)
        present = stamp.is_file() and stamp.read_text("utf-8") == wanted
        if present and not always:
            return
        print(f"installing {' '.join(requirements)}", file=sys.stderr, flush=True)
        if not present:
            run([sys.executable, "-m", "venv", "--clear", str(self.directory)], CACHE)
        pip = [self.python, "-m", "pip", "--disable-pip-version-check", "install", "--quiet"]
        run([*pip, *requirements], self.directory)  # pip installs a directory anew, whatever its version
        stamp.write_text(wanted, "utf-8")


# -- the cases ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Case:
    """One comparison.

    :param ours: takes one sample of our side
    :param other: takes one sample of what we are compared with
    :param target: the wording of the target
    :param is_met: decides it, by our median and the ratio of medians
    """

    name: str
    unit: str
    ours: Callable[[], float]
    other: Callable[[], float]
    target: str
    is_met: Callable[[float, float], bool]

    def row(self, rounds: int) -> str:
        """Run each side once to warm up, then both in turn, and return the row of the table."""
        takes = {"ours": self.ours, "other": self.other}
        sample_in_turn(takes, 1)
        samples = sample_in_turn(takes, rounds)
        ratios = [mine / others for mine, others in zip(*samples.values(), strict=True)]
        ours, other = map(statistics.median, samples.values())
        digits = 3 if self.unit == "s" else 0
        figures = "".join(f"{f'{each:.{digits}f} {self.unit}':>16}" for each in (ours, other))
        verdict = "met" if self.is_met(ours, ours / other) else "MISSED"
        span = f"{min(ratios):.3f}..{max(ratios):.3f}"
        return f"{self.name:<36}{figures}{ours / other:>8.3f}   {span:16} {verdict} ({self.target})"


def compare(description: str, make_cases: Callable[[Environment, Environment, Path], list[Case]]) -> None:
    """Measure and print; the exit code says whether there was an error, not whether a target was missed.

    :param make_cases: makes the cases, of our environment, today's, and a directory that exists while they are sampled
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--only", type=int, action="append", help="this row of the table; may be repeated")
    parser.add_argument("--rounds", type=int, default=5, metavar="N", help="samples of each side (default: 5)")
    options = parser.parse_args()
    ours, todays = Environment("ours"), Environment("todays")
    try:
        todays.provide(*TODAYS)
        ours.provide(str(CHECKOUT), always=True)
        load = f"load {os.getloadavg()[0]:.1f}, " if hasattr(os, "getloadavg") else ""
        print(f"{os.cpu_count()} cores, {load}Python {sys.version.split()[0]}; medians of {options.rounds} rounds")
        print(f"\n{'case':<36}{'ours':>16}{'other':>16}{'ratio':>8}   min..max of rounds", flush=True)
        with tempfile.TemporaryDirectory(prefix="pyfrc-speed-") as directory:
            for number, case in enumerate(make_cases(ours, todays, Path(directory).resolve()), 1):
                if not options.only or number in options.only:
                    print(case.row(options.rounds), flush=True)
    except BenchmarkError as error:
        sys.exit(f"error: {error}")
