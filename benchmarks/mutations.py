"""Change the core in one place at a time, and see whether a direct test notices.

    python benchmarks/mutations.py

Draws mutants with a fixed seed from the rooms in `mutants.ROOMS`, and runs for each the tests in `mutation_runs.TESTS`
that execute the changed line, in a copy of this repository, until one fails. A line that no test executes is a survivor
at once. Linux only, at the lowest priority.
"""

from __future__ import annotations

import argparse
import os
import pickle
import struct
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from line_tests import LineTests
from mutants import Mutant, draw
from mutation_runs import (
    HANGS,
    KILLED,
    NOT_RUN,
    SURVIVED,
    Copy,
    Runner,
    Trial,
    control,
    imports_that_do_not_change,
    record,
    run_imported,
    run_with_imports,
    trial_of,
)
from processes_below import adopt_orphans

#: Processes that run tests.
MOST_PROCESSES = 2

_NUMBER = struct.Struct("<I")


def main() -> None:
    """Draw, run, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=200, help="how many mutants")
    parser.add_argument("--seed", type=int, default=14)
    parser.add_argument("--only", default="", metavar="PATH", help="of files whose name has this in it")
    parser.add_argument("--processes", type=int, default=MOST_PROCESSES, choices=range(1, MOST_PROCESSES + 1))
    parser.add_argument("--list", action="store_true", help="print which lines no test executes, no more")
    options = parser.parse_args()
    os.nice(19)
    imports_that_do_not_change()
    with tempfile.TemporaryDirectory(prefix="mutations-", ignore_cleanup_errors=True) as name:
        began = time.monotonic()
        line_tests = which_tests_run_which_lines(Path(name))
        used = sum(line_tests.cpu_seconds.values())
        print(f"{len(line_tests.cpu_seconds)} tests, recorded in {used:.0f} s of processor time", flush=True)
        drawn = draw(options.seed, options.count, options.only)
        if options.list:
            print_lines_not_run([mutant for mutant in drawn if not line_tests.tests_of(mutant.file, mutant.lines)])
            return
        trials = [trial_of(mutant, line_tests) for mutant in drawn]
        *verdicts, without_change = run_all([*trials, control(line_tests)], line_tests, Path(name), options.processes)
        print_summary([(trial.mutant, verdict) for trial, verdict in zip(trials, verdicts, strict=True)], options.seed)
        print(f"{time.monotonic() - began:.0f} s of wall time")
        if without_change != SURVIVED:
            sys.exit("in forks, the tests fail without any change")


def which_tests_run_which_lines(directory: Path) -> LineTests:
    """Run all tests once, on the core as it is."""
    copy, result, output = Copy(directory / "recorded"), directory / "line_tests", directory / "output"
    process = os.fork()
    if not process:
        with output.open("wb") as stream:
            os.dup2(stream.fileno(), 1)
            os.dup2(stream.fileno(), 2)
        copy.enter()
        code = record(copy, lambda line_tests: result.write_bytes(pickle.dumps(line_tests)))
        sys.stdout.flush()
        os._exit(code)
    code = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    if code != 0:
        sys.exit(f"the tests fail without any change (exit code {code}):\n{output.read_text()}")
    line_tests: LineTests = pickle.loads(result.read_bytes())
    return line_tests


def run_all(trials: list[Trial], line_tests: LineTests, directory: Path, processes: int) -> list[str]:
    """Return the verdict on each, in their order."""
    verdicts = [NOT_RUN] * len(trials)
    # Two queues, which are pipes: each process takes its next number from there.
    runnable = [(number, trial) for number, trial in enumerate(trials) if trial.tests]
    slow = _queue([number for number, trial in runnable if trial.codes is None])
    fast = _queue([number for number, trial in runnable if trial.codes is not None])
    reading, writing = os.pipe()
    workers = []
    for index in range(processes):
        worker = os.fork()
        if not worker:
            os.close(reading)
            _work(trials, line_tests, directory / f"copy{index}", (slow, fast), writing)
        workers.append(worker)
    os.close(writing)
    with os.fdopen(reading) as results:
        for line in results:
            number, _, verdict = line.rstrip("\n").partition(" ")
            verdicts[int(number)] = verdict
            print(f"{verdict:18} {trials[int(number)].mutant}", flush=True)
    for worker in workers:
        if os.waitpid(worker, 0)[1]:
            sys.exit("a process that runs tests has failed")
    return verdicts


def _work(trials: list[Trial], line_tests: LineTests, directory: Path, queues: tuple[int, int], results: int) -> None:
    """Be one of the processes that run tests."""
    code = 1
    try:
        adopt_orphans()
        output = directory.with_suffix(".output")
        with output.open("wb") as stream:
            os.dup2(stream.fileno(), 1)
        copy = Copy(directory)
        copy.enter()
        runner = Runner(copy, line_tests, output)

        def report(number: int, verdict: str) -> None:
            os.write(results, f"{number} {verdict}\n".encode())

        for queue, run in zip(queues, (run_with_imports, run_imported), strict=True):
            numbers = ((number, trials[number]) for number in _numbers(queue))
            run(runner, numbers, report)
        code = 0
    finally:
        os._exit(code)


def _queue(numbers: list[int]) -> int:
    reading, writing = os.pipe()
    for number in numbers:
        os.write(writing, _NUMBER.pack(number))
    os.close(writing)
    return reading


def _numbers(queue: int) -> Iterator[int]:
    while data := os.read(queue, _NUMBER.size):
        yield _NUMBER.unpack(data)[0]


def print_lines_not_run(mutants: list[Mutant]) -> None:
    lines = sorted({(mutant.file, mutant.line) for mutant in mutants})
    for file, count in Counter(file for file, _ in lines).most_common():
        print(file, count, *(line for each, line in lines if each == file))


def print_summary(verdicts: list[tuple[Mutant, str]], seed: int) -> None:
    """Print the survivors in the order of their lines, and how many were killed."""
    print("\nSurvivors:")
    for mutant, verdict in sorted(verdicts, key=lambda each: (each[0].file, each[0].line)):
        if verdict not in (KILLED, HANGS):
            print(f"{verdict:18} {mutant}")
    print(f"\n{len(verdicts)} mutants, seed {seed}")
    counts = Counter(verdict for _, verdict in verdicts)
    for verdict, count in counts.most_common():
        print(f"{verdict:18} {count:4} {count / len(verdicts):6.1%}")
    dead = counts[KILLED] + counts[HANGS]
    print(f"{'dead in all':18} {dead:4} {dead / max(1, len(verdicts)):6.1%}")


if __name__ == "__main__":
    main()
