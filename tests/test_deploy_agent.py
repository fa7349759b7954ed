"""The agent, sent to a plain Python as on a robot, and its frames."""

from __future__ import annotations

import ast
import io
import os
import sys
import zlib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from loops import for_each
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, LocalRobot, Processes, directory_in_memory, project_of

from pyfrc_core import wheel_files
from pyfrc_core.deploy import agent
from pyfrc_core.deploy.agent import wire
from pyfrc_core.deploy.agent_client import DeployRequest, Watched
from pyfrc_core.deploy.agent_stream import agent_command, agent_package
from pyfrc_core.deploy.errors import ConnectionFailedError, DeployError
from pyfrc_core.deploy.targets.roborio import ROBORIO

SOURCES = [*sorted(Path(agent.__file__).parent.glob("*.py")), Path(wheel_files.__file__)]


def pythons() -> dict[str, str]:
    """This Python, and the oldest that a robot may have, where there is one."""
    versions = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"), "versions")
    oldest = [str(each) for each in versions.glob("3.9.*/bin/python3.9")] + ["/usr/bin/python3.9"]
    there = [each for each in oldest if Path(each).exists()]
    return {"this": sys.executable, **dict.fromkeys(["3.9"] if there else [], there[0] if there else "")}


@for_each("source", SOURCES)
def test_python_39_and_its_standard_library_are_enough(source: Path) -> None:
    tree = ast.parse(source.read_text("utf-8"), feature_version=(3, 9))
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level == 0:
            assert node.module is not None
            assert node.module.split(".")[0] in sys.stdlib_module_names
        elif isinstance(node, ast.ImportFrom):
            own = node.level == 1 and source.parent == SOURCES[0].parent
            assert own or (node.level, node.module) == (3, "wheel_files"), "from the agent's own modules only"
        elif isinstance(node, ast.Import):
            assert {each.name.split(".")[0] for each in node.names} <= sys.stdlib_module_names


@pytest.mark.parametrize("python", pythons().values(), ids=pythons())
def test_it_runs_as_it_is_sent(robot: LocalRobot, tmp_path: Path, python: str) -> None:
    robot.agents = Processes(python)
    project = project_of(tmp_path / "project", {"robot.py": ROBOT_PY, "Ü b/it's.txt": "x"})
    robot.deploy(project)
    (robot.home / "py/log.txt").write_text("written")
    deployed = robot.deploy(project_of(tmp_path / "project", {"robot.py": "# 2\n"}))
    assert (deployed.release, deployed.files_sent) == (2, 1)
    assert robot.startable() == {"robot.py": b"# 2\n", "Ü b/it's.txt": b"x", "log.txt": b"written"}
    session = robot.start()
    assert session.rollback().release.number == 1
    session.close()


def test_nothing_of_the_user_stands_in_the_command() -> None:
    command = agent_command(ROBORIO.python)
    assert command.startswith("/usr/local/bin/python3 -X utf8 -u -c '")
    assert command.count("'") == 2
    assert not set("$`\\!{%") & set(command)
    assert len(agent_package()) < 60_000, "each deploy sends it: 0.12 s at 4 Mbit/s"


def test_memory(robot: LocalRobot, tmp_path: Path) -> None:
    """A project of 20 MB, compressible and not, in large files and small: under 40 MB at the highest."""
    files: dict[str, str | bytes] = {f"data/{number}.bin": os.urandom(50_000) for number in range(200)}
    files |= {"zeros.bin": bytes(8_000_000), "path.json": b"[1.234567, 2.345678]\n" * 100_000, "robot.py": ROBOT_PY}
    files |= {f"module{number}.py": f"NUMBER = {number}\n" * 100 for number in range(50)}
    project = project_of(tmp_path / "project", files)
    assert project.total_bytes > 20_000_000
    for files_sent in (len(project.entries), 0, 1):
        if files_sent == 1:
            project = project_of(tmp_path / "project", {"path.json": b"[1.234567, 2.345679]\n" * 100_000})
        robot.agents = Processes()
        session = robot.start()
        assert session.deploy(project, DeployRequest("robot.py", {})).files_sent == files_sent
        peak = robot.channel.peak_memory()
        session.close()
        assert peak < 40_000_000


VALUES = st.none() | st.integers() | st.text(max_size=9)
MESSAGE = st.dictionaries(st.text(max_size=9), VALUES | st.lists(VALUES, max_size=3), max_size=3)


