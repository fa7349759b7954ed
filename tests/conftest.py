"""Robot projects made for one test, and the `pyfrc` command run in them as a user would."""

from __future__ import annotations

import compileall
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from textwrap import dedent
from typing import TYPE_CHECKING, Any

import forked
import other_systems
import pytest
from hypothesis import HealthCheck, settings
from spelling import IN_ANOTHER_FORM, motors_of, spell_copy, spelled
from started_commands import StartedCommand, start_command

if TYPE_CHECKING:
    from pyfrc_core.config.sim_file import LoadedSimConfig
    from pyfrc_core.processes.spawn import StartedProcess

# What would make a run here differ from the user's: the outer pytest's settings, measurements, colours.
_NOT_PASSED_ON = ("COVERAGE_", "PYTEST_", "COV_CORE_")
_NOT_PASSED_ON_EITHER = {
    "PYTHONHASHSEED",
    "PYTHONPATH",
    "PYTHONUNBUFFERED",
    "FORCE_COLOR",
    "PY_COLORS",
    "CLICOLOR_FORCE",
    "CI",
    "BUILD_NUMBER",
    "XDG_DATA_HOME",
}

# Threads of numpy's linear algebra spin while they wait, in each process that imports it for up to a tenth of a second.
# The matrices of robots are too small for threads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# The same examples in each run, and no limits by the clock: a failure is not chance, nor a busy machine. By day, half
# as many as Hypothesis takes by default.
settings.register_profile(
    "suite", deadline=None, derandomize=True, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("day", settings.get_profile("suite"), max_examples=50)
settings.load_profile("suite")

# A suite that a shell has started in the background ignores Ctrl-C. The commands that are tested must not inherit that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

#: Guards of tests that need what not every machine has, and of those that only one season has; which run, and how long.
pytest_plugins = ["skips", "seasons", "runs", "people_at_pages"]

#: That code makes no progress, or is still being loaded.
_SLOW = re.compile(r"no progress for \d+ s|^still loading WPILib")

_BANNER = re.compile(r"^=+ .+ =+$")
_BLOCK = re.compile(r"^_{2,} (.+?) _{2,}$")


@dataclass(frozen=True)
class Result:
    """What a command did: its exit code, and what it printed."""

    code: int
    stdout: str
    stderr: str

    @property
    def output(self) -> str:
        """Everything printed: what went to standard output, then the errors."""
        return self.stdout + self.stderr

    @property
    def complaints(self) -> str:
        """What went to standard error, without the notes that a slow machine causes."""
        lines = self.stderr.splitlines(keepends=True)
        return "".join(line for line in lines if _SLOW.search(line) is None)

    @property
    def first_error(self) -> str:
        """The first line of the error that a command ended with.

        On a busy machine, a note may stand before it that code makes no progress.
        """
        lines = self.stderr.splitlines() or [""]
        return next((line for line in lines if line.startswith("error: ")), lines[0]).removeprefix("error: ")

    def blocks(self) -> dict[str, str]:
        """What pytest shows of each failure and error, by the test's name."""
        found: dict[str, list[str]] = {}
        block: list[str] = []
        for line in self.stdout.splitlines():
            if (heading := _BLOCK.match(line)) is not None:
                block = found.setdefault(heading[1], [])
            elif _BANNER.match(line):
                block = []
            else:
                block.append(line)
        return {name: "\n".join(lines).strip() for name, lines in found.items()}

    def outcomes(self) -> dict[str, str]:
        """Of a run with ``-v``: each test's outcome, in the order in which they were reported."""
        lines = re.findall(r"^(\S+::.+?) (PASSED|FAILED|ERROR|SKIPPED|XFAIL|XPASS)\b", self.stdout, re.MULTILINE)
        return dict(lines)


def _written(stream: io.TextIOWrapper) -> str:
    return stream.buffer.getvalue().decode("utf-8")  # type: ignore[attr-defined,no-any-return]


def _environment() -> dict[str, str]:
    """What commands find in theirs."""
    passed_on = {
        name: value
        for name, value in os.environ.items()
        if name not in _NOT_PASSED_ON_EITHER and not name.startswith(_NOT_PASSED_ON)
    }
    return {
        **passed_on,
        **other_systems.environment(),
        "COLUMNS": "120",
        # Files may be changed twice within a second: Python would take what it has kept of the first for the second.
        "PYTHONDONTWRITEBYTECODE": "1",
        # Robot projects do not use hypothesis. With -v its plugin imports all of it, which takes a second.
        "PYTEST_ADDOPTS": "-p no:hypothesispytest",
        # Units that were parsed are the one thing in the home directory of who runs the suite that commands share.
        "XDG_CACHE_HOME": os.environ.get("XDG_CACHE_HOME", str(Path.home() / ".cache")),
    }


def pytest_configure(config: pytest.Config) -> None:
    """Compile our packages, as installing them does: commands would do it each time, since they keep nothing."""
    if not config.getoption("run_slow"):
        settings.load_profile("day")
    if hasattr(config, "workerinput"):
        _forking.extend(config.workerinput["forking"])
        return
    for package in ("pyfrc", "pyfrc_cli", "pyfrc_core"):
        compileall.compile_dir(Path(__file__).parents[1] / package, quiet=2)


@pytest.hookimpl(optionalhook=True)
def pytest_configure_node(node: Any) -> None:
    """Give all workers of pytest-xdist one process that forks: its imports take as long as a hundred forks."""
    node.workerinput["forking"] = [_forking_process()] if forked.POSSIBLE else []


#: The address of the process that forks, once there is one.
_forking: list[str] = []


def _forking_process() -> str:
    if not _forking:
        _forking.append(forked.start_server(_environment()))
    return _forking[0]


def _start_python(command: Sequence[str], **options: Any) -> Any:
    """Do what `subprocess.Popen` does with Python and its arguments; faster, where that is the same."""
    if not forked.POSSIBLE:
        return subprocess.Popen(command, **options)
    return forked.popen(_forking_process(), command, **options)


@pytest.fixture(scope="session", autouse=True)
def _start_hosts_fast() -> None:
    """Start the hosts of simulations in this process as commands are started."""
    from pyfrc_core.processes import spawn

    spawn.popen = _start_python


def trace_hash(file: Path) -> str:
    """The hash at the end of a trace."""
    return str(json.loads(file.read_text("utf-8").splitlines()[-1])["sha256"])


@dataclass(frozen=True)
class RobotProject:
    """A robot project in a directory of its own."""

    path: Path
    #: Where the runs' temporary files go; empty again when they have tidied up.
    temporary: Path
    #: Whether its files have the season's spelling already.
    as_written: bool = False

    @property
    def home(self) -> Path:
        """The home directory that its commands see: they write nothing into that of the person who runs the suite."""
        return self.path.parent / "home of the user"

    def write(self, files: Mapping[str, str]) -> None:
        """Write the files, named relative to the project, their text without its common indentation."""
        motors = motors_of(files.values())
        for name, text in files.items():
            file = self.path / name
            file.parent.mkdir(parents=True, exist_ok=True)
            text = dedent(text).lstrip("\n")
            spell = file.suffix == ".py" and not self.as_written
            file.write_text(spelled(text, motors) if spell else text, encoding="utf-8")

    def copy(self, robot: Path, *left_out: str) -> None:
        """Copy a sample robot's files: running a robot leaves files in its project.

        :param left_out: patterns of names that are not copied, besides what runs leave
        """
        ignore = shutil.ignore_patterns("__pycache__", ".pytest_cache", ".pyfrc", "ctre_sim", *left_out)
        shutil.copytree(robot, self.path, dirs_exist_ok=True, ignore=ignore)
        if not self.as_written:
            spell_copy(self.path)

    def line(self, name: str, text: str) -> int:
        """The number of the one line of a file with `text` in it."""
        text, lines = (
            text if self.as_written else spelled(text),
            (self.path / name).read_text(encoding="utf-8").splitlines(),
        )
        numbers = [number for number, line in enumerate(lines, 1) if text in line]
        assert len(numbers) == 1, f"{text!r} is in the lines {numbers} of {name}"
        return numbers[0]

    def place(self, name: str, text: str) -> str:
        """``robot.py:12``, for the one line of a file with `text` in it."""
        return f"{name}:{self.line(name, text)}"

    def run(
        self,
        *args: str | Path,
        env: Mapping[str, str] | None = None,
        cwd: Path | None = None,
        stdin: str | None = None,
        program: str = "pyfrc",
        cold: bool = False,
    ) -> Result:
        """Run ``pyfrc`` with these arguments, as a user would in the project's directory, and wait for its end.

        :param cold: in a new interpreter, even where a warm start does the same
        """
        typed = None
        if stdin is not None:
            typed, typing = os.pipe()
            with os.fdopen(typing, "w", encoding="utf-8") as file:
                file.write(stdin)  # fits into a pipe
        command = start_command(
            lambda streams: self.start_with(streams, *args, env=env, cwd=cwd, program=program, cold=cold), typed, True
        )
        if typed is not None:
            os.close(typed)
        with command:
            printed, errors = command.rest()
            return Result(command.wait(), printed, errors)

    def start(
        self, *args: str | Path, env: Mapping[str, str] | None = None, stdin: int | None = None, apart: bool = False
    ) -> StartedCommand:
        """Start ``pyfrc`` as `run` does, and let it go on.

        :param stdin: a descriptor of its input; by default, it has none
        :param apart: whether its errors are not among what it prints
        """
        return start_command(lambda streams: self.start_with(streams, *args, env=env), stdin, apart)

    def start_with(
        self,
        streams: Sequence[int],
        *args: str | Path,
        env: Mapping[str, str] | None = None,
        cwd: Path | None = None,
        program: str = "pyfrc",
        cold: bool = False,
        own_session: bool = False,
    ) -> StartedProcess:
        """Start ``pyfrc`` with these descriptors as its standard input, output and errors.

        :param own_session: whether it leads a session of its own, as at another terminal
        """
        stdin, stdout, stderr = streams
        environment = _environment() | dict.fromkeys(("TMPDIR", "TEMP"), str(self.temporary))
        environment |= dict.fromkeys(("HOME", "USERPROFILE"), str(self.home))
        if args[:1] == ("fuzz",):
            # With more processes, shrinking runs scripts that it does not need then: a third more processor time. What
            # is found is the same. Tests that are about the number pass it.
            environment["PYTHON_CPU_COUNT"] = "1"
        popen: Callable[..., StartedProcess] = subprocess.Popen if cold else _start_python
        return popen(
            [sys.executable, "-m", program, *map(str, args)],
            cwd=cwd or self.path,
            env=environment | dict(env or {}),
            stdin=stdin,
            stdout=stdout,
            stderr=stderr,
            start_new_session=own_session,
        )

    def run_here(self, *args: str | Path, env: Mapping[str, str] | None = None) -> Result:
        """Run ``pyfrc`` in this process: a command that ends before it runs robot code, such as one that is refused.

        It takes a hundredth of the time of `run`.
        """
        from pyfrc_cli import main

        streams = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True) for _ in range(2)]
        with pytest.MonkeyPatch.context() as patch:
            patch.chdir(self.path)
            patch.setattr(sys, "argv", ["pyfrc", *map(str, args)])
            for name in ("HOME", "USERPROFILE"):
                patch.setenv(name, str(self.home))
            for name, value in {"COLUMNS": "120", **(env or {})}.items():
                patch.setenv(name, value)
            with redirect_stdout(streams[0]), redirect_stderr(streams[1]), pytest.raises(SystemExit) as ended:
                main.run()
        code = ended.value.code
        return Result(code if isinstance(code, int) else int(code is not None), *map(_written, streams))

    def pytest(self, *args: str | Path, cwd: Path | None = None, env: Mapping[str, str] | None = None) -> Result:
        """Run plain ``pytest``, as an editor does."""
        return self.run(*args, cwd=cwd, env=env, program="pytest")


