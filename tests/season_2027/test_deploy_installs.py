"""The first deploy to a blank SystemCore installs Python and packages, later ones what changed; and back again."""

from __future__ import annotations

import hashlib
import io
import shutil
import sys
import tarfile
from collections.abc import Generator, Mapping
from importlib.metadata import version
from pathlib import Path
from zipfile import ZipFile, ZipInfo

import pytest
from conftest import MakeProject, Result, RobotProject
from roborio import Proxy
from systemcore import Systemcore, require_systemcore

from pyfrc_core.season import CURRENT
from pyfrc_core.sync.lock import Lock, LockedFile, save_lock

WPILIB = version("wpilib")
ROBOT = """
    import spinner
    import wpilib

    print("program {number} with spinner", spinner.VERSION)


    class MyRobot(wpilib.TimedRobot):
        pass
"""
PLAIN = """
    import wpilib

    print("plain program {number}")


    class MyRobot(wpilib.TimedRobot):
        pass
"""
STAND_INS = Path(__file__).parents[1] / "systemcore/site-packages"
_LEFT_OUT = ("dist-packages", "site-packages", "test", "idlelib", "tkinter", "__pycache__", "ensurepip", "turtledemo")


@pytest.fixture(scope="session")
def python_archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """This machine's Python as an archive, as a standalone one is packed."""
    prefix, name = Path(sys.base_prefix), f"python{sys.version_info.major}.{sys.version_info.minor}"

    def packed(member: tarfile.TarInfo) -> tarfile.TarInfo | None:
        parts = Path(member.name).parts
        return None if any(part in _LEFT_OUT or part.startswith("config-") for part in parts) else member

    archive = tmp_path_factory.mktemp("python") / "python.tar.gz"
    with tarfile.open(archive, "w:gz", compresslevel=1) as tar:
        tar.add((prefix / "bin" / name).resolve(), f"python/bin/{name}")
        link = tarfile.TarInfo("python/bin/python3")
        link.type, link.linkname = tarfile.SYMTYPE, name
        tar.addfile(link)
        tar.add(prefix / "lib" / name, f"python/lib/{name}", filter=packed)
        # Debian's own has a link to /etc among its modules.
        for each in (prefix / "lib").glob("libpython*.so*"):
            tar.add(each, f"python/lib/{each.name}")
    return archive


