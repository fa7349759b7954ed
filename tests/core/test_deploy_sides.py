"""Both sides of a deploy, with a connection, a robot and a disk that are made up: what carries over, what is shown."""

from __future__ import annotations

import os
import struct
import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from loops import for_each
from written_files import write_files

from pyfrc_core.config.robotpy import RobotPackages
from pyfrc_core.deploy import console, robot_packages, session
from pyfrc_core.deploy.agent import carrying, disk, system
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.console import ConsoleFrames, ConsoleProtocolError, text_frame
from pyfrc_core.deploy.console import ConnectionReports
from pyfrc_core.deploy.discovery import Address, _why
from pyfrc_core.deploy.errors import ConnectionFailedError, NoConsoleError, RefusedError
from pyfrc_core.deploy.progress import DeployProgress, UserInterface
from pyfrc_core.deploy.targets import systemcore
from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE
from pyfrc_core.errors import UsageError

QUIET = Activity(lambda **said: None)


def tree(root: Path) -> dict[str, str]:
    return {each.relative_to(root).as_posix(): each.read_text() for each in sorted(root.rglob("*")) if each.is_file()}


# -- on the robot ------------------------------------------------------------------------------------------------------


@pytest.mark.skipif(sys.platform == "win32", reason="the agent runs on Linux")
def test_what_the_program_has_written_is_carried_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def link_file(source: str, target: str) -> None:
        if source.endswith("pipe"):  # as Linux forbids it to all users but root
            raise PermissionError
        os.link(source, target)

    monkeypatch.setattr(disk, "link_file", link_file)
    old = write_files(
        tmp_path / "1", {"robot.py": "1", "data/log.txt": "a", "photos": "p", "notes/x": "n", "lib/a.py": "1"}
    )
    (old / "empty").mkdir()
    os.mkfifo(old / "pipe")
    new = write_files(tmp_path / "2", {"robot.py": "2", "photos/a.jpg": "new", "notes": "file", "lib/a.py": "2"})
    manifests = {"robot.py", "lib/a.py"}, {"robot.py", "photos/a.jpg", "notes", "lib/a.py"}
    between = tmp_path / "between"
    first = carrying.carry_over(old, new, manifests, None, between, QUIET)
    kept = {"robot.py": "2", "lib/a.py": "2", "photos/a.jpg": "new", "notes": "file"}
    carried = {"data/log.txt": "a", "photos.release-1": "p", "notes.release-1/x": "n"}
    assert tree(new) == {**kept, **carried}
    assert (new / "empty").is_dir()
    assert (sorted(first.renamed), first.skipped) == (["notes.release-1", "photos.release-1"], ["pipe"])
    assert first.files == {name: (old / name).stat().st_ino for name in ("data/log.txt", "photos", "notes/x")}
    # Later, only what the old program has written since; what the new one has changed is its own.
    (old / "data/log.txt").unlink()
    write_files(old, {"data/log.txt": "b", "late.txt": "l"})
    (new / "photos.release-1").unlink()
    write_files(new, {"photos.release-1": "changed"})
    carrying.carry_over(old, new, manifests, first.files, between, QUIET)
    assert tree(new) == {**kept, **carried, "data/log.txt": "b", "late.txt": "l", "photos.release-1": "changed"}
    assert not between.exists()


def test_of_another_tools_directory_the_code_is_left(tmp_path: Path) -> None:
    old = write_files(
        tmp_path / "other", {"robot.py": "1", "a.pyc": "", "deploy.json": "{}", "log.txt": "x", "same.txt": "s"}
    )
    new = write_files(tmp_path / "2", {"robot.py": "2", "log.txt": "y", "same.txt": "s", "log.txt.release-2": "z"})
    carrying.carry_over(old, new, (None, {"robot.py"}), None, tmp_path / "between", QUIET)
    assert tree(new) == {
        "robot.py": "2",
        "log.txt": "x",
        "log.txt.release-2": "z",
        "log.txt.release-2-2": "y",
        "same.txt": "s",
    }


@for_each("length, kept", [(220, 220), (221, 50)])
def test_a_long_name_is_cut_for_its_suffix(length: int, kept: int, tmp_path: Path) -> None:
    target = tmp_path / ("x" * length)
    target.write_text("a")
    (tmp_path / "other").write_text("b")
    carrying._keep_beside(target, tmp_path / "other", "3")
    assert (tmp_path / f"{'x' * kept}.release-3").read_text() == "a"


