"""`pyfrc sync`: what the robot needs, from indexes on this machine, with pip itself."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import MakeProject, Result, RobotProject
from package_index import ROBOT_TAGS, WPILIB, PackageIndex, package_index

from pyfrc_core.file_hash import hash_file
from pyfrc_core.season import CURRENT
from pyfrc_core.sync import LOCK_FILE, Lock, LockedFile, load_lock
from pyfrc_core.sync.cache import LOCKED_WHILE_CHANGED
from pyfrc_core.sync.lock import save_lock
from pyfrc_core.sync.resolve import source_of

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        pass
"""
CACHE = Path("wpilib", str(CURRENT.year), "robotpy")
CONTROLLER = CURRENT.controller.name


def pyproject(components: str = '"commands2"', requires: str = '"simple-lib"', version: str = WPILIB) -> str:
    return f"[tool.robotpy]\nrobotpy_version = {version!r}\ncomponents = [{components}]\nrequires = [{requires}]\n"


@pytest.fixture
def index(tmp_path: Path) -> Iterator[PackageIndex]:
    with package_index(tmp_path / "index") as index:
        index.add_wpilib()
        index.add("simple-lib", "1.0")
        yield index


@pytest.fixture
def project(make_project: MakeProject) -> RobotProject:
    return make_project({"robot.py": ROBOT, "pyproject.toml": pyproject()})


class Laptop:
    """A computer with a home directory of its own, and a copy of the project."""

    def __init__(self, home: Path, project: RobotProject, index: PackageIndex) -> None:
        self.home = home
        self.project = project
        self.index = index

    def run(self, *args: str | Path, **env: str) -> Result:
        return self.project.run_here("sync", *args, env=self.index.environment(self.home) | env)

    def sync(self, *args: str | Path, **env: str) -> str:
        """Run it, and return what it prints; it must succeed."""
        done = self.run(*args, **env)
        assert done.code == 0, done.output
        return done.stdout

    def write_lock(self) -> None:
        """Write the lock that the first `sync` writes, for tests that are not about how pip finds packages."""
        simple, robot = f"{self.index.url}/simple", f"{self.index.url}/robot"
        wheels = [
            *self.index.directory.glob("robot/*/*.whl"),
            *(each for each in self.index.directory.glob("simple/*/*-none-any.whl")),
        ]
        packages = []
        for wheel in wheels:
            name, index = wheel.parent.name, robot if "robot" in wheel.parts[-3] else simple
            if name == "robotpy-apriltag":
                continue  # a component that was not chosen
            url = f"{index}/{name}/{wheel.name}"
            sha256, size = hash_file(wheel)
            packages.append(
                LockedFile(
                    name, wheel.name.split("-")[1], wheel.name, size, sha256, url, source_of(url, [simple, robot])
                )
            )
        python = self.index.python
        sha256, size = hash_file(python)
        locked = LockedFile(
            "python", CURRENT.downloads.python, python.name, size, sha256, f"{self.index.url}/{python.name}"
        )
        requirements = (f"robotpy[commands2]=={WPILIB}", "simple-lib")
        packages.sort(key=lambda each: each.name)
        save_lock(self.project.path / LOCK_FILE, Lock(CURRENT.year, CONTROLLER, requirements, locked, tuple(packages)))

    @property
    def lock(self) -> Lock:
        lock = load_lock(self.project.path / LOCK_FILE, CURRENT)
        assert lock is not None
        return lock

    @property
    def packages(self) -> dict[str, str]:
        return {each.name: each.version for each in self.lock.packages}

    def cached(self) -> dict[str, bytes]:
        """Return the cache's files by name."""
        files = [
            each for each in (self.home / CACHE).rglob("*") if each.is_file() and each.name != LOCKED_WHILE_CHANGED
        ]
        return {each.name: each.read_bytes() for each in files}


@pytest.fixture
def laptop(tmp_path: Path, project: RobotProject, index: PackageIndex) -> Laptop:
    return Laptop(tmp_path / "home", project, index)


