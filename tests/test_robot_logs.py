"""`pyfrc logs`: what lies on a robot is listed, fetched through cuts, verified, and removed only if asked."""

from __future__ import annotations

import io
import os
import random
import shutil
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from conftest import MakeProject
from hypothesis import given
from hypothesis import strategies as st
from roborio import Proxy, Roborio, require_roborio
from roborio.computer import Computer
from roborio.local import LocalRobot
from roborio.ssh import SshConnection
from systemcore import Systemcore, require_systemcore

from pyfrc_core.deploy import logs
from pyfrc_core.deploy.agent_client import AgentClient
from pyfrc_core.deploy.errors import ConnectionFailedError, DeployError, RefusedError
from pyfrc_core.deploy.facts import RobotLog
from pyfrc_core.deploy.logs import LogRequest, fetch_log, fetch_logs
from pyfrc_core.deploy.progress import DeployProgress, Questions, UserInterface
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE
from pyfrc_core.deploy.team import RobotChoice
from pyfrc_core.errors import UsageError

Q12, Q9, KIT, HOOT = (
    "FRC_20260321_141502_OHCL_Q12.wpilog",
    "FRC_20260321_101502_OHCL_Q9.wpilog",
    "akit_26-03-20_09-00-00_ohcl_p1.wpilog",
    "2026-03-19/rio_2026-03-19.hoot",
)
CONTENT = random.Random(7).randbytes(1_300_000)


@pytest.fixture(params=[ROBORIO])
def robot(request: pytest.FixtureRequest, in_memory: Path) -> LocalRobot:
    """A robot with four logs: two on its USB stick, two in its home directory."""
    made = LocalRobot.new(in_memory / "robot", request.param)
    put(made, "/u/logs", Q12, CONTENT, hours=1)
    put(made, "/u/logs", KIT, b"a", hours=30)
    put(made, f"{request.param.layout.home}/logs", Q9, b"b" * 3000, hours=5)
    put(made, f"{request.param.layout.home}/logs", HOOT, b"", hours=50)
    put(made, "/u/logs", "notes.txt", b"", hours=0)
    return made


def put(robot: LocalRobot, directory: str, name: str, content: bytes, hours: float) -> Path:
    file = robot.paths.of(f"{directory}/{name}")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(content)
    at = 1_774_100_000 - hours * 3600
    os.utime(file, (at, at))
    return file


class Command:
    """The command, with an agent on this computer."""

    def __init__(self, robot: LocalRobot, monkeypatch: pytest.MonkeyPatch) -> None:
        self.asked: list[str] = []
        self.printed = ""

        @contextmanager
        def connected_agent(*_: object) -> Iterator[tuple[Any, AgentClient]]:
            with closing(robot.start()) as agent:
                yield SimpleNamespace(host="10.12.34.2", controller=robot.controller), agent

        monkeypatch.setattr(logs, "connected_agent", connected_agent)

    def __call__(self, *wanted: str, answer: str | bool | None = None, **options: Any) -> str:
        def ask(question: str) -> Any:
            self.asked.append(question)
            return answer

        stream = io.StringIO()
        talk = UserInterface(DeployProgress(stream), None if answer is None else Questions(ask, ask))
        try:
            fetch_logs(None, RobotChoice(robot="10.12.34.2"), LogRequest(wanted, **options), talk)
        finally:
            self.printed = stream.getvalue()
        return self.printed


