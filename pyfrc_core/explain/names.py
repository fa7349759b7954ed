"""Names that a library no longer has, or that are misspelt."""

from __future__ import annotations

import builtins
import re
import sys
from difflib import get_close_matches
from importlib.util import find_spec

from ..project.hidden_libraries import LIBRARIES
from ..project.robot_files import RobotFiles
from .explanation import Explanation
from .other_season import in_2027
from .places import imported_name, place_of_assignment, users_frame


def _spark(setting: str) -> str:
    """Return how a motor controller of REV is set up: all settings at once."""
    once = "MOTOR.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)"
    return f"config = rev.SparkMaxConfig(); config.{setting}; and once, with all settings: {once}"


#: Names of other languages: what Python calls them.
_ELSEWHERE = {"true": "True", "false": "False", "null": "None", "nil": "None", "NULL": "None", "this": "self"}

#: Names of earlier seasons: what to write instead.
GONE = {
    # wpilib
    "IterativeRobot": "wpilib.TimedRobot",
    "SampleRobot": "wpilib.TimedRobot",
    "RobotDrive": "wpilib.drive.DifferentialDrive",
    "SpeedController": "wpilib.interfaces.MotorController",
    "SpeedControllerGroup": "wpilib.MotorControllerGroup",
    "Victor": "wpilib.PWMVictorSPX",
    "Jaguar": "wpilib.PWMSparkMax",
    "PWMSpark": "wpilib.Spark",
    "PWMVictorSP": "wpilib.VictorSP",
    "PWMTalon": "wpilib.PWMTalonSRX",
    "PIDController": "wpimath.controller.PIDController",
    "PowerDistributionPanel": "wpilib.PowerDistribution",
    "GearTooth": "wpilib.Counter",
    "Shuffleboard": "wpilib.SmartDashboard",
    "Filesystem": "wpilib.getDeployDirectory() and wpilib.getOperatingDirectory()",
    "command": "the package commands2",
    "Hand": "getLeftX(), getRightX(), getLeftY() and getRightY()",
    "getX": "getLeftX() or getRightX()",
    "getY": "getLeftY() or getRightY()",
    "hasPeriodPassed": "hasElapsed(seconds), or advanceIfElapsed(seconds) for something that repeats",
    "getInstance": "the methods of the class itself, such as wpilib.DriverStation.isEnabled()",
    "addDefault": "setDefaultOption",
    "addObject": "addOption",
    "setSpeed": "set",
    "isOperatorControl": "isTeleop",
    "getBumper": "getLeftBumper and getRightBumper",
    "getTriggerAxis": "getLeftTriggerAxis and getRightTriggerAxis",
    "getStickButton": "getLeftStickButton and getRightStickButton",
    "isSysBrownedOut": "isBrownedOut",
    "putInt": "putNumber",
    "putDouble": "putNumber",
    "getDouble": "getNumber",
    # commands2
    "CommandBase": "commands2.Command",
    "SubsystemBase": "commands2.Subsystem",
    "Scheduler": "commands2.CommandScheduler",
    "whenPressed": "onTrue",
    "whenActive": "onTrue",
    "whenReleased": "onFalse",
    "whenInactive": "onFalse",
    "whenHeld": "whileTrue",
    "whileActiveOnce": "whileTrue",
    "whileHeld": "whileTrue(command.repeatedly())",
    "whileActiveContinous": "whileTrue(command.repeatedly())",
    "whileActiveContinuous": "whileTrue(command.repeatedly())",
    "toggleWhenPressed": "toggleOnTrue",
    "toggleWhenActive": "toggleOnTrue",
    "requires": "addRequirements",
    "PerpetualCommand": "commands2.RepeatCommand",
    "perpetually": "repeatedly",
    "withInterrupt": "until",
    "MecanumControllerCommand": "commands2.SwerveControllerCommand or a command of your own",
    # vendors
    "CANSparkMax": "rev.SparkMax",
    "CANSparkMaxLowLevel": "rev.SparkLowLevel",
    "CANSparkFlex": "rev.SparkFlex",
    "CANEncoder": "rev.RelativeEncoder",
    "CANPIDController": "rev.SparkClosedLoopController",
    "SparkMaxPIDController": "rev.SparkClosedLoopController",
    "SparkPIDController": "rev.SparkClosedLoopController",
    "getPIDController": "getClosedLoopController",
    "setSmartCurrentLimit": _spark("smartCurrentLimit(40)"),
    "setIdleMode": _spark("setIdleMode(rev.SparkMaxConfig.IdleMode.kBrake)"),
    "restoreFactoryDefaults": _spark("inverted(False)"),
    "burnFlash": _spark("inverted(False)"),
    "AHRS_SPI": "navx.AHRS.create_spi()",
    "WPI_TalonFX": "phoenix6.hardware.TalonFX",
    "NetworkTables": "ntcore.NetworkTableInstance.getDefault()",
}

