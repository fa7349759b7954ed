"""Campaigns on a Dask cluster: a real scheduler with its workers, on this computer."""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
import sys
import threading
from collections.abc import Generator, Iterator, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from skips import requires
from started_commands import StartedCommand, start_command

from pyfrc_core.fuzz.campaign import cluster as cluster_module

pytestmark = requires("campaigns on a cluster", [] if find_spec("distributed") else ["Dask"])
if find_spec("distributed"):
    from pyfrc_core.fuzz.campaign.cluster_worker import versions

DOCS = (Path(__file__).parents[1] / "docs/how_to/fuzz_every_night.md").read_text("utf-8")
_ON_A_CLUSTER = DOCS.partition("## On a cluster")[2].partition("\n## ")[0]
_BLOCKS = re.findall(r"```sh\n(.*?)```", _ON_A_CLUSTER, re.DOTALL)
#: The commands of the documentation, as lists of arguments.
INSTALL, SCHEDULER, WORKER, FUZZ = (shlex.split(line) for block in _BLOCKS for line in block.splitlines())

SETTINGS = "[tool.pyfrc.fuzz]\nmatch_seconds = 1.5\n"

#: The file that its worker names in its environment has the number of a process, which the robot ends; by default the
#: process that has forked its own. Its last failure needs a restart of the program in the middle of a match.
ROBOT = """
    import os
    import signal
    import wpilib

    #: The robot is imported once, in the process whose forks play the matches and their restarts.
    PLAYS_MATCHES = os.getpid()

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.pad = wpilib.XboxController(0)
            assert wpilib.Preferences.getString("state", "") != str(type(self))

        def teleopInit(self):
            wpilib.Preferences.setString("state", str(type(self)))
            victim = os.environ.get("ENDS_A_PROCESS", "")
            if os.path.exists(victim):
                with open(victim) as file:
                    number = int(file.read() or PLAYS_MATCHES)
                os.unlink(victim)
                os.kill(number, signal.SIGKILL)

        def teleopPeriodic(self):
            if self.pad.getBButton():
                raise ValueError("button")
            if self.pad.getPOV() == 315:
                open(os.path.join(os.path.dirname(__file__), "missing.txt"))
    """

CAMPAIGN = ("--seed", "101", "--runs", "32")


