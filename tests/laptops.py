"""Computers with a home directory of their own, and robots of the season without Python: for tests of installations."""

from __future__ import annotations

import sys
import tarfile
from importlib.metadata import version
from pathlib import Path
from typing import Any

from conftest import Result, RobotProject
from package_index import ANY_TAGS, DOWNLOADS, ROBOT_TAGS, PackageIndex, add_wheel
from roborio import Proxy, Roborio, python_package, require_roborio
from roborio.computer import Computer
from started_commands import StartedCommand
from systemcore import Systemcore, require_systemcore

from pyfrc_core.season import CURRENT

WPILIB = version("wpilib")
IS_ROBORIO = CURRENT.controller.name == "roboRIO"
_TESTS = Path(__file__).parent
#: The robot's packages: stand-ins, since this machine's are for another processor.
_STAND_INS = _TESTS / (
    "roborio/files/usr/local/lib/python3.14/site-packages" if IS_ROBORIO else "systemcore/site-packages"
)
_LEFT_OUT = ("dist-packages", "site-packages", "test", "idlelib", "tkinter", "__pycache__", "ensurepip", "turtledemo")


def require_computer() -> None:
    """Skip the test where the season's controller cannot have a look-alike."""
    if IS_ROBORIO:
        require_roborio()
    else:
        require_systemcore()


def blank_computer(**options: Any) -> Computer:
    """One that was just imaged: no Python, no program."""
    require_computer()
    if IS_ROBORIO:
        return Roborio(blank=True, **options)
    return Systemcore(python=None, **{"disk_size": "400m", **options})


def write_python(file: Path) -> None:
    """Write this machine's Python as the season's robots get theirs."""
    if IS_ROBORIO:
        file.write_bytes(python_package(DOWNLOADS.python))
        return
    prefix, name = Path(sys.base_prefix), f"python{sys.version_info.major}.{sys.version_info.minor}"

    def packed(member: tarfile.TarInfo) -> tarfile.TarInfo | None:
        parts = Path(member.name).parts
        return None if any(part in _LEFT_OUT or part.startswith("config-") for part in parts) else member

    with tarfile.open(file, "w:gz", compresslevel=1) as tar:
        tar.add((prefix / "bin" / name).resolve(), f"python/bin/{name}")
        link = tarfile.TarInfo("python/bin/python3")
        link.type, link.linkname = tarfile.SYMTYPE, name
        tar.addfile(link)
        tar.add(prefix / "lib" / name, f"python/lib/{name}", filter=packed)
        # Debian's own has a link to /etc among its modules.
        for each in (prefix / "lib").glob("libpython*.so*"):
            tar.add(each, f"python/lib/{each.name}")


def fill(index: PackageIndex, python: Path, **versions: str) -> None:
    """Add what robots get: Python, stand-ins for WPILib's packages, and small packages with these versions."""
    if not index.python.exists() or index.python.stat().st_size != python.stat().st_size:
        index.python.write_bytes(python.read_bytes())
    for name, tags in (("wpilib", ROBOT_TAGS), ("robotpy", ANY_TAGS)):
        modules = [name, "wpimath"] if IS_ROBORIO and name == "wpilib" else [name]
        files = {
            file.relative_to(_STAND_INS).as_posix(): file.read_text(encoding="utf-8")
            for module in modules
            for file in (_STAND_INS / module).rglob("*.py")
        }
        if name == "wpilib":
            files["wpilib/version.py"] = f'version = __version__ = "{WPILIB}"\n'
        place = index.directory / ("robot" if tags == ROBOT_TAGS else "simple") / name
        add_wheel(place, name, WPILIB, [f"wpilib=={WPILIB}"] if name == "robotpy" else [], tags, files)
    for name, number in versions.items():
        files = {f"{name}/__init__.py": f'VERSION = "{number}"\n'}
        add_wheel(index.directory / "simple" / name, name, number, files=files)


class Laptop:
    """A computer with a home directory of its own, and the project."""

    def __init__(self, home: Path, project: RobotProject, index: PackageIndex, python: Path) -> None:
        self.packages = home / "wpilib" / str(CURRENT.year) / "robotpy/pip_cache"
        self._project, self._index, self._python = project, index, python
        self._environment = index.environment(home)

    def sync(self, **versions: str) -> str:
        """Ask for these packages besides WPILib's, and run `pyfrc sync`. Return what it prints."""
        fill(self._index, self._python, **versions)
        requires = ", ".join(f'"{name}=={number}"' for name, number in versions.items())
        table = f'[tool.robotpy]\nrobotpy_version = "{WPILIB}"\nrequires = [{requires}]\n'
        # On this computer the package is a directory of the project: the program is imported before it is deployed.
        self._project.write({"pyproject.toml": f'{table}[tool.pyfrc.deploy]\nexclude = ["spinner"]\n'})
        done = self._project.run("sync", env=self._environment)
        assert done.code == 0, done.output
        return done.stdout

    def start(self, robot: Computer, *command: str) -> StartedCommand:
        """Start a command about a robot, and let it go on."""
        return self._project.start(*command, "--robot", robot.where, env=self._environment, apart=True)

    def run(self, robot: Computer | Proxy, *command: str) -> Result:
        """Run a command about a robot: in a new interpreter where WPILib has threads that would end a fork of it."""
        where = robot.where if isinstance(robot, Computer) else f"{robot.host}:{robot.port}"
        return self._project.run(*command, "--robot", where, env=self._environment, cold=not IS_ROBORIO)

    def deploy(self, robot: Computer | Proxy, *options: str) -> str:
        """Deploy, and return what that prints."""
        result = self.run(robot, "deploy", "--skip-tests", *options)
        assert result.code == 0, result.output
        return result.stdout
