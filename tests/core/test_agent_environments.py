"""Environments as the robot's side makes them, of wheels that may have the same files; and damaged files in them."""

from __future__ import annotations

import hashlib
import itertools
import os
import stat
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pyfrc_core.deploy.agent.environment_files import EnvironmentFiles
from pyfrc_core.deploy.targets import ControllerKind
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE
from pyfrc_core.wheel_files import WheelError

from .agent_disk import PACKAGES, PYTHON, AgentDisk, run_quickly
from .test_agent_power_cuts import FIRST, ONE, SECOND, TWO, deploy, packages_of, started

Wheels = Mapping[str, Mapping[str, str]]


class Robot:
    """A robot's disk, on which environments are made of wheels."""

    def __init__(self, root: Path) -> None:
        self._disk = AgentDisk(root, SYSTEMCORE.layout)
        self.paths = self._disk.places
        self.environments = self._disk.environments
        #: The wheels that the last installation has received.
        self.sent: list[str] = []

    def install(self, name: str, wheels: Wheels) -> None:
        self.sent = self._disk.install(name, wheels)

    def place(self, name: str) -> Path:
        return self.environments.directory(name)

    def tree(self, name: str) -> dict[str, bytes | str]:
        """The files of an environment, with what a robot would notice of their permissions."""
        place, found = self.place(name), {}
        for file in sorted(place.rglob("*")):
            if file.is_symlink():
                found[str(file.relative_to(place))] = str(file.readlink())
            elif file.is_file() and file.name != "environment.json" and file.suffix != ".pyc":
                found[str(file.relative_to(place))] = file.read_bytes().replace(name.encode(), b"NAME")
        return found

    def compiled(self, name: str) -> dict[str, bytes]:
        return {str(each.relative_to(self.place(name))): each.read_bytes() for each in self.place(name).rglob("*.pyc")}


@contextmanager
def robot_in_memory() -> Iterator[Robot]:
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.access("/dev/shm", os.W_OK) else None) as root:
        yield Robot(Path(root))


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(EnvironmentFiles, "_run", run_quickly)
    monkeypatch.setattr("pyfrc_core.deploy.agent.disk.flush", lambda directory: None)


@pytest.fixture
def robot() -> Iterator[Robot]:
    with robot_in_memory() as robot:
        yield robot


NAMES = [f"{number:016x}" for number in range(4)]
#: Wheels with few names and few contents, so that most of them have a file in common with another.
_FILES = st.dictionaries(
    st.sampled_from(
        ["tests/__init__.py", "a/b.py", "a/c.txt", "x-1.data/scripts/tool", "x-1.data/data/a/c.txt", "d.py"]
    ),
    st.sampled_from(["", "A = 1\n", "A = 2\n", "#!python\nA = 3\n"]),
    min_size=1,
    max_size=4,
)
_WHEELS = st.lists(_FILES, min_size=1, max_size=4, unique_by=lambda files: tuple(sorted(files.items())))


@settings(deadline=None, max_examples=20)
@given(st.lists(_WHEELS, min_size=2, max_size=4), st.randoms(use_true_random=False))
def test_any_wheels_in_any_order_give_the_same_as_on_a_fresh_robot(sets: list[list[dict[str, str]]], random) -> None:
    """And no older environment changes by a byte."""
    pool = list(itertools.chain(*sets))
    with robot_in_memory() as robot:
        before: dict[str, tuple[object, object]] = {}
        for name, number in zip(NAMES, map(len, sets), strict=False):
            files = random.sample(pool, min(number, len(pool)))
            wheels = {f"w{hashlib.sha256(repr(each).encode()).hexdigest()[:8]}.whl": each for each in files}
            robot.install(name, wheels)
            with robot_in_memory() as fresh:
                fresh.install(name, wheels)
                expected = {
                    path: content.replace(str(fresh.paths.root).encode(), str(robot.paths.root).encode())
                    if isinstance(content, bytes)
                    else content.replace(str(fresh.paths.root), str(robot.paths.root))
                    for path, content in fresh.tree(name).items()
                }
                assert robot.tree(name) == expected
                assert robot.compiled(name).keys() == fresh.compiled(name).keys()
            assert robot.environments.damaged() == {}
            for older, was in before.items():
                assert (robot.tree(older), robot.compiled(older)) == was, "an older environment has changed"
            before[name] = robot.tree(name), robot.compiled(name)


