"""Names of the other season: a robot of 2026 beside WPILib 2027, or one of 2027 beside WPILib 2026.

Names that only their spelling distinguishes are found by their letters: `getY` and `get_y`, `kRed` and `RED`. The
tables have what has moved to another module, and what is gone.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from pathlib import Path

from ..config.robotpy import load_season_settings
from ..errors import SettingsError
from ..project.robot_files import RobotFiles
from ..season import CURRENT, SEASONS
from ..season.spelling import snake_case
from .explanation import Explanation
from .places import imported_name

_TELEMETRY = "the modules telemetry (to show values) and tunables (to set them)"

#: Modules of 2026, and the module that has their names in 2027.
OF_WPIMATH = ("controller", "estimator", "filter", "geometry", "interpolation", "kinematics", "optimization", "path")
_MODULES_OF_2026 = {
    **dict.fromkeys(("wpilib.drive", "wpilib.event", "wpilib.interfaces"), "wpilib"),
    **{f"wpimath.{each}": "wpimath" for each in (*OF_WPIMATH, "spline", "system", "system.plant", "trajectory")},
    "wpimath.trajectory.constraint": "wpimath",
    "wpilib.shuffleboard": _TELEMETRY,
    "wpiutil.log": "wpilog",
}
_CONTROLLERS = (
    *("Koors40", "PWMSparkFlex", "PWMSparkMax", "PWMTalonFX", "PWMTalonSRX", "PWMVenom", "PWMVictorSPX", "Spark"),
    *("Talon", "VictorSP"),
)
_DASHBOARDS = ("LiveWindow", "NTSendable", "Sendable", "Shuffleboard", "SmartDashboard")
_IMUS = ("ADIS16448_IMU", "ADIS16470_IMU", "ADXRS450_Gyro", "AnalogGyro", "BuiltInAccelerometer")
#: Names of 2026 that another module has in 2027, or what replaces them.
_NAMES_OF_2026 = {
    **{name: f"wpilib_drivers.{name}" for name in _CONTROLLERS},
    **dict.fromkeys(_DASHBOARDS, _TELEMETRY),
    **{name: f"wpiutil.{name}" for name in ("Alert", "Color", "Color8Bit")},
    **{name: f"wpilog.{name}" for name in ("DataLogBackgroundWriter", "DataLogWriter")},
    **dict.fromkeys(_IMUS, "wpilib.OnboardIMU"),
    **dict.fromkeys(("AnalogTrigger", "AnalogTriggerOutput"), "wpilib.AnalogInput and a comparison"),
    **dict.fromkeys(("AsynchronousInterrupt", "SynchronousInterrupt"), "wpilib.EdgeCounter, or a look in each turn"),
    "DigitalGlitchFilter": "wpimath.Debouncer",
    "Relay": "wpilib_drivers.PWMSparkMax or a wpilib.DigitalOutput and a driver (SystemCore has no relay ports)",
    "SPI": "wpilib.I2C, or a sensor on CAN or USB (SystemCore has no SPI)",
    "getTime": "wpilib.Timer.get_timestamp()",
    "run": "the class alone, without this line (pyfrc sim, or python -m robotpy sim, starts it)",
    "Counter": "wpilib.EdgeCounter or wpilib.Tachometer",
    "PS4Controller": "wpilib.DualShock4Controller or wpilib.NiDsPS4Controller",
    "PS5Controller": "wpilib.DualSenseController or wpilib.NiDsPS5Controller",
    "SendableChooser": "tunables.Selectable",
    "Servo": "wpilib.ExpansionHubServo",
}
#: Methods of 2026, and of those who remember them halfway: what they are called where a class of 2027 has that.
_METHODS_OF_2026 = {
    **dict.fromkeys(("set", "setSpeed", "set_speed"), "set_throttle"),
    "get": "get_throttle",
    "stop": "stop_motor",
    **dict.fromkeys(("isTest", "is_test"), "is_utility"),
    **dict.fromkeys(("isTestEnabled", "is_test_enabled"), "is_utility_enabled"),
    **dict.fromkeys(("getFPGATimestamp", "get_fpga_timestamp"), "get_monotonic_timestamp"),
}
#: The classes among which 2027 has divided what `DriverStation` had.
_OF_DRIVER_STATION = ("RobotState", "MatchState", "DriverStationBackend")
#: Modules and names that 2027 has, and 2026 has not.
_MODULES_OF_2027 = frozenset({"telemetry", "tunables", "wpilib_drivers", "wpilog"})
_OPMODES = ("OpMode", "OpModeRobot", "OpModeRobotBase", "PeriodicOpMode", "autonomous", "teleop", "utility")
_NAMES_OF_2027 = frozenset(
    {
        *("CANPort", "DriverStationBackend", "EdgeCounter", "ExpansionHub", "Gamepad", "MatchState", "OnboardIMU"),
        *("Tachometer", *_OPMODES),
    }
)
_LIBRARIES = (
    "commands2",
    "hal",
    "magicbot",
    "ntcore",
    "rev",
    "robotpy_apriltag",
    "wpilib",
    "wpilib_drivers",
    "wpilog",
    "wpimath",
    "wpiutil",
)


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    if isinstance(error, ModuleNotFoundError):
        return _module(error.name or "", files)
    if isinstance(error, ImportError):
        return _of_module(imported_name(error), error.name or "", files)
    if isinstance(error, AttributeError) and error.name:
        owner = error.obj if isinstance(error.obj, type) else type(error.obj)
        if owner.__module__ == "builtins":
            return _of_module(error.name, str(getattr(error.obj, "__name__", "")), files)
        base = next((each for each in owner.__mro__ if _is_library(each.__module__)), None)
        if base is not None and (instead := _of_class(error.name, base)):
            return _explanation(2026, f"{owner.__name__} has no {error.name}", files, instead)
    return None


def _of_class(name: str, cls: type) -> str | None:
    """Return what replaces a name of a class of 2026."""
    if CURRENT.year < 2027:
        return None
    known = dir(cls)
    if instead := _respelled(name, known):
        return instead
    if (renamed := _METHODS_OF_2026.get(name)) in known:
        return renamed
    if cls.__name__ != "DriverStation":
        return None
    wpilib = sys.modules.get("wpilib")
    for successor in _OF_DRIVER_STATION:
        if instead := _of_class(name, getattr(wpilib, successor)):
            return f"wpilib.{successor}.{instead}"
    return f"wpilib.{name}" if name in dir(wpilib) else None


def in_2027(text: str) -> str:
    """Return a remedy that is written in 2026's names, in those of the installed WPILib."""
    if CURRENT.year < 2027:
        return text
    for module, successor in sorted(_MODULES_OF_2026.items(), reverse=True):
        text = text.replace(f"{module}.", f"{successor}.")
    return re.sub(r"\b[a-z]{2,}\d?(?:[A-Z][A-Za-z0-9]*)+\b", lambda found: snake_case(found[0]), text)


