"""Mutants: change one place of pyfrc, run the tests that touch its line, and see whether one of them fails.

    make mutants ARGS=--map                                 once: see which tests run which lines; needs Python 3.12
    make mutants ARGS="--seed 1 --each 10"                  ten mutants in random functions of each room
    make mutants ARGS="--seed 1 --each 30 --room pyfrc_core/sync"
    make mutants ARGS="--at pyfrc_core/wording.py:20"       every mutant of that line

A mutant that no test notices is a hole in the suite, unless it does the same as the program. All happens in a copy of the
working tree, with an environment that finds that copy first. ``--map tests/core/test_a.py`` adds new tests to the map.
"""

from __future__ import annotations

import argparse
import ast
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
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress

from dataclasses import dataclass
from pathlib import Path

import touched_lines

ROOT = Path(__file__).resolve().parents[1]
#: Of a test's own time, after which a mutant counts as one that never ends: processor time, which no busy machine uses up.
TIMES, AND_SECONDS = 10, 60.0
#: Wall-clock seconds without any use of the processor, after which all wait for each other. No test waits so long.
IDLE = 90.0

_OTHER: dict[type[ast.AST], tuple[str, str]] = {
    ast.Lt: ("<", "<="), ast.LtE: ("<=", "<"), ast.Gt: (">", ">="), ast.GtE: (">=", ">"),
    ast.Eq: ("==", "!="), ast.NotEq: ("!=", "=="), ast.Is: ("is", "is not"), ast.IsNot: ("is not", "is"),
    ast.In: ("in", "not in"), ast.NotIn: ("not in", "in"), ast.And: ("and", "or"), ast.Or: ("or", "and"),
    ast.Add: ("+", "-"), ast.Sub: ("-", "+"), ast.Mult: ("*", "/"), ast.Div: ("/", "*"),
    ast.FloorDiv: ("//", "/"), ast.Mod: ("%", "*"), ast.BitOr: ("|", "&"), ast.BitAnd: ("&", "|"),
}  # fmt: skip


@dataclass(frozen=True)
class Mutant:
    """One change of one file: these bytes become the new ones."""

    file: str
    function: str
    kind: str
    line: int
    statement: int
    start: int
    end: int
    old: str
    new: str

    def __str__(self) -> str:
        old, new = (" ".join(each.split()) for each in (self.old, self.new))
        return f"{self.file}:{self.line} {self.function}, {self.kind}: {old} -> {new}"


class Finder(ast.NodeVisitor):
    """All mutants in the functions of a file."""

    def __init__(self, file: str, source: bytes) -> None:
        self._file = file
        self._source = source
        self._starts = [0]
        for line in source.splitlines(keepends=True):
            self._starts.append(self._starts[-1] + len(line))
        self._names: list[str] = []
        self._in_function = False
        self._statement = 0
        self.found: list[Mutant] = []
        self.visit(ast.parse(source))

    def visit(self, node: ast.AST) -> None:
        """Change this node, then those in it; not types, defaults and other text that no test calls."""
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            self._enter(node)
            return
        if isinstance(node, (ast.Assert, ast.Raise, ast.JoinedStr, ast.Import, ast.ImportFrom)) or _is_text(node):
            return
        if isinstance(node, ast.stmt):
            self._statement = node.lineno
        if self._in_function:
            self._change(node)
        for name, value in ast.iter_fields(node):
            if name not in ("annotation", "type_params"):
                for each in value if isinstance(value, list) else [value]:
                    if isinstance(each, ast.AST):
                        self.visit(each)

    def _enter(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) -> None:
        before = self._in_function
        self._in_function = before or not isinstance(node, ast.ClassDef)
        self._names.append(node.name)
        for each in node.body:
            self.visit(each)
        self._names.pop()
        self._in_function = before

    def _change(self, node: ast.AST) -> None:
        if isinstance(node, ast.Compare) and len(node.ops) == 1:
            self._operator(node.left, node.ops[0], node.comparators[0])
        elif isinstance(node, ast.BinOp):
            self._operator(node.left, node.op, node.right)
        elif isinstance(node, ast.BoolOp):
            self._operator(node.values[0], node.op, node.values[1])
        elif isinstance(node, ast.Constant):
            self._constant(node)
        elif isinstance(node, (ast.If, ast.While, ast.IfExp)):
            self._add("condition", node.test, f"(not ({self._text(node.test)}))")
        elif isinstance(node, ast.comprehension):
            for test in node.ifs:
                self._add("condition", test, f"(not ({self._text(test)}))")
        elif isinstance(node, ast.Return) and node.value is not None and not _is_none(node.value):
            self._add("return", node.value, "None")
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
            self._add("call", node, "pass")

    def _constant(self, node: ast.Constant) -> None:
        value = node.value
        if isinstance(value, bool):
            self._add("constant", node, str(not value))
        elif isinstance(value, (int, float)):
            self._add("constant", node, repr(value + 1))
        elif isinstance(value, str) and value and not re.search(r"\s", value):
            self._add("constant", node, repr(f"{value}X"))

    def _operator(self, left: ast.expr, operator: ast.AST, right: ast.expr) -> None:
        if type(operator) in _OTHER:
            old, new = _OTHER[type(operator)]
            start, end = self._place(left)[1], self._place(right)[0]
            between = self._source[start:end].decode()
            changed = re.sub(r"\s+".join(map(re.escape, old.split())), new, between, count=1)
            self._append("operator", left.end_lineno or left.lineno, start, end, changed)

    def _add(self, kind: str, node: ast.expr | ast.stmt, new: str) -> None:
        self._append(kind, node.lineno, *self._place(node), new)

    def _append(self, kind: str, line: int, start: int, end: int, new: str) -> None:
        old = self._source[start:end].decode()
        self.found.append(Mutant(self._file, ".".join(self._names), kind, line, self._statement, start, end, old, new))

    def _text(self, node: ast.expr) -> str:
        start, end = self._place(node)
        return self._source[start:end].decode()

    def _place(self, node: ast.expr | ast.stmt) -> tuple[int, int]:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        return self._starts[node.lineno - 1] + node.col_offset, self._starts[node.end_lineno - 1] + node.end_col_offset