#: Where the length of a match is not the point: less than a real one, for the sake of the suite's time.
SHORT_MATCH = """
[tool.pyfrc.match]
autonomous = 2
pause = 1
teleop = 5
"""


def add_settings(directory: Path, text: str) -> None:
    """Append this text to the ``pyproject.toml`` of the project in this directory."""
    with (directory / "pyproject.toml").open("a", encoding="utf-8") as pyproject:
        pyproject.write(text)


def sampled(values: Iterable[Any], *daily: Any) -> list[Any]:
    """Return parameters of which all but the `daily` ones are marked as slow."""
    return [
        value
        if value in daily
        else pytest.param(*(value if isinstance(value, tuple) else [value]), marks=pytest.mark.slow)
        for value in values
    ]


def sample_robots(*daily: str) -> list[Any]:
    """Return the sample robots as parameters: all but the `daily` ones are slow, and some run in 2026 only."""
    names = sorted(path.parent.name for path in (Path(__file__).parent / "robots").glob("*/robot.py"))
    return [
        pytest.param(
            name, marks=[pytest.mark.season_2026] * (name in IN_ANOTHER_FORM) + [pytest.mark.slow] * (name not in daily)
        )
        for name in names
    ]


MakeProject = Callable[[Mapping[str, str]], RobotProject]