def _module(module: str, files: RobotFiles) -> Explanation | None:
    text = f"there is no module {module}"
    if CURRENT.year < 2027:
        return _explanation(2027, text, files) if module.partition(".")[0] in _MODULES_OF_2027 else None
    return _explanation(2026, text, files, _MODULES_OF_2026[module]) if module in _MODULES_OF_2026 else None


def _of_module(name: str, module: str, files: RobotFiles) -> Explanation | None:
    text = f"{module} has no {name}"
    if not _is_library(module):
        return None
    if CURRENT.year < 2027:
        return _explanation(2027, text, files) if name in _NAMES_OF_2027 else None
    if f"{module}.{name}" in _MODULES_OF_2026:
        return _module(f"{module}.{name}", files)
    instead = _NAMES_OF_2026.get(name) or _respelled(name, dir(sys.modules.get(module)))
    return _explanation(2026, text, files, instead) if instead else None


def _respelled(name: str, known: Iterable[str]) -> str | None:
    """Return the name of 2027 that has the same letters as one of 2026; of ``kRed``, those of ``RED``."""

    def letters(each: str) -> str:
        return re.sub(r"^k(?=[A-Z])", "", each).replace("_", "").lower()

    if CURRENT.year < 2027:
        return None
    return next((each for each in known if letters(each) == letters(name) and not each.startswith("_")), None)


def _is_library(module: str) -> bool:
    return module.partition(".")[0] in _LIBRARIES


def _explanation(year: int, text: str, files: RobotFiles, instead: str | None = None) -> Explanation:
    """Return the explanation of a name of another season.

    Where the project does not say its season, it may be the WPILib that is wrong: the remedy has both.

    :param instead: the name in this season
    """
    remedy = [f"Instead: {instead}."] if instead else []
    try:
        says = load_season_settings(Path(files.root) / "pyproject.toml")
    except (SettingsError, OSError):
        says = []  # reported where the settings are needed
    if not says or not instead:
        wanted = f'pip install "{SEASONS[year].requirement}"' if year in SEASONS else "install the pyfrc of that season"
        remedy.append(f"If the robot is for WPILib {year}: {wanted}")
    return Explanation(f"{text} in WPILib {CURRENT.year}", "\n  ".join(remedy))