def _is_none(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def _is_text(node: ast.AST) -> bool:
    """Whether this is a docstring, or what only a type checker reads."""
    if isinstance(node, ast.If):
        return isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


# -- what to change ----------------------------------------------------------------------------------------------------


def rooms() -> dict[str, list[str]]:
    """The files of each room; what another season's WPILib needs is left out."""
    found = defaultdict(list)
    for package in ("pyfrc_core", "pyfrc_cli"):
        for path in sorted((ROOT / package).rglob("*.py")):
            name = path.relative_to(ROOT).as_posix()
            if "/season_2027/" not in name and "/vendor/" not in name:
                parts = name.split("/")
                found["/".join(parts[:2] if package == "pyfrc_core" and len(parts) > 2 else parts[:1])].append(name)
    return found


def mutants_of(file: str) -> list[Mutant]:
    """Every mutant of a file."""
    return Finder(file, (ROOT / file).read_bytes()).found


def choose(files: Iterable[str], each: int, seed: str) -> list[Mutant]:
    """Choose mutants: each in another random function, as long as there are others."""
    chance = random.Random(seed)
    functions = defaultdict(list)
    for mutant in (mutant for file in files for mutant in mutants_of(file)):
        functions[mutant.file, mutant.function].append(mutant)
    names = sorted(functions)
    return [chance.choice(functions[name]) for name in chance.sample(names, min(each, len(names)))]


# -- which tests -------------------------------------------------------------------------------------------------------


class Map:
    """Which tests ran which lines, how many seconds each took, and the text of each file then."""

    def __init__(self, file: Path) -> None:
        self._file = file
        stored = json.loads(file.read_text("utf-8")) if file.exists() else {"seconds": {}, "lines": {}, "sources": {}}
        self.seconds: dict[str, float] = stored["seconds"]
        self._lines: dict[str, list[int]] = stored["lines"]
        self._sources: dict[str, str] = stored["sources"]

    def add(self, directory: Path, tree: Path) -> None:
        """Add what `touched_lines` has recorded; a test that was skipped or has failed is left out."""
        for file in directory.iterdir():
            texts = set(file.read_text("utf-8", errors="replace").splitlines())
            (name,) = (text[2:] for text in texts if text.startswith("= "))
            parts = {text.split()[1]: text.split()[2:] for text in texts if text.startswith("@ ")}
            if name in self.seconds or [outcome for outcome, _ in parts.values()] != ["passed"] * 3:
                continue
            number = len(self.seconds)
            self.seconds[name] = sum(float(seconds) for _, seconds in parts.values())
            for text in texts:
                if text[0] not in "=@":
                    path, _, line = text.rpartition(":")
                    if not path.endswith(".py"):  # the agent's modules
                        path = path.replace(".", "/")
                        path += "/__init__.py" if (tree / path).is_dir() else ".py"
                    self._lines.setdefault(f"{path}:{line}", []).append(number)
                    if path not in self._sources:
                        self._sources[path] = (tree / path).read_text("utf-8")
        content = {"seconds": self.seconds, "lines": self._lines, "sources": self._sources}
        self._file.write_text(json.dumps(content), encoding="utf-8")

    def tests_of(self, mutant: Mutant) -> list[str]:
        """Return the tests that touch its line, or else its statement, the quickest first."""
        before = self._sources.get(mutant.file, "").splitlines()
        after = (ROOT / mutant.file).read_text("utf-8").splitlines()
        names = list(self.seconds)
        for line in (mutant.line, mutant.statement):
            for block in difflib.SequenceMatcher(None, before, after, autojunk=False).get_matching_blocks():
                if block.b < line <= block.b + block.size:
                    tests = [names[each] for each in self._lines.get(f"{mutant.file}:{block.a + line - block.b}", ())]
                    if tests:
                        return sorted(tests, key=lambda name: (self.seconds[name], name))
        return []


# -- trying them -------------------------------------------------------------------------------------------------------


class Workshop:
    """A copy of the working tree, with an environment whose Python finds this pyfrc before the installed one."""

    def __init__(self, directory: Path) -> None:
        self.tree = directory / "tree"
        self._environment = directory / "environment"
        self._selected = directory / "selected"
        self._changes = 0
        self.python = self._environment / "bin/python"
        shutil.rmtree(directory, ignore_errors=True)
        listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        for name in subprocess.check_output(listed, cwd=ROOT, text=True).split("\0"):
            if name and (ROOT / name).is_file():
                (self.tree / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, self.tree / name)
        subprocess.run(["git", "init", "--quiet"], cwd=self.tree, check=True)
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", self._environment], check=True)
        (self.site,) = self._environment.glob("lib/python*/site-packages")
        theirs = next(each for each in sys.path if each.endswith("site-packages"))
        lines = (str(self.tree), f"import site; site.addsitedir({theirs!r})")
        (self.site / "a_pyfrc.pth").write_text("\n".join(lines), encoding="utf-8")

    def pytest(self, *options: str, **environment: str) -> subprocess.Popen[str]:
        """Start pytest in the copy."""
        command = [
            self.python,
            "-m",
            "pytest",
            "-q",
            "--tb=no",
            "-p",
            "no:cacheprovider",
            "-p",
            "touched_lines",
            *options,
        ]
        variables = {**os.environ, "PYTHONPATH": str(self.tree / "tests"), **environment}
        return subprocess.Popen(command, cwd=self.tree, env=variables, stdout=subprocess.PIPE, text=True)

    def record(self, map: Map, options: Sequence[str]) -> None:
        """Run tests, and add which lines they run to the map."""
        directory = self.tree.parent / "touched"
        directory.mkdir()
        shutil.copy(touched_lines.__file__, self.site)
        starting = f"import touched_lines; touched_lines.record({str(self.tree)!r})"
        (self.site / "b_touched.pth").write_text(starting, encoding="utf-8")
        print(self.pytest(*options, **{touched_lines.DIRECTORY: str(directory)}).communicate()[0], flush=True)
        map.add(directory, self.tree)

    def run(self, tests: Sequence[str], seconds: float) -> str:
        """Run tests until one fails, and say which; empty if none does.

        :param seconds: how long they take otherwise
        """
        self._selected.write_text("\n".join(tests), encoding="utf-8")
        files = dict.fromkeys(test.partition("::")[0] for test in tests)
        with self.pytest("-x", "-rfE", *files, **{touched_lines.SELECTED: str(self._selected)}) as process:
            why: list[str] = []
            watch = threading.Thread(target=self._watch, args=(process, TIMES * seconds + AND_SECONDS, why))
            watch.start()
            output = process.communicate()[0]
            watch.join()
        if why:
            return why[0]
        failed = re.findall(r"^(?:FAILED|ERROR) (\S+(?: \S+)*?)(?: - .*)?$", output, re.MULTILINE)
        return failed[0] if failed else f"pytest's exit code {process.returncode}" if process.returncode else ""

    def _watch(self, process: subprocess.Popen[str], limit: float, why: list[str]) -> None:
        """Stop everything that this run has started when the run has ended, or when it does not get to its end."""
        used: dict[int, float] = {}
        last_use = time.monotonic()
        while process.poll() is None:
            time.sleep(0.5)
            before = dict(used)
            used.update(self._processes())
            if used != before:
                last_use = time.monotonic()
            if sum(used.values()) > limit:
                why.append(f"stopped after {limit:.0f} s of processor time")
            elif time.monotonic() - last_use > IDLE:
                why.append(f"stopped after {IDLE:.0f} s in which nothing happened")
            if why:
                break
        for pid in self._processes():
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)

    def _processes(self) -> dict[int, float]:
        """Return the processes that run in the copy, and the processor time that each has used, in seconds."""
        mark = f"{touched_lines.SELECTED}={self._selected}".encode()
        found = {}
        for directory in Path("/proc").glob("[0-9]*"):
            with suppress(OSError, IndexError):
                if mark in (directory / "environ").read_bytes():
                    values = (directory / "stat").read_text().rpartition(")")[2].split()
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