#: The libraries whose names may be in the table.
_KNOWN = (
    *("wpilib", "wpilib_drivers", "commands2", "rev", "phoenix6", "phoenix5", "navx", "ntcore", "wpimath", "magicbot"),
    *("hal", "telemetry", "tunables"),
)


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    if isinstance(error, AttributeError) and error.name:
        return _attribute(error, error.name, files)
    if isinstance(error, ImportError) and error.name and (wanted := imported_name(error)):
        return _import(wanted, error.name)
    if isinstance(error, UnboundLocalError):
        return _unbound(error, files)
    if isinstance(error, NameError) and error.name:
        if error.name in _ELSEWHERE:
            return Explanation(remedy=f"Did you mean {_ELSEWHERE[error.name]}?")
        frame = users_frame(error, files)
        known = [*frame[0].f_locals, *frame[0].f_globals, *dir(builtins), *LIBRARIES] if frame else []
        if close := get_close_matches(error.name, known, n=1, cutoff=0.75):
            return Explanation(remedy=f"Did you mean {close[0]}?")
        if frame and error.name in dir(frame[0].f_locals.get("self")):
            return Explanation(remedy=f"Did you mean self.{error.name}?")
        return Explanation(remedy=f"Nothing has given {error.name} a value: is it misspelt, or is an import missing?")
    return None


def _unbound(error: UnboundLocalError, files: RobotFiles) -> Explanation | None:
    found, frame = re.search(r"variable '(\w+)'", str(error)), users_frame(error, files)
    if found is None or frame is None:
        return None
    name = found[1]
    if name in frame[0].f_globals:
        return Explanation(
            remedy=f"Keep the value in the robot, as self.{name}; or write first in the function: global {name}"
        )
    return Explanation(remedy=f"Not every way through the function sets {name}: give it a value at the beginning.")


def _attribute(error: AttributeError, name: str, files: RobotFiles) -> Explanation | None:
    obj = error.obj
    owner = obj if isinstance(obj, type) else type(obj)
    module = getattr(obj, "__name__", "") if owner.__module__ == "builtins" else owner.__module__
    is_library = module.partition(".")[0] in _KNOWN or any(
        base.__module__.partition(".")[0] in _KNOWN for base in owner.__mro__
    )
    if is_library and name in GONE:
        what = module if owner.__module__ == "builtins" else owner.__name__
        return Explanation(f"{what} has no {name} any more", f"Instead: {in_2027(GONE[name])}.")
    if module in _KNOWN and owner.__module__ == "builtins" and find_spec(f"{module}.{name}") is not None:
        return Explanation(remedy=f"Is this line missing at the top: import {module}.{name}")
    meant = _nearest(name, [each for each in dir(obj) if not each.startswith("__")])
    if meant:
        return Explanation(remedy=f"Did you mean {meant}?")
    if owner.__module__.partition(".")[0] not in ("builtins", *_KNOWN) and not isinstance(obj, type):
        place, target = place_of_assignment(owner, files, name)
        if target == name:
            return Explanation(
                remedy=f"Write self.{name} = ... in {place}: without self, the name is known there only."
            )
        if place:
            return Explanation(remedy=f"{place} sets {name}, but has not run yet: move it to __init__ or robotInit.")
        return Explanation(remedy=f"Nothing has set {name}: is the line missing, or is the name misspelt?")
    return None


def _import(name: str, module: str) -> Explanation:
    if module.partition(".")[0] in _KNOWN and name in GONE:
        return Explanation(f"{module} has no {name} any more", f"Instead: {in_2027(GONE[name])}.")
    known = [each for each in dir(sys.modules.get(module)) if not each.startswith("_")]
    meant = _nearest(name, known)
    return Explanation(f"{module} has no {name}", f"Did you mean {meant}?" if meant else "Is the name right?")


def _nearest(name: str, known: list[str]) -> str:
    """Return a name that differs in case, or in a letter or two."""
    same = next((each for each in known if each.lower().replace("_", "") == name.lower().replace("_", "")), "")
    return same or next(iter(get_close_matches(name, known, n=1, cutoff=0.75)), "")
