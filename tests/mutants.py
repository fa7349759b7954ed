"""Mutants: change pyfrc in one place, run the tests that run this line, and see whether one of them fails.

    make mutants ARGS=--map                             once: which tests run which lines; needs Python 3.12
    make mutants ARGS="--seed 1 --each 10"              mutants in random functions of each room
    make mutants ARGS="--seed 1 --room pyfrc_core/sync"
    make mutants ARGS="--at pyfrc_core/wording.py:counted"      all of a function, or of a line: --at FILE:LINE

A mutant that no test notices is a hole in the suite, unless it does what the program does. All happens in a copy of the
working tree, with an environment that finds this copy first. ``--map tests/core/test_a.py`` adds new tests to the map.
"""

from __future__ import annotations

import argparse
import difflib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from pathlib import Path

import touched_lines
from mutant_places import Mutant, mutants_of

ROOT = Path(__file__).resolve().parents[1]
#: The processor time, in seconds, after which a mutant counts as one that never ends: by the time of its tests.
LIMIT = 60.0, 10
#: In so many seconds without any use of the processor, all processes wait for each other. No test waits so long.
IDLE = 90.0


def rooms() -> dict[str, list[str]]:
    """Return the files of each room, but for what needs another season's WPILib."""
    found = defaultdict(list)
    for path in sorted(each for package in ("pyfrc_core", "pyfrc_cli") for each in (ROOT / package).rglob("*.py")):
        name = path.relative_to(ROOT).as_posix()
        if "/season_2027/" not in name:
            found["/".join(name.split("/")[:-1][:2])].append(name)
    return found


def choose(files: Sequence[str], each: int, seed: str) -> list[Mutant]:
    """Choose mutants, each of another function."""
    functions = defaultdict(list)
    for mutant in (mutant for file in files for mutant in mutants_of(file, (ROOT / file).read_bytes())):
        functions[mutant.file, mutant.function].append(mutant)
    chance = random.Random(seed)
    return [chance.choice(functions[name]) for name in chance.sample(sorted(functions), min(each, len(functions)))]


def at(place: str) -> list[Mutant]:
    """Return all mutants of a line or a function, such as ``pyfrc_core/wording.py:counted``."""
    file, _, where = place.partition(":")
    return [each for each in mutants_of(file, (ROOT / file).read_bytes()) if where in (str(each.line), each.function)]


