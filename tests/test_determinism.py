"""The same robot, inputs and seed do the same, bit for bit: however often, in whichever interpreter, however busy."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from conftest import SHORT_MATCH, MakeProject, RobotProject, add_settings, trace_hash

ROBOTS = Path(__file__).parent / "robots"
NAMES = sorted(path.name for path in ROBOTS.iterdir() if (path / "robot.py").is_file())

#: Interpreters, and how often each tests the robot: a new one, and one that is forked from another where that can be.
SESSIONS, TESTED_IN_EACH = 2, 4

#: One more has a busy machine: for a robot that runs in place, and for one with threads and a loop of its own.
BUSY = 2 * (os.cpu_count() or 1)
TESTED_BUSY = ("timed", "worker")

#: Its own tests count the loops of a match of the real length.
WHOLE_MATCHES = "timed"

#: Between them they are in every mode; the fuzz test has a determinism test of its own.
READY_MADE = "from pyfrc.tests import test_operator_control, test_practice\n"

#: Where another run of this test, by another version of Python, left its hashes to compare with.
HASHES_OF_OTHERS = "PYFRC_TRACE_HASHES"


def pyfrc_test(project: RobotProject, *args: str, cold: bool) -> str:
    result = project.run("test", *args, cold=cold)
    assert result.code == 0, result.output
    return result.stdout


@pytest.fixture
def project(name: str, make_project: MakeProject) -> RobotProject:
    """A copy of the sample robot."""
    project = make_project({})
    project.copy(ROBOTS / name)
    return project


@contextmanager
def busy_processes(count: int) -> Iterator[None]:
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def hashes(directory: Path) -> Iterator[tuple[str, str]]:
    """(test, hash of its trace) for each trace in the directory."""
    for trace in sorted(directory.iterdir()):
        test = trace.stem.partition("_test.py.")[2]
        yield test, trace_hash(trace)


@pytest.mark.parametrize("name", NAMES)
def test_sample_robot_passes_the_ready_made_tests_and_its_own(name: str, project: RobotProject) -> None:
    if name != WHOLE_MATCHES:
        add_settings(project.path, SHORT_MATCH)
    output = pyfrc_test(project, "--", "-v", cold=False)
    assert "pyfrc_test.py::test_practice PASSED" in output
    assert "failed" not in output


@pytest.mark.parametrize("name", NAMES)
def test_tested_again_and_again_it_does_the_same(name: str, project: RobotProject, tmp_path: Path) -> None:
    shutil.rmtree(project.path / "tests")
    project.write({f"tests/run{number}_test.py": READY_MADE for number in range(TESTED_IN_EACH)})
    add_settings(project.path, SHORT_MATCH)

    seen: dict[str, set[str]] = defaultdict(set)
    tested = 0
    for session in range(SESSIONS):
        pyfrc_test(project, "--trace", str(tmp_path / f"traces{session}"), cold=session == 0)
    if name in TESTED_BUSY:
        with busy_processes(BUSY):
            pyfrc_test(project, "--trace", str(tmp_path / "traces-busy"), "--", "tests/run0_test.py", cold=False)
    for directory in tmp_path.glob("traces*"):
        for test, digest in hashes(directory):
            seen[test].add(digest)
            tested += test == "test_practice"

    assert tested == SESSIONS * TESTED_IN_EACH + (name in TESTED_BUSY)
    assert {test: len(digests) for test, digests in seen.items()} == dict.fromkeys(seen, 1)
    compare_with_other_interpreters(name, {test: digest for test, (digest,) in seen.items()})


def compare_with_other_interpreters(name: str, found: dict[str, str]) -> None:
    """The first interpreter leaves its hashes, the others must have the same."""
    directory = os.environ.get(HASHES_OF_OTHERS)
    if directory is None:
        return
    file = Path(directory) / f"{name}.json"
    if file.exists():
        assert found == json.loads(file.read_text())
    else:
        file.write_text(json.dumps(found, indent=2))
