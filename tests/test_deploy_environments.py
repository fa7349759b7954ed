"""Environments on the robot, made by its Python: sent once, shared, and gone back from.

Which are kept and mended is in `core/test_agent_environments`, power cuts are in `core/test_agent_power_cuts`, cut
connections in `test_deploy_installs`.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from collections.abc import Mapping
from contextlib import closing
from pathlib import Path

import pytest
from conftest import sampled
from roborio.local import ROBOT_PY, LocalRobot, Processes, project_of
from written_files import zip_of

from pyfrc_core.deploy.agent_client import DeployRequest
from pyfrc_core.deploy.errors import RefusedError
from pyfrc_core.deploy.manifest import Entry, Manifest
from pyfrc_core.deploy.targets import ControllerKind
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="a robot runs Linux")

PYTHON = "0123456789abcdef"
FIRST, SECOND = "aaaaaaaaaaaaaaaa", "bbbbbbbbbbbbbbbb"
TOOL = "#!python\nimport sys\nprint(sys.prefix, sys.argv[1:])\n"


def wheel(directory: Path, name: str, files: Mapping[str, str | bytes]) -> Entry:
    """A wheel of these files."""
    content, file = zip_of(files), directory / f"{name}-py3-none-any.whl"
    file.write_bytes(content)
    return Entry(file.name, len(content), hashlib.sha256(content).hexdigest(), False, file)


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


def install(robot: LocalRobot, environment: str, *wheels: Entry, unpacked: int = 5_000) -> int:
    send_python(robot)  # if a deploy that does not need it has removed it
    python = None if robot.controller.install_python.is_system else PYTHON
    with closing(robot.start()) as session:
        return session.install(environment, python, Manifest(wheels), [unpacked] * len(wheels))


def deploy(robot: LocalRobot, directory: Path, code: str, environment: str) -> None:
    with closing(robot.start()) as session:
        session.deploy(
            project_of(directory, {"robot.py": code}), DeployRequest("robot.py", {}, environment=environment)
        )


def started(robot: LocalRobot) -> dict[str, str] | None:
    """The program that would be started, and the modules of the packages that it would have; None without one."""
    program = robot.startable()
    if program is None:
        return None
    (python,) = (word for word in robot.paths.start_command().split() if word.endswith("/bin/python3"))
    place = robot.paths.of(python).parents[1]
    if place.is_symlink():
        place = place.parent / place.readlink()
    assert (place / "environment.json").is_file(), "an incomplete one"
    files = place.glob("lib/python3*/site-packages/*.py")
    return {"robot.py": program["robot.py"].decode(), **{each.name: each.read_text() for each in files}}


@pytest.mark.parametrize("controller", sampled([ROBORIO, SYSTEMCORE], SYSTEMCORE), ids=lambda each: each.name)
def test_a_change_sends_only_what_is_new_and_a_rollback_undoes_it(controller: ControllerKind, in_memory: Path) -> None:
    robot, new = new_robot(in_memory / "robot", controller), f"# new\n{ROBOT_PY}"
    texts = {"kept.py": "A = 1\n" * 200, "spinner.py": "VERSION = 1\n"}
    newer = {"kept.py": texts["kept.py"], "spinner.py": "VERSION = 2\n", "more.py": "B = 1\n"}
    kept = wheel(in_memory, "kept-1.0", {"kept.py": texts["kept.py"], "kept-1.0.dist-info/METADATA": "Name: kept\n"})
    one, two = (wheel(in_memory, f"spinner-{n}.0", {"spinner.py": f"VERSION = {n}\n"}) for n in (1, 2))
    more = wheel(in_memory, "more-1.0", {"more.py": "B = 1\n", "more-1.0.data/scripts/tool": TOOL})
    assert install(robot, FIRST, kept, one) == 2
    assert started(robot) is None
    deploy(robot, in_memory / "project", ROBOT_PY, FIRST)
    before = started(robot)
    assert before == {"robot.py": ROBOT_PY, **texts}
    assert install(robot, SECOND, kept, two, more) == 2
    assert install(robot, SECOND, kept, two, more) == 0
    assert started(robot) == before
    deploy(robot, in_memory / "project", new, SECOND)
    assert started(robot) == {"robot.py": new, **newer}
    places = [robot.home.resolve() / ".pyfrc/environments" / name for name in (FIRST, SECOND)]
    printed = subprocess.run([places[1] / "bin/tool", "a b"], check=True, capture_output=True, text=True).stdout
    assert printed == f"{places[1]} ['a b']\n", "it runs in its own environment"
    shared, own = (
        [each.relative_to(places[1]) for each in places[1].rglob(f"{name}.*py*")] for name in ("kept", "spinner")
    )
    assert len(shared) == len(own) == 2, "a source, and its compiled form"
    assert all(Path.samefile(*(place / each for place in places)) for each in shared), "what is the same is one file"
    assert not any(Path.samefile(*(place / each for place in places)) for each in own)
    with closing(robot.start()) as session:
        assert session.rollback().release.number == 1
    assert started(robot) == before


def test_too_little_disk_space_is_said_before_anything_is_sent(in_memory: Path) -> None:
    robot = new_robot(in_memory / "robot")
    with pytest.raises(RefusedError, match="too full to install packages") as caught:
        install(robot, FIRST, wheel(in_memory, "kept-1.0", {"kept.py": ""}), unpacked=1 << 50)
    assert "Nothing was changed" in str(caught.value.remedy)
    assert not (robot.home / ".pyfrc/wheels").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="it reads the memory of a process as Linux shows it")
def test_memory(in_memory: Path) -> None:
    """A wheel of 20 MB: under 40 MB at the highest. What needs more to be compiled is left to the program."""
    robot, table = new_robot(in_memory / "robot", ROBORIO), "TABLE = [\n" + '    ["a", 1.5, "b"],\n' * 100_000 + "]\n"
    big = wheel(in_memory, "big-1.0", {"big.bin": os.urandom(20_000_000), "small.py": "A = 1\n", "table.py": table})
    robot.agents = Processes()
    with closing(robot.start()) as session:
        assert session.install(FIRST, None, Manifest((big,)), [1]) == 1
        assert robot.channel.peak_memory() < 40_000_000
    assert {each.name.partition(".")[0] for each in robot.home.rglob("*.pyc")} == {"small"}