class Map:
    """Which tests run which lines, how many seconds each takes, and the text of each file at that time."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self.seconds, self._lines, self._sources = (
            json.loads(file.read_text("utf-8")) if file.exists() else ({}, {}, {})
        )

    def add(self, directory: Path, tree: Path) -> None:
        """Add what `touched_lines` has recorded; tests that were skipped or have failed are left out."""
        for file in directory.iterdir():
            texts = set(file.read_text("utf-8", errors="replace").splitlines())
            name = next(text[2:] for text in texts if text.startswith("= "))
            parts = {text.split()[1]: text.split()[2:] for text in texts if text.startswith("@ ")}
            if name in self.seconds or [outcome for outcome, _ in parts.values()] != ["passed"] * 3:
                continue
            number = len(self.seconds)
            self.seconds[name] = sum(float(seconds) for _, seconds in parts.values())
            for path, _, line in (text.rpartition(":") for text in texts if text[0] not in "=@"):
                if not path.endswith(".py"):  # a module of the agent
                    path = path.replace(".", "/")
                    path += "/__init__.py" if (tree / path).is_dir() else ".py"
                self._lines.setdefault(f"{path}:{line}", []).append(number)
                if path not in self._sources:
                    self._sources[path] = (tree / path).read_text("utf-8")
        self._file.write_text(json.dumps((self.seconds, self._lines, self._sources)), encoding="utf-8")

    def tests_of(self, mutant: Mutant) -> list[str]:
        """Return the tests that run its line, or else its statement, the quickest first."""
        before = self._sources.get(mutant.file, "").splitlines()
        now = (ROOT / mutant.file).read_text("utf-8").splitlines()
        blocks = difflib.SequenceMatcher(None, before, now, autojunk=False).get_matching_blocks()
        names = list(self.seconds)
        for line in (mutant.line, mutant.statement):
            # Of a line that is new, those of the one before.
            old = max((each.a + min(line - each.b, each.size) for each in blocks if each.b < line), default=0)
            if tests := [names[each] for each in self._lines.get(f"{mutant.file}:{old}", ())]:
                return sorted(tests, key=lambda name: (self.seconds[name], name))
        return []


class Workshop:
    """A copy of the working tree, with an environment whose Python finds this pyfrc before the installed one."""

    def __init__(self, directory: Path) -> None:
        shutil.rmtree(directory, ignore_errors=True)
        self.tree, self._selected, self._changes = directory / "tree", directory / "selected", 0
        listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        for name in subprocess.check_output(listed, cwd=ROOT, text=True).split("\0"):
            if name and (ROOT / name).is_file():
                (self.tree / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, self.tree / name)
        subprocess.run(["git", "init", "--quiet"], cwd=self.tree, check=True)
        environment = directory / "environment"
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", environment], check=True)
        self.python = environment / "bin/python"
        (self.site,) = environment.glob("lib/python*/site-packages")
        installed = next(each for each in sys.path if each.endswith("site-packages"))
        (self.site / "a.pth").write_text(
            f"{self.tree}\nimport site; site.addsitedir({installed!r})\n", encoding="utf-8"
        )

    def pytest(self, *options: str, **variables: str) -> subprocess.Popen[str]:
        """Start pytest in the copy."""
        command = [self.python, "-m", "pytest", "-q", "--tb=no", "-p", "no:cacheprovider", "-p", "touched_lines"]
        environment = {**os.environ, "PYTHONPATH": str(self.tree / "tests"), **variables}
        return subprocess.Popen([*command, *options], cwd=self.tree, env=environment, stdout=subprocess.PIPE, text=True)

    def record(self, map: Map, options: Sequence[str]) -> None:
        """Run tests, and add which lines they run to the map."""
        (directory := self.tree.parent / "touched").mkdir()
        shutil.copy(touched_lines.__file__, self.site)
        recording = f"import touched_lines; touched_lines.record({str(self.tree)!r})\n"
        (self.site / "b.pth").write_text(recording, encoding="utf-8")
        print(self.pytest(*options, **{touched_lines.DIRECTORY: str(directory)}).communicate()[0], flush=True)
        map.add(directory, self.tree)

    def run(self, tests: Sequence[str], seconds: float) -> str:
        """Run tests until one fails, and return which; empty if none does.

        :param seconds: how long they take otherwise
        """
        self._selected.write_text("\n".join(tests), encoding="utf-8")
        files, stopped = dict.fromkeys(test.partition("::")[0] for test in tests), list[str]()
        with self.pytest("-x", "-rfE", *files, **{touched_lines.SELECTED: str(self._selected)}) as process:
            watch = threading.Thread(target=self._watch, args=(process, LIMIT[0] + LIMIT[1] * seconds, stopped))
            watch.start()
            output = process.communicate()[0]
            watch.join()
        failed = re.findall(r"^(?:FAILED|ERROR) (\S+(?: \S+)*?)(?: - .*)?$", output, re.MULTILINE)
        code = [f"pytest's exit code {process.returncode}"] if process.returncode else []
        return next(iter((*stopped, *failed, *code)), "")

    def _watch(self, process: subprocess.Popen[str], limit: float, stopped: list[str]) -> None:
        """End all that a run has started when the run is over, or does not come to its end."""
        used, last_use = dict[int, float](), time.monotonic()
        while process.poll() is None and not stopped:
            time.sleep(0.5)
            before = dict(used)
            used |= self._processes()
            last_use = last_use if used == before else time.monotonic()
            if sum(used.values()) > limit:
                stopped.append(f"the limit of {limit:.0f} s of processor time")
            elif time.monotonic() - last_use > IDLE:
                stopped.append(f"the limit of {IDLE:.0f} s in which nothing happens")
        for pid in self._processes():
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)

    def _processes(self) -> dict[int, float]:
        """Return what runs in the copy, and the processor time that each process has used, in seconds."""
        mark, found = f"{touched_lines.SELECTED}={self._selected}".encode(), {}
        for directory in Path("/proc").glob("[0-9]*"):
            with suppress(OSError, IndexError):
                if mark in (directory / "environ").read_bytes():
                    values = (directory / "stat").read_text("utf-8", "replace").rpartition(")")[2].split()
                    found[int(directory.name)] = (int(values[11]) + int(values[12])) / os.sysconf("SC_CLK_TCK")
        return found

    @contextmanager
    def planted(self, mutant: Mutant) -> Iterator[None]:
        """Have the mutant in the copy, with a time of change that no compiled module has."""
        path = self.tree / mutant.file
        before, times = path.read_bytes(), path.stat()
        self._changes += 1
        path.write_bytes(before[: mutant.start] + mutant.new.encode() + before[mutant.end :])
        os.utime(path, (times.st_atime, times.st_mtime + self._changes))
        try:
            yield
        finally:
            path.write_bytes(before)
            os.utime(path, (times.st_atime, times.st_mtime))

    def verdict(self, mutant: Mutant, tests: Sequence[str], map: Map, most_seconds: float) -> str:
        """Return what became of a mutant.

        :param most_seconds: how long its tests may take; the slower ones are left out, but for the first three
        """
        chosen = [
            test for n, test in enumerate(tests, 1) if n <= 3 or sum(map.seconds[t] for t in tests[:n]) < most_seconds
        ]
        if not chosen:
            return "SURVIVES: no test runs it"
        with self.planted(mutant):
            failed = self.run(chosen, sum(map.seconds[test] for test in chosen))
        return f"killed by {failed}" if failed else f"SURVIVES {len(chosen)} of its {len(tests)} tests"


def main(words: Sequence[str]) -> int:
    """Make the map; or try mutants, print a line for each, and a table of rooms."""
    parser = argparse.ArgumentParser("mutants", description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--map", action="store_true", help="run tests, and see which lines they run")
    parser.add_argument("--seed", default="1", help="what the choice depends on (%(default)s)")
    parser.add_argument("--each", type=int, default=10, help="how many mutants of each room (%(default)s)")
    parser.add_argument("--room", action="append", help="a directory or a file; by default all rooms")
    parser.add_argument("--at", action="append", default=[], help="all mutants of FILE:LINE or FILE:FUNCTION")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds of tests for each mutant (%(default)s)")
    parser.add_argument("--jobs", type=int, default=2, help="how many mutants at a time (%(default)s)")
    parser.add_argument("--scratch", type=Path, default=ROOT / "build/mutants", help="a directory (%(default)s)")
    options, rest = parser.parse_known_args(words)
    map = Map(options.scratch.resolve() / "map.json")
    if options.map:
        if sys.version_info < (3, 12):
            parser.error(
                "the map needs Python 3.12 or newer: make mutants PYTHON=python3.13 VENV=.venv-3.13 ARGS=--map"
            )
        Workshop(options.scratch.resolve() / "mapping").record(map, rest or ["-n", str(options.jobs)])
        return 0
    if not map.seconds:
        parser.error("first see which tests run which lines: make mutants ARGS=--map")
    mutants = [mutant for place in options.at for mutant in at(place)]
    for room in [] if options.at else options.room or sorted(rooms()):
        files = [file for files in rooms().values() for file in files if file.startswith(room)]
        mutants += choose(rooms().get(room, files), options.each, f"{options.seed} {room}")
    workshops = [Workshop(options.scratch.resolve() / f"job{number}") for number in range(options.jobs)]
    tests = [map.tests_of(mutant) for mutant in mutants]
    some = [names[0] for names in tests if names][:1]
    if some and (failed := workshops[0].run(some, 0.0)):
        parser.error(f"without a mutant, this fails: {failed}")
    killed, killers = defaultdict[str, list[bool]](list), dict[str, float]()

    def try_out(mutant: Mutant, tests: Sequence[str]) -> None:
        workshop = workshops.pop()
        verdict = workshop.verdict(mutant, tests, map, options.limit)
        workshops.append(workshop)
        print(f"{mutant}\n    {verdict}", flush=True)
        for room in ("/".join(mutant.file.split("/")[:-1][:2]), "~ all"):
            killed[room].append(verdict.startswith("killed"))
        if (killer := verdict.removeprefix("killed by ")) in map.seconds:
            killers[killer] = map.seconds[killer]

    with ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(try_out, mutants, tests))
    for room, each in sorted(killed.items()):
        print(f"{room:28} {sum(each):4} of {len(each):4} killed")
    if killers and (failed := workshops[0].run(list(killers), sum(killers.values()))):
        print(f"Do not believe this: without a mutant, {failed} fails, too.")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
