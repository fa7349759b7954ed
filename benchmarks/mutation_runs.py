"""How `mutations.py` runs tests on mutants: in forks of a process that has imported them and the core.

A fork replaces the code of the functions that a mutant changes, and runs the tests that execute its line until one
fails. A change of what is executed during an import needs another fork: of a process that has imported WPILib and
pytest only. The file is changed on disk, too, for new interpreters that a test starts.
"""

from __future__ import annotations

import compileall
import gc
import mmap
import os
import select
import shutil
import signal
import struct
import sys
import traceback
import types
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from line_tests import LineRecorder, LineTests
from mutants import REPOSITORY, Mutant
from processes_below import end_processes_below, is_blocked, used_cpu_seconds

#: What has to notice.
TESTS = (
    "tests/core",
    "tests/test_hal_data.py",
    "tests/test_hal_paths.py",
    "tests/test_hal_recording.py",
    "tests/test_hal_reports.py",
    "tests/test_hal_scaling.py",
    "tests/test_deploy_watching.py",
)
COPIED = ("pyfrc", "pyfrc_cli", "pyfrc_core", "tests", "pyproject.toml")

KILLED, HANGS, SURVIVED, NOT_RUN = "killed", "killed, hangs", "survived", "survived, not run"

#: Seconds of processor time that a test of a mutant has, beside a multiple of what it needed while it was recorded.
#: Recording makes it several times as slow.
CPU_SECONDS, CPU_FACTOR = 2.0, 2.0

#: A test hangs, too, when its processes want no processor for so many looks at them.
LOOK_SECONDS, LOOKS = 0.1, 80

_PYTEST = ["-q", "-s", "-p", "no:cacheprovider", "--tb=line"]
_OPTIMIZED = 1  # the flag of a function's code, which that of a class or module has not


# -- a copy of the repository ------------------------------------------------------------------------------------------


class Copy:
    """A copy of the repository, whose files may be changed."""

    def __init__(self, directory: Path) -> None:
        self.path = directory
        self._changes = 0
        for name in COPIED:
            source = REPOSITORY / name
            if source.is_dir():
                shutil.copytree(source, directory / name, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy2(source, directory)
        compileall.compile_dir(directory, quiet=2)

    def enter(self) -> None:
        """Make it the current directory, and import the core from it."""
        os.chdir(self.path)
        os.environ["PYTHONPATH"] = str(self.path)
        os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
        sys.dont_write_bytecode = True
        sys.path.insert(0, str(self.path))

    @contextmanager
    def changed(self, mutant: Mutant) -> Iterator[None]:
        """While this lasts, a file is as the mutant has it."""
        file = self.path / mutant.file
        source, before = file.read_bytes(), file.stat()
        file.write_bytes(mutant.apply(source))
        self._changes += 1
        os.utime(file, (self._changes, self._changes))  # no compiled file is this one's
        try:
            yield
        finally:
            file.write_bytes(source)
            os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))


def record(copy: Copy, result: Callable[[LineTests], object]) -> int:
    """Run all tests in this process, and pass on which lines each executes."""
    files = sorted((copy.path / "pyfrc_core").rglob("*.py"))
    recorder = LineRecorder(copy.path / "recorded", {str(file.relative_to(copy.path)): file for file in files})

    class Plugin:
        @pytest.hookimpl(wrapper=True, tryfirst=True)
        def pytest_runtest_protocol(self, item: pytest.Item) -> Any:
            with recorder.test(item.nodeid):
                return (yield)

    recorder.begin(most_tests=2000)
    code = int(pytest.main([*_PYTEST, "-x", *TESTS], [Plugin()]))
    result(recorder.result())
    return code


# -- what is to be run for a mutant ------------------------------------------------------------------------------------

Code = types.CodeType
#: Where a function's code is: its file, its name, the number of its first line.
Place = tuple[str, str, int]


@dataclass(frozen=True)
class Trial:
    """A mutant, and what shows whether a test notices it.

    :param tests: those that execute its line, the shortest first
    :param codes: the new code of functions; None when the change is not in functions alone
    """

    mutant: Mutant
    tests: Sequence[str]
    codes: dict[Place, Code] | None


def trial_of(mutant: Mutant, line_tests: LineTests) -> Trial:
    source = (REPOSITORY / mutant.file).read_bytes()
    codes = _changed_functions(
        compile(source, mutant.file, "exec", dont_inherit=True),
        compile(mutant.apply(source), mutant.file, "exec", dont_inherit=True),
    )
    tests = line_tests.tests_of(mutant.file, mutant.lines)
    if codes is None or "" in tests:  # executed by an import
        codes, tests = None, tests | line_tests.tests_of_file(mutant.file)
    return Trial(mutant, sorted(tests - {""}, key=lambda test: (line_tests.cpu_seconds[test], test)), codes)


def control(line_tests: LineTests) -> Trial:
    """Return a trial of no change, which all tests must let pass."""
    mutant = Mutant("pyfrc_core/errors.py", 1, 1, "", 0, 0, "", "")
    return Trial(mutant, sorted(line_tests.cpu_seconds, key=line_tests.cpu_seconds.__getitem__), {})


def _changed_functions(old: Code, new: Code) -> dict[Place, Code] | None:
    """Return the new code of functions that are different; None when something else is."""
    changed: dict[Place, Code] = {}
    inner = [[const for const in code.co_consts if isinstance(const, Code)] for code in (old, new)]
    same_shell = len(inner[0]) == len(inner[1]) and _shell(old) == _shell(new)
    if old.co_flags & _OPTIMIZED:
        if old.co_freevars != new.co_freevars:
            return None
        if old != new:
            changed[place_of(old)] = new
    elif not same_shell:
        return None
    for pair in zip(*inner, strict=True) if same_shell else ():
        below = _changed_functions(*pair)
        if below is None:
            return None
        changed |= below
    return changed