def wheel(name: str, number: str, files: Mapping[str, str]) -> tuple[str, bytes]:
    """A wheel for any Python: its file name and its content, the same each time."""
    content = io.BytesIO()
    about = f"{name}-{number}.dist-info"
    metadata = {
        f"{about}/METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: {number}\n",
        f"{about}/WHEEL": "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    with ZipFile(content, "w") as archive:
        for path, text in {**files, **metadata}.items():
            archive.writestr(ZipInfo(path), text)
    return f"{name}-{number}-py3-none-any.whl", content.getvalue()


class Laptop:
    """A home directory with the season's cache, as `pyfrc sync` fills it."""

    def __init__(self, home: Path, project: RobotProject, python: Path) -> None:
        self.home = home
        self._project = project
        cache = home / "wpilib" / str(CURRENT.year) / "robotpy"
        self.packages, pythons = cache / "pip_cache", cache / CURRENT.downloads.python_cache
        for directory in (self.packages, pythons):
            directory.mkdir(parents=True)
        content = python.read_bytes()
        (pythons / "python.tar.gz").write_bytes(content)
        self._python = LockedFile(
            "python", CURRENT.downloads.python, "python.tar.gz", len(content), hashlib.sha256(content).hexdigest()
        )

    def sync(self, **versions: str) -> None:
        """Write the lock, with these packages besides WPILib's stand-in."""
        own = {
            name: {
                file.relative_to(STAND_INS).as_posix(): file.read_text(encoding="utf-8")
                for file in (STAND_INS / name).rglob("*.py")
            }
            for name in ("wpilib", "robotpy")
        }
        own["wpilib"]["wpilib/version.py"] = f'version = "{WPILIB}"\n'
        wheels = [wheel(name, WPILIB, files) for name, files in own.items()]
        for name, number in versions.items():
            wheels.append(wheel(name, number, {f"{name}/__init__.py": f'VERSION = "{number}"\n'}))
        locked = []
        for file, content in wheels:
            (self.packages / file).write_bytes(content)
            name, number, *_ = file.split("-")
            locked.append(LockedFile(name, number, file, len(content), hashlib.sha256(content).hexdigest()))
        packages = tuple(sorted(locked, key=lambda each: each.name))
        lock = Lock(CURRENT.year, CURRENT.controller.name, (), self._python, packages)
        save_lock(self._project.path / "pyfrc-lock.toml", lock)

    def run(self, robot: Systemcore, *command: str) -> Result:
        environment = {"HOME": str(self.home)}
        return self._project.run(*command, "--robot", robot.where, env=environment, cold=True)

    def deploy(self, robot: Systemcore, *options: str) -> str:
        result = self.run(robot, "deploy", "--skip-tests", *options)
        assert result.code == 0, result.output
        return result.stdout


@pytest.fixture
def blank() -> Generator[Systemcore]:
    """One that was just imaged: no Python, no program."""
    require_systemcore()
    with Systemcore(python=None, disk_size="400m") as robot:
        yield robot


@pytest.fixture
def project(make_project: MakeProject) -> RobotProject:
    return make_project(
        {"robot.py": ROBOT.format(number=1), "spinner/__init__.py": 'VERSION = "here"\n', "pyproject.toml": EXCLUDES}
    )


#: The package is a stand-in on this computer, where the program is imported before it is deployed.
EXCLUDES = """
    [tool.pyfrc.deploy]
    exclude = ["spinner"]
"""


@pytest.fixture
def laptop(project: RobotProject, tmp_path: Path, python_archive: Path) -> Laptop:
    return Laptop(tmp_path / "home", project, python_archive)


def test_from_nothing_to_two_rollbacks(blank: Systemcore, laptop: Laptop, project: RobotProject) -> None:
    laptop.sync(spinner="1.0")
    first = laptop.deploy(blank)
    assert "there is no Python on it yet" in first
    assert f"install    Python {CURRENT.downloads.python}, 3 packages of 3 sent" in first
    blank.said("program 1 with spinner 1.0")
    again = laptop.deploy(blank)
    assert "nothing has changed" in again
    assert "install " not in again
    project.write({"robot.py": ROBOT.format(number=2)})
    laptop.deploy(blank)
    blank.said("program 2 with spinner 1.0")
    laptop.sync(spinner="2.0")
    third = laptop.deploy(blank)
    assert "install    1 package of 3 sent" in third
    assert "upload     1 file, " in third, "the lock"
    blank.said("program 2 with spinner 2.0")
    assert laptop.run(blank, "deploy", "--rollback").code == 0
    blank.said("program 2 with spinner 1.0")
    assert laptop.run(blank, "deploy", "--rollback").code == 0
    blank.said("program 1 with spinner 1.0")
    python = blank.home / ".python/bin/python3"
    assert python.parent.parent.is_symlink(), "where today's tool looks for it"


def test_what_todays_tool_has_installed_is_kept_for_the_releases_that_use_it(
    laptop: Laptop, project: RobotProject
) -> None:
    require_systemcore()
    project.write({"robot.py": PLAIN.format(number=1)})
    with Systemcore(wpilib=WPILIB, disk_size="400m") as robot:
        assert "install " not in laptop.deploy(robot), "there is no lock"
        robot.said("plain program 1")
        project.write({"robot.py": ROBOT.format(number=2)})
        laptop.sync(spinner="1.0")
        laptop.deploy(robot)
        robot.said("program 2 with spinner 1.0")
        assert (robot.home / "venv").readlink().parent.name == "environments"
        assert laptop.run(robot, "deploy", "--rollback").code == 0
        robot.said("plain program 1")
        assert (robot.home / "venv").readlink().name == "taken-1"


def test_a_blank_robot_without_a_lock_or_without_the_files(
    blank: Systemcore, laptop: Laptop, project: RobotProject
) -> None:
    refused = laptop.run(blank, "deploy", "--skip-tests")
    assert refused.code == 1
    assert refused.first_error.endswith("there is no Python on the robot (/home/systemcore/venv/bin/python3)")
    assert "with internet: pyfrc sync; then at the robot: pyfrc deploy" in refused.stderr
    laptop.sync(spinner="1.0")
    (laptop.packages / f"wpilib-{WPILIB}-py3-none-any.whl").write_bytes(b"")
    refused = laptop.run(blank, "deploy", "--skip-tests")
    assert refused.code == 1
    assert f"wpilib {WPILIB} for the robot has another content than the lock says" in refused.first_error
    assert list(blank.home.iterdir()) == []


def test_a_full_disk_is_said_before_anything_is_installed(laptop: Laptop) -> None:
    require_systemcore()
    laptop.sync(spinner="1.0")
    with Systemcore(python=None, disk_size="20m") as robot:
        refused = laptop.run(robot, "deploy", "--skip-tests")
        assert refused.code == 1
        assert "the robot's disk is too full to install Python: " in refused.first_error
        assert not (robot.home / ".pyfrc/releases").exists()


def test_a_damaged_archive_and_a_cut_connection_leave_the_robot_as_it_was(
    blank: Systemcore, laptop: Laptop, project: RobotProject, python_archive: Path
) -> None:
    project.write({"robot.py": PLAIN.format(number=1)})
    laptop.sync(spinner="1.0")
    size = python_archive.stat().st_size
    with Proxy((blank.host, blank.port), cut_to_robot=size // 2) as proxy:
        cut = project.run(
            *["deploy", "--skip-tests", "--robot", f"{proxy.host}:{proxy.port}"],
            env={"HOME": str(laptop.home)},
            cold=True,
        )
        assert cut.code == 1, cut.output
    assert not (blank.home / "venv").exists()
    assert not (blank.home / "robotCommand").exists()
    laptop.deploy(blank)
    blank.said("plain program 1")
    assert not (blank.home / ".pyfrc/pythons/.new").exists()


def test_two_laptops_with_one_lock_give_the_same_packages(
    laptop: Laptop, project: RobotProject, tmp_path: Path, python_archive: Path
) -> None:
    """Byte for byte, and under the same name."""
    require_systemcore()
    project.write({"robot.py": PLAIN.format(number=1)})
    other, seen = Laptop(tmp_path / "other", project, python_archive), []
    for each in (laptop, other):
        each.sync(spinner="1.0")
        with Systemcore(python=None, disk_size="400m") as robot:
            each.deploy(robot)
            place = robot.home / ".pyfrc/environments"
            seen.append(
                {
                    file.relative_to(place).as_posix(): file.read_bytes()
                    for file in place.rglob("*")
                    if file.is_file() and not file.is_symlink() and file.suffix != ".pyc"
                }
            )
        shutil.rmtree(project.path / ".pyfrc")  # the next robot has another key
    assert seen[0] == seen[1]
    assert len(seen[0]) > 5