def test_two_names_are_exchanged_in_one_step(tmp_path: Path) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    one.write_text("1")
    other.write_text("2")
    assert isinstance(system.user(), str)
    assert system.is_own(one.stat())
    link = tmp_path / "link"
    link.symlink_to("one")
    assert system.linked_directory(link) == one
    assert system.linked_directory(one) is None
    (tmp_path / "next").symlink_to("other")
    system.replace_link(tmp_path / "next", link)
    assert link.read_text() == "2"


def test_the_disk_space_that_a_python_takes(tmp_path: Path) -> None:
    archive = tmp_path / "python.tar.gz"
    archive.write_bytes(b"12345678" + struct.pack("<I", 1000))
    assert systemcore._needed_for_python(archive) == 12 + 1250


@for_each(
    "message, found",
    [
        ({"robotIp": "10.0.0.2", "fmsControlled": True}, ("10.0.0.2", True)),
        ({"robotIp": "0.0.0.0"}, (None, False)),
        ({"robotIp": "robot", "fmsControlled": 1}, (None, False)),
        ({"robotIp": 3}, (None, False)),
    ],
)
def test_what_a_systemcores_driver_station_says(message: dict[str, Any], found: tuple[str | None, bool]) -> None:
    assert systemcore._station_robot(message) == found


# -- the console -------------------------------------------------------------------------------------------------------


def test_frames_of_a_console() -> None:
    whole = text_frame(b"one\n", 1) + b"\0\0" + text_frame("zwei ß".encode(), 2)
    for size in (1, 5, len(whole)):
        frames, pieces = ConsoleFrames(), [whole[begin : begin + size] for begin in range(0, len(whole), size)]
        assert [line.text for piece in pieces for line in frames.lines(piece)] == ["one", "zwei ß"]
    sent = text_frame(b"x" * 70_000, 65_537)
    ((seconds, line),) = ConsoleFrames().lines(sent)
    assert (seconds > 0, line) == (True, "x" * 65_000)
    assert sent[7:9] == b"\0\x01", "the number of a line is counted in two bytes"
    texts = b"".join(struct.pack(">H", len(each)) + each for each in (b"details", b"place", b"stack"))
    head = struct.pack(">BfHHiB", 11, 2.5, 1, 1, -44, 1)
    error = head + texts
    (line,) = ConsoleFrames().lines(struct.pack(">H", len(error)) + error)
    assert (line.seconds, line.text) == (2.5, "-44 details place stack")
    for wrong, why in (
        (error[:-1], "it sends an error message with texts longer than the message"),
        (head[:3], "it sends an error message of 3 bytes, which is too short"),
        (text_frame(b"", 1)[2:5], "it sends a text message of 3 bytes, which is too short"),
        (b"\xff", "it sends messages of kind 255, which does not exist"),
    ):
        with pytest.raises(ConsoleProtocolError, match=f"^{why}$"):
            list(ConsoleFrames().lines(struct.pack(">H", len(wrong)) + wrong))
    with pytest.raises(ConsoleProtocolError, match="empty"):
        list(ConsoleFrames().lines(bytes(1 << 16)))


class Channel:
    """The output of a command over SSH."""

    def __init__(self, pieces: list[bytes | None], status: int = 0, errors: bytes = b"") -> None:
        self._pieces, self._status, self._errors = pieces, status, errors
        self.timeout = 0.0

    def settimeout(self, seconds: float) -> None:
        self.timeout = seconds

    def recv(self, count: int) -> bytes:
        piece = self._pieces.pop(0) if self._pieces else b""
        if piece is None:
            raise TimeoutError
        return piece

    def exit_status_ready(self) -> bool:
        return self._status >= 0

    def recv_exit_status(self) -> int:
        return self._status

    def recv_stderr(self, count: int) -> bytes:
        return self._errors


def connection_with(channel: Channel) -> Any:
    @contextmanager
    def opened(command: str) -> Iterator[Channel]:
        assert command.split()[0] in " ".join(SYSTEMCORE.layout.output)
        yield channel

    return SimpleNamespace(controller=SYSTEMCORE, address=Address("10.0.0.2"), opened=opened)


