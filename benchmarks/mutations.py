"""Change the core in one place at a time, and see whether a direct test notices.

    python benchmarks/mutations.py --sample 40

Draws mutants with a fixed seed from the rooms in `ROOMS`, and runs for each the tests in `TESTS` that execute the
changed line, in a copy of this repository, until one fails. A line that no test executes is a survivor at once. Linux
only, and one process at a time, at the lowest priority.
"""

from __future__ import annotations

import argparse
import ast
import compileall
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from py_compile import PycInvalidationMode

REPOSITORY = Path(__file__).resolve().parents[1]
#: What is changed.
ROOMS = ("runtime", "hal", "processes", "deploy/agent")
#: What has to notice.
TESTS = (
    "tests/core",
    "tests/test_hal_data.py",
    "tests/test_hal_paths.py",
    "tests/test_hal_recording.py",
    "tests/test_deploy_watching.py",
)
COPIED = ("pyfrc", "pyfrc_cli", "pyfrc_core", "tests", "pyproject.toml")

#: Seconds of processor time that the tests of a mutant have, and seconds without any after which they hang.
CPU_LIMIT, HANG = 20, 5.0

KILLED, SURVIVED, NOT_RUN = "killed", "survived", "survived, not run"


# -- the mutants ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Mutant:
    """One change: the text from `start` to `end` (bytes) of a file becomes `text`."""

    file: str
    line: int
    statement: int  # the line at which its statement begins
    start: int
    end: int
    before: str
    text: str

    def apply(self, source: bytes) -> bytes:
        return source[: self.start] + self.text.encode() + source[self.end :]

    def __str__(self) -> str:
        short = [" ".join(text.split())[:60] for text in (self.before, self.text)]
        return f"{self.file}:{self.line}  {short[0]}  =>  {short[1]}"


_COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
_ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.FloorDiv,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.FloorDiv,
}
#: Assignments that say nothing about behaviour.
_NOT_BEHAVIOUR = {"__tracebackhide__", "__slots__", "__hash__"}


def changes_of(node: ast.AST) -> Iterator[ast.AST]:
    """What a node may become."""
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        for other in _COMPARISONS[type(node.ops[0])]:
            yield ast.Compare(node.left, [other()], node.comparators)
    elif isinstance(node, ast.BoolOp):
        yield ast.BoolOp(ast.Or() if isinstance(node.op, ast.And) else ast.And(), node.values)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        yield node.operand
    elif isinstance(node, ast.BinOp) and type(node.op) in _ARITHMETIC:
        yield ast.BinOp(node.left, _ARITHMETIC[type(node.op)](), node.right)
    elif isinstance(node, ast.Constant) and type(node.value) is bool:
        yield ast.Constant(not node.value)
    elif isinstance(node, ast.Constant) and type(node.value) in (int, float):
        yield ast.Constant(node.value + 1)
        yield ast.Constant(node.value - 1)
    elif isinstance(node, ast.Call) and len(node.args) > 1 and not any(isinstance(a, ast.Starred) for a in node.args):
        yield ast.Call(node.func, [node.args[1], node.args[0], *node.args[2:]], node.keywords)
    elif isinstance(node, (ast.If, ast.While, ast.IfExp)):
        pass  # their conditions, below
    elif isinstance(node, ast.Return) and node.value is not None and not _is_none(node.value):
        yield ast.Return(ast.Constant(None))
    elif isinstance(node, (ast.Assign, ast.AugAssign, ast.Raise, ast.Delete, ast.Expr)):
        yield ast.Pass()


def mutants_of(file: str, source: bytes) -> Iterator[Mutant]:
    """All mutants of one file, in their order."""
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    tree = ast.parse(source)
    statements = {
        part: statement.lineno
        for statement in ast.walk(tree)  # which comes to inner statements later
        if isinstance(statement, ast.stmt)
        for part in ast.walk(statement)
    }

    def mutant(node: ast.expr | ast.stmt, text: str) -> Mutant:
        start = starts[node.lineno - 1] + node.col_offset
        end = starts[(node.end_lineno or node.lineno) - 1] + (node.end_col_offset or 0)
        return Mutant(file, node.lineno, statements[node], start, end, source[start:end].decode(), text)

    for node in _code(tree):
        if isinstance(node, (ast.If, ast.While, ast.IfExp)):
            yield mutant(node.test, f"(not ({ast.unparse(node.test)}))")
        for change in changes_of(node):
            text = ast.unparse(ast.fix_missing_locations(change))
            yield mutant(node, text if isinstance(change, ast.stmt) else f"({text})")  # type: ignore[arg-type]


