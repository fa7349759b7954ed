"""Projects of thousands of files: keep-alive messages, limited memory. Linear work is in `core/test_agent_deploy`."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from importlib.util import cache_from_source
from pathlib import Path
from typing import Any

import pytest
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, LocalRobot, project_of

from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.compiling import Compiler
from pyfrc_core.deploy.agent_client import AgentClient, DeployRequest
from pyfrc_core.deploy.manifest import Entry, Manifest
from pyfrc_core.deploy.progress import describe_work

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="an agent runs on Linux")

REQUEST = DeployRequest("robot.py", {})


class Signs:
    """An activity with a stopped clock, and its messages."""

    def __init__(self) -> None:
        self.now = 0.0
        self.sent: list[tuple[str, int, int]] = []
        self.on_sign: Callable[[], None] = lambda: None
        self.activity = Activity(self._say, lambda: self.now, pause=1.0)

    def _say(self, alive: dict[str, object]) -> None:
        self.sent.append(tuple(alive.values()))  # type: ignore[arg-type]
        self.on_sign()


# -- keep-alive messages -----------------------------------------------------------------------------------------------


def test_one_keep_alive_message_per_second_has_the_progress() -> None:
    signs = Signs()
    signs.activity.begin("check", 100)
    for _ in range(100):
        signs.activity.step()
        signs.now += 0.03
    assert signs.sent == [("check", 35, 100), ("check", 69, 100)]


def test_the_system_may_take_its_time() -> None:
    signs, written = Signs(), threading.Event()
    activity = Activity(signs._say, lambda: signs.now, pause=0.001)

    def second_sign() -> None:
        if len(signs.sent) == 2:
            written.set()

    def syncfs(seconds: float) -> str:
        signs.now += 1.0
        assert written.wait(60)
        return f"written in {seconds} s"

    def clock_goes_on() -> None:
        signs.now += 1.0
        second_sign()

    signs.on_sign = clock_goes_on
    activity.begin("sync")
    assert activity.wait_for(syncfs, 2.0) == "written in 2.0 s"
    assert signs.sent[:2] == [("sync", 0, 0)] * 2


def test_a_laptop_that_goes_meanwhile_leaves_nothing_running() -> None:
    """What is done under the lock has ended before the lock is released."""
    signs, gone, ended = Signs(), threading.Event(), []
    activity = Activity(signs._say, lambda: signs.now, pause=0.001)

    def hang_up() -> None:
        gone.set()
        raise BrokenPipeError

    def syncfs() -> None:
        signs.now += 1.0
        assert gone.wait(60)
        ended.append(True)

    signs.on_sign = hang_up
    with pytest.raises(BrokenPipeError):
        activity.wait_for(syncfs)
    assert ended == [True]


def large_project(directory: Path, modules: int, **more: str | bytes) -> Manifest:
    files: dict[str, str | bytes] = {f"generated/m{number}.py": f"x = {number}\n" for number in range(modules)}
    return project_of(directory, {"robot.py": ROBOT_PY, **files, **more})


#: Actions, and the phases in the agent's keep-alive messages.
WORK: dict[str, tuple[Callable[[AgentClient, Manifest, Callable[[str, int, int], None]], object], set[str]]] = {
    "plan": (lambda agent, project, on: agent.plan(project, on), {"check"}),
    "deploy": (
        lambda agent, project, on: agent.deploy(project, REQUEST, on),
        {"check", "link", "receive", "copy", "compile", "sync", "switch", "carry", "remove"},
    ),
    "rollback": (lambda agent, project, on: agent.rollback(None, on), {"check", "carry", "sync"}),
    "undeploy": (lambda agent, project, on: agent.undeploy(on), {"stop", "remove", "sync"}),
}


def test_keep_alive_messages_during_all_work(robot: LocalRobot, tmp_path: Path) -> None:
    for content in ("1", "22", "333"):
        robot.deploy(large_project(tmp_path / "project", 10, **{"a.txt": content}))
    copies = {"a.txt": os.urandom(300_000), "b.txt": b"333", "new.py": "x = 17\n"}
    project = large_project(tmp_path / "project", 10, **copies)
    seen: list[tuple[str, int, int]] = []
    for what, (do, expected) in WORK.items():
        seen.clear()
        agent = robot.start(all_signs=True)
        do(agent, project, lambda *sign: seen.append(sign))
        agent.close()
        assert {phase for phase, _, _ in seen} >= expected, what
        assert all(describe_work(*sign) != "working" for sign in seen if sign[0] not in ("send", "receive"))
        checked = [(done, of) for phase, done, of in seen if phase == "check"]
        assert not checked or max(checked)[0] >= 11
        if "receive" in expected:
            assert ("receive", 300_007, 300_007) in seen


def test_work_as_the_terminal_shows_it() -> None:
    assert describe_work("check", 2300, 5000) == "checking 2,300 of 5,000 files"
    assert describe_work("carry", 5003, 0) == "searching 5,003 files for files that the program wrote"
    assert describe_work("sync", 0, 0) == "waiting for the robot's disk"
    assert describe_work("a word of a newer agent", 1, 2) == "working"


def test_sources_are_asked_for_first(robot: LocalRobot, tmp_path: Path) -> None:
    """They are compiled while the rest is received."""
    files = {"a.onnx": "1", "z/b.py": "2", "robot.py": ROBOT_PY, "c.json": "3"}
    project = project_of(tmp_path / "project", files)
    agent = robot.start()
    asked: list[str] = []
    send = agent._send_contents

    def sent(entries: list[Entry], *others: Any) -> None:
        asked.extend(entry.path for entry in entries)
        send(entries, *others)

    agent._send_contents = sent  # type: ignore[method-assign]
    agent.deploy(project, REQUEST)
    agent.close()
    assert asked == ["robot.py", "z/b.py", "a.onnx", "c.json"]


# -- compiling ---------------------------------------------------------------------------------------------------------


def is_compiled(source: Path) -> bool:
    return Path(cache_from_source(str(source), optimization=1)).exists()


def test_what_is_there_is_compiled_while_the_rest_is_received(tmp_path: Path) -> None:
    first, second = tmp_path / "a.py", tmp_path / "b.py"
    first.write_text("x = 1\n")
    os.mkfifo(second)
    signs = Signs()
    with Compiler(tmp_path, ["a.py", "b.py"], debug=False) as compiler:
        compiler.add_next()
        compiler.add_next()
        with second.open("w") as stream:  # open when the compiler reads it
            assert is_compiled(first)
            stream.write("y = 2\n")
        compiler.finish(signs.activity)
    assert is_compiled(second)


def test_a_compiler_that_is_not_needed_any_more_is_ended(tmp_path: Path) -> None:
    children = Path(f"/proc/self/task/{threading.get_native_id()}/children")
    before = children.read_text(encoding="utf-8")
    os.mkfifo(tmp_path / "a.py")  # reading it would block
    with Compiler(tmp_path, ["a.py"], debug=False) as compiler:
        compiler.add_next()
        assert children.read_text(encoding="utf-8") != before
    assert children.read_text(encoding="utf-8") == before


def test_what_a_compiler_leaves_that_the_system_kills_is_compiled_by_the_program(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As Linux does when memory is short."""
    compile_one = Compiler._compile

    def killed(self: Compiler, name: str) -> None:
        if name == "b.py":
            os.kill(os.getpid(), signal.SIGKILL)
        compile_one(self, name)

    monkeypatch.setattr(Compiler, "_compile", killed)
    names = ["a.py", "b.py", "robot.py"]
    for name in names:
        (tmp_path / name).write_text("x = 1\n")
    with Compiler(tmp_path, names, False, ["robot.py"]) as compiler:
        for _ in names:
            compiler.add_next()
        compiler.finish(Signs().activity)
    assert [is_compiled(tmp_path / name) for name in names] == [True, False, False]


COMPILING = """
import resource, sys
from pathlib import Path
from typing import Any
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.compiling import Compiler
names = ["large.py", "small.py"]
with Compiler(Path(sys.argv[1]), names, False) as compiler:
    for _ in names:
        compiler.add_next()
    compiler.finish(Activity(lambda alive: None))
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def test_memory_of_the_compiler(tmp_path: Path) -> None:
    """A table of 600 kB would take 100 MB; the program compiles it when it imports it."""
    large, small = tmp_path / "large.py", tmp_path / "small.py"
    large.write_text("X = [\n" + "".join(f"  {number}, {number + 1},\n" for number in range(50_000)) + "]\n")
    small.write_text("x = 1\n")
    environment = {"PYTHONPATH": os.pathsep.join(sys.path)}
    printed = subprocess.run(
        [sys.executable, "-c", COMPILING, str(tmp_path)], env=environment, capture_output=True, text=True, check=True
    ).stdout
    assert int(printed) * 1024 < 40_000_000
    assert not is_compiled(large)
    assert is_compiled(small)
