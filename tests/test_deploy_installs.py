"""The first deploy to a blank robot installs Python and packages, later ones what changed; and back again.

With the season's controller.
"""

from __future__ import annotations

import os
import select
import shutil
from collections.abc import Generator, Iterator
from pathlib import Path

import pytest
from conftest import RobotProject, new_project
from laptops import IS_ROBORIO, Laptop, blank_computer, write_python
from package_index import PackageIndex, package_index
from roborio import PATIENCE, Proxy
from roborio.computer import Computer

from pyfrc_core.season import CURRENT

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
#: By day, one test with the roboRIO is enough: what differs is how Python comes.
nightly = pytest.mark.slow if IS_ROBORIO else lambda test: test


@pytest.fixture(scope="session")
def python(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("python") / "python"
    write_python(file)
    return file


@pytest.fixture
def index(tmp_path: Path) -> Iterator[PackageIndex]:
    with package_index(tmp_path / "index") as index:
        yield index


@pytest.fixture
def blank() -> Generator[Computer]:
    with blank_computer() as robot:
        yield robot


@pytest.fixture
def project(tmp_path: Path) -> RobotProject:
    files = {"robot.py": ROBOT.format(number=1), "spinner/__init__.py": 'VERSION = "here"\n'}
    return new_project(tmp_path, files, as_written=True)  # the look-alike of no season has more than WPILib's base


@pytest.fixture
def laptop(project: RobotProject, tmp_path: Path, index: PackageIndex, python: Path) -> Laptop:
    return Laptop(tmp_path / "home", project, index, python)


def test_from_nothing_to_a_rollback(blank: Computer, laptop: Laptop, project: RobotProject) -> None:
    assert "pyfrc-lock.toml is new: 3 packages" in laptop.sync(spinner="1.0")
    first = laptop.deploy(blank)
    assert "there is no Python on it yet" in first
    assert f"install    Python {CURRENT.downloads.python}, 3 packages of 3 sent" in first
    blank.said("program 1 with spinner 1.0")
    project.write({"robot.py": ROBOT.format(number=2)})
    laptop.sync(spinner="2.0")
    assert "install    1 package of 3 sent" in laptop.deploy(blank)
    blank.said("program 2 with spinner 2.0")
    assert laptop.run(blank, "deploy", "--rollback").code == 0
    blank.said("program 1 with spinner 1.0")
    if IS_ROBORIO:
        assert not (blank.disk / "usr/local/pyfrc/installing").exists()
        assert blank.run("find", "/home/lvuser", "!", "-user", "lvuser").stdout == ""


@nightly
def test_a_cut_connection_leaves_the_robot_as_it_was(laptop: Laptop, project: RobotProject, python: Path) -> None:
    """While Python and the packages are sent; near the end, how many bytes there are differs from deploy to deploy."""
    project.write({"robot.py": PLAIN.format(number=1)})
    laptop.sync(spinner="1.0")
    with blank_computer() as robot, Proxy((robot.host, robot.port)) as proxy:
        laptop.deploy(proxy)
        total = proxy.bytes_to_robot
    for place in (0.1, 0.45, 0.8):
        shutil.rmtree(project.path / ".pyfrc")  # the next robot has another key
        with blank_computer() as robot:
            with Proxy((robot.host, robot.port), cut_to_robot=int(total * place)) as proxy:
                cut = laptop.run(proxy, "deploy", "--skip-tests")
                assert cut.code != 0, cut.output
            started = (robot.home / "robotCommand").exists()
            assert started == (robot.home / "py").exists(), f"after {place} of the bytes"
            robot.wait_for_end_of_deploy()
            laptop.deploy(robot)
            robot.said("plain program 1")
            remains = [*robot.home.glob(".pyfrc/pythons/.new*"), *robot.disk.glob("usr/local/pyfrc/*")]
            assert remains == []


@pytest.mark.season_2026
@nightly
def test_an_interrupted_opkg_runs_again(blank: Computer, laptop: Laptop, project: RobotProject) -> None:
    """Python has its files then, but perhaps not all of them."""
    project.write({"robot.py": PLAIN.format(number=1)})
    laptop.sync(spinner="1.0")
    opkg = blank.disk / "usr/local/bin/opkg"
    works = opkg.read_text(encoding="utf-8")
    blank.put("usr/local/bin/opkg", works.replace('echo "$name - ', 'echo " * power is gone"; exit 255 # '), mode=0o755)
    failed = laptop.run(blank, "deploy", "--skip-tests")
    assert failed.code == 1
    assert "Python could not be installed on the robot: * power is gone" in failed.first_error
    assert (blank.disk / "usr/local/bin/python3").is_symlink()
    blank.put("usr/local/bin/opkg", works, mode=0o755)
    assert "there is no Python on it yet" in laptop.deploy(blank)
    blank.said("plain program 1")


@pytest.mark.season_2026
@nightly
def test_two_first_installations_at_once(blank: Computer, laptop: Laptop, project: RobotProject) -> None:
    """The second one is done while the first one waits for opkg, which then has nothing more to do."""
    project.write({"robot.py": PLAIN.format(number=1)})
    laptop.sync(spinner="1.0")
    opkg = (blank.disk / "usr/local/bin/opkg").read_text(encoding="utf-8")
    waits = "if mkdir /usr/local/first 2> /dev/null; then echo > /usr/local/here; cat /usr/local/go; fi\n"
    blank.put("usr/local/bin/opkg", opkg.replace("control=$(tar", f"{waits}control=$(tar", 1), mode=0o755)
    for name in ("here", "go"):
        os.mkfifo(blank.disk / "usr/local" / name)
    here = os.open(blank.disk / "usr/local/here", os.O_RDONLY | os.O_NONBLOCK)
    with laptop.start(blank, "deploy", "--skip-tests") as first:
        assert select.select([here], [], [], PATIENCE)[0], "the first one has not come to opkg"
        os.close(here)
        laptop.deploy(blank)
        blank.said("plain program 1")
        (blank.disk / "usr/local/go").write_text("", encoding="utf-8")
        printed, errors = first.rest()
        assert first.wait() == 0, printed + errors
    assert "0 packages of 3 sent" in printed
    assert not (blank.disk / "usr/local/pyfrc/installing").exists()
