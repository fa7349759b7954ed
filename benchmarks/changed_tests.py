"""Whether `pyfrc test --changed` leaves out a test that a change breaks, and how many tests it runs.

    python benchmarks/changed_tests.py [ROBOT] [--count 50]

Changes a competition robot (tests/robots/competition) in one random place at a time, in its own code and not in its
tests. For each change, it compares the failures of `pyfrc test --changed`, after a run without the change, with those
of `pyfrc test`. It needs an environment with pyfrc's development requirements.
"""

from __future__ import annotations

import argparse
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from competition_robots import NAMES, copy_robot
from mutants import Mutant, mutants_of

#: A match that is shorter than the real one: the tests of this benchmark are run a hundred times.
SETTINGS = "\n[tool.pyfrc.match]\nautonomous = 3\npause = 0.1\nteleop = 3\n"
_RESULT = re.compile(r"^(\S+::\S+(?: .*)?) (PASSED|FAILED|ERROR)", re.MULTILINE)


def main() -> None:
    """Change, run both, compare, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robot", nargs="?", default="tank_arm", choices=NAMES)
    parser.add_argument("--count", type=int, default=50, help="how many changes")
    parser.add_argument("--seed", type=int, default=15)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="changed-tests-", ignore_cleanup_errors=True) as directory:
        project = copy_robot(options.robot, Path(directory), SETTINGS)
        sys.exit(compare(project, options.count, options.seed))


def compare(project: Path, count: int, seed: int) -> int:
    """Print a line for each change and a summary; return 1 if a failing test was left out."""
    all_tests = run(project, "--changed")
    assert set(all_tests.values()) == {"PASSED"}, all_tests
    memory = project / ".pyfrc" / "passes.json"
    passes = memory.read_bytes()
    drawn = random.Random(seed).sample(sorted(changes(project), key=str), count)
    left_out, failing, shares = 0, 0, []
    for number, change in enumerate(drawn, 1):
        file = project / change.file
        before = file.read_bytes()
        file.write_bytes(change.apply(before))
        chosen, whole = run(project, "--changed"), run(project)
        file.write_bytes(before)
        memory.write_bytes(passes)
        broken = {test for test in all_tests if whole.get(test) != "PASSED"}
        if not whole:  # the program cannot be imported: neither runs a test
            missed: set[str] = set() if not chosen else broken
        else:
            missed = {test for test in broken if chosen.get(test, "PASSED") == "PASSED"}
            shares.append(len(chosen) / len(all_tests))
        left_out += bool(missed)
        failing += bool(broken)
        print(f"{number:3}  {len(chosen):3} run, {len(broken):3} fail  {'LEFT OUT' if missed else '':8}  {change}")
        for test in sorted(missed):
            print(f"       {test}")
        sys.stdout.flush()
    share = 100 * sum(shares) / len(shares)
    print(f"\n{count} changes, {failing} of them fail tests: {left_out} with a failing test that --changed left out.")
    print(f"It ran {share:.0f} % of {len(all_tests)} tests on average; the fewest {100 * min(shares):.0f} %.")
    return int(left_out > 0)


def changes(project: Path) -> list[Mutant]:
    """All single changes of the robot's own code."""
    files = (file for file in project.rglob("*.py") if "tests" not in file.relative_to(project).parts)
    return [each for file in files for each in mutants_of(str(file.relative_to(project)), file.read_bytes())]


def run(project: Path, *options: str) -> dict[str, str]:
    """Run the tests; return the outcome of each that ran, by its name."""
    command = [sys.executable, "-m", "pyfrc", "test", "-v", *options, "--", "--tb=no", "-p", "no:cacheprovider"]
    done = subprocess.run(command, cwd=project, capture_output=True, text=True, check=False)
    return dict(_RESULT.findall(done.stdout))


if __name__ == "__main__":
    main()