@pytest.fixture
def command(robot: LocalRobot, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Command:
    monkeypatch.chdir(tmp_path)
    return Command(robot, monkeypatch)


def log_of(agent: AgentClient, name: str) -> RobotLog:
    (found,) = (each for each in agent.logs()[0] if each.name == name)
    return found


def names_in(directory: str) -> list[str]:
    return sorted(each.name for each in Path(directory).iterdir() if each.name != ".gitignore")


def no_progress(done: int, total: int) -> None:
    pass


@pytest.mark.parametrize("robot", [ROBORIO, SYSTEMCORE], ids=lambda each: each.name, indirect=True)
def test_the_newest_come_first_with_match_and_place(command: Command, robot: LocalRobot) -> None:
    put(robot, "/u/logs", "FRC_TBD_1f.wpilog", b"", hours=90)
    (robot.root / "U").symlink_to("u")  # as on robots: they are not there twice
    lines = command().splitlines()[1:]
    rows = [line.split() for line in lines]
    assert [row[1] for row in rows] == [Q12, Q9, KIT, HOOT, "FRC_TBD_1f.wpilog"]
    assert [" ".join(row[2:4]) for row in rows[:3]] == ["OHCL Q12", "OHCL Q9", "OHCL P1"]
    assert "1300 kB" in lines[0]
    assert lines[0].endswith("USB stick")
    assert lines[1].endswith("robot")
    assert not Path("logs").exists()


def test_of_more_than_two_thousand_the_oldest_are_only_counted(command: Command, robot: LocalRobot) -> None:
    for number in range(2000):
        put(robot, "/u/logs", f"FRC_{number}.wpilog", b"", hours=2)
    printed = command()
    assert "2,000 logs, and 4 older ones that are not listed" in printed
    assert [name in printed for name in (Q12, Q9)] == [True, False]


def test_what_to_do_with_a_log_that_only_its_maker_can_read(command: Command) -> None:
    assert command("hoot").endswith("owlet -f wpilog FILE.hoot FILE.wpilog\n")
    assert "To look at it: pyfrc view logs" in command("hoot", "Q9")


@pytest.mark.parametrize("robot", [ROBORIO, SYSTEMCORE], ids=lambda each: each.name, indirect=True)
def test_a_robot_without_logs_says_where_they_would_be(command: Command, robot: LocalRobot) -> None:
    shutil.rmtree(robot.root / "u")
    shutil.rmtree(robot.home / "logs")
    printed = command(answer="1")
    assert f"There are no logs in /u/logs, /U/logs (a USB stick) and {robot.controller.layout.home}/logs" in printed
    assert "wpilib.DataLogManager.start()" in printed
    assert command.asked == []
    with pytest.raises(UsageError, match=r"no log on the robot has 'Q12' in its name\n  The newest: there are none\."):
        command("Q12")


def test_words_and_numbers_choose(command: Command) -> None:
    assert f"pyfrc view {Path('logs', Q9)}" in command("q9")
    assert names_in("logs") == [Q9]
    command(answer="0", into=Path("here"))
    assert not Path("here").exists()
    command(answer="1 ohcl", into=Path("here"))
    assert names_in("here") == sorted([Q12, Q9, KIT])
    assert Path("here", Q12).read_bytes() == CONTENT
    command("all")
    assert Path("logs", HOOT).read_bytes() == b""
    with pytest.raises(UsageError, match=r"no log on the robot has 'Q1' in its name\n  The newest: FRC_20260321"):
        command("Q1")


def test_a_fetch_goes_on_where_it_was_cut(robot: LocalRobot, tmp_path: Path) -> None:
    file, cuts, received = tmp_path / Q12, 0, 0
    while not file.exists():
        assert cuts < 9
        with closing(robot.start(cut_from_robot=400_000 + 200_000 * cuts)) as agent:
            with suppress(ConnectionFailedError):
                fetch_log(agent, log_of(agent, Q12), file, no_progress)
            received += robot.channel.bytes_from_robot
        cuts += 1
    assert cuts > 2
    assert file.read_bytes() == CONTENT
    assert received < 1.5 * len(CONTENT) + 600_000 * cuts, "no piece that is complete is sent twice"
    assert list(tmp_path.iterdir()) == [file]
    with closing(robot.start()) as agent:
        assert not fetch_log(agent, log_of(agent, Q12), file, no_progress)
        assert robot.channel.bytes_from_robot < 100_000, "it is here already"


def test_a_cut_says_that_the_next_command_goes_on(command: Command, robot: LocalRobot) -> None:
    start = robot.start
    robot.start = lambda: start(cut_from_robot=900_000)  # type: ignore[method-assign]
    with pytest.raises(ConnectionFailedError, match="it goes on where this one has ended"):
        command("Q12")
    assert names_in("logs") == [f".{Q12}.part"]


def test_a_log_that_grows_is_fetched_as_it_was_and_later_its_rest(
    command: Command, robot: LocalRobot, tmp_path: Path
) -> None:
    source, file = robot.root / "u/logs" / Q12, Path("logs", Q12)
    fetched = logs.fetch_log

    def grow(*args: Any) -> bool:
        with source.open("ab") as stream:
            stream.write(b"more")
        return fetched(*args)

    logs.fetch_log = grow
    try:
        printed = command("Q12", delete=True, confirmed=True)
    finally:
        logs.fetch_log = fetched
    assert f"the robot is still writing {Q12}: fetch it again later for the rest" in printed
    assert "has just been written on the robot, so it was not removed" in printed
    assert (file.read_bytes(), source.exists()) == (CONTENT, True)
    assert "just written" in command()
    command("Q12")
    assert file.read_bytes() == CONTENT + b"more"
    with closing(robot.start()) as agent:
        fetch_log(agent, log_of(agent, Q12), file, no_progress)
        assert robot.channel.bytes_from_robot < 100_000


Change = Callable[[Path], object]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda source: source.rename(source.with_name("FRC_20260321_141502.wpilog")), "has renamed or removed it"),
        (lambda source: source.write_bytes(b"short"), "has become shorter on the robot"),
        (lambda source: source.write_bytes(bytes(len(CONTENT))), "was changed on the robot meanwhile, or was damaged"),
    ],
    ids=["renamed", "shorter", "other"],
)
def test_a_log_that_changes_while_it_is_fetched(robot: LocalRobot, tmp_path: Path, change: Change, says: str) -> None:
    with closing(robot.start()) as agent:
        log = log_of(agent, Q12)

        def change_once(done: int, total: int) -> None:
            if done:
                change(robot.root / "u/logs" / Q12)

        with pytest.raises(DeployError, match=says):
            fetch_log(agent, log, tmp_path / Q12, change_once)
        assert not (tmp_path / Q12).exists()
        assert agent.info().current is None, "the agent goes on"