def try_out(workshop: Workshop, mutant: Mutant, map: Map, limit: float) -> str:
    """Return the verdict on a mutant.

    :param limit: seconds that its tests may take by the map; the slower ones are left out
    """
    tests = map.tests_of(mutant)
    chosen, seconds = [], 0.0
    for test in tests:
        seconds += map.seconds[test]
        if seconds > limit and len(chosen) >= 3:
            break
        chosen.append(test)
    if not tests:
        return "SURVIVES: no test runs it"
    with workshop.planted(mutant):
        failed = workshop.run(chosen, sum(map.seconds[test] for test in chosen))
    return f"killed by {failed}" if failed else f"SURVIVES {len(chosen)} of its {len(tests)} tests"


def main(words: Sequence[str]) -> int:
    """Make the map, or try mutants and print a line for each and a table of rooms."""
    parser = argparse.ArgumentParser(
        prog="make mutants", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--map", action="store_true", help="run tests, and see which lines they run")
    parser.add_argument("--seed", default="1", help="what the choice depends on (%(default)s)")
    parser.add_argument("--each", type=int, default=10, help="how many mutants of each room (%(default)s)")
    parser.add_argument("--room", action="append", help="a package or a module; all rooms if it is not given")
    parser.add_argument("--at", action="append", help="all mutants of FILE:LINE or FILE:FUNCTION")
    parser.add_argument("--limit", type=float, default=60, help="seconds of tests for each mutant (%(default)s)")
    parser.add_argument("--jobs", type=int, default=2, help="how many mutants are tried at a time (%(default)s)")
    parser.add_argument("--scratch", type=Path, default=ROOT / "build/mutants", help="a directory (%(default)s)")
    options, rest = parser.parse_known_args(words)
    scratch = options.scratch.resolve()
    map = Map(scratch / "map.json")
    if options.map:
        if sys.version_info < (3, 12):
            parser.error(
                "the map needs Python 3.12 or newer: make mutants PYTHON=python3.13 VENV=.venv-3.13 ARGS=--map"
            )
        Workshop(scratch / "mapping").record(map, rest or ["-n", str(options.jobs), "--dist", "worksteal"])
        return 0
    if not map.seconds:
        parser.error("there is no map of lines and tests yet: make mutants ARGS=--map")
    if options.at:
        chosen = [mutant for place in options.at for mutant in _at(place)]
    else:
        asked = {room: files for room, files in rooms().items() if room in (options.room or [room])}
        for module in {*(options.room or ())} - {*asked}:
            asked[module] = [file for files in rooms().values() for file in files if file.startswith(module)]
        chosen = [
            each for room in sorted(asked) for each in choose(asked[room], options.each, f"{options.seed} {room}")
        ]
    workshops = [Workshop(scratch / f"job{number}") for number in range(options.jobs)]

    def verdict(mutant: Mutant) -> str:
        workshop = workshops.pop()
        try:
            found = try_out(workshop, mutant, map, options.limit)
        finally:
            workshops.append(workshop)
        print(f"{mutant}\n    {found}", flush=True)
        return found

    with ThreadPoolExecutor(options.jobs) as pool:
        verdicts = list(pool.map(verdict, chosen))
    _print_table(chosen, verdicts)
    return 0


def _at(place: str) -> list[Mutant]:
    file, _, where = place.partition(":")
    return [each for each in mutants_of(file) if where in (str(each.line), each.function)]


def _print_table(mutants: Sequence[Mutant], verdicts: Sequence[str]) -> None:
    killed: dict[str, list[bool]] = defaultdict(list)
    for mutant, found in zip(mutants, verdicts, strict=True):
        room = "/".join(mutant.file.split("/")[:-1][:2])
        for each in (room, "all"):
            killed[each].append(found.startswith("killed"))
    for room, each in sorted(killed.items(), key=lambda item: (item[0] == "all", item[0])):
        print(f"{room:28} {sum(each):4} of {len(each):4} killed")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
