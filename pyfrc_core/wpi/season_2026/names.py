"""The names that robot code gives its methods, for what reads robot code. It imports no WPILib."""

from __future__ import annotations

import re
from collections.abc import Mapping

#: The libraries whose classes robot classes derive from.
LIBRARIES = ("wpilib", "commands2", "magicbot")

#: What runs a robot from its start to its end; robots with a loop of their own override it.
MAIN = "startCompetition"
#: What a robot does first, once.
INITIALIZATION = "robotInit"

_MODES = ("robot", "disabled", "autonomous", "teleop", "test", "simulation", "_simulation")

#: The methods that WPILib's loop calls, by the mode.
OF_MODES = frozenset(f"{mode}{when}" for mode in _MODES for when in ("Init", "Periodic", "Exit"))

#: Of these, the ones that are called in a simulation only.
OF_SIMULATION = frozenset({"simulationInit", "simulationPeriodic", "_simulationInit", "_simulationPeriodic"})

#: The methods that a class without the right base class has, if it was meant to be a robot.
OF_A_ROBOT = frozenset({INITIALIZATION, "teleopInit", "teleopPeriodic", "autonomousInit", "autonomousPeriodic"})

#: The methods that run a robot's loop, and end it.
OF_A_LOOP = frozenset({MAIN, "endCompetition"})
#: Other methods of a robot that libraries call.
_OF_ALL_ROBOTS = frozenset({*OF_A_LOOP, "driverStationConnected", "createObjects", "onException"})
#: The method of a command that says whether it is finished.
END_CONDITION = "isFinished"
#: The methods of commands, subsystems and magicbot's components that libraries call.
OF_A_COMMAND = frozenset({"initialize", "execute", "end", END_CONDITION})
#: The methods of an opmode: there are none before 2027.
OF_AN_OPMODE: frozenset[str] = frozenset()
OF_A_SUBSYSTEM = frozenset({"periodic", "simulationPeriodic"})
OF_A_COMPONENT = frozenset({"execute", "on_enable", "on_disable"})

#: What the loop of a plain `RobotBase` has to call in each turn, to take in what the driver station sends.
REFRESH = "wpilib.DriverStation.refreshData()"

#: All methods that robot code overrides, besides those of the modes.
OVERRIDDEN = _OF_ALL_ROBOTS | OF_A_COMMAND | {"periodic", "runsWhenDisabled", "getInterruptionBehavior"}

#: What lets drivers choose on a dashboard.
CHOICES = "wpilib.SendableChooser or SmartDashboard"

#: The tables of NetworkTables whose entries are settings, and those that only WPILib itself writes.
SETTINGS = ("/SmartDashboard/", "/Shuffleboard/", "/Preferences/")
WRITTEN_BY_WPILIB = ("/FMSInfo/", "/LiveWindow/")
#: The file of a library that reads entries on behalf of robot code: magicbot's tunables.
TUNABLES_FILE = "magic_tunable.py"

#: Words that are written for a mode's name: those of other seasons, and abbreviations.
SYNONYMS = (
    (re.compile("^auto(n|nomus|nomos)?(?=init|periodic|exit)"), "autonomous"),
    (re.compile("^(teleoperated|tele)(?=init|periodic|exit)"), "teleop"),
    (re.compile("^(disable)(?=init|periodic|exit)"), "disabled"),
    (re.compile("^(utility)(?=init|periodic|exit)"), "test"),
)

#: What another season's spelling of a name has, and whose it is.
OTHER_SPELLING = re.compile("(?<=[^_])_(?=[^_])"), "snake_case names are those of WPILib 2027"
#: The methods that are not called in classes derived from one of this name, in lower case, and where their lines go.
NOT_CALLED: Mapping[str, Mapping[str, str]] = {}