def test_another_file_of_the_name_stays_and_another_part_does_not(command: Command) -> None:
    Path("logs").mkdir()
    Path("logs", Q9).write_bytes(b"mine")
    with pytest.raises(RefusedError, match=r"there is another file of this name, not the robot's log\n.*--into"):
        command("Q9")
    assert Path("logs", Q9).read_bytes() == b"mine"
    Path("logs", f".{Q12}.part").write_bytes(b"of another log")
    command("Q12")
    assert Path("logs", Q12).read_bytes() == CONTENT


def test_a_full_disk_here(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    if Path("/dev/full").exists():
        Path("logs").mkdir()
        Path("logs", f".{Q12}.part").symlink_to("/dev/full")
        monkeypatch.setattr(logs, "_begun", lambda *_: 0)
        with pytest.raises(
            DeployError, match=r"this computer's disk is full\n  Make room on it, or .* it goes on where"
        ):
            command("Q12")
    monkeypatch.setattr(shutil, "disk_usage", lambda path: SimpleNamespace(free=1_000))
    with pytest.raises(
        RefusedError, match="this computer's disk has too little room: 1300 kB are missing, 1000 bytes are free"
    ):
        command("Q12")


def test_logs_are_removed_only_if_asked_and_confirmed(command: Command, robot: LocalRobot) -> None:
    on_robot = robot.root / "u/logs" / Q12
    with pytest.raises(UsageError, match="confirmation needed"):
        command("Q12", delete=True)
    with pytest.raises(UsageError, match="--delete needs the names of logs"):
        command(delete=True, confirmed=True)
    command("Q12", delete=True, answer=False)
    assert command.asked == ["Remove 1 log (1300 kB) from the robot?"]
    assert on_robot.exists()
    assert f"removed from the robot: /u/logs/{Q12}" in command("Q12", delete=True, answer=True)
    assert not on_robot.exists()
    assert Path("logs", Q12).read_bytes() == CONTENT
    (robot.root / "u/logs" / KIT).touch()  # by the program that is still running
    assert "has just been written on the robot, so it was not removed" in command("P1", delete=True, answer=True)
    assert (robot.root / "u/logs" / KIT).exists()


def test_the_agent_touches_nothing_but_logs(robot: LocalRobot) -> None:
    kept = put(robot, "/etc", "a.wpilog", b"", hours=1)
    with closing(robot.start()) as agent:
        for path in ("/etc/a.wpilog", "/u/logs/../../etc/a.wpilog", "/u/logs/notes.txt"):
            with pytest.raises(RefusedError, match="is none of the robot's logs"):
                agent.remove_log(path, 0)
            with pytest.raises(RefusedError, match="is none of the robot's logs"):
                agent.read_log(path, 0, 1)
    assert kept.exists()


@given(st.text(min_size=1, max_size=30))
def test_whatever_a_robot_calls_its_log_it_is_below_the_directory(name: str) -> None:
    parts = logs._local_name(name).parts
    assert parts
    assert not {"..", ".", "", "/"} & set(parts)
    assert not set("".join(parts)) & set('\\/:*?"<>|\0\n')


def test_over_a_real_connection_that_is_cut(make_project: MakeProject) -> None:
    require_roborio()
    project = make_project({"robot.py": ""})
    with Roborio() as computer:
        put_old(computer)
        with Proxy((computer.host, computer.port), cut_from_robot=900_000, host=computer.host) as proxy:
            cut = project.run("logs", "Q12", "--robot", f"{computer.host}:{proxy.port}")
            assert (cut.code, proxy.has_cut) == (1, True), cut.output
        assert "it goes on where this one has ended" in cut.output
        (part,) = (project.path / "logs").glob(".*.part")
        assert (part.name, part.stat().st_size > 0) == (f".{Q12}.part", True)
        done = project.run("logs", "Q12", "--robot", computer.where, "--delete", "--yes")
        assert done.code == 0, done.output
        assert (project.path / "logs" / Q12).read_bytes() == CONTENT
        assert not (computer.home / "logs" / Q12).exists()


@pytest.mark.slow
def test_a_real_connection_to_a_systemcore_that_is_cut(tmp_path: Path) -> None:
    require_systemcore()
    with Systemcore() as computer:
        put_old(computer)
        with Proxy((computer.host, computer.port), cut_from_robot=900_000, host=computer.host) as proxy:
            with pytest.raises(ConnectionFailedError), agent_on(computer, proxy.host, proxy.port) as agent:
                fetch_log(agent, log_of(agent, Q12), tmp_path / Q12, no_progress)
            assert proxy.has_cut
        begun = (tmp_path / f".{Q12}.part").stat().st_size
        seen: list[int] = []
        with agent_on(computer, computer.host, computer.port) as agent:
            fetch_log(agent, log := log_of(agent, Q12), tmp_path / Q12, lambda done, total: seen.append(done))
            agent.remove_log(log.path, log.size)
        assert seen[0] == begun > 0
        assert (tmp_path / Q12).read_bytes() == CONTENT
        assert not (computer.home / "logs" / Q12).exists()


def put_old(computer: Computer) -> None:
    """Put a log on it that is not being written."""
    file = computer.put(f"{computer.home_directory}/logs/{Q12}", CONTENT)
    os.utime(file, (1_774_100_000, 1_774_100_000))


@contextmanager
def agent_on(computer: Computer, host: str, port: int) -> Iterator[AgentClient]:
    with SshConnection(host, port, None, computer.controller) as ssh, closing(AgentClient.start(ssh)) as agent:
        yield agent