def new_project(directory: Path, files: Mapping[str, str], as_written: bool = False) -> RobotProject:
    """Make a robot project of files in this directory."""
    project = RobotProject(directory / "robot-project", directory / "temporary", as_written)
    for path in (project.path, project.temporary, project.home):
        path.mkdir()
    project.write(files)
    return project


@pytest.fixture
def make_project(tmp_path: Path) -> MakeProject:
    """Makes a robot project of files; for one test."""
    return lambda files: new_project(tmp_path, files)


@pytest.fixture(scope="session")
def make_shared_project(tmp_path_factory: pytest.TempPathFactory) -> MakeProject:
    """Makes a robot project of files, for a fixture that several tests share."""
    return lambda files: new_project(tmp_path_factory.mktemp("shared"), files)


@pytest.fixture
def hangup_ends_programs() -> Generator[None]:
    """Have SIGHUP end the programs that this test starts, also where the suite runs under nohup, which they inherit."""
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL) if hasattr(signal, "SIGHUP") else None
    yield
    if before is not None:
        signal.signal(signal.SIGHUP, before)


@pytest.fixture
def in_memory() -> Generator[Path]:
    """A directory in memory, where there is such a thing."""
    from roborio.local import directory_in_memory

    with directory_in_memory() as directory:
        yield directory


@pytest.fixture
def patient_doctor(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have `pyfrc doctor` wait for a robot that is there, however busy this machine is."""
    for name in ("SEARCH_SECONDS", "CHECK_SECONDS"):
        monkeypatch.setattr(f"pyfrc_core.doctor.robot.{name}", 100.0)


LoadConfig = Callable[[str], "LoadedSimConfig"]


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project's directory, with one for its sim/config.json."""
    directory = tmp_path_factory.mktemp("project")
    (directory / "sim").mkdir()
    return directory


@pytest.fixture(scope="module")
def load(root: Path) -> LoadConfig:
    """Loads a text as sim/config.json."""
    from pyfrc_core.config.sim_file import load_sim_config

    def load(text: str) -> LoadedSimConfig:
        (root / "sim/config.json").write_text(text, encoding="utf-8")
        return load_sim_config(root)

    return load
