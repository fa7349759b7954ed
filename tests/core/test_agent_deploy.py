"""Deploys as the robot's side does them: what it says, in which order it changes the disk, and what is left."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import pytest

from pyfrc_core.deploy.agent import disk, serve, transaction
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.releases import Releases

from .agent_disk import AgentDisk, Message, contents, manifest

ONE = {"robot.py": "# one\nimport arm\n", "arm.py": "# arm\n", "data/path.json": "{}"}
TWO = {**ONE, "robot.py": "# two\nimport arm\n"}


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AgentDisk:
    """A robot with an empty disk, on which nothing has to wait for the disk."""
    monkeypatch.setattr(disk, "flush", lambda directory: None)
    return AgentDisk(tmp_path / "robot")


def deployed_twice(robot: AgentDisk) -> AgentDisk:
    robot.deploy(ONE, *ONE.values())
    robot.deploy(TWO, TWO["robot.py"])
    return robot


# -- one deploy after the other --------------------------------------------------------------------------------------


def test_the_order_in_which_a_deploy_changes_the_disk(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    robot.deploy(ONE, *ONE.values())
    log: list[str] = []

    def flush(directory: Path) -> None:
        numbers = sorted(each.name for each in robot.places.releases.glob("[0-9]*"))
        log.append(f"{directory.name}: {' '.join(numbers)}, {robot.startable()}")

    monkeypatch.setattr(disk, "flush", flush)
    robot.deploy(TWO, TWO["robot.py"])
    assert log == [
        ".pyfrc: 1 1.json, py/robot.py: # one",  # the contents
        ".pyfrc: 1 1.json 2.json, py/robot.py: # one",  # the record
        ".pyfrc: 1 1.json 2 2.json, py/robot.py: # one",  # the directory's name
        "lvuser: 1 1.json 2 2.json, py/robot.py: # two",  # the link
    ]
    # Another main file: the start command names the release's own directory first.
    log.clear()
    robot.deploy({"main.py": "# three\n"}, "# three\n", main="main.py")
    assert [entry.partition(", ")[2] for entry in log] == [
        "py/robot.py: # two",
        "py/robot.py: # two",
        "py/robot.py: # two",
        ".pyfrc/releases/3/main.py: # three",
        ".pyfrc/releases/3/main.py: # three",
        "py/main.py: # three",
    ]


# -- what is refused -------------------------------------------------------------------------------------------------


def refused(answers: list[dict[str, object]]) -> tuple[object, object]:
    (*_, last) = answers
    return last["error"], last["message"]


def test_a_path_twice_and_a_main_file_that_is_not_there(robot: AgentDisk) -> None:
    request = {"op": "deploy", "files": manifest(ONE) * 2, "main": "robot.py"}
    assert refused(robot.ask(request)) == ("path", "the manifest has the same path twice")
    assert refused(robot.deploy(ONE, main="other.py")) == ("main", "there is no other.py among the files")
    for main in ("my robot.py", "$(reboot).py", "a;b.py", "-x.py"):
        kind, message = refused(robot.deploy({main: ""}, main=main))
        assert kind == "main"
        assert repr(main) in str(message)
    for path in ("../x", "/etc/x", "a/../../x", "a//b", "", ".", "a\0b"):
        said = f"{path!r} is not a path within the program's directory"
        assert refused(robot.deploy({**ONE, path: ""})) == ("path", said)
    assert robot.startable() == "nothing"


def test_contents_that_are_not_as_announced(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    text = TWO["robot.py"]
    assert refused(robot.deploy(TWO, text.replace("two", "six"))) == (
        "changed",
        "robot.py was changed while it was sent",
    )
    assert refused(robot.deploy(TWO, text[:-1])) == ("protocol", "received fewer contents than requested")
    assert refused(robot.deploy(TWO, text, "more")) == ("protocol", "received more contents than requested")
    broken = {"op": "deploy", "files": manifest(TWO), "main": "robot.py"}
    kind, message = refused(robot.ask(broken, contents("")[:5] + b"\xff" * (len(contents("")) - 5)))
    assert kind == "protocol"
    assert str(message).startswith("the contents cannot be decompressed")
    assert robot.startable() == "py/robot.py: # one"
    assert not robot.places.incoming.exists()
    assert Releases(robot.places, None).numbers() == [1]  # type: ignore[arg-type]


def test_a_full_disk(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    # A source needs its own size, and twice that for its compiled form; whole blocks, and 512 bytes for each file.
    needed = 256 * 1024 + 512 * 3 + 4096 * 3 * 2 + 4096
    monkeypatch.setattr(transaction, "free_bytes", lambda directory: needed - 1)
    *_, last = robot.deploy(ONE)
    assert (last["error"], last["needed"], last["free"]) == ("space", needed, needed - 1)
    assert last["message"] == f"the robot's disk is full: {needed:,} bytes are needed, {needed - 1:,} are free"
    monkeypatch.setattr(transaction, "free_bytes", lambda directory: needed)
    *_, done = robot.deploy(ONE, *ONE.values())
    assert done["done"]["release"] == 1
    # What is linked needs no room.
    needed = 256 * 1024 + 512 * 3 + 4096 * 3
    monkeypatch.setattr(transaction, "free_bytes", lambda directory: needed)
    *_, done = robot.deploy(TWO, TWO["robot.py"])
    assert done["done"]["release"] == 2


def test_old_releases_make_room(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    deployed_twice(robot)
    free = iter([0, 1 << 30])
    monkeypatch.setattr(transaction, "free_bytes", lambda directory: next(free))
    need, _, done = robot.deploy(ONE, ONE["robot.py"])
    assert need["need"] == ["robot.py"]  # whose release has gone
    assert done["done"]["release"] == 3
    assert Releases(robot.places, None).numbers() == [2, 3]  # type: ignore[arg-type]


def test_old_releases_make_room_for_cleaning_up(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    deployed_twice(robot)
    Releases(robot.places, serve.Activity(lambda **said: None)).carry_late_writes(2)
    recover, kept = Releases.recover, []

    def recover_with_room(self: Releases) -> None:
        kept.append(self.numbers())
        if len(kept[-1]) > 1:
            raise OSError(28, "No space left on device")
        recover(self)

    monkeypatch.setattr(Releases, "recover", recover_with_room)
    *_, done = robot.deploy(ONE, ONE["robot.py"])
    assert done["done"]["release"] == 3
    assert kept == [[1, 2], [2]]


def test_errors_of_the_disk_and_of_the_agent(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(error: Exception) -> dict[str, object]:
        def plan(*_: object) -> None:
            raise error

        monkeypatch.setattr(serve, "plan", plan)
        (answer,) = robot.ask({"op": "plan", "files": []})
        return answer

    monkeypatch.setattr(serve, "free_bytes", lambda directory: 1234)
    full = failing(OSError(28, "No space left on device"))
    assert (full["error"], full["free"]) == ("space", 1234)
    assert full["message"] == "the robot's disk is full: 1,234 bytes are free"
    mode = failing(PermissionError(13, "Permission denied", str(robot.home / "py")))
    assert (mode["error"], mode["message"]) == ("disk", f"{robot.home / 'py'}: Permission denied")
    assert failing(OSError(5, "Input/output error"))["message"] == "the robot: Input/output error"
    assert (
        failing(OSError(30, ""))["message"] == "the robot's disk cannot be written: it is read-only, as after an error"
    )
    taken = OSError(21, "Is a directory", str(robot.home / "missing"), None, str(robot.home))
    assert failing(taken)["message"] == f"{robot.home}: Is a directory"
    assert failing(shutil.SpecialFileError("`x` is a named pipe"))["message"] == "the robot: `x` is a named pipe"
    assert failing(OSError())["message"] == "the robot: OSError"
    bug = failing(KeyError("x"))
    assert (bug["error"], bug["message"]) == ("bug", "the agent on the robot has failed")
    assert "KeyError: 'x'" in str(bug["traceback"])
    with pytest.raises(ConnectionResetError):
        failing(ConnectionResetError())
    (unknown,) = robot.ask({"op": "no such thing"})
    assert unknown["error"] == "bug"


def test_a_computer_that_is_no_roborio(robot: AgentDisk) -> None:
    robot.home.rmdir()
    kind, message = refused(robot.deploy(ONE))
    assert kind == "controller"
    assert message == f"there is no {robot.home} here: this is not a roboRIO"


# -- what a deploy would do, and what there is -----------------------------------------------------------------------


def test_a_plan_over_another_tools_code(robot: AgentDisk) -> None:
    (robot.home / "py").mkdir()
    (robot.home / "py/old.py").write_text("")
    (robot.home / "py/notes.txt").write_text("")
    (plan,) = robot.ask({"op": "plan", "files": manifest(ONE)})
    assert plan["done"]["removed"] == ["old.py"]


# -- going back ------------------------------------------------------------------------------------------------------


def test_a_program_without_a_start_command_cannot_be_gone_back_to(robot: AgentDisk) -> None:
    (robot.home / "py").mkdir()
    (robot.home / "py/robot.py").write_text("")
    robot.deploy(ONE, *ONE.values())
    (answer,) = robot.ask({"op": "rollback"})
    assert answer["message"] == "release 1 was left by another tool, and had no start command"


# -- the program's own files -----------------------------------------------------------------------------------------


def test_names_that_the_project_has_taken(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    (robot.home / "py/logs/old").mkdir(parents=True)
    (robot.home / "py/logs/old/match.csv").write_text("precious")
    (robot.home / "py/field").write_text("a map")
    new = {**ONE, "logs": "a file now", "field/map.json": "{}"}
    *_, done = robot.deploy(new, "a file now")
    assert done["done"]["renamed"] == ["field.release-1", "logs.release-1"]
    (robot.home / ".pyfrc/releases/1/logs/late.csv").write_text("late")
    for files in (new, TWO, ONE):
        robot.deploy(files, *({TWO["robot.py"]} - set(new.values()) if files is TWO else ()))
        assert robot.read("py/logs.release-1/old/match.csv") == "precious"
        assert robot.read("py/logs.release-1/late.csv") == "late"
        assert robot.read("py/field.release-1") == "a map"


def test_late_writes_of_the_old_program_replace_nothing_of_the_new_one(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    for name in ("state", "removed"):
        (robot.places.code / name).write_text("old")
    robot.deploy(TWO, TWO["robot.py"])
    (robot.places.releases / "1/late").write_text("late")
    (robot.places.code / "removed").unlink()
    (robot.places.code / "x").write_text("new")
    (robot.places.code / "x").replace(robot.places.code / "state")
    Releases(robot.places, serve.Activity(lambda **said: None)).carry_late_writes(2)
    assert (robot.read("py/state"), robot.read("py/late"), robot.read("py/removed")) == ("new", "late", None)


def test_links_of_another_tools_program_stay_valid(robot: AgentDisk) -> None:
    (robot.home / "data").mkdir()
    (robot.home / "data/keep.json").write_text("{}")
    (robot.places.code / "within").mkdir(parents=True)
    (robot.places.code / "robot.py").write_text("# other\n")
    (robot.home / "robotCommand").write_text("python3 --main /home/lvuser/py/robot.py run\n")
    links = {"ours": "../data", "within/ours": "../../data", "within/same": "../ours", "absolute": "/nowhere"}
    for name, target in links.items():
        (robot.places.code / name).symlink_to(target)
    robot.deploy(ONE, *ONE.values())
    for _ in range(2):
        assert robot.read("py/ours/keep.json") == robot.read("py/within/ours/keep.json") == "{}"
        assert str((robot.places.code / "within/same").readlink()) == "../ours"
        assert str((robot.places.code / "absolute").readlink()) == "/nowhere"
        robot.ask({"op": "rollback", "release": 1})


# -- after a cut -----------------------------------------------------------------------------------------------------


def test_the_debris_of_a_deploy_that_was_cut_is_cleared_up(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    own = robot.places.own
    for debris in ("incoming/robot.py", "trash-1/robot.py", "between", "releases/.1.json.new"):
        (own / debris).parent.mkdir(parents=True, exist_ok=True)
        (own / debris).write_text("")
    (own / "releases/8.json").write_text("{}")
    (own / "releases/9").symlink_to("1")
    (own / "py").symlink_to("1")
    (robot.home / ".robotCommand.new").write_text("half of it")
    *_, done = robot.deploy(TWO, TWO["robot.py"])
    assert done["done"]["release"] == 2
    assert sorted(each.name for each in own.iterdir()) == ["lock", "releases"]
    assert sorted(each.name for each in (own / "releases").iterdir()) == ["1", "1.json", "2", "2.json"]
    assert robot.read(".robotCommand.new") is None


def test_what_the_program_writes_above_its_directory_stays(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    """`..` of a release is a directory of pyfrc's."""
    monkeypatch.setattr(RealRobot, "stop", lambda host, start: None)
    deployed_twice(robot)
    written = (
        "releases/match.txt",
        "releases/logs/1.txt",
        "releases/2026/log.txt",
        "releases/a.json",
        "trash-can",
        "x",
    )
    for name in written:
        (robot.places.own / name).parent.mkdir(exist_ok=True)
        (robot.places.own / name).write_text(name)
    robot.deploy(ONE)
    robot.ask({"op": "rollback"})
    assert robot.ask({"op": "undeploy"}) == [{"done": {"removed": True}}]
    assert robot.tree(".pyfrc") == sorted(written)
    *_, done = robot.deploy(ONE, *ONE.values())
    assert done["done"]["release"] == 2027  # no name is used twice
    assert robot.startable() == "py/robot.py: # one"


