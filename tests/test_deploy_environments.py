"""Environments on the robot, made by its Python: sent once, shared, and gone back from.

Which are kept and mended is in `core/test_agent_environments`, power cuts are in `core/test_agent_power_cuts`, cut
connections in `test_deploy_installs`.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import subprocess
import sys
from collections.abc import Generator, Mapping
from pathlib import Path
from typing import Any

import pytest
from conftest import sampled
from roborio.local import ROBOT_PY, LocalRobot, Processes, project_of
from written_files import zip_of

from pyfrc_core.deploy.agent_client import AgentClient, DeployRequest
from pyfrc_core.deploy.errors import RefusedError
from pyfrc_core.deploy.manifest import Entry, Manifest
from pyfrc_core.deploy.targets import ControllerKind
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="a robot runs Linux")

Files = dict[str, bytes]
PYTHON = "0123456789abcdef"
FIRST, SECOND = "aaaaaaaaaaaaaaaa", "bbbbbbbbbbbbbbbb"
OLD, NEW = {"robot.py": ROBOT_PY.encode()}, {"robot.py": b"# new\n" + ROBOT_PY.encode()}
SPINNER = "spinner/__init__.py"
TOOL = "#!python\nimport sys\nprint(sys.prefix, sys.argv[1:])\n"


def wheel(directory: Path, name: str, files: Mapping[str, str | bytes]) -> Entry:
    """A wheel of these files."""
    content, file = zip_of(files), directory / f"{name}-py3-none-any.whl"
    file.write_bytes(content)
    return Entry(file.name, len(content), hashlib.sha256(content).hexdigest(), False, file)


class Packages:
    """Two environments: the second has another version of a package, and one more."""

    def __init__(self, directory: Path) -> None:
        directory.mkdir()
        kept = wheel(directory, "kept-1.0", {"kept.py": "A = 1\n" * 200, "kept-1.0.dist-info/METADATA": "Name: kept\n"})
        first, second = (wheel(directory, f"spinner-{n}.0", {SPINNER: f"VERSION = {n}\n"}) for n in (1, 2))
        more = wheel(directory, "more-1.0", {"more.py": "B = 1\n", "more-1.0.data/scripts/tool": TOOL})
        self.wheels = {FIRST: Manifest((kept, first)), SECOND: Manifest((kept, second, more))}
        self.content: dict[str | None, Files] = {None: {}}
        self.content[FIRST] = {"kept.py": b"A = 1\n" * 200, SPINNER: b"VERSION = 1\n"}
        self.content[SECOND] = {**self.content[FIRST], SPINNER: b"VERSION = 2\n", "more.py": b"B = 1\n"}


def new_robot(root: Path, controller: ControllerKind = SYSTEMCORE) -> LocalRobot:
    """A robot with a Python, as the shell script of an installation leaves it, and nothing else."""
    robot = LocalRobot.new(root, controller)
    send_python(robot)
    return robot


def send_python(robot: LocalRobot) -> None:
    python = robot.home / ".pyfrc/pythons" / PYTHON / "bin/python3"
    if robot.controller.install_python.is_system:
        python = robot.paths.of(robot.controller.python)
    python.parent.mkdir(parents=True, exist_ok=True)
    python.unlink(missing_ok=True)
    python.symlink_to(os.path.realpath(sys.executable))


@contextlib.contextmanager
def agent(robot: LocalRobot, **options: Any) -> Generator[AgentClient]:
    session = robot.start(**options)
    try:
        yield session
    finally:
        session.close()


def install(robot: LocalRobot, packages: Packages, name: str, **cut: Any) -> int:
    send_python(robot)  # if a deploy that does not need it has removed it
    with agent(robot, **cut) as session:
        wheels = packages.wheels[name]
        python = None if robot.controller.install_python.is_system else PYTHON
        return session.install(name, python, wheels, [5_000] * len(wheels.entries))


def deploy(robot: LocalRobot, project: Manifest, environment: str | None, **cut: Any) -> None:
    with agent(robot, **cut) as session:
        session.deploy(project, DeployRequest("robot.py", {}, environment=environment))


def started(robot: LocalRobot) -> tuple[Files, Files] | None:
    """The files of the program that would be started, and of the packages that it would have; None without one."""
    program = robot.startable()
    if program is None:
        return None
    (python,) = (word for word in robot.paths.start_command().split() if word.endswith("/bin/python3"))
    place = robot.paths.of(python).parents[1]
    if place.is_symlink():
        place = place.parent / place.readlink()
    assert (place / "environment.json").is_file() or place.name in ("venv", "local"), "an incomplete one"
    (packages,) = place.glob("lib/python3*/site-packages")
    return program, {file.relative_to(packages).as_posix(): file.read_bytes() for file in packages.rglob("*.py")}


@pytest.fixture
def packages(in_memory: Path) -> Packages:
    return Packages(in_memory / "wheels")


@pytest.fixture(params=sampled([ROBORIO, SYSTEMCORE], SYSTEMCORE), ids=lambda each: each.name)
def controller(request: pytest.FixtureRequest) -> ControllerKind:
    return request.param


def test_a_change_sends_only_what_is_new_and_a_rollback_undoes_it(
    controller: ControllerKind, in_memory: Path, packages: Packages
) -> None:
    robot = new_robot(in_memory / "robot", controller)
    old, new = project_of(in_memory / "old", OLD), project_of(in_memory / "new", NEW)
    assert install(robot, packages, FIRST) == 2
    assert started(robot) is None
    deploy(robot, old, FIRST)
    assert started(robot) == (OLD, packages.content[FIRST])
    assert install(robot, packages, SECOND) == 2
    assert install(robot, packages, SECOND) == 0
    assert started(robot) == (OLD, packages.content[FIRST])
    deploy(robot, new, SECOND)
    assert started(robot) == (NEW, packages.content[SECOND])
    check_scripts(robot, SECOND)
    places = [robot.home / ".pyfrc/environments" / name for name in (FIRST, SECOND)]
    kept, spinner = (next(places[1].rglob(name)).relative_to(places[1]) for name in ("kept.py", "spinner/__init__.py"))
    shared = [kept, *(each.relative_to(places[1]) for each in places[1].rglob("kept.*.pyc"))]
    assert len(shared) == 2
    assert all(Path.samefile(*(place / each for place in places)) for each in shared), "what is the same is one file"
    assert not Path.samefile(*(place / spinner for place in places))
    with agent(robot) as session:
        assert session.rollback().release.number == 1
    assert started(robot) == (OLD, packages.content[FIRST])


def check_scripts(robot: LocalRobot, environment: str) -> None:
    place = robot.home.resolve() / ".pyfrc/environments" / environment
    tool = place / "bin/tool"
    printed = subprocess.run([tool, "a b"], check=True, capture_output=True, text=True).stdout
    assert printed == f"{place} ['a b']\n", "it runs in its own environment"


def test_too_little_disk_space_is_said_before_anything_is_sent(in_memory: Path, packages: Packages) -> None:
    robot = new_robot(in_memory / "robot")
    with agent(robot) as session, pytest.raises(RefusedError, match="too full to install packages") as caught:
        session.install(FIRST, PYTHON, packages.wheels[FIRST], [1 << 50, 1])
    assert "Nothing was changed" in str(caught.value.remedy)
    assert not (robot.home / ".pyfrc/wheels").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="it reads the memory of a process as Linux shows it")
def test_memory(in_memory: Path, packages: Packages) -> None:
    """A wheel of 20 MB: under 40 MB at the highest. What needs more to be compiled is left to the program."""
    robot, table = new_robot(in_memory / "robot", ROBORIO), "TABLE = [\n" + '    ["a", 1.5, "b"],\n' * 100_000 + "]\n"
    big = wheel(in_memory, "big-1.0", {"big.bin": os.urandom(20_000_000), "small.py": "A = 1\n", "table.py": table})
    packages.wheels[FIRST] = Manifest((big,))
    robot.agents = Processes()
    session = robot.start()
    assert session.install(FIRST, None, packages.wheels[FIRST], [1]) == 1
    peak = robot.channel.peak_memory()
    session.close()
    assert peak < 40_000_000
    assert {each.name.partition(".")[0] for each in robot.home.rglob("*.pyc")} == {"small"}