def another(laptop: Laptop, tmp_path: Path) -> Laptop:
    """Another computer with a clone of the project."""
    directory = tmp_path / "another"
    directory.mkdir()
    shutil.copytree(laptop.project.path, directory / "robot-project")
    project = RobotProject(directory / "robot-project", laptop.project.temporary)
    return Laptop(directory / "home", project, laptop.index)


@pytest.mark.bare
def test_python_and_the_packages_for_the_robot_are_downloaded_and_locked(laptop: Laptop, index: PackageIndex) -> None:
    printed = laptop.sync()
    # Not what only desktops, Windows or older Pythons need, whatever runs here.
    assert laptop.packages == {
        "only-on-robots": "1.0",
        "robotpy": WPILIB,
        "robotpy-cli": "1.0",
        "robotpy-commands-v2": WPILIB,
        "robotpy-hal": WPILIB,
        "simple-lib": "1.0",
        "wpilib": WPILIB,
    }
    lock = laptop.lock
    assert lock.requirements == (f"robotpy[commands2]=={WPILIB}", "simple-lib")
    assert lock.python.version == CURRENT.downloads.python
    assert lock.python.size == index.python.stat().st_size
    wpilib = next(each for each in lock.packages if each.name == "wpilib")
    assert wpilib.file == f"wpilib-{WPILIB}-{ROBOT_TAGS}.whl"
    assert wpilib.url == f"{index.url}/robot/wpilib/{wpilib.file}"
    assert set(laptop.cached()) == {each.file for each in lock.files}
    assert laptop.cached()[index.python.name] == index.python.read_bytes()
    assert f"{LOCK_FILE} is new: 7 packages. Commit it." in printed
    assert f"For the {CONTROLLER}: 8 files, " in printed
    assert f"get       wpilib {WPILIB} " in printed
    laptop.write_lock()
    assert laptop.lock == lock


def test_with_a_lock_nothing_is_looked_up_and_what_is_there_is_not_downloaded_again(laptop: Laptop) -> None:
    laptop.write_lock()
    laptop.sync()
    text = (laptop.project.path / LOCK_FILE).read_bytes()
    laptop.index.add("simple-lib", "2.0")
    laptop.index.requests.clear()
    assert f"{LOCK_FILE}: unchanged" in laptop.sync()
    assert laptop.index.requests == []
    (laptop.home / CACHE / "pip_cache" / "simple_lib-1.0-py3-none-any.whl").unlink()
    laptop.sync()
    assert [path for path, _ in laptop.index.requests] == ["/simple/simple-lib/simple_lib-1.0-py3-none-any.whl"]
    assert (laptop.project.path / LOCK_FILE).read_bytes() == text


@pytest.mark.bare
def test_two_laptops_with_the_same_lock_have_the_same_bytes(laptop: Laptop, tmp_path: Path) -> None:
    laptop.write_lock()
    laptop.sync()
    other = another(laptop, tmp_path)
    # Its cache has something else under the same name, and the indexes have newer packages.
    file = other.home / CACHE / "pip_cache" / "simple_lib-1.0-py3-none-any.whl"
    file.parent.mkdir(parents=True)
    file.write_bytes(b"another build")
    laptop.index.add("simple-lib", "2.0")
    laptop.index.add("robotpy-cli", "2.0")
    other.sync()
    assert other.cached() == laptop.cached()
    assert other.lock == laptop.lock


def test_a_file_with_another_content_than_the_locked_is_refused(laptop: Laptop, tmp_path: Path) -> None:
    laptop.write_lock()
    laptop.sync()
    other = another(laptop, tmp_path)
    wheel = laptop.index.directory / "simple/simple-lib/simple_lib-1.0-py3-none-any.whl"
    wheel.write_bytes(wheel.read_bytes() + b"more")
    refused = other.run()
    assert refused.code == 1
    expected = "simple-lib 1.0 from 127.0.0.1 has another content than it should have (its SHA-256 differs)"
    assert refused.first_error == expected
    assert wheel.name not in other.cached()
    assert other.lock == laptop.lock