SAME = {"first-1.whl": {"tests/__init__.py": "A = 1\n", "first.py": ""}, "last-1.whl": {"tests/__init__.py": "A = 2\n"}}


def test_of_two_wheels_with_the_same_file_the_last_counts(robot: Robot) -> None:
    robot.install(NAMES[0], SAME)
    file = robot.place(NAMES[0]) / PACKAGES / "tests/__init__.py"
    assert file.read_text() == "A = 2\n"
    robot.install(NAMES[1], {**SAME, "more-1.whl": {"more.py": ""}})
    assert robot.sent == ["first-1.whl", "more-1.whl"], "not all of the first one is on the robot"
    assert (robot.place(NAMES[1]) / PACKAGES / "tests/__init__.py").samefile(file)


def test_files_are_read_only_and_scripts_can_be_run(robot: Robot) -> None:
    robot.install(NAMES[0], {"a-1.whl": {"a.py": "", "a-1.data/scripts/tool": "#!python\n"}})
    modes = {
        file.name: stat.S_IMODE(file.stat().st_mode)
        for file in robot.place(NAMES[0]).rglob("*")
        if file.is_file() and not file.is_symlink() and file.suffix not in (".pyc", ".json")
    }
    assert modes == {"a.py": 0o444, "tool": 0o555, "pyvenv.cfg": 0o444}


# -- damage ------------------------------------------------------------------------------------------------------------

BASE = {"kept-1.whl": {"kept.py": "A = 1\n", "data.bin": "1"}, "spinner-1.whl": {"spinner.py": "V = 1\n"}}
NEXT = {**BASE, "spinner-1.whl": {"spinner.py": "V = 2\n"}}


def damage(file: Path, content: str = "broken") -> None:
    """Change a file's content, as a worn disk does: in all its hard links."""
    file.chmod(0o644)
    file.write_text(content, encoding="utf-8")


@pytest.fixture
def two(robot: Robot) -> Robot:
    robot.install(NAMES[0], BASE)
    robot.install(NAMES[1], NEXT)
    assert robot.sent == ["spinner-1.whl"]
    return robot


@pytest.mark.parametrize("damaged", ["kept.py", "data.bin", "__pycache__/kept.cpython-314.opt-1.pyc"])
def test_what_is_damaged_is_replaced_in_all_environments(two: Robot, damaged: str) -> None:
    trees = [(two.tree(name), two.compiled(name).keys()) for name in NAMES[:2]]
    file, same = (two.place(name) / PACKAGES / damaged for name in NAMES[:2])
    assert file.samefile(same)
    damage(file)
    assert two.environments.damaged() == {name: [f"{PACKAGES}/{damaged}"] for name in NAMES[:2]}
    two.install(NAMES[1], NEXT)
    assert two.sent == ([] if "pyc" in damaged else ["kept-1.whl"])
    assert [(two.tree(name), two.compiled(name).keys()) for name in NAMES[:2]] == trees
    assert two.environments.damaged() == {}
    assert stat.S_IMODE(file.stat().st_mode) & 0o222 == 0 or damaged.endswith(".pyc")
    two.install(NAMES[1], NEXT)
    assert two.sent == []


def test_what_venv_has_made_is_made_again(two: Robot) -> None:
    trees = [two.tree(name) for name in NAMES[:2]]
    place = two.place(NAMES[0])
    damage(place / "pyvenv.cfg", "")
    (place / "bin/python3").unlink()
    assert two.environments.damaged() == {NAMES[0]: ["pyvenv.cfg", "bin/python3"]}
    two.install(NAMES[1], NEXT)
    assert [two.tree(name) for name in NAMES[:2]] == trees
    assert not (two.paths.own / "new").exists()


def test_a_file_that_this_computer_cannot_send_stays_named(two: Robot) -> None:
    damage(two.place(NAMES[0]) / PACKAGES / "spinner.py")
    two.install(NAMES[1], NEXT)
    assert two.environments.damaged() == {NAMES[0]: [f"{PACKAGES}/spinner.py"]}
    two.install(NAMES[0], BASE)
    assert two.environments.damaged() == {}