def test_lines_of_a_command_over_ssh(capsys: pytest.CaptureFixture[str]) -> None:
    channel = Channel([b"one\ntw", None, b"o\n", b"x" * ((1 << 16) + 1), b"rest\nnever ended"], status=-1)
    reports = ConnectionReports(quiet=False)
    lines = list(console._lines_over_ssh(lambda: nullcontext(connection_with(channel)), reports))
    assert lines == ["one", "two", "x" * ((1 << 16) + 1), "rest"]
    assert channel.timeout == console._WAKE_SECONDS
    said = ["connected to 10.0.0.2", "the connection was lost; reconnecting to 10.0.0.2"]
    assert capsys.readouterr().err.splitlines() == said
    list(console._lines_over_ssh(lambda: nullcontext(connection_with(Channel([]))), reports))
    assert capsys.readouterr().err.splitlines() == said

    def fails() -> Any:
        raise ConnectionFailedError("no route", where="10.0.0.2")

    for _ in range(2):
        assert list(console._lines_over_ssh(fails, reports)) == []
    assert capsys.readouterr().err == "10.0.0.2: no route\n"


@for_each("errors, said", [(b" no journal\n", "no journal"), (b"", "exit code 3")])
def test_a_command_that_cannot_print_the_output(errors: bytes, said: str) -> None:
    with pytest.raises(NoConsoleError) as error:
        list(console._printed_lines(connection_with(Channel([], 3, errors))))
    assert (error.value.message, error.value.where) == (f"the program's output cannot be read: {said}", "10.0.0.2")


def test_a_report_about_a_connection_is_made_once(capsys: pytest.CaptureFixture[str]) -> None:
    report = ConnectionReports(quiet=False)
    for _ in range(2):
        report("lost", "it was lost\x07")
    report.reset()
    report("lost", "again")
    assert capsys.readouterr().err == "it was lost\\x07\nagain\n"
    quiet = ConnectionReports(quiet=True)
    quiet("lost", "it was lost")
    assert (capsys.readouterr().err, quiet.made) == ("", {"lost"})


# -- on the laptop -----------------------------------------------------------------------------------------------------


@for_each(
    "error, host, why",
    [
        (TimeoutError(), "10.0.0.2", "no response within"),
        (ConnectionRefusedError(), "10.0.0.2", "refused: a computer is there, but no SSH server"),
        (ConnectionRefusedError(), "127.0.0.1", "refused: no virtual robot runs at port 22"),
        (ConnectionResetError(), "10.0.0.2", "closed the connection"),
        (OSError(113, "No route to host"), "10.0.0.2", "no route to host"),
        (OSError("Odd"), "10.0.0.2", "odd"),
    ],
)
def test_why_an_address_does_not_respond(error: OSError, host: str, why: str) -> None:
    assert _why(error, Address(host)).startswith(why)


@dataclass(frozen=True)
class Facts:
    """Those of `RobotFacts` that are shown."""

    current: int | None = None
    releases: tuple[Any, ...] = ()
    image: str | None = "FRC_2026"
    python: str = "3.14.0"
    wpilib: str | None = "2026.2.2"
    free_bytes: int = 12_340_000
    other_code: bool = False
    deploy_json: Any = None
    running: bool = False
    program_age: float | None = None


def release(number: int, **more: Any) -> Any:
    same = {"ran": False, "ended": False, "damaged": False, "taken": False, "deploy_json": {}}
    return SimpleNamespace(number=number, **{**same, **more})


