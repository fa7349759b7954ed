"""Releases that share files with others: what a disk has damaged is noticed, is not shared further, and is replaced."""

from __future__ import annotations

from pathlib import Path

import pytest

from pyfrc_core.deploy.agent import disk

from .agent_disk import AgentDisk

ONE = {
    "robot.py": "# one\nimport arm\n",
    "arm.py": "A = 1\n",
    "data/path.json": "{}",
    "leg.py": "",
    "sub/a.py": "",
    "sub/b.py": "B = 1\n",
}
TWO = {**ONE, "robot.py": "# two\nimport arm\n"}


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AgentDisk:
    """A robot with two releases."""
    monkeypatch.setattr(disk, "flush", lambda directory: None)
    robot = AgentDisk(tmp_path / "robot")
    robot.deploy(ONE, *robot.needed(ONE))
    robot.deploy(TWO, TWO["robot.py"])
    return robot


def compiled(robot: AgentDisk, release: int, name: str) -> Path:
    source = robot.places.releases / str(release) / name
    (file,) = source.parent.glob(f"__pycache__/{source.name}.*.pyc")
    return file


def different(robot: AgentDisk) -> list[str]:
    (checked,) = robot.ask({"op": "check"})
    found: list[str] = checked["done"]["different"]
    return found


def test_compiled_files_are_shared_as_their_sources_are(robot: AgentDisk) -> None:
    for name in ("arm", "leg", "sub/a", "sub/b"):
        assert compiled(robot, 1, name).samefile(compiled(robot, 2, name)), name
    assert not compiled(robot, 1, "robot").samefile(compiled(robot, 2, "robot"))
    assert different(robot) == []


def test_a_damaged_compiled_file_is_named_and_not_shared_further(robot: AgentDisk) -> None:
    file = compiled(robot, 2, "arm")
    file.write_bytes(b"broken")
    assert different(robot) == [f"__pycache__/{file.name}"]
    *_, done = robot.deploy(TWO)
    assert done["done"]["unchanged"]
    assert different(robot) == [f"__pycache__/{file.name}"], "the same program again does not hide it"
    three = {**ONE, "robot.py": "# three\n"}
    robot.deploy(three, three["robot.py"])
    assert different(robot) == []
    assert compiled(robot, 3, "arm").read_bytes() != b"broken"


def test_a_new_installation_mends_the_current_release_and_older_ones(robot: AgentDisk) -> None:
    damaged = compiled(robot, 2, "arm")
    damaged.write_bytes(b"broken")
    for path in ("arm.py", "data/path.json"):
        (robot.places.releases / "2" / path).write_text("broken")
    assert different(robot) == ["__pycache__/" + damaged.name, "arm.py"], "data may be changed by the program"
    need, *_, done = robot.deploy(TWO, ONE["arm.py"], ONE["data/path.json"], reinstall=True)
    assert need["need"] == ["arm.py", "data/path.json"]
    assert done["done"]["release"] == 3
    assert different(robot) == []
    for number in (1, 2):
        for path in ("arm.py", "data/path.json"):
            assert (robot.places.releases / str(number) / path).samefile(robot.places.code / path)
        assert not (robot.places.releases / str(number) / "__pycache__" / damaged.name).exists()
    (back,) = robot.ask({"op": "rollback", "release": 1})
    assert back["done"]["changed"] == []
    assert different(robot) == []


def test_a_new_installation_of_what_is_not_damaged_compiles_everything_again(robot: AgentDisk) -> None:
    *_, done = robot.deploy(TWO, reinstall=True)
    assert done["done"]["release"] == 3
    assert not compiled(robot, 3, "arm").samefile(compiled(robot, 2, "arm"))
    assert robot.startable() == "py/robot.py: # two"