def _shell(code: Code) -> tuple[object, ...]:
    """Return a code without those in it."""
    constants = [(type(const), const) for const in code.co_consts if not isinstance(const, Code)]
    return (code.co_code, code.co_names, code.co_varnames, repr(constants))


def place_of(code: Code) -> Place:
    return code.co_filename, getattr(code, "co_qualname", code.co_name), code.co_firstlineno


# -- the runs ----------------------------------------------------------------------------------------------------------


class Runner:
    """Runs trials in forks of this process, in a copy of the repository."""

    def __init__(self, copy: Copy, line_tests: LineTests, output: Path) -> None:
        self._copy = copy
        self._line_tests = line_tests
        self._output = output
        self._current_test = mmap.mmap(-1, 4)  # its number, which forks write

    def run(self, trial: Trial, run_tests: Callable[[Trial], int]) -> str:
        """Call a function, which returns an exit code, in a fork; return the verdict."""
        with self._copy.changed(trial.mutant):
            self.set_current(0)
            process = os.fork()
            if not process:
                code = 70
                try:
                    with self._output.open("wb") as stream:
                        os.dup2(stream.fileno(), 1)
                        os.dup2(stream.fileno(), 2)
                    code = run_tests(trial)
                except BaseException:
                    traceback.print_exc()
                finally:
                    sys.stdout.flush()
                    sys.stderr.flush()
                    os._exit(code)
            hangs = self._end_if_it_hangs(process, trial)
            _, status = os.waitpid(process, 0)
            end_processes_below()
        if hangs:
            return HANGS
        if status and not trial.mutant.before:
            print(self._output.read_text()[-5000:], file=sys.stderr)
        return SURVIVED if os.waitstatus_to_exitcode(status) == 0 else KILLED

    def set_current(self, number: int) -> None:
        struct.pack_into("<I", self._current_test, 0, number)

    def _end_if_it_hangs(self, process: int, trial: Trial) -> bool:
        """Return whether a process had to be ended. Wall time says nothing on a busy machine."""
        current, began, blocked = -1, 0.0, 0
        ended = os.pidfd_open(process)
        try:
            while not select.select([ended], [], [], LOOK_SECONDS)[0]:
                used = used_cpu_seconds()
                (now,) = struct.unpack("<I", self._current_test[:4])
                if now != current:
                    current, began, blocked = now, used, 0
                blocked = blocked + 1 if is_blocked() else max(0, blocked - 5)
                needs = self._line_tests.cpu_seconds[trial.tests[min(current, len(trial.tests) - 1)]]
                if used - began > CPU_SECONDS + CPU_FACTOR * needs or blocked > LOOKS:
                    with suppress(ProcessLookupError):
                        os.kill(process, signal.SIGKILL)
                    return True
            return False
        finally:
            os.close(ended)


def run_with_imports(runner: Runner, trials: Iterable[tuple[int, Trial]], report: Callable[[int, str], None]) -> None:
    """Run trials whose tests have to import the core again."""
    for number, trial in trials:
        verdict = runner.run(trial, lambda trial: int(pytest.main([*_PYTEST, "-x", *trial.tests])))
        report(number, verdict)


def run_imported(runner: Runner, trials: Iterable[tuple[int, Trial]], report: Callable[[int, str], None]) -> None:
    """Run trials that change functions only, in forks of this process, after pytest has imported everything here."""

    class Plugin:
        failed = False

        def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
            if report.failed:
                self.failed = True
                print(report.nodeid, report.longreprtext)

        @pytest.hookimpl(tryfirst=True)
        def pytest_runtestloop(self, session: pytest.Session) -> bool:
            items = {item.nodeid: item for item in session.items}
            functions = _functions()

            def run_tests(trial: Trial) -> int:
                for place, code in (trial.codes or {}).items():
                    file = str(runner._copy.path / place[0])
                    for function in functions.get((file, *place[1:]), ()):
                        function.__code__ = _in_file(code, file)
                tests = [items[name] for name in trial.tests]
                for number, item in enumerate(tests):
                    runner.set_current(number)
                    next_item = tests[number + 1] if number + 1 < len(tests) else None
                    item.ihook.pytest_runtest_protocol(item=item, nextitem=next_item)
                    if self.failed:
                        return 1
                return 0

            for number, trial in trials:
                report(number, runner.run(trial, run_tests))
            return True

    code = int(pytest.main([*_PYTEST, *TESTS], [Plugin()]))
    if code != 0:
        raise RuntimeError(f"pytest failed with exit code {code}")


def _functions() -> dict[Place, list[types.FunctionType]]:
    found: dict[Place, list[types.FunctionType]] = {}
    for each in gc.get_objects():
        if type(each) is types.FunctionType:
            found.setdefault(place_of(each.__code__), []).append(each)
    return found


def _in_file(code: Code, file: str) -> Code:
    """Return a code, and those in it, as compiled from this file."""
    constants = tuple(_in_file(const, file) if isinstance(const, Code) else const for const in code.co_consts)
    return code.replace(co_filename=file, co_consts=constants)


def imports_that_do_not_change() -> None:
    """Import what no mutant changes, before the forks."""
    import hal.simulation  # noqa: F401
    import hypothesis  # noqa: F401
    import ntcore  # noqa: F401
    import wpilib.simulation  # noqa: F401