def _code(node: ast.AST) -> Iterator[ast.AST]:
    """The nodes that run, on Linux: no docstrings, annotations, imports for types, and no other systems' branches."""
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "bases"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST) and not _is_left_out(child):
                yield child
                if isinstance(child, ast.If) and _is_of_another_system(child.test):
                    for other in child.orelse:
                        yield other
                        yield from _code(other)
                    continue
                yield from _code(child)


def _is_left_out(node: ast.AST) -> bool:
    if isinstance(node, ast.Expr):
        return isinstance(node.value, ast.Constant)
    if isinstance(node, ast.Assign):
        return isinstance(node.targets[0], ast.Name) and node.targets[0].id in _NOT_BEHAVIOUR
    if isinstance(node, ast.If):
        return isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
    return isinstance(node, ast.JoinedStr)  # the words of a message


def _is_of_another_system(test: ast.expr) -> bool:
    return ast.unparse(test) in ("sys.platform == 'win32'", "sys.platform == 'darwin'")


def _is_none(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def all_mutants() -> list[Mutant]:
    """Those of all rooms that there are."""
    found: list[Mutant] = []
    for room in ROOMS:
        for file in sorted((REPOSITORY / "pyfrc_core" / room).rglob("*.py")):
            name = file.relative_to(REPOSITORY).as_posix()
            found += mutants_of(name, file.read_bytes())
    return found


# -- the tests -----------------------------------------------------------------------------------------------------


class Copy:
    """A copy of the repository, in which tests run in forks of this process."""

    def __init__(self, directory: Path) -> None:
        self.path = directory
        for name in COPIED:
            source = REPOSITORY / name
            if source.is_dir():
                shutil.copytree(source, directory / name, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(source, directory)
        # A compiled file is good for its source's very content, whatever the time of that.
        compileall.compile_dir(directory, quiet=2, invalidation_mode=PycInvalidationMode.CHECKED_HASH)
        os.environ["PYTHONPATH"] = str(directory)
        os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
        sys.dont_write_bytecode = True
        sys.path.insert(0, str(directory))

    def run(self, do: Callable[[], int], output: Path, cpu_limit: int = CPU_LIMIT) -> int:
        """Call a function in a fork, in the copy; return its exit code, negative where a signal has ended it."""
        process = os.fork()
        if not process:
            code = 70
            try:
                os.setsid()
                resource.setrlimit(resource.RLIMIT_CPU, (cpu_limit, cpu_limit))
                os.chdir(self.path)
                with output.open("wb") as stream:
                    os.dup2(stream.fileno(), 1)
                    os.dup2(stream.fileno(), 2)
                code = do()
            except BaseException:
                traceback.print_exc()
            finally:
                sys.stdout.flush()
                sys.stderr.flush()
                os._exit(code)
        _end_if_it_hangs(process)
        _, status = os.waitpid(process, 0)
        return os.waitstatus_to_exitcode(status)


def _end_if_it_hangs(process: int) -> None:
    """Return when a process has ended; end it when its session uses no processor time for long, and asks for none.

    Wall time says nothing on a busy machine.
    """
    used, since = -1, time.monotonic()
    while os.waitid(os.P_PID, process, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
        now_used, wants_more = _use_of_session(process)
        if wants_more or now_used != used:
            used, since = now_used, time.monotonic()
        elif time.monotonic() - since > HANG:
            os.kill(process, signal.SIGKILL)
        time.sleep(0.05)
    with suppress(ProcessLookupError):
        os.killpg(process, signal.SIGKILL)  # what it has left


def _use_of_session(session: int) -> tuple[int, bool]:
    """Return the processor time of a session's processes, in ticks, and whether one of their threads could run."""
    used, wants_more = 0, False
    for process in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if (process / "stat").read_text().rpartition(")")[2].split()[3] != str(session):
                continue
            for task in (process / "task").iterdir():
                fields = (task / "stat").read_text().rpartition(")")[2].split()
                used += int(fields[11]) + int(fields[12])
                wants_more |= fields[0] in "RD"
    return used, wants_more


def run_tests(tests: list[str]) -> int:
    """Run pytest until the first failure."""
    import pytest

    return int(pytest.main(["-x", "-q", "-p", "no:cacheprovider", "--tb=line", *tests]))


class Reached:
    """Which tests execute which lines."""

    def __init__(self, copy: Copy, output: Path) -> None:
        data_file = copy.path / "reached"
        code = copy.run(lambda: _measure(data_file), output, 600)
        if code != 0:
            sys.exit(f"the tests fail without any change (exit code {code}):\n{output.read_text()}")
        import coverage

        self._root = copy.path
        self._data = coverage.CoverageData(str(data_file))
        self._data.read()
        self._contexts: dict[str, dict[int, list[str]]] = {}

    def tests_of(self, mutant: Mutant) -> list[str]:
        """The tests that execute a mutant's line; all that execute its file, if it is executed when imported."""
        if mutant.file not in self._contexts:
            self._contexts[mutant.file] = self._data.contexts_by_lineno(str(self._root / mutant.file))
        lines = self._contexts[mutant.file]
        found = set(lines.get(mutant.line) or lines.get(mutant.statement, ()))
        if "" in found:
            found |= {test for tests in lines.values() for test in tests}
        return sorted(found - {""})


def _measure(data_file: Path) -> int:
    import coverage
    import pytest

    measuring = coverage.Coverage(data_file=str(data_file), source=["pyfrc_core"], config_file=False)

    class Contexts:
        @pytest.hookimpl(wrapper=True)
        def pytest_runtest_protocol(self, item: pytest.Item):  # type: ignore[no-untyped-def]
            measuring.switch_context(item.nodeid)
            try:
                return (yield)
            finally:
                measuring.switch_context("")

    measuring.start()
    code = int(pytest.main(["-x", "-q", "-p", "no:cacheprovider", "--durations=10", *TESTS], [Contexts()]))
    measuring.stop()
    measuring.save()
    return code


# -- the run -------------------------------------------------------------------------------------------------------


def verdict_on(mutant: Mutant, copy: Copy, reached: Reached, output: Path) -> str:
    """Run the tests that may notice it."""
    tests = reached.tests_of(mutant)
    if not tests:
        return NOT_RUN
    file = copy.path / mutant.file
    source = file.read_bytes()
    file.write_bytes(mutant.apply(source))
    try:
        return SURVIVED if copy.run(lambda: run_tests(tests), output) == 0 else KILLED
    finally:
        file.write_bytes(source)


def _import_what_does_not_change() -> None:
    """Import it once, before the forks."""
    import coverage  # noqa: F401
    import hal.simulation  # noqa: F401
    import hypothesis  # noqa: F401
    import ntcore  # noqa: F401
    import pytest  # noqa: F401
    import wpilib.simulation  # noqa: F401


def main() -> None:
    """Draw, run, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sample", type=int, default=200, help="how many mutants")
    parser.add_argument("--seed", type=int, default=14)
    parser.add_argument("--only", default="", help="of files whose name has this in it")
    parser.add_argument("--seconds", type=float, default=3600.0, help="begin no further mutant after this wall time")
    parser.add_argument("--list", action="store_true", help="print which lines no test executes, no more")
    options = parser.parse_args()
    os.nice(19)
    mutants = [mutant for mutant in all_mutants() if options.only in mutant.file]
    drawn = random.Random(options.seed).sample(mutants, min(options.sample, len(mutants)))
    _import_what_does_not_change()
    with tempfile.TemporaryDirectory(prefix="mutations-", ignore_cleanup_errors=True) as name:
        copy, output = Copy(Path(name)), Path(name, "output")
        reached = Reached(copy, output)
        print(output.read_text(), flush=True)
        if options.list:
            lines = sorted({(each.file, each.line) for each in mutants if not reached.tests_of(each)})
            for file, count in Counter(file for file, _ in lines).most_common():
                print(file, count, *(line for each, line in lines if each == file))
            return
        verdicts: dict[Mutant, str] = {}
        began = time.monotonic()
        for mutant in drawn:  # in their random order: those of a run that is cut short are a fair sample, too
            if time.monotonic() - began > options.seconds:
                break
            verdicts[mutant] = verdict_on(mutant, copy, reached, output)
            print(f"{verdicts[mutant]:18} {mutant}", flush=True)
        print_summary(verdicts, len(mutants), options.seed)


def print_summary(verdicts: dict[Mutant, str], of: int, seed: int) -> None:
    """Print the survivors in the order of their lines, and how many were killed."""
    print("\nSurvivors:")
    for mutant, verdict in sorted(verdicts.items(), key=lambda each: (each[0].file, each[0].line)):
        if verdict != KILLED:
            print(f"{verdict:18} {mutant}")
    print(f"\n{len(verdicts)} of {of} mutants, seed {seed}")
    for verdict, count in Counter(verdicts.values()).most_common():
        print(f"{verdict:18} {count:4} {count / len(verdicts):6.1%}")


if __name__ == "__main__":
    main()