def test_what_is_known_of_a_robot_as_text() -> None:
    info_text: Any = session.info_text
    assert info_text(Facts(image=None, wpilib=None), "").splitlines() == [
        "robot      unknown image, Python 3.14.0, wpilib missing",
        "disk       12.3 MB free",
        "program    none",
    ]
    deployed = {"deploy-user": "ada", "deploy-date": "today", "code-path": "/robot", "git-desc": "v1-dirty"}
    by_git = {**deployed, "deploy-host": "laptop", "git-branch": "main", "git-desc": "v2"}
    releases = release(1, taken=True), release(2, ran=True, damaged=True), release(3, deploy_json=by_git, ended=True)
    text = info_text(Facts(3, releases, deploy_json=deployed, running=True, program_age=12.4), "Ada's")
    assert text.splitlines() == [
        "name       Ada's",
        "robot      FRC_2026, Python 3.14.0, wpilib 2026.2.2",
        "disk       12.3 MB free",
        "program    release 3, ended after its last start; started again 12 s ago",
        "  by           ada on an unknown computer",
        "  date         today",
        "  from         /robot",
        "  commit       v1, with uncommitted changes",
        "* release 3   today, ada on laptop, v2 on main, ended after its last start",
        "  release 2   date unknown, seen to run, its record is damaged",
        "  release 1   date unknown, left by another tool",
    ]
    (program,) = info_text(Facts(other_code=True, deploy_json={}, running=True, program_age=0.42), "").splitlines()[2:]
    assert program == "program    deployed by another tool, running for 0.4 s"
    for number, running, age, says in (
        (2, True, 312.4, "running for 312 s"),
        (2, True, None, "running"),
        (2, False, None, "not running"),
        (3, True, None, "ended after its last start; started again"),
        (3, False, 0.42, "ended after its last start; not running"),
    ):
        text = info_text(Facts(number, releases, deploy_json={}, running=running, program_age=age), "")
        assert f"program    release {number}, {says}" in text.splitlines()
    shown = StringIO()
    session._note_unfit_releases(
        Facts(3, (release(2, damaged=True), release(1, ran=True, ended=True), release(3, ran=True, ended=True))),  # type: ignore[arg-type]
        DeployProgress(shown),
    )
    assert shown.getvalue().splitlines() == [
        "  the record of release 2 on the robot is damaged: it cannot be started again",
        "  release 3 ended after its last start: only --rollback 3 selects it",
    ]


def test_commands_about_a_robot_and_their_results(monkeypatch: pytest.MonkeyPatch) -> None:
    shown, results = StringIO(), list[Any]()
    talk = UserInterface(DeployProgress(shown))
    monkeypatch.setattr(talk.progress, "result", lambda *result, **more: results.append((*result, more)))
    robot = SimpleNamespace(facts=Facts(), undeploy=lambda work: results == [])
    key = SimpleNamespace(fingerprint="SHA256:x")
    link = SimpleNamespace(host="10.0.0.2", recognized=SimpleNamespace(name=""), key=key)
    monkeypatch.setattr(session, "connected_agent", lambda *asked: nullcontext((link, robot)))
    monkeypatch.setattr(session, "choose_target", lambda *asked: "target")
    choice: Any = None
    session.undeploy(None, choice, talk, True)
    session.undeploy(None, choice, talk, True)
    assert results == [
        ({"host": "10.0.0.2", "removed": True}, "The robot program was removed.", {}),
        ({"host": "10.0.0.2", "removed": False}, "There was no robot program to remove.", {}),
    ]
    with pytest.raises(UsageError, match="confirmation needed: the robot program and all of its releases"):
        session.undeploy(None, choice, talk, False)
    session.show_info(None, choice, talk)
    info, text, more = results[-1]
    assert {"host": "10.0.0.2", "robot_name": None, "host_key": "SHA256:x", "python": "3.14.0"}.items() <= info.items()
    assert text.startswith("robot      FRC_2026")
    assert more == {"requested": True}


def test_packages_that_prevent_a_deploy(monkeypatch: pytest.MonkeyPatch) -> None:
    packages = RobotPackages("2026.1", ("comands2",), (), {"robotpy_version": "p:2", "components": "p:3"})
    search: Any = SimpleNamespace(problems=lambda facts, packages: [])
    facts: Any = SimpleNamespace(wpilib="2026.2.2", image="FRC_2026", packages={"wpilib": "2026.2.2"}, python="3.14.0")
    shown = StringIO()
    check: Any = robot_packages.check_packages
    with pytest.raises(RefusedError) as refused:
        check(search, packages, facts, UserInterface(DeployProgress(shown)), refuse=True, dry_run=False)
    assert "components has 'comands2', which does not exist" in refused.value.message
    assert "robotpy_version is 2026.1, but the robot has wpilib 2026.2.2" in refused.value.message
    check(search, packages, facts, UserInterface(DeployProgress(shown)), refuse=True, dry_run=True)
    assert [line.partition(": ")[0] for line in shown.getvalue().splitlines()] == ["warning"] * 2
    check(search, packages, facts, UserInterface(DeployProgress(shown)), refuse=False, dry_run=False)
