"""The names that robot code gives its methods, for what reads robot code. It imports no WPILib."""

from __future__ import annotations

import re

from ..opmodes import DECORATORS

#: The libraries whose classes robot classes derive from.
LIBRARIES = ("wpilib", "commands2", "magicbot")

#: What runs a robot from its start to its end; robots with a loop of their own override it.
MAIN = "start_competition"
#: What a robot does first, once. In 2027, `TimedRobot` has no other method for it.
INITIALIZATION = "__init__"

_MODES = ("robot", "disabled", "autonomous", "teleop", "utility", "simulation", "none")

#: The methods that WPILib's loop calls, by the mode.
OF_MODES = frozenset(f"{mode}_{when}" for mode in _MODES for when in ("init", "periodic", "exit"))

#: Of these, the ones that are called in a simulation only.
OF_SIMULATION = frozenset({"simulation_init", "simulation_periodic"})

#: The methods that a class without the right base class has, if it was meant to be a robot.
OF_A_ROBOT = frozenset({"teleop_init", "teleop_periodic", "autonomous_init", "autonomous_periodic"})

#: The methods that run a robot's loop, and end it.
OF_A_LOOP = frozenset({MAIN, "end_competition"})
#: Other methods of a robot that libraries call.
_OF_ALL_ROBOTS = frozenset({*OF_A_LOOP, "driver_station_connected", "create_objects", "robot_init", "on_exception"})
#: The method of a command that says whether it is finished.
END_CONDITION = "is_finished"
#: The methods of commands, subsystems and magicbot's components that libraries call.
OF_A_COMMAND = frozenset({"initialize", "execute", "end", END_CONDITION})
#: The methods of an opmode.
OF_AN_OPMODE = frozenset({"disabled_periodic", "start", "periodic", "end"})
OF_A_SUBSYSTEM = frozenset({"periodic", "simulation_periodic"})
OF_A_COMPONENT = frozenset({"execute", "on_enable", "on_disable"})

#: What the loop of a plain `RobotBase` has to call in each turn, to take in what the driver station sends.
REFRESH = "wpilib.DriverStationBackend.refresh_data()"

#: All methods that robot code overrides, besides those of the modes.
OVERRIDDEN = _OF_ALL_ROBOTS | OF_A_COMMAND | OF_AN_OPMODE | {"runs_when_disabled", "get_interruption_behavior"}

#: What lets drivers choose on a dashboard.
CHOICES = "tunables.Selectable"

#: The tables of NetworkTables whose entries are settings, and those that only WPILib itself writes.
SETTINGS = ("/Tunables/", "/Preferences/")
WRITTEN_BY_WPILIB = ("/DriverStation/", "/Robot/", "/Telemetry/")
#: The file of a library that reads entries on behalf of robot code: magicbot's tunables.
TUNABLES_FILE = "magic_tunable.py"

#: Words that are written for a mode's name: those of other seasons, and abbreviations.
SYNONYMS = (
    (re.compile("^auto(n|nomus|nomos)?(?=init|periodic|exit)"), "autonomous"),
    (re.compile("^(teleoperated|tele)(?=init|periodic|exit)"), "teleop"),
    (re.compile("^(disable)(?=init|periodic|exit)"), "disabled"),
    (re.compile("^(test)(?=init|periodic|exit)"), "utility"),
)

#: What another season's spelling of a name has, and whose it is.
OTHER_SPELLING = re.compile("[A-Z]"), "camelCase names are those of WPILib 2026"
_INSTEAD = {"init": "start", "periodic": "periodic", "exit": "end"}
#: The methods that are not called in classes derived from one of this name, in lower case, and where their lines go.
NOT_CALLED = {
    "RobotBase": {"robotinit": "__init__, after super().__init__()"},
    "OpMode": {mode + when: name for mode in DECORATORS for when, name in _INSTEAD.items()},
    "OpModeRobotBase": {
        mode + when: f"{name} of an opmode, a class with @wpilib.{mode}"
        for mode in DECORATORS
        for when, name in _INSTEAD.items()
    },
}
