"""What the agent does around a deploy: restarts and watches, the laptop's progress, which releases stay, cuts."""

from __future__ import annotations

import io
import json
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from pyfrc_core.deploy.agent import host, program, releases, serve, system, transaction
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.compiling import CompiledForms, Compiler
from pyfrc_core.deploy.agent.content_index import ContentIndex
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.program import Program
from pyfrc_core.deploy.agent.releases import Releases
from pyfrc_core.deploy.agent.robot_paths import Refusal, RobotPaths
from pyfrc_core.deploy.agent.virtual import VARIABLE, VirtualRobotClient
from pyfrc_core.deploy.agent.wire import Wire, message_frame, parse_message, read_frame
from pyfrc_core.deploy.targets.roborio import ROBORIO

from .agent_disk import AgentDisk, contents, manifest

ONE = {"robot.py": "# one\nimport arm\n", "arm.py": "# arm\n", "data/path.json": "{}"}
TWO = {**ONE, "robot.py": "# two\nimport arm\n"}


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AgentDisk:
    """A robot with an empty disk, on which nothing has to wait for the disk."""
    monkeypatch.setattr(releases, "flush", lambda directory: None)
    return AgentDisk(tmp_path / "robot")


def numbered(robot: AgentDisk, *numbers: int) -> None:
    for number in numbers:
        robot.deploy({"robot.py": f"# {number}\n"}, f"# {number}\n")


def record(robot: AgentDisk, number: int) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(robot.read(f".pyfrc/releases/{number}.json") or "{}")
    return found


def quiet(robot: AgentDisk) -> Releases:
    return Releases(robot.places, Activity(lambda **message: None))


# -- a restart and its watch -------------------------------------------------------------------------------------------


