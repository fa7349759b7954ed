"""Deploys as the robot's side does them: what it says, in which order it changes the disk, and what is left."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from pyfrc_core.deploy.agent import disk, releases, robot_paths, serve, system, transaction
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.releases import Releases, start_commands
from pyfrc_core.deploy.agent.robot_paths import Lock, Refusal
from pyfrc_core.deploy.targets.roborio import ROBORIO

from .agent_disk import AgentDisk, contents, manifest

ONE = {"robot.py": "# one\nimport arm\n", "arm.py": "# arm\n", "data/path.json": "{}"}
TWO = {**ONE, "robot.py": "# two\nimport arm\n"}
PYTHON = "env LD_LIBRARY_PATH=/usr/local/frc/lib/ /usr/local/bin/python3 -u"


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AgentDisk:
    """A robot with an empty disk, on which nothing has to wait for the disk."""
    monkeypatch.setattr(releases, "flush", lambda directory: None)
    return AgentDisk(tmp_path / "robot")


def deployed_twice(robot: AgentDisk) -> AgentDisk:
    robot.deploy(ONE, *ONE.values())
    robot.deploy(TWO, TWO["robot.py"])
    return robot


# -- one deploy after the other --------------------------------------------------------------------------------------


def test_the_first_deploy(robot: AgentDisk) -> None:
    need, switch, done = robot.deploy(ONE, *ONE.values())
    assert need == {"need": ["robot.py", "arm.py", "data/path.json"], "bytes": 25}
    assert switch == {"phase": "switch"}
    assert done == {
        "done": {
            "release": 1,
            "previous": None,
            "taken": None,
            "unchanged": False,
            "files": 3,
            "bytes": 25,
            "skipped": [],
            "renamed": [],
            "fallback": None,
        }
    }
    assert robot.read("robotCommand") == f"{PYTHON} -O -m robotpy --main /home/lvuser/py/robot.py run\n"
    assert robot.read("robotDebugCommand") == f"{PYTHON} -m robotpy --main /home/lvuser/py/robot.py -v run\n"
    assert (robot.home / "py").readlink() == Path(".pyfrc/releases/1")
    assert robot.tree() == [
        "1.json",
        *(f"1/{name}" for name in ("arm.py", "data/path.json", "deploy.json", "robot.py")),
    ]
    assert json.loads(robot.read("py/deploy.json") or "") == {"by": "Ada"}
    compiled = sorted(each.name for each in (robot.home / "py/__pycache__").iterdir())
    assert [name.partition(".")[0] for name in compiled] == ["arm", "robot"]
    assert all(name.endswith(".opt-1.pyc") for name in compiled)
    assert not robot.places.is_debug()
    assert not robot.places.incoming.exists()
    assert (robot.home / "py/robot.py").stat().st_mode & 0o777 == 0o644


def test_the_second_sends_what_has_changed_and_links_the_rest(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    need, _, done = robot.deploy(TWO, TWO["robot.py"])
    assert need == {"need": ["robot.py"], "bytes": 17}
    assert done["done"]["release"] == 2
    assert done["done"]["previous"] == done["done"]["fallback"] == 1
    old, new = robot.home / ".pyfrc/releases/1", robot.home / ".pyfrc/releases/2"
    assert (old / "arm.py").samefile(new / "arm.py")
    assert not (old / "robot.py").samefile(new / "robot.py")
    assert robot.startable() == "py/robot.py: # two"
    assert sorted(each.name.partition(".")[0] for each in (new / "__pycache__").iterdir()) == ["arm", "robot"]


def test_the_same_again_changes_nothing_but_who_has_deployed(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    need, done = robot.deploy(ONE, deploy_json={"by": "Grace"})
    assert need == {"need": [], "bytes": 0}
    assert done["done"] == {
        "release": 1, "previous": 1, "files": 0, "bytes": 0, "taken": None, "unchanged": True, "fallback": None,
        "has_run": False,
    }  # fmt: skip
    assert json.loads(robot.read("py/deploy.json") or "") == {"by": "Grace"}
    assert json.loads(robot.read(".pyfrc/releases/1.json") or "")["deploy"] == {"by": "Grace"}


def test_a_release_that_the_program_has_changed_is_not_the_same(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    (robot.home / "py/arm.py").write_text("# ARM\n")
    need, _, done = robot.deploy(ONE, ONE["arm.py"])
    assert need["need"] == ["arm.py"]
    assert done["done"]["release"] == 2
    assert robot.read("py/arm.py") == "# arm\n"


def test_each_content_is_sent_once_and_sources_first(robot: AgentDisk) -> None:
    files = {"b.txt": "same", "robot.py": "# one\n", "a.txt": "same", "sub/c.py": "# one\n"}
    need, _, done = robot.deploy(files, "# one\n", "same")
    assert need == {"need": ["robot.py", "b.txt"], "bytes": 10}
    assert done["done"]["files"] == 2
    assert {name: robot.read(f"py/{name}") for name in files} == files


def test_executable_files_and_debugging(robot: AgentDisk) -> None:
    request = {"op": "deploy", "files": manifest(ONE, ("arm.py",)), "main": "robot.py", "debug": True}
    robot.ask(request, contents(*ONE.values()))
    assert (robot.home / "py/arm.py").stat().st_mode & 0o777 == 0o755
    assert robot.places.is_debug()
    assert robot.startable() == "py/robot.py: # one"
    assert {each.name.split(".")[2] for each in (robot.home / "py/__pycache__").iterdir()} == {"pyc"}
    # A file that is no longer executable is another.
    need, _, _ = robot.deploy(ONE)
    assert need["need"] == []
    assert (robot.home / "py/arm.py").stat().st_mode & 0o777 == 0o644
    assert not robot.places.is_debug()


def test_so_many_releases_are_kept(robot: AgentDisk) -> None:
    for number in range(1, 7):
        (*_, done) = robot.deploy({"robot.py": f"# {number}\n"}, f"# {number}\n")
        assert done["done"]["release"] == number
    assert Releases(robot.places, None).numbers() == [4, 5, 6]  # type: ignore[arg-type]
    assert [name for name in robot.tree() if name.endswith("0.json")] == []
    assert sorted(each.name for each in robot.places.own.iterdir()) == ["lock", "releases"]


def note_run(records: Releases, number: int, ended: bool = False) -> None:
    """Note that a watch has seen a release run."""
    records.update_record(number, lambda record: {**record, "ran": True, "ended": ended})


def test_the_newest_release_that_was_seen_to_run_is_kept(robot: AgentDisk) -> None:
    robot.deploy({"robot.py": "# 1\n"}, "# 1\n")
    note_run(Releases(robot.places, None), 1)  # type: ignore[arg-type]
    for number in range(2, 7):
        (*_, done) = robot.deploy({"robot.py": f"# {number}\n"}, f"# {number}\n")
    assert done["done"]["fallback"] == 1
    assert Releases(robot.places, None).numbers() == [1, 5, 6]  # type: ignore[arg-type]


def test_the_order_in_which_a_deploy_changes_the_disk(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    robot.deploy(ONE, *ONE.values())
    log: list[str] = []

    def flush(directory: Path) -> None:
        numbers = sorted(each.name for each in robot.places.releases.glob("[0-9]*"))
        log.append(f"{directory.name}: {' '.join(numbers)}, {robot.startable()}")

    monkeypatch.setattr(releases, "flush", flush)
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


@pytest.mark.parametrize(
    "path", ["", "/etc/passwd", "../robot.py", "a/../b", "a//b", "./a", "a/.", "a\0b"], ids=lambda path: repr(path)
)
def test_paths_outside_the_program_are_refused(path: str, robot: AgentDisk) -> None:
    kind, message = refused(robot.deploy({**ONE, path: ""}))
    assert (kind, message) == ("path", f"{path!r} is not a path within the program's directory")
    assert not robot.places.releases.exists()


def test_a_path_twice_and_a_main_file_that_is_not_there(robot: AgentDisk) -> None:
    request = {"op": "deploy", "files": manifest(ONE) * 2, "main": "robot.py"}
    assert refused(robot.ask(request)) == ("path", "the manifest has the same path twice")
    assert refused(robot.deploy(ONE, main="other.py")) == ("main", "there is no other.py among the files")
    kind, message = refused(robot.deploy({"my robot.py": ""}, main="my robot.py"))
    assert kind == "main"
    assert "'my robot.py'" in str(message)


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


def test_a_source_that_cannot_be_compiled(robot: AgentDisk) -> None:
    files = {"robot.py": "# fine\n", "wrong.py": "\n\ndef f(:\n", "unused.py": "def g(:\n"}
    kind, message = refused(robot.deploy(files, *files.values(), program=["robot.py", "wrong.py"]))
    assert kind == "syntax"
    assert str(message).startswith("wrong.py:3: the robot's Python")
    (*_, done) = robot.deploy({**files, "wrong.py": ""}, "# fine\n", "", "def g(:\n", program=["robot.py"])
    assert done["done"]["release"] == 1


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


def test_one_deploy_at_a_time(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot_paths, "_GRACE", 0.05)
    with Lock(robot.places, "Grace"):
        *_, last = robot.deploy(ONE)
        assert (last["error"], last["holder"]) == ("locked", "Grace")
        assert last["message"] == "Grace is deploying to this robot right now"
    assert robot.places.lock.read_text() == ""
    *_, done = robot.deploy(ONE, *ONE.values())
    assert done["done"]["release"] == 1
    robot.places.lock.write_text("no json")
    assert {robot_paths._holder(text) for text in (b"no json", b"[]", b"{}")} == {"another computer"}


# -- what a deploy would do, and what there is -----------------------------------------------------------------------


def test_a_plan_writes_nothing(robot: AgentDisk) -> None:
    assert robot.ask({"op": "plan", "files": manifest(ONE)}) == [
        {
            "done": {
                "added": ["robot.py", "arm.py", "data/path.json"],
                "changed": [],
                "removed": [],
                "files": 3,
                "bytes": 25,
            }
        }
    ]
    assert sorted(robot.home.iterdir()) == []
    robot.deploy(ONE, *ONE.values())
    (robot.home / "py/log.txt").write_text("the program's own")
    files = {"robot.py": "# other\n", "arm.py": "# arm\n", "new.py": "# arm\n"}
    assert robot.ask({"op": "plan", "files": manifest(files)}) == [
        {"done": {"added": ["new.py"], "changed": ["robot.py"], "removed": ["data/path.json"], "files": 1, "bytes": 8}}
    ]
    (_, need, *_) = robot.ask(
        {"op": "plan", "files": manifest(files)},
        {"op": "deploy", "files": manifest(files), "main": "robot.py"},
        contents("# other\n"),
    )
    assert need["need"] == ["robot.py"]
    assert robot.startable() == "py/robot.py: # other"


def test_a_plan_over_another_tools_code(robot: AgentDisk) -> None:
    (robot.home / "py").mkdir()
    (robot.home / "py/old.py").write_text("")
    (robot.home / "py/notes.txt").write_text("")
    (plan,) = robot.ask({"op": "plan", "files": manifest(ONE)})
    assert plan["done"]["removed"] == ["old.py"]


def test_facts(robot: AgentDisk) -> None:
    deployed_twice(robot)
    (robot.root / "etc/natinst/share").mkdir(parents=True)
    (robot.root / "etc/natinst/share/scs_imagemetadata.ini").write_text('IMAGEVERSION = "FRC_roboRIO_2026_v1.2"\n')
    (robot.root / "etc/natinst/share/ni-rt.ini").write_text("[STARTUP]\nStartupDLLs = a.so\n")
    (facts,) = robot.ask({"op": "info", "modules": ["json", "no_such_module"]})
    found = facts["done"]
    assert (ROBORIO.image_in(found["texts"]), ROBORIO.wastes_memory(found["texts"])) == ("FRC_roboRIO_2026_v1.2", True)
    assert (found["virtual"], found["can_restart"]) == (False, False)
    assert (found["current"], found["home"], found["other_code"], found["debug"]) == (2, True, False, False)
    assert found["missing_modules"] == ["no_such_module"]
    assert found["deploy_json"] == '{\n  "by": "Ada"\n}'
    assert found["command"].endswith("--main /home/lvuser/py/robot.py run\n")
    assert found["other_languages"] == []
    assert found["free"] > 0
    about = {"main": "robot.py", "debug": False, "deploy": {"by": "Ada"}, "taken": False}
    about |= {"ran": False, "ended": False, "damaged": False}
    assert found["releases"] == [
        {"release": 1, "files": 3, "from": None, **about},
        {"release": 2, "files": 3, "from": 1, **about},
    ]
    (robot.home / "robotCommand").write_text("/usr/local/frc/JRE/bin/java -jar /home/lvuser/Robot.jar")
    (robot.home / "Robot.jar").write_text("")
    (facts,) = robot.ask({"op": "info"})
    assert facts["done"]["other_languages"] == ["/home/lvuser/robotCommand", "/home/lvuser/Robot.jar"]


# -- going back ------------------------------------------------------------------------------------------------------


def test_rolling_back_and_forward(robot: AgentDisk) -> None:
    deployed_twice(robot)
    (answer,) = robot.ask({"op": "rollback"})
    assert (answer["done"]["release"], answer["done"]["previous"], answer["done"]["changed"]) == (1, 2, [])
    assert answer["done"]["about"]["main"] == "robot.py"
    assert robot.startable() == "py/robot.py: # one"
    (answer,) = robot.ask({"op": "rollback", "release": 2})
    assert (answer["done"]["release"], answer["done"]["previous"]) == (2, 1)
    assert robot.startable() == "py/robot.py: # two"
    (robot.home / ".pyfrc/releases/1/robot.py").write_text("# 1\n")
    (answer,) = robot.ask({"op": "rollback", "release": 1})
    assert answer["done"]["changed"] == ["robot.py"]


def test_what_cannot_be_gone_back_to(robot: AgentDisk) -> None:
    assert robot.ask({"op": "rollback"}) == [
        {
            "error": "release",
            "message": "there is no earlier release on the robot to go back to",
            "remedy": "It has no releases yet: each pyfrc deploy adds one.",
        }
    ]
    deployed_twice(robot)
    (answer,) = robot.ask({"op": "rollback", "release": 7})
    assert (answer["message"], answer["remedy"]) == (
        "there is no release 7 on the robot to go back to",
        "Its releases: 1, 2; current: 2.",
    )
    (robot.home / ".pyfrc/releases/1/arm.py").unlink()
    (answer,) = robot.ask({"op": "rollback"})
    assert answer["message"] == "release 1 is no longer complete: arm.py is missing"
    assert robot.startable() == "py/robot.py: # two"


def test_a_rollback_goes_to_what_was_seen_to_run(robot: AgentDisk) -> None:
    for number in (1, 2, 3):
        robot.deploy({"robot.py": f"# {number}\n"}, f"# {number}\n")
    records = Releases(robot.places, None)  # type: ignore[arg-type]
    assert [records.fallback(number) for number in (None, 1, 2, 3)] == [3, None, 1, 2]
    note_run(records, 1)
    assert [records.fallback(number) for number in (None, 1, 2, 3)] == [1, None, 1, 1]
    note_run(records, 2, ended=True)
    assert records.fallback(3) == 1, "the other one has ended"
    note_run(records, 2)
    assert records.fallback(3) == 2
    note_run(records, 9)
    assert records.record(9) == {}


def test_another_tools_program_becomes_a_release(robot: AgentDisk) -> None:
    (robot.home / "py").mkdir()
    (robot.home / "py/robot.py").write_text("# other tool's\n")
    (robot.home / "py/notes.txt").write_text("the program's own")
    (robot.home / "py/deploy.json").write_text('{"by": "other"}')
    (robot.home / "robotCommand").write_text("python3 --main /home/lvuser/py/robot.py run\n")
    *_, done = robot.deploy(ONE, *ONE.values())
    assert (done["done"]["taken"], done["done"]["previous"], done["done"]["release"]) == (1, 1, 2)
    assert robot.startable() == "py/robot.py: # one"
    assert robot.read("py/notes.txt") == "the program's own"
    record = json.loads(robot.read(".pyfrc/releases/1.json") or "")
    assert (record["taken"], record["debug"], record["deploy"]) == (True, False, {"by": "other"})
    (answer,) = robot.ask({"op": "rollback"})
    assert answer["done"]["release"] == 1
    assert robot.startable() == "py/robot.py: # other tool's"
    assert robot.read("robotDebugCommand") is None


def test_a_program_without_a_start_command_cannot_be_gone_back_to(robot: AgentDisk) -> None:
    (robot.home / "py").mkdir()
    (robot.home / "py/robot.py").write_text("")
    robot.deploy(ONE, *ONE.values())
    (answer,) = robot.ask({"op": "rollback"})
    assert answer["message"] == "release 1 was left by another tool, and had no start command"


# -- the program's own files -----------------------------------------------------------------------------------------


def test_what_the_program_has_written_goes_along(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    code = robot.home / "py"
    (code / "log.txt").write_text("log")
    (code / "data/learned.json").write_text("learned")
    (code / "empty").mkdir()
    robot.deploy({"robot.py": "# two\n", "data/learned.json": "from the project"}, "# two\n", "from the project")
    assert robot.read("py/log.txt") == "log"
    assert (code / "log.txt").samefile(robot.home / ".pyfrc/releases/1/log.txt")
    assert robot.read("py/data/learned.json") == "from the project"
    assert robot.read("py/data/path.json") is None  # which came with the code
    assert (code / "empty").is_dir()


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


def test_what_the_old_program_writes_after_the_switch_goes_along_when_it_has_ended(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    (robot.home / "py/log.txt").write_text("log")
    (robot.home / "py/both.txt").write_text("before")
    robot.deploy(TWO, TWO["robot.py"])
    old, new = robot.home / ".pyfrc/releases/1", robot.home / ".pyfrc/releases/2"
    (old / "late.txt").write_text("late")
    (old / "log.txt").unlink()
    (old / "log.txt").write_text("the old one's")
    (old / "both.txt").unlink()
    (old / "both.txt").write_text("the old one's")
    (new / "other").write_text("the new one's")
    (new / "other").replace(new / "both.txt")
    records = Releases(robot.places, serve.Activity(lambda **said: None))
    records.carry_late_writes(2)
    assert (new / "late.txt").read_text() == "late"
    assert (new / "log.txt").read_text() == "the old one's"
    assert (new / "both.txt").read_text() == "the new one's"
    assert "carried" not in records.record(2)
    (old / "later.txt").write_text("later")
    records.carry_late_writes(2)
    assert not (new / "later.txt").exists()


def test_going_back_keeps_both_programs_files(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    old = robot.home / ".pyfrc/releases/1"
    (old / "log.txt").write_text("log of 1")
    robot.deploy(TWO, TWO["robot.py"])
    new = robot.home / ".pyfrc/releases/2"
    (new / "log.txt").unlink()
    (new / "log.txt").write_text("log of 2")
    robot.ask({"op": "rollback"})
    assert (old / "log.txt").read_text() == "log of 2"
    assert (old / "log.txt.release-1").read_text() == "log of 1"


# -- in place --------------------------------------------------------------------------------------------------------


def test_in_place_overwrites_and_deletes_nothing(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    note_run(Releases(robot.places, None), 1)  # type: ignore[arg-type]
    *_, done = robot.deploy({"robot.py": "# two\n", "sub/new.py": "# new\n"}, "# two\n", "# new\n", in_place=True)
    assert done["done"] == {
        "release": 1, "previous": 1, "taken": None, "unchanged": False, "files": 2, "bytes": 12, "fallback": None
    }  # fmt: skip
    assert robot.startable() == "py/robot.py: # two"
    assert robot.tree("py") == ["arm.py", "data/path.json", "deploy.json", "robot.py", "sub/new.py"]
    record = json.loads(robot.read(".pyfrc/releases/1.json") or "")
    assert sorted(record["files"]) == ["arm.py", "data/path.json", "robot.py", "sub/new.py"]
    assert record["ran"] is False
    need, _, done = robot.deploy({"robot.py": "# two\n"}, in_place=True)
    assert need["need"] == []
    assert done["done"]["unchanged"] is True


def test_in_place_nothing_is_deleted_for_a_file_of_another_kind(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    assert refused(robot.deploy({"robot.py": "", "data": "x"}, in_place=True)) == (
        "path",
        "'data' is a directory on the robot",
    )
    assert refused(robot.deploy({"robot.py": "", "arm.py/x": "x"}, in_place=True)) == (
        "path",
        "'arm.py' is a file on the robot",
    )


# -- after a cut -----------------------------------------------------------------------------------------------------


def test_the_debris_of_a_deploy_that_was_cut_is_cleared_up(robot: AgentDisk) -> None:
    robot.deploy(ONE, *ONE.values())
    own = robot.places.own
    for debris in ("incoming/robot.py", "trash-1/robot.py", "carried", "releases/.1.json.new"):
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


def test_a_record_that_cannot_be_read(robot: AgentDisk) -> None:
    deployed_twice(robot)
    (robot.places.releases / "1.json").write_text("")
    (answer,) = robot.ask({"op": "rollback", "release": 1})
    assert (answer["error"], answer["message"]) == ("release", "the record of release 1 cannot be read")
    assert robot.startable() == "py/robot.py: # two"


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


def test_undeploy_removes_it_all(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    stopped: list[tuple[str, bool]] = []
    monkeypatch.setattr(RealRobot, "stop", lambda host, start: stopped.append((robot.startable(), start)))
    robot.deploy(ONE, *ONE.values(), debug=True)
    (robot.home / "keep.txt").write_text("")
    assert robot.ask({"op": "undeploy"}) == [{"done": {"removed": True}}]
    assert stopped == [("nothing", False)]
    assert [each.name for each in robot.home.iterdir()] == ["keep.txt"]
    assert not robot.places.is_debug()
    assert robot.ask({"op": "undeploy"}) == [{"done": {"removed": False}}]


# -- parts -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("main", ["robot.py", "src/robot.py", "_a-b.py", "9.py"])
def test_start_commands(main: str) -> None:
    assert set(start_commands(ROBORIO.layout, main, debug=False)) == {"robotCommand", "robotDebugCommand"}
    one_file = ROBORIO.layout._replace(debug_command="", debug_flag="")
    assert start_commands(one_file, main, debug=True) == {
        "robotCommand": f"{PYTHON} -m robotpy --main /home/lvuser/py/{main} -v run\n"
    }


@pytest.mark.parametrize("main", ["", "-c", "a b.py", "a;b", "/robot.py", "a\n"])
def test_main_files_that_would_break_the_command(main: str) -> None:
    with pytest.raises(Refusal):
        start_commands(ROBORIO.layout, main, debug=False)


def test_files_are_written_whole(tmp_path: Path) -> None:
    file = tmp_path / "file"
    disk.write_whole(file, "a\udcff", 0o600)
    assert file.read_bytes() == b"a\xff"
    assert file.stat().st_mode & 0o777 == 0o600
    disk.write_whole(file, "b")
    assert disk.text_of(file) == "b"
    assert file.stat().st_mode & 0o777 == 0o644
    assert [each.name for each in tmp_path.iterdir()] == ["file"]
    assert disk.text_of(tmp_path) is None
    disk.remove(file)
    disk.remove(file)
    assert list(tmp_path.iterdir()) == []


def test_what_is_below_a_directory(tmp_path: Path) -> None:
    for name in ("b/2", "b/1", "a", "c/__pycache__/x.pyc", "b.txt"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    (tmp_path / "link").symlink_to(tmp_path / "a")
    assert [name for name, _ in disk.everything_below(tmp_path)] == ["a", "b", "b.txt", "c", "link", "b/1", "b/2"]
    assert [name for name, _ in disk.files_below(tmp_path)] == ["a", "b.txt", "b/1", "b/2"]
    assert list(disk.files_below(tmp_path / "none")) == []


def test_links_and_exchanges(tmp_path: Path) -> None:
    for name in "ab":
        (tmp_path / name).mkdir()
        (tmp_path / name / name).write_text("")
    link = tmp_path / "link"
    system.make_link(link, tmp_path / "a", tmp_path / "link")
    assert link.readlink() == Path("a")
    assert system.linked_directory(link) == tmp_path / "a"
    assert system.linked_directory(tmp_path / "a") is None
    if system.exchange(link, tmp_path / "b"):
        assert (tmp_path / "link/b").exists()
        assert system.linked_directory(tmp_path / "b") == tmp_path / "a"
        assert system.exchange(link, tmp_path / "none") is False
    system.flush(tmp_path)
    with pytest.raises(FileNotFoundError):
        disk.link_or_copy(str(tmp_path / "none"), str(tmp_path / "new"))


def test_a_file_system_without_links(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(source: str, target: str) -> None:
        raise PermissionError

    monkeypatch.setattr(disk, "link_file", refuse)
    (tmp_path / "a").write_text("text")
    disk.link_or_copy(str(tmp_path / "a"), str(tmp_path / "b"))
    assert (tmp_path / "b").read_text() == "text"
    assert not (tmp_path / "a").samefile(tmp_path / "b")
