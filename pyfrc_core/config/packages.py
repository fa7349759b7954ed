"""The package of each module that robots import, and the lines that install it here and on the robot."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import SettingsError
from ..season import CURRENT
from .robotpy import COMPONENTS, NUMBERED_BY_SEASON, load_robot_packages

if TYPE_CHECKING:
    from packaging.requirements import Requirement

#: The package of each module: its name for pip. Known also where it is not installed.
PACKAGES = {
    "choreo": "sleipnirgroup-choreolib",
    "commands2": "robotpy-commands-v2",
    "cscore": "robotpy-cscore",
    "cv2": "opencv-python",
    "hal": "robotpy-hal",
    "halsim_gui": "robotpy-halsim-gui",
    "hypothesis": "hypothesis",
    "libgrapplefrc": "libgrapplefrc-py",
    "magicbot": "robotpy-wpilib-utilities",
    "navx": "robotpy-navx",
    "ntcore": "pyntcore",
    "numpy": "numpy",
    "pathplannerlib": "robotpy-pathplannerlib",
    "phoenix5": "robotpy-ctre",
    "phoenix6": "phoenix6",
    "photonlibpy": "photonlibpy",
    "playingwithfusion": "robotpy-playingwithfusion",
    "pykit": "robotpy-pykit",
    "requests": "requests",
    "rev": "robotpy-rev",
    "robotpy_apriltag": "robotpy-apriltag",
    "robotpy_ext": "robotpy-wpilib-utilities",
    "robotpy_fields": "robotpy-fields",
    "romi": "robotpy-romi",
    "scipy": "scipy",
    "serial": "pyserial",
    "simple_pid": "simple-pid",
    "telemetry": "robotpy-telemetry",
    "tunables": "robotpy-tunables",
    "urcl": "robotpy-urcl",
    "usb": "pyusb",
    "wpilib": "wpilib",
    "wpilib_drivers": "wpilib-drivers",
    "wpilog": "robotpy-wpilog",
    "wpimath": "robotpy-wpimath",
    "wpinet": "robotpy-wpinet",
    "wpiutil": "robotpy-wpiutil",
    "xrp": "robotpy-xrp",
    "yaml": "PyYAML",
}

#: Modules of earlier seasons, or under a name that is often written: what to import instead, and how to write what has
#: changed more than its name.
SUCCESSORS = {
    "ctre": "from phoenix6.hardware import TalonFX, CANcoder, Pigeon2; or for a Talon SRX or Victor SPX: "
    "from phoenix5 import WPI_TalonSRX, WPI_VictorSPX",
    "grapplefrc": "libgrapplefrc",
    "networktables": 'import ntcore, and ntcore.NetworkTableInstance.getDefault().getTable("SmartDashboard")',
    "photonvision": "photonlibpy",
    "wpilib.command": "commands2",
    "wpilib.buttons": "commands2.button",
    "wpilib.geometry": "wpimath.geometry",
    "wpilib.kinematics": "wpimath.kinematics",
    "wpilib.controller": "wpimath.controller",
    "wpilib.trajectory": "wpimath.trajectory",
    "wpilib.estimator": "wpimath.estimator",
    "pathplanner": "pathplannerlib",
    "robotpy_apriltags": "robotpy_apriltag",
    "opencv": "cv2",
    "apriltag": "robotpy_apriltag",
    "commands": "commands2",
}

#: Packages that come with WPILib: a robot needs no line for them.
_WITH_WPILIB = frozenset(
    {
        "pyntcore",
        "robotpy-hal",
        "robotpy-telemetry",
        "robotpy-tunables",
        "robotpy-wpilog",
        "robotpy-wpimath",
        "robotpy-wpinet",
        "robotpy-wpiutil",
        "wpilib",
    }
)
#: Packages for this computer only.
_NOT_ON_ROBOT = frozenset({"hypothesis", "robotpy-halsim-gui", "robotpy-romi", "robotpy-xrp"})
#: OpenCV comes with `cscore` on a robot.
_BROUGHT_BY = {"opencv-python": "cscore"}


def quoted_requirement(needed: Requirement) -> str:
    """Return a requirement as every shell takes it.

    Without its marker, which has been evaluated, and has quotation marks of its own.
    """
    extras = f"[{','.join(sorted(needed.extras))}]" if needed.extras else ""
    return f'"{needed.name}{extras}{needed.specifier}"'


def install_line(package: str) -> str:
    """Return the command that installs a package on this computer."""
    needed = CURRENT.requirement_of(package) if package.startswith(NUMBERED_BY_SEASON) else package
    return f"python -m pip install {needed}"


def robot_line(package: str, pyproject: Path) -> str:
    """Return what to write into ``[tool.robotpy]`` for the robot to get a package; empty if it needs no line."""
    if package in _WITH_WPILIB or package in _NOT_ON_ROBOT:
        return ""
    try:
        wanted = load_robot_packages(pyproject)
    except (SettingsError, OSError):
        return ""  # reported where the settings are needed
    component = component_of(package)
    if package in {each.name for each in wanted.requires} or component in wanted.components:
        return ""
    key, entry = ("requires", package) if component is None else ("components", component)
    if key in wanted.lines:
        return f'for the robot, add "{entry}" to {key} in {wanted.lines[key]}'
    return f'for the robot, write {key} = ["{entry}"] under [tool.robotpy] in pyproject.toml'


def component_of(package: str) -> str | None:
    """Return the optional component of ``[tool.robotpy]`` that installs a package, if there is one."""
    if package in _BROUGHT_BY:
        return _BROUGHT_BY[package]
    return next((name for name, brought in COMPONENTS.items() if package in brought), None)


def how_to_install(package: str, pyproject: Path) -> str:
    """Return how to install a package here and on the robot, as one sentence."""
    line = robot_line(package, pyproject)
    return f"Install it: {install_line(package)}" + (f"\n  {line[:1].upper()}{line[1:]}." if line else "")