def test_a_deploy_that_fails_leaves_no_release(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    robot.deploy(ONE, *ONE.values())

    def fail(self: Releases, *_: object) -> None:
        raise OSError(5, "Input/output error", "/home/lvuser/py")

    for name in ("carry_over", "switch"):
        monkeypatch.setattr(Releases, name, fail)
        *_, last = robot.deploy(TWO, TWO["robot.py"])
        assert last["message"] == "/home/lvuser/py: Input/output error"
        assert robot.startable() == "py/robot.py: # one"
        assert {name.split("/")[0] for name in robot.tree()} == {"1", "1.json"}
        monkeypatch.undo()


def test_a_deploy_that_was_cut_past_its_moment_is_finished(robot: AgentDisk) -> None:
    deployed_twice(robot)
    records = Releases(robot.places, serve.Activity(lambda **said: None))
    direct = (robot.read("robotCommand") or "").replace("/home/lvuser/py/", "/home/lvuser/.pyfrc/releases/1/")
    (robot.home / "robotCommand").write_text(direct)
    assert records._startable() == {"1", "2"}
    records.recover()
    assert robot.startable() == "py/robot.py: # one"
    assert records.current() == 1
    # A release that is not whole is no reason to leave the one that is.
    (robot.home / "robotCommand").write_text(direct.replace("releases/1/", "releases/9/"))
    records.recover()
    assert records.current() == 1


# -- linear work -----------------------------------------------------------------------------------------------------


def calls_of(robot: AgentDisk, *requests: Message | bytes) -> int:
    """Have the agent handle requests, and return the calls that this makes, of functions in Python and in C.

    Other processes and threads, and the wall clock, do not change the count: a busy machine gives the same.
    """
    count = 0

    def profile(frame: object, event: str, argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(profile)
    try:
        said = robot.ask(*requests)
    finally:
        sys.setprofile(None)
    assert "done" in said[-1], said
    return count


@pytest.fixture
def _alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(os, "fork")  # the agent compiles by itself then
    monkeypatch.setattr(RealRobot, "processes", lambda robot: set())
    monkeypatch.setattr(RealRobot, "stop", lambda host, start, meanwhile=None: False)


def large(number: int, **more: str) -> dict[str, str]:
    return {"robot.py": "", **{f"generated/m{each}.py": f"x = {each}\n" for each in range(number)}, **more}


@pytest.mark.usefixtures("_alone")
def test_the_work_is_linear_in_the_files_of_a_directory(robot: AgentDisk) -> None:
    """For 80 files more, the calls grow as for 40 before."""
    counts = []
    for files in (40, 80, 160):
        there = AgentDisk(robot.root.with_name(str(files)))
        first, changed = large(files), large(files, **{"generated/m7.py": "x = 'changed'\n"})
        deploys = [{"op": "deploy", "files": manifest(each), "main": "robot.py"} for each in (first, first, changed)]
        counts.append(
            [
                calls_of(there, deploys[0], contents(*there.needed(first))),
                calls_of(there, deploys[1]),
                calls_of(there, deploys[2], contents(changed["generated/m7.py"])),
                calls_of(there, {"op": "plan", "files": manifest(first)}),
                *(calls_of(there, {"op": op}) for op in ("rollback", "info", "undeploy")),
            ]
        )
    for few, some, many in zip(*counts, strict=True):
        assert many - some <= 2.2 * (some - few) + 200, counts


@pytest.mark.usefixtures("_alone")
def test_an_unchanged_file_is_read_once(robot: AgentDisk) -> None:
    """Only the program in place is looked through, where it has all: earlier releases cost nothing."""
    project, plan = large(100), {"op": "plan", "files": manifest(large(100))}
    robot.deploy(project, *robot.needed(project))
    one_release = calls_of(robot, plan)
    for text in ("1", "2"):
        robot.deploy(other := large(100, **{"a.txt": text}), *robot.needed(other))
    robot.deploy(project)
    assert calls_of(robot, plan) < 1.2 * one_release


# -- parts -----------------------------------------------------------------------------------------------------------


def test_a_file_system_without_links(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(source: str, target: str) -> None:
        raise PermissionError

    monkeypatch.setattr(disk, "link_file", refuse)
    (tmp_path / "a").write_text("text")
    disk.link_or_copy(str(tmp_path / "a"), str(tmp_path / "b"))
    assert (tmp_path / "b").read_text() == "text"
    assert not (tmp_path / "a").samefile(tmp_path / "b")