@pytest.fixture
def verdicts(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What the next watches find; each restart is noted in `restarted`."""
    found: list[str] = []
    monkeypatch.setattr(Program, "restart", lambda self, main, has_run: restarted.append(main) or len(restarted) > 1)
    monkeypatch.setattr(
        Program,
        "watch",
        lambda self, wire, seconds, unheard: (
            watched.append((seconds, unheard)) or {"verdict": found.pop(0), "age": 3.0}
        ),
    )
    restarted.clear()
    watched.clear()
    return found


restarted: list[Path | None] = []
watched: list[tuple[float, float]] = []


def test_a_restart_starts_the_current_release_and_its_watch_is_recorded(robot: AgentDisk, verdicts: list[str]) -> None:
    verdicts += ["ended", "running", "ended"]
    watch = {"op": "watch", "seconds": 9, "unheard": 4}
    request = {"op": "deploy", "files": manifest(ONE), "main": "robot.py"}
    *_, restart, seen = robot.ask(request, contents(*ONE.values()), {"op": "restart"}, watch)
    assert restart == {"done": {"survived": False}}
    assert seen == {"done": {"verdict": "ended", "age": 3.0}}
    assert restarted == [robot.places.code / "robot.py"]
    assert (record(robot, 1)["ran"], record(robot, 1)["ended"]) == (False, True)
    assert "carried" not in record(robot, 1)
    assert robot.ask({"op": "restart"}, {"op": "watch", "seconds": 5}) == [
        {"done": {"survived": True}},
        {"done": {"verdict": "running", "age": 3.0}},
    ]
    assert (record(robot, 1)["ran"], record(robot, 1)["ended"]) == (True, False)
    robot.ask({"op": "restart"}, watch)
    assert (record(robot, 1)["ran"], record(robot, 1)["ended"]) == (True, True)
    assert watched == [(9, 4), (5, 5), (9, 4)]


def test_a_watch_without_a_restart_records_nothing(robot: AgentDisk, verdicts: list[str]) -> None:
    verdicts += ["running", "unheard"]
    robot.deploy(ONE, *ONE.values())
    robot.ask({"op": "watch", "seconds": 5})
    assert record(robot, 1).get("ran") is None
    robot.ask({"op": "restart"}, {"op": "watch", "seconds": 5})
    assert record(robot, 1)["ran"] is True


def test_a_robot_without_a_release_is_restarted_too(robot: AgentDisk, verdicts: list[str]) -> None:
    assert robot.ask({"op": "restart"}) == [{"done": {"survived": False}}]
    assert restarted == [None]


def test_the_lock_is_held_from_the_deploy_to_the_end_of_the_watch(
    robot: AgentDisk, verdicts: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    verdicts += ["running"]
    held: list[bool] = []

    def is_held() -> bool:
        with robot.places.lock.open("a") as file:
            try:
                system.lock(file)
            except OSError:
                return True
        return False

    real = serve.Agent._watch
    monkeypatch.setattr(serve.Agent, "_respond", _noting(serve.Agent._respond, lambda: held.append(is_held())))
    assert real is serve.Agent._watch
    request = {"op": "deploy", "files": manifest(ONE), "main": "robot.py"}
    robot.places.own.mkdir()
    robot.ask(request, contents(*ONE.values()), {"op": "restart"}, {"op": "watch", "seconds": 1})
    assert held == [False, True, True, False]  # the facts, the deploy, the restart, the watch


def _noting(call: Callable[..., Any], note: Callable[[], object]) -> Callable[..., Any]:
    def noting(*args: Any) -> Any:
        try:
            return call(*args)
        finally:
            note()

    return noting


def test_a_watch_reports_once_a_second_what_is_new(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr(program.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(RealRobot, "processes", lambda robot: listed.append(now[0]) or {8})
    monkeypatch.setattr(RealRobot, "is_running", lambda robot, process: process == 8)
    monkeypatch.setattr(program, "process_state", lambda host, process: {"cpu": 1.0})
    listed: list[float] = []
    waits: list[float] = []
    texts = iter(["one\n", "", "two\n"])
    ours = Program(RealRobot(RobotPaths(ROBORIO.layout, str(tmp_path))))

    def receive(seconds: float) -> str:
        waits.append(seconds)
        now[0] += 0.25
        return next(texts, "")

    monkeypatch.setattr(ours._console, "receive", receive)
    source, target = os.pipe()
    answers = io.BytesIO()
    with io.FileIO(source, "rb") as stream, io.FileIO(target, "wb"):
        done = ours.watch(Wire(stream, answers), 3.0, 60)
    assert (done["verdict"], done["seconds"], done["cpu"]) == ("starting", 3.0, 1.0)
    answers.seek(0)
    sent = []
    while answers.tell() < len(answers.getvalue()):
        sent.append(parse_message(*read_frame(answers.read)))
    assert [each["output"] for each in sent if "output" in each] == ["one\n", "two\n"]
    assert [each["watching"]["seconds"] for each in sent if "watching" in each] == [1.0, 2.0]
    assert listed == [100.25, 101.25, 102.25]  # listing all is expensive
    assert set(waits) == {0.1}


# -- what the laptop shows meanwhile -----------------------------------------------------------------------------------


def phases_of(do: Callable[[Activity], object]) -> list[str]:
    """The phases that keep-alive messages name, in their order."""
    found: list[str] = []

    def send(**message: Any) -> None:
        phase = message["alive"]["phase"]
        if found[-1:] != [phase]:
            found.append(phase)

    do(Activity(send, pause=0.0))
    return found


def test_the_phases_of_releases(robot: AgentDisk) -> None:
    numbered(robot, 1)
    file = robot.home / "file"
    file.touch()
    assert phases_of(lambda activity: Releases(robot.places, activity).remove(file)) == ["remove"]
    assert not file.exists()
    assert phases_of(lambda activity: Releases(robot.places, activity).flush(robot.home)) == ["sync"]
    (robot.home / ".pyfrc/releases/1/log.txt").touch()
    new = robot.home / "new"
    new.mkdir()

    def carry(activity: Activity) -> None:
        Releases(robot.places, activity).carry_over(robot.places.code.resolve(), new, None)

    assert phases_of(carry) == ["carry"]
    assert (new / "log.txt").exists()


def test_the_steps_of_compiling(tmp_path: Path) -> None:
    names = [f"{letter}.py" for letter in "abc"]
    for name in names:
        (tmp_path / name).write_text("x = 1\n")
    signs: list[dict[str, Any]] = []
    with Compiler(tmp_path, names, debug=False) as compiler:
        for _ in names:
            compiler.add_next()
        compiler.finish(Activity(lambda **message: signs.append(message["alive"]), pause=0.0))
    assert {(each["phase"], each["of"]) for each in signs} == {("compile", 3)}
    assert signs[-1]["count"] == 3


# -- which releases stay -----------------------------------------------------------------------------------------------


def test_what_the_current_release_has_replaced_stays(robot: AgentDisk) -> None:
    numbered(robot, 1, 2, 3)
    robot.ask({"op": "rollback", "release": 1})
    numbered(robot, 4)
    assert record(robot, 4)["from"] == 1
    assert quiet(robot).numbers() == [1, 3, 4]
    numbered(robot, 5)
    assert quiet(robot).numbers() == [3, 4, 5]
    quiet(robot).prune(kept=1)
    assert quiet(robot).numbers() == [4, 5]  # what 4 has written after the switch is not carried over yet
    quiet(robot).carry_late_writes(5)
    quiet(robot).prune(kept=1)
    assert quiet(robot).numbers() == [5]


def test_a_release_loses_its_name_before_it_is_removed(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    numbered(robot, 1, 2)
    removed: list[tuple[str, list[int]]] = []
    records = quiet(robot)

    def remove(path: Path, *, if_possible: bool = False) -> None:
        removed.append((path.name, records.numbers()))
        assert if_possible

    monkeypatch.setattr(records, "remove", remove)
    (robot.places.own / "trash-1").mkdir()
    quiet(robot).carry_late_writes(2)
    records.prune(kept=1)
    assert removed == [("trash-2", [2])]


def test_a_switch_from_another_tools_program_that_was_cut_is_finished(robot: AgentDisk) -> None:
    numbered(robot, 1)
    robot.places.code.unlink()
    robot.places.code.mkdir()
    (robot.places.code / "robot.py").write_text("# other\n")
    command = robot.read("robotCommand") or ""
    (robot.home / "robotCommand").write_text(command.replace("/home/lvuser/py/", "/home/lvuser/.pyfrc/releases/1/"))
    quiet(robot).recover()
    assert robot.startable() == "py/robot.py: # 1"
    assert quiet(robot).current() == 1
    assert quiet(robot).numbers() == [1, 2]
    assert record(robot, 2)["taken"] is True
    assert robot.read(".pyfrc/releases/2/robot.py") == "# other\n"


def test_a_rollback_over_another_tools_program_keeps_that(robot: AgentDisk) -> None:
    numbered(robot, 1)
    robot.places.code.unlink()
    robot.places.code.mkdir()
    (robot.places.code / "robot.py").write_text("# other\n")
    (robot.places.code / "log.txt").write_text("written by it")
    (robot.home / "robotCommand").write_text("python3 --main /home/lvuser/py/robot.py run\n")
    (answer,) = robot.ask({"op": "rollback", "release": 1})
    assert answer["done"]["release"] == 1
    assert answer["done"]["previous"] is None
    assert robot.startable() == "py/robot.py: # 1"
    assert quiet(robot).numbers() == [1, 2]
    assert robot.read("py/log.txt") == "written by it"
    assert record(robot, 1)["carried"]["from"] == 2


def test_another_users_directory_cannot_be_taken(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    robot.places.code.mkdir()
    (robot.places.code / "robot.py").write_text("# other\n")
    monkeypatch.setattr(os, "access", lambda path, how: False)
    *_, answer = robot.deploy(ONE, *ONE.values())
    assert (answer["error"], answer["message"]) == (
        "disk",
        "/home/lvuser/py belongs to another user of the robot, and cannot be moved",
    )
    assert robot.read("py/robot.py") == "# other\n"
    assert not robot.places.incoming.exists()


def test_no_file_stays_open(robot: AgentDisk) -> None:
    numbered(robot, 1)
    before = open_files()
    numbered(robot, 2, 3)
    robot.ask({"op": "rollback"})
    robot.ask({"op": "plan", "files": manifest(ONE)})
    assert open_files() == before


def open_files() -> int:
    return len(list(Path("/proc/self/fd").iterdir())) if sys.platform == "linux" else 0


def test_undeploy_is_on_the_disk_before_the_program_is_stopped_and_when_it_is_done(
    robot: AgentDisk, monkeypatch: pytest.MonkeyPatch
) -> None:
    numbered(robot, 1)
    log: list[str] = []

    def note(what: str) -> None:
        there = [name for name in ("robotCommand", "py", ".pyfrc") if (robot.home / name).exists()]
        log.append(f"{what}: {' '.join(there)}")

    monkeypatch.setattr(releases, "flush", lambda directory: note(f"flush {directory.name}"))
    monkeypatch.setattr(RealRobot, "stop", lambda host, start: note("stop"))
    robot.ask({"op": "undeploy"})
    assert log == ["flush lvuser: py .pyfrc", "stop: py .pyfrc", "flush lvuser: "]


def test_a_compiling_process_that_was_killed_is_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = ["a.py", "b.py", "c.py"]
    for name in names:
        (tmp_path / name).write_text("x = 1\n")
    forked: list[int] = []
    fork = os.fork

    def noting() -> int:
        forked.append(fork())
        return forked[-1]

    monkeypatch.setattr(os, "fork", noting)
    with Compiler(tmp_path, names, debug=False) as compiler:
        os.kill(forked[0], signal.SIGKILL)
        for _ in names:
            compiler.add_next()
        compiler.finish(Activity(lambda **message: None))
    assert len(forked) == 2
    assert sorted(each.name.partition(".")[0] for each in (tmp_path / "__pycache__").iterdir()) == ["a", "b", "c"]


# -- contents ----------------------------------------------------------------------------------------------------------


def test_a_file_that_is_changed_while_it_is_copied_is_refused(
    robot: AgentDisk, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot.deploy(ONE, *ONE.values())
    copies = {"arm.py": "# arm\n", "robot.py": "# two\n", "wrist.py": "# arm\n"}  # the wrist's is a copy of the arm's
    real = ContentIndex.copy

    def change(self: ContentIndex, wanted: Any) -> str | None:
        found = real(self, wanted)
        if found is not None and wanted.path == "wrist.py":
            changed = robot.root / "changed"
            changed.write_text("# changed\n")
            return str(changed)
        return found

    monkeypatch.setattr(ContentIndex, "copy", change)
    *_, answer = robot.deploy(copies, "# two\n")
    assert answer["message"] == "wrist.py was changed by the robot program during the deploy"
    assert robot.startable() == "py/robot.py: # one"
    monkeypatch.undo()
    with pytest.raises(Refusal):
        transaction._copy(None, transaction.parse_manifest(manifest(ONE))[0], robot.root / "x", Activity(print))


def test_compiled_forms_go_along(tmp_path: Path) -> None:
    (tmp_path / "old/__pycache__").mkdir(parents=True)
    (tmp_path / "new").mkdir()
    for form in ("a.cpython-39.pyc", "a.cpython-39.opt-1.pyc", "b.cpython-39.pyc"):
        (tmp_path / "old/__pycache__" / form).write_text(form)
    forms = CompiledForms()
    assert [Path(each).name for each in forms.of(f"{tmp_path}/old/a.py")] == [
        "a.cpython-39.opt-1.pyc",
        "a.cpython-39.pyc",
    ]
    assert forms.of(f"{tmp_path}/old/a.txt") == forms.of(f"{tmp_path}/old/c.py") == []
    forms.link(f"{tmp_path}/old/c.py", f"{tmp_path}/new/c.py")
    assert not (tmp_path / "new/__pycache__").exists()
    forms.link(f"{tmp_path}/old/a.py", f"{tmp_path}/new/a.py")
    forms.link(f"{tmp_path}/old/b.py", f"{tmp_path}/new/b.py")
    assert len(list((tmp_path / "new/__pycache__").iterdir())) == 3


# -- a virtual robot ---------------------------------------------------------------------------------------------------


def test_a_virtual_robots_program_is_asked_for_and_restarted() -> None:
    asked: list[str] = []
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def respond() -> None:
            for _ in range(5):
                connection, _ = listener.accept()
                with connection, connection.makefile("rw") as stream:
                    key, request = stream.readline().split()
                    asked.append(f"{key}: {request}")
                    stream.write("[3, 4]")

        thread = threading.Thread(target=respond, daemon=True)
        thread.start()
        virtual = VirtualRobotClient(ROBORIO.layout, "/robot", listener.getsockname()[1], "key", 1)
        assert virtual.processes() == {3, 4}
        assert (virtual.is_running(3), virtual.is_running(5)) == (True, False)
        assert virtual.stop(start=True) is False
        assert virtual.stop(start=False) is False
        thread.join(60)
    assert asked == ["key: processes"] * 3 + ["key: restart", "key: stop"]
    assert virtual.can_restart()
    assert virtual.other_languages() == []
    assert virtual.serves_network_tables(3) is None


AGENT = "import sys; from pyfrc_core.deploy.agent.serve import main; main(open(0, 'rb', buffering=0))"


def test_the_agent_as_a_process(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a disk that the laptop names; what it sends then is no frame."""
    monkeypatch.delenv(VARIABLE, raising=False)
    (tmp_path / "home/lvuser").mkdir(parents=True)
    (tmp_path / "home/lvuser/robotCommand").write_text("the command")
    sent = [{"root": str(tmp_path), "layout": ROBORIO.layout._asdict()}, {"op": "plan", "files": manifest(ONE)}]
    stream = b"".join(map(message_frame, sent)) + b"\0\0\0\3Xabc"
    done = subprocess.run([sys.executable, "-c", AGENT], input=stream, capture_output=True)
    assert (done.returncode, done.stderr) == (1, b"")
    answers = io.BytesIO(done.stdout)
    facts = parse_message(*read_frame(answers.read))["done"]
    assert (facts["command"], facts["home"]) == ("the command", True)
    assert parse_message(*read_frame(answers.read))["done"]["added"] == list(ONE)


# -- processes of a roboRIO --------------------------------------------------------------------------------------------


def test_a_process_that_serves_network_tables(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        monkeypatch.setattr(host, "NETWORK_TABLES_PORT", server.getsockname()[1])
        assert RealRobot(RobotPaths(ROBORIO.layout)).serves_network_tables(os.getpid()) is True
        with socket.create_connection(server.getsockname()):
            pass
    assert RealRobot(RobotPaths(ROBORIO.layout)).serves_network_tables(os.getpid()) is False


def test_programs_are_known_by_their_command_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Below a directory of this test's own: no agent of another test takes them for its robot's.
    home = str(tmp_path)
    robot = RealRobot(RobotPaths(ROBORIO.layout._replace(home=home, code=f"{home}/py")))
    started: list[subprocess.Popen[bytes]] = []

    def start(name: str, *words: str) -> int:
        code = "import sys; print(flush=True); sys.stdin.read()"
        process = subprocess.Popen(
            [name, "-c", code, *words], executable=sys.executable, stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        started.append(process)
        assert process.stdout is not None
        process.stdout.readline()
        return process.pid

    try:
        ours = {start("/usr/local/bin/python3", f"{home}/py/robot.py"), start("java", f"{home}/Robot.jar")}
        ours.add(start(f"{home}/frcUserProgram"))
        others = {start("python3", "/tmp/robot.py"), start("tail", f"{home}/py/robot.py"), start("java", "x.jar")}
        found = robot.processes()
        assert found & (ours | others) == ours
        monkeypatch.setattr(host.os, "geteuid", lambda: -1)
        assert robot.processes() == set()
    finally:
        for process in started:
            process.communicate()


def test_ages_and_processor_time(monkeypatch: pytest.MonkeyPatch) -> None:
    ticks = os.sysconf("SC_CLK_TCK")
    fields = ["S"] + ["0"] * 10 + [str(3 * ticks), str(2 * ticks)] + ["0"] * 6 + [str(60 * ticks)]
    files = {"/proc/7/stat": f"7 (a) b) {' '.join(fields)}", "/proc/uptime": "100.5 7", "/proc/8/stat": "8 (x"}
    fields[19] = str(20 * ticks)
    files["/proc/9/stat"] = f"9 (python) {' '.join(fields)}"

    def read_text(path: Path) -> str:
        if str(path) not in files:
            raise FileNotFoundError
        return files[str(path)]

    monkeypatch.setattr(Path, "read_text", read_text)
    assert host.cpu_seconds(7) == 5
    assert host.age_of([7]) == 40.5
    assert host.age_of([6, 7, 8, 9]) == 80.5
    assert host.age_of([6, 8]) is None