def _pairs(options: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield each option with its value."""
    return zip(options[::2], options[1::2], strict=True)


def start(program: str, arguments: list[str], directory: Path, env: Mapping[str, str] | None = None) -> StartedCommand:
    """Start ``python -m program arguments``, without input.

    :param env: variables, besides those of this process
    """
    command = [sys.executable, "-m", program, *arguments]
    environment = {**os.environ, **(env or {})}
    return start_command(
        lambda streams: subprocess.Popen(
            command, stdin=streams[0], stdout=streams[1], stderr=streams[2], cwd=directory, env=environment
        ),
        apart=True,
    )


class Cluster:
    """A scheduler and its workers, each a process that ends with the context."""

    def __init__(self, directory: Path) -> None:
        self._directory = directory
        self._processes: list[StartedCommand] = []
        self._workers: list[tuple[StartedCommand, Path]] = []
        self.scheduler, (self.address,) = self._start(
            [*SCHEDULER, "--host", "127.0.0.1", "--port", "0", "--no-dashboard"], r"Scheduler at: +(\S+)"
        )

    def add_worker(self, env: Mapping[str, str] | None = None) -> StartedCommand:
        """Start a worker with one thread, and wait until the scheduler knows it."""
        command = [self.address if each.startswith("tcp://") else each for each in WORKER]
        own = self._directory / str(len(self._workers))
        options = ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(own)]
        worker, _ = self._start([*command, *options], r"Registered to: +(\S+)", env)
        self._workers.append((worker, own))
        return worker

    def left_on_workers(self) -> list[Path]:
        """What pyfrc has left in the directories of workers that run."""
        return [left for worker, own in self._workers if worker.poll() is None for left in own.rglob("pyfrc-*")]

    def _start(
        self, command: list[str], ready: str, env: Mapping[str, str] | None = None
    ) -> tuple[StartedCommand, tuple[str, ...]]:
        assert command[0] == "dask"
        started = start("dask", command[1:], self._directory, env)
        self._processes.append(started)
        assert started.stderr is not None
        log = ""
        for line in started.stderr:
            log += line
            if (found := re.search(ready, line)) is not None:
                threading.Thread(target=started.rest, daemon=True).start()
                return started, found.groups()
        raise AssertionError(log)

    def close(self) -> None:
        for process in reversed(self._processes):
            process.kill()
        for process in self._processes:
            process.wait()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Generator[Cluster]:
    """A cluster with a worker."""
    cluster = Cluster(tmp_path_factory.mktemp("cluster"))
    try:
        cluster.add_worker()
        yield cluster
    finally:
        cluster.close()


@pytest.fixture
def own_cluster(tmp_path: Path) -> Generator[Cluster]:
    """A cluster without workers, for one test."""
    (tmp_path / "own").mkdir()
    cluster = Cluster(tmp_path / "own")
    try:
        yield cluster
    finally:
        cluster.close()


def copy(make_shared_project: Any) -> Any:
    return make_shared_project({"robot.py": ROBOT, "pyproject.toml": SETTINGS})


def written(project: Any) -> dict[str, bytes]:
    """The files that a campaign has written, with what is in them."""
    files = [*(project.path / "tests").rglob("*"), *(project.path / ".pyfrc/fuzz").rglob("*")]
    return {
        file.relative_to(project.path).as_posix(): file.read_bytes()
        for file in sorted(files)
        if file.is_file() and file.suffix != ".pyc"
    }


@pytest.fixture(scope="module")
def alone(make_shared_project) -> tuple[dict[str, bytes], str]:
    """What one process writes and prints in a whole campaign; its project's directory is replaced."""
    project = copy(make_shared_project)
    found = project.run("fuzz", *CAMPAIGN, "-j", "1")
    assert (found.code, len(list(project.path.rglob("*.jsonl")))) == (1, 3), found.output
    assert "the robot program starts again" in found.output
    return _everywhere(project, found)


def _everywhere(project: Any, result: Any) -> tuple[dict[str, bytes], str]:
    path = str(project.path)
    contents = {name: content.replace(path.encode(), b"PROJECT") for name, content in written(project).items()}
    *lines, last = result.stdout.replace(path, "PROJECT").splitlines()
    # How often the progress is printed depends on the time, and what is found before another script is short.
    return contents, "\n".join([*(line for line in lines if not re.match(r"\d+ match|found ", line)), last])


@pytest.mark.slow
def test_a_cluster_finds_what_one_process_finds(cluster: Cluster, alone, make_shared_project) -> None:
    cluster.add_worker()
    project = copy(make_shared_project)
    values = {"--scheduler": cluster.address, **dict(_pairs(CAMPAIGN))}
    options = [word for name, _ in _pairs(FUZZ[2:]) for word in (name, values.pop(name))]
    assert not values
    result = project.run("fuzz", *options)
    assert result.code == 1, result.output
    assert _everywhere(project, result) == alone
    assert "missing.txt" in result.stdout
    assert str(project.path) in result.stdout  # not a path of the worker
    assert cluster.left_on_workers() == []


@pytest.mark.slow
def test_matches_whose_process_dies_are_played_again(
    cluster: Cluster, alone, make_shared_project, tmp_path: Path
) -> None:
    a_worker, a_process_of_a_worker = tmp_path / "worker", tmp_path / "process"
    worker = cluster.add_worker({"ENDS_A_PROCESS": str(a_worker)})
    a_worker.write_text(str(worker.pid))
    another = cluster.add_worker({"ENDS_A_PROCESS": str(a_process_of_a_worker)})
    a_process_of_a_worker.touch()
    project = copy(make_shared_project)
    result = project.run("fuzz", *CAMPAIGN, "--scheduler", cluster.address)
    assert worker.wait() == -signal.SIGKILL
    assert list(tmp_path.iterdir()) == []
    assert _everywhere(project, result) == alone, result.output
    another.kill()  # each worker of a campaign starts processes that play its matches
    another.wait()


def _begin(project: Any, *options: str) -> StartedCommand:
    """Begin a long campaign, and return it when it has found something."""
    arguments = ["fuzz", "--seed", "1", "--runs", "100000", *options]
    campaign = start("pyfrc", arguments, project.path, {"PYTHONHASHSEED": "0"})
    for line in campaign.stdout:
        if "pyfrc replay" in line:
            return campaign
    raise AssertionError(campaign.rest())


@pytest.mark.slow
def test_a_scheduler_that_is_lost(own_cluster: Cluster, make_shared_project) -> None:
    own_cluster.add_worker()
    project = copy(make_shared_project)
    campaign = _begin(project, "--scheduler", own_cluster.address)
    own_cluster.scheduler.kill()
    _, stderr = campaign.rest()
    assert campaign.wait() == 1
    assert stderr.splitlines()[-1] == f"error: the connection to the scheduler at {own_cluster.address} was lost"
    assert list(project.path.rglob("tests/fuzz/*.jsonl"))


class _Client:
    """What a campaign asks of Dask's client, of a cluster with one worker or none."""

    def __init__(self, threads: dict[str, int], **packages: str) -> None:
        there = versions()
        python = f"{there.pop('Python')}.1.final.0"
        self._versions = {"host": {"python": python}, "packages": there}
        self._threads = threads
        self._workers = {worker: {**self._versions, "packages": {**there, **packages}} for worker in threads}

    def nthreads(self) -> dict[str, int]:
        return self._threads

    def get_versions(self, packages: Sequence[str]) -> dict[str, Any]:
        return {"scheduler": self._versions, "workers": self._workers}


def test_a_cluster_that_cannot_play_the_same_matches() -> None:
    worker = {"tcp://10.0.0.6:1": 1}
    cluster_module._check_versions(_Client(worker), "tcp://10.0.0.5:1")
    with pytest.raises(cluster_module.ClusterError) as raised:
        cluster_module._check_versions(_Client({}), "tcp://10.0.0.5:1")
    assert str(raised.value).startswith("the scheduler at tcp://10.0.0.5:1 has no workers\n")
    assert "dask worker tcp://10.0.0.5:1" in str(raised.value)
    with pytest.raises(cluster_module.ClusterError) as raised:
        cluster_module._check_versions(_Client(worker, pyfrc="2025.9.9"), "tcp://10.0.0.5:1")
    here = f"({versions()['pyfrc']} here)"
    assert str(raised.value).startswith(f"the worker at tcp://10.0.0.6:1 has another version: pyfrc 2025.9.9 {here}\n")


def test_workers_play_the_matches(cluster: Cluster, make_project) -> None:
    robot = """
        import wpilib

        class MyRobot(wpilib.TimedRobot):
            def teleopPeriodic(self):
                raise ValueError(f"{__name__} fails")
        """
    project = make_project({"robot.py": robot, "pyproject.toml": SETTINGS})
    result = project.run("fuzz", "--runs", "2", "--seed", "1", "--scheduler", cluster.address)
    assert result.code == 1, result.output
    assert "robot.py:5" in result.stdout, result.output
    assert [file.name for file in project.path.rglob("tests/fuzz/*.jsonl")] == ["valueerror-robot-teleopperiodic.jsonl"]
    assert cluster.left_on_workers() == []


@pytest.mark.parametrize("address", ["nonsense", "tcp://127.0.0.1", "tcp://127.0.0.1:port", ""])
def test_what_is_no_address(address: str, make_project) -> None:
    result = make_project({"robot.py": ROBOT}).run("fuzz", "--scheduler", address)
    assert (result.code, "is not the address of a scheduler" in result.first_error) == (2, True), result.stderr
