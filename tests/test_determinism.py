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
from conftest import SHORT_MATCH, MakeProject, RobotProject, add_settings, sample_robots, trace_hash

ROBOTS = Path(__file__).parent / "robots"

#: How often a new interpreter tests each robot. Another one, forked from a third where that can be, tests it once.
TESTED_IN_ONE = 2

#: Its own tests count the loops of a match of the real length. The ready-made ones pass in such matches: test_docs.
WHOLE_MATCHES = "timed"

#: It is tested on a busy machine, too: a robot with threads and a loop of its own.
TESTED_BUSY = "worker"
#: A container may have only some of the computer's cores: with as many busy processes as those, nothing would go on.
BUSY = min(os.cpu_count() or 1, 8)
#: Ends also when pytest is killed.
COMPUTE = "import os\nstarted_by = os.getppid()\nwhile os.getppid() == started_by:\n    sum(range(100_000))"

#: Between them they are in every mode; the fuzz test has a determinism test of its own.
COMPARED = ("test_operator_control", "test_practice")
READY_MADE = f"from pyfrc.tests import {', '.join(COMPARED)}\n"

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
    busy = [subprocess.Popen([sys.executable, "-c", COMPUTE]) for _ in range(count)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def hashes(directory: Path) -> Iterator[tuple[str, str]]:
    """(test, hash of its trace) for each trace of the ready-made tests in the directory."""
    for trace in sorted(directory.iterdir()):
        test = trace.stem.partition("_test.py.")[2]
        if test in COMPARED:
            yield test, trace_hash(trace)


@pytest.mark.parametrize("name", sample_robots("worker"))
def test_sample_robot_passes_all_tests_and_does_the_same_again_and_again(
    name: str, project: RobotProject, tmp_path: Path
) -> None:
    """Its own tests and the ready-made ones pass; the latter give the same traces wherever they run."""
    if name == WHOLE_MATCHES:
        (project.path / "tests/pyfrc_test.py").unlink()
    else:
        add_settings(project.path, SHORT_MATCH)
    output = pyfrc_test(project, "--trace", str(tmp_path / "traces-own"), "--", "-v", cold=False)
    assert ("pyfrc_test.py::test_practice PASSED" in output) == (name != WHOLE_MATCHES)
    assert "failed" not in output

    shutil.rmtree(project.path / "tests")
    project.write({f"tests/run{number}_test.py": READY_MADE for number in range(TESTED_IN_ONE)})
    if name == WHOLE_MATCHES:
        shutil.rmtree(tmp_path / "traces-own")
        add_settings(project.path, SHORT_MATCH)
    pyfrc_test(project, "--trace", str(tmp_path / "traces-new"), cold=True)
    found = the_same_each_time(tmp_path, TESTED_IN_ONE + (name != WHOLE_MATCHES))
    compare_with_other_interpreters(name, found)


@pytest.mark.slow
@pytest.mark.parametrize("name", [TESTED_BUSY])
def test_a_sample_robot_does_the_same_on_a_busy_machine(name: str, project: RobotProject, tmp_path: Path) -> None:
    add_settings(project.path, SHORT_MATCH)
    shutil.rmtree(project.path / "tests")
    project.write({"tests/run_test.py": READY_MADE})
    pyfrc_test(project, "--trace", str(tmp_path / "traces-alone"), cold=False)
    with busy_processes(BUSY):
        pyfrc_test(project, "--trace", str(tmp_path / "traces-busy"), cold=False)
    the_same_each_time(tmp_path, 2)


def the_same_each_time(traces: Path, times: int) -> dict[str, str]:
    """Return the hash of each test's traces, which are so many, and equal."""
    seen: dict[str, list[str]] = defaultdict(list)
    for directory in traces.glob("traces*"):
        for test, digest in hashes(directory):
            seen[test].append(digest)
    assert {test: len(digests) for test, digests in seen.items()} == dict.fromkeys(COMPARED, times)
    assert {test: len(set(digests)) for test, digests in seen.items()} == dict.fromkeys(COMPARED, 1)
    return {test: digests[0] for test, digests in seen.items()}


def compare_with_other_interpreters(name: str, found: dict[str, str]) -> None:
    """Each interpreter leaves its hashes; the others, which may run beside it, must have the same."""
    directory = os.environ.get(HASHES_OF_OTHERS)
    if directory is None:
        return
    own = Path(directory) / f"{name}-3.{sys.version_info.minor}.json"
    own.with_suffix(".new").write_text(json.dumps(found, indent=2))
    own.with_suffix(".new").replace(own)
    for file in Path(directory).glob(f"{name}-*.json"):
        assert found == json.loads(file.read_text()), file