@settings(max_examples=50)
@given(MESSAGE, st.lists(st.binary(max_size=99), max_size=3), st.data())
def test_frames_come_as_they_were_sent(said: wire.Message, pieces: list[bytes], data: st.DataObject) -> None:
    stream = wire.message_frame(said) + b"".join(wire.frame(wire.CONTENT, piece) for piece in pieces)
    reading = io.BytesIO(stream)
    assert wire.parse_message(*wire.read_frame(reading.read)) == said
    assert [wire.read_frame(reading.read) for _ in pieces] == [(wire.CONTENT, piece) for piece in pieces]
    cut = io.BytesIO(stream[: data.draw(st.integers(0, len(stream) - 1))])
    with pytest.raises(wire.EndedError):
        [wire.read_frame(cut.read) for _ in range(len(pieces) + 1)]


@given(st.binary(max_size=50))
def test_what_is_no_frame_is_refused(noise: bytes) -> None:
    with pytest.raises(wire.WireError):
        wire.parse_message(*wire.read_frame(io.BytesIO(noise).read))


def test_a_frame_that_unpacks_to_too_much() -> None:
    bomb = wire.frame(wire.MESSAGE, zlib.compress(b'{"a": "' + bytes(wire.MAX_FRAME_BYTES) + b'"}'))
    with pytest.raises(wire.WireError):
        wire.parse_message(*wire.read_frame(io.BytesIO(bomb).read))


@settings(max_examples=10)
@given(noise=st.binary(min_size=1, max_size=200))
def test_noise_changes_nothing_on_the_robot(noise: bytes) -> None:
    with directory_in_memory() as directory:
        robot = LocalRobot.new(directory / "robot")
        session = robot.start()
        robot.channel.sendall(noise)
        session.close()
        assert list(robot.home.iterdir()) == []


def test_an_invalid_request_is_reported(robot: LocalRobot) -> None:
    session = robot.start()
    robot.channel.sendall(wire.message_frame({"op": "watch"}))
    with pytest.raises(DeployError, match=r"the agent on the robot has failed: .*seconds.*\n.*is complete"):
        session._stream.read_response(lambda fields: None)
    assert session.info().current is None
    session.close()


def test_a_python_that_cannot_run_it(robot: LocalRobot) -> None:
    robot.agents = Processes(shell="echo 'old python' >&2; exit 1")
    with pytest.raises(DeployError, match="the agent on the robot has ended: old python") as caught:
        robot.start()
    assert not isinstance(caught.value, ConnectionFailedError)


def test_a_python_that_is_too_old(robot: LocalRobot) -> None:
    program = agent_command("python3").partition(" -c '")[2].removesuffix("'")
    old = f"{sys.executable} -c 'import sys\nsys.version_info = (3, 8, 10)\n{program}'"
    robot.agents = Processes(shell=old)
    with pytest.raises(DeployError, match=r"the robot's Python 3\.8 is too old: pyfrc needs 3\.9 or newer\n  Prep"):
        robot.start()


def test_something_else_that_prints_before(robot: LocalRobot) -> None:
    """A login script's greeting, say."""
    robot.agents = Processes(shell="echo 'Welcome to the robot'; exec cat >/dev/null")
    with pytest.raises(DeployError, match=r"the robot sent data that is not from pyfrc's agent: .*Welco"):
        robot.start()


def test_the_link_is_cut_while_the_agent_is_sent(robot: LocalRobot) -> None:
    robot.agents = Processes()
    for place in (1, 9, len(agent_package())):
        with pytest.raises(ConnectionFailedError, match=r"the connection to the robot was lost"):
            robot.start(cut_to_robot=place)
        assert list(robot.home.iterdir()) == []


def test_the_last_traceback_counts() -> None:
    first = 'Traceback (most recent call last):\n  File "a.py", line 1, in a\nZeroDivisionError: division by zero\n'
    second = 'Traceback (most recent call last):\n  File "b.py", line 2, in b\n    b()\nKeyError: 1\n'
    watched = Watched("ended", f"{first}\nDuring this:\n\n{second}The end\n")
    assert watched.traceback == second.rstrip()
    assert Watched("ended", "no\n").traceback is None


def test_a_traceback_that_is_cut_off_is_shown_only_without_a_whole_one() -> None:
    """A program that crashes in a loop is in the middle of its next crash when the watch ends."""
    whole = 'Traceback (most recent call last):\n  File "a.py", line 1, in a\nZeroDivisionError: division by zero\n'
    cut = 'Traceback (most recent call last):\n  File "a.py", line 1, in a\n'
    assert Watched("ended", f"{whole}starting again\n{cut}").traceback == whole.rstrip()
    assert Watched("ended", cut).traceback == cut.rstrip()