def test_a_damaged_file_is_not_linked_into_another_environment(two: Robot) -> None:
    damage(two.place(NAMES[0]) / PACKAGES / "__pycache__/kept.cpython-314.opt-1.pyc")
    damage(two.place(NAMES[0]) / PACKAGES / "data.bin")
    two.install(NAMES[2], {**NEXT, "more-1.whl": {"more.py": ""}})
    assert two.sent == ["kept-1.whl", "more-1.whl"]
    assert two.environments.damaged() == {}


def test_what_an_interrupted_installation_has_left_is_removed(two: Robot) -> None:
    own = two.paths.own
    for name in (f"environments/{NAMES[2]}/bin/python3", "wheels/0", "new/0/a.py", "environments/theirs/x"):
        (own / name).parent.mkdir(parents=True, exist_ok=True)
        (own / name).touch()
    two.environments.remove_remains()
    assert sorted(each.name for each in own.iterdir()) == ["environments", "pythons"]
    assert sorted(each.name for each in (own / "environments").iterdir()) == [*NAMES[:2], "theirs"]


def test_environments_and_pythons_that_nothing_needs_are_removed(two: Robot) -> None:
    pythons = two.paths.own / "pythons"
    for name in ("f" * 16, "mine"):
        (pythons / name).mkdir()
    two.environments.remove_unused([None, NAMES[1]])
    assert [each.name for each in (two.paths.own / "environments").iterdir()] == [NAMES[1]]
    assert sorted(each.name for each in pythons.iterdir()) == [PYTHON, "mine"]
    two.environments.remove_unused([])
    assert [each.name for each in pythons.iterdir()] == ["mine"]


@pytest.mark.parametrize("path", ["bin/python3", "pyvenv.cfg", "environment.json"])
def test_what_venv_made_is_never_replaced(robot: Robot, path: str) -> None:
    with pytest.raises(WheelError, match=r"x-1\.whl has a file in the place of Python's own"):
        robot.install(NAMES[0], {"x-1.whl": {f"x-1.data/data/{path}": ""}})
    assert not robot.environments.is_usable(NAMES[0])


# -- environments and the releases that need them ----------------------------------------------------------------------


@pytest.fixture(params=[ROBORIO, SYSTEMCORE], ids=lambda each: each.name)
def controller(request: pytest.FixtureRequest) -> ControllerKind:
    return request.param


def test_what_no_release_needs_is_removed(controller: ControllerKind, tmp_path: Path) -> None:
    robot = AgentDisk(tmp_path / "robot", controller.layout)
    deploy(robot, ONE, FIRST)
    for number in range(1, 5):
        deploy(robot, {"robot.py": f"# {number}\n"}, SECOND)
    own = robot.places.own
    assert [each.name for each in (own / "environments").iterdir()] == [SECOND]
    assert not (own / "wheels").exists()
    assert list(own.glob("pythons/*")) in ([], [own / "pythons" / PYTHON])


def test_another_tools_packages_are_kept_for_the_releases_that_use_them(
    controller: ControllerKind, tmp_path: Path
) -> None:
    robot = AgentDisk(tmp_path / "robot", controller.layout)
    deploy(robot, ONE)
    theirs = robot.places.start_command()
    assert controller.layout.python in theirs
    deploy(robot, TWO, SECOND)
    assert started(robot, controller) == (TWO, packages_of(SECOND))
    robot.ask({"op": "rollback"})
    assert (robot.places.start_command(), started(robot, controller)) == (theirs, (ONE, {}))
    robot.ask({"op": "rollback", "release": 2})
    assert started(robot, controller) == (TWO, packages_of(SECOND))


def test_another_tools_program_keeps_the_packages_that_it_was_deployed_with(
    controller: ControllerKind, tmp_path: Path
) -> None:
    robot = AgentDisk(tmp_path / "robot", controller.layout)
    deploy(robot, ONE, FIRST)
    robot.places.code.unlink()
    robot.places.code.mkdir()
    (robot.places.code / "robot.py").write_text("# theirs\n")
    deploy(robot, TWO, SECOND)
    robot.ask({"op": "rollback"})
    assert started(robot, controller) == ({"robot.py": "# theirs\n"}, packages_of(FIRST))