def test_a_check_compares_and_changes_nothing(laptop: Laptop, tmp_path: Path) -> None:
    checked = laptop.run("--check")
    assert (checked.code, checked.stdout) == (1, f"there is no {LOCK_FILE}\n\nTo get it: pyfrc sync\n")
    laptop.write_lock()
    laptop.sync()
    laptop.index.requests.clear()
    assert laptop.sync("--check") == "nothing is missing\n"
    laptop.project.write({"pyproject.toml": pyproject(components="")})
    (laptop.home / CACHE / "pip_cache" / "simple_lib-1.0-py3-none-any.whl").unlink()
    (laptop.home / CACHE / "pip_cache" / "robotpy_cli-1.0-py3-none-any.whl").write_bytes(b"another")
    checked = laptop.run("-q", "--check")
    assert checked.code == 1
    assert checked.stdout.splitlines() == [
        f"pyproject.toml asks for robotpy=={WPILIB}, which the lock does not have",
        f"the lock is for robotpy[commands2]=={WPILIB}, which pyproject.toml does not ask for",
        "robotpy-cli 1.0: another content (robotpy_cli-1.0-py3-none-any.whl)",
        "simple-lib 1.0: not on this computer (simple_lib-1.0-py3-none-any.whl)",
    ]
    assert laptop.index.requests == []


def test_a_component_that_does_not_exist_is_refused_before_the_download(laptop: Laptop) -> None:
    laptop.project.write({"pyproject.toml": pyproject(components='"comands2"')})
    refused = laptop.run()
    assert refused.code == 2
    assert refused.first_error == "pyproject.toml:3: components has 'comands2', which does not exist"
    assert "Did you mean 'commands2'?" in refused.stderr
    assert laptop.index.requests == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("requires", "message"),
    [
        ('"needs-c"', f"there is no wheel of only-for-pcs>=1 for the {CONTROLLER} (Python 3.14); needs-c needs it"),
        (
            '"needs-old", "simple-lib==1.0"',
            "the requirements contradict each other: [tool.robotpy] has simple-lib==1.0; needs-old 1.0 depends on "
            "simple-lib<1",
        ),
    ],
    ids=["only for others", "contradiction"],
)
def test_what_cannot_be_found_is_named_and_what_to_do(laptop: Laptop, requires: str, message: str) -> None:
    laptop.index.add("needs-c", "1.0", ["only-for-pcs>=1"])
    laptop.index.add("only-for-pcs", "1.0", tags="cp314-cp314-manylinux_2_17_x86_64")
    laptop.index.add("needs-old", "1.0", ["simple-lib<1"])
    laptop.index.add("simple-lib", "0.5")
    laptop.project.write({"pyproject.toml": pyproject(requires=requires)})
    failed = laptop.run()
    assert failed.code == 1
    assert failed.first_error == message
    assert "pyproject.toml" in failed.stderr.splitlines()[1]
    assert not (laptop.project.path / LOCK_FILE).exists()


def test_what_is_no_wheel_is_refused_with_how_to_make_one(laptop: Laptop) -> None:
    laptop.project.write({"pyproject.toml": pyproject(requires='"own-lib @ git+https://example.org/own-lib"')})
    refused = laptop.run()
    assert refused.code == 2
    assert "pyproject.toml:4: requires has 'own-lib" in refused.first_error
    assert "python -m pip wheel --no-deps --wheel-dir wheels" in refused.stderr


def test_a_copy_of_the_cache_serves_a_laptop_without_internet(laptop: Laptop, tmp_path: Path) -> None:
    laptop.write_lock()
    laptop.sync()
    other = another(laptop, tmp_path)
    laptop.index.close()
    assert other.run().code == 1
    shutil.copytree(laptop.home / CACHE, other.home / CACHE, dirs_exist_ok=True)
    other.sync()
    assert other.sync("--check") == "nothing is missing\n"
