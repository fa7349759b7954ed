"""The robots of tests in the spelling of the season that is installed.

Tests spell robots as season 2026 does. Season 2027 has the same names in snake_case, constants in capitals, and a few
names of its own: `spelled` writes a robot's file so, line by line. What a season has in another form, and not only
under another name, is tested in a directory of the season's own, such as ``season_2027``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from pyfrc_core.season import CURRENT

#: Names in camelCase that are not WPILib's, in robots and their tests.
_OTHERS = {
    "assertEqual",
    "basicConfig",
    "fieldObjects",
    "navX",
    "roboRIO",
    "robotCommand",
    "setUp",
    "setUpClass",
    "tearDown",
}

_CAMEL = re.compile(r"\b_?[a-z][a-z0-9]*(?:[A-Z]+[a-z0-9]*)+\b")
_CONSTANT = re.compile(r"(?<=\.)k([A-Z][A-Za-z0-9]*)\b")
_HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")

_PWM_MOTORS = r"(?:PWM(?:SparkFlex|SparkMax|TalonFX|TalonSRX|Venom|VictorSPX)|Spark|Talon|VictorSP)"
_MOTOR_NAMES = re.compile(rf"^\s*([\w., ]+?)\s*(?:=.*\b{_PWM_MOTORS}\(|: wpilib\.{_PWM_MOTORS}$)", re.MULTILINE)

#: Sample robots with more than names in another form: `pyfrc migrate` writes them, in `season_2027`.
IN_ANOTHER_FORM = {"pneumatics", "square", "timed"}

#: What is more than the same name in snake_case, before names are written so. The constructor is `robotInit`.
_OTHER_NAMES = [
    (re.compile(r"^( *)def robotInit\(self\)(.*)$", re.MULTILINE), r"\1def __init__(self)\2\n\1    super().__init__()"),
    (re.compile(r"^ *self\.robotInit\(\)\n", re.MULTILINE), ""),
    (re.compile(r"\bPWMSim\b"), "PWMMotorControllerSim"),
    (re.compile(r"\bgetSpeed\b"), "getThrottle"),
    (re.compile(r"\bDriverStation\.(?=refreshData|getStick|isJoystick|getJoystick)"), "DriverStationBackend."),
    (re.compile(r"\b_simulation(Init|Periodic)\b"), r"simulation\1"),
    (re.compile(r"\btest(Init|Periodic|Exit)\b"), r"utility\1"),
    (re.compile(rf"\bwpilib\.(?={_PWM_MOTORS}\b)"), "wpilib_drivers."),
    (re.compile(r"^( *)import wpilib$", re.MULTILINE), r"\1import wpilib, wpilib_drivers"),
    (re.compile(r"\bwpimath\.(?:geometry|kinematics|controller|filter|system\.plant)\b"), "wpimath"),
    (re.compile(r"\bwpilib\.(?:drive|event|interfaces)\b"), "wpilib"),
    # Robot time 0 is at a multiple of 10 ** 6 s of the HAL's.
    (re.compile(r"\b(?:wpilib\.)?Timer\.getFPGATimestamp\(\)"), "(wpilib.Timer.get_timestamp() % 1e6)"),
    (re.compile(r"\bgetFPGATime\b"), "getTime"),
    (re.compile(r"\bDriverStation(?=\.is[A-Z])"), "RobotState"),
    (re.compile(r"\bDriverStation(?=\.get(?:Alliance|Match\w*|Event\w*|Location|Replay\w*)\b)"), "MatchState"),
    (re.compile(r"\bwpilib\.DriverStation\.getGameSpecificMessage\(\)"), '(wpilib.MatchState.getGameData() or "")'),
    (re.compile(r"\bDriverStation\.Alliance\b"), "Alliance"),
    (re.compile(r"\bcreateEvent\b"), "makeEvent"),
    (re.compile(r"\bPneumaticsModuleType\.(CTRE|REV)(PCM|PH)\b"), r"PneumaticsModuleType.\1_\2"),
]  # fmt: skip


def _snake(found: re.Match[str]) -> str:
    name = found[0]
    return name if name in _OTHERS else _HUMP.sub("_", name).lower()


def motors_of(texts: Iterable[str]) -> frozenset[str]:
    """Return the names that these files give to PWM motors, whose `set` and `get` have other names in 2027."""
    lines = [names for text in texts for names in _MOTOR_NAMES.findall(text)]
    return frozenset(name.strip().rpartition(".")[2] for names in lines for name in names.split(","))


def spelled(text: str, motors: frozenset[str] = frozenset()) -> str:
    """Return Python code, or a part of it, in the installed season's spelling."""
    if CURRENT.year < 2027:
        return text
    for name in motors | {"motor"}:
        text = re.sub(rf"\b{name}(\[[^]]*\])?\.(set|get)\(", rf"{name}\1.\2_throttle(", text)
    for pattern, replacement in _OTHER_NAMES:
        text = pattern.sub(replacement, text)
    text = _CONSTANT.sub(lambda found: _HUMP.sub("_", found[1]).upper(), text)
    return _CAMEL.sub(_snake, text)


def spell_copy(project: Path) -> None:
    """Write the files of a copied robot in the installed season's spelling, and let the robot be of that season."""
    if CURRENT.year < 2027:
        return
    files = {file: file.read_text("utf-8") for file in project.rglob("*.py")}
    motors = motors_of(files.values())
    for file, text in files.items():
        file.write_text(spelled(text, motors), "utf-8")
    settings = project / "pyproject.toml"
    if settings.exists():
        text = re.sub(r'(?m)^robotpy_version = ".*"\n', "", settings.read_text("utf-8"))
        settings.write_text(re.sub(r"==2026[\w.]*", "", text), "utf-8")
