"""What a season fixes, as one record."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Literal


@dataclass(frozen=True)
class MatchLengths:
    """The periods of a match, in seconds.

    :param autonomous: length of the autonomous period
    :param pause:      time between autonomous and teleoperated, in which the robot is disabled
    :param teleop:     length of the teleoperated period
    """

    autonomous: float
    pause: float
    teleop: float


#: What a part of the field is to a robot: it stops it, is driven over, is driven under, is flat; or it is only a line.
PartKind = Literal["solid", "ramp", "arch", "floor", "line"]


@dataclass(frozen=True)
class FieldPart:
    """A part of a season's field, seen from above.

    :param name:     what the game manual calls it; empty for a part of another one
    :param alliance: ``blue`` or ``red``; empty: neither
    :param points:   its corners in feet, with x to the right and y downwards
    """

    name: str
    kind: PartKind
    alliance: str
    points: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class SeasonField:
    """A season's field, drawn with x to the right and y downwards, and its rules for robots.

    :param w:              size along x, in feet
    :param h:              size along y, in feet
    :param px_per_ft:      scale of the drawing, in pixels per foot
    :param messages:       the game data that the field may send before autonomous
    :param auto_joysticks: whether the robot gets joystick data in autonomous
    :param parts:          its structures and lines, as far as they are known
    """

    w: float
    h: float
    px_per_ft: float = 15.0
    messages: tuple[str, ...] = ()
    auto_joysticks: bool = False
    parts: tuple[FieldPart, ...] = ()


@dataclass(frozen=True)
class ControllerSoftware:
    """The computer on the robot, as the season's tools prepare it. `deploy.targets` has the rest of it.

    :param name:           its product name
    :param images:         versions of its system image that the season's tools accept, the newest last
    :param python:         the version of Python that WPILib is built for there
    :param home:           home directory of the user that runs the robot program
    :param channels:       which channels it has, in a sentence for who asks for another one
    :param few:            what it has few of
    :param analog_volts:   what its analog inputs measure, from 0
    """

    name: str
    images: tuple[str, ...]
    python: tuple[int, int]
    home: str
    channels: str
    few: str
    analog_volts: float


@dataclass(frozen=True)
class Packages:
    """The Python packages of the season, from which new projects are made.

    :param wpilib:   the version of WPILib that new projects ask for; pyfrc runs with no older preview
    :param commands: requirement for the command-based library
    :param utilities: requirement for the library with `MagicRobot`
    :param drivers:  requirements for WPILib's motor controllers, where they are not in its own package
    """

    wpilib: str
    commands: str
    utilities: str
    drivers: tuple[str, ...] = ()


@dataclass(frozen=True)
class RobotDownloads:
    """What `pyfrc sync` downloads for the season's robots, and how the season's own tool does it.

    :param python:         the version of Python on the robots, of which this file is
    :param python_url:     the address of its file
    :param python_cache:   the directory in the season's cache where that file is kept
    :param index:          WPILib's own package index of the season, beside the usual one
    :param packages:       the package that needs all of WPILib, and has the optional components as extras
    :param abi:            the tag of wheels for that Python
    :param platforms:      the tags of wheels for the controller, the best first
    :param marker_machine: what markers of requirements call the controller (``platform_machine``)
    """

    python: str
    python_url: str
    python_cache: str
    index: str
    packages: str
    abi: str
    platforms: tuple[str, ...]
    marker_machine: str


@dataclass(frozen=True)
class Dashboards:
    """Where dashboards find in NetworkTables what robots show.

    :param tables:         the tables of what robot code shows
    :param choice:         the entry of a chooser that a dashboard writes
    :param robot_on_field: the target of input scripts that places the robot: x and y in metres, and an angle
    :param publishing:     the functions with which robot code shows objects
    :param in_radians:     whether this angle is in radians; otherwise in degrees
    """

    tables: tuple[str, ...]
    choice: str
    robot_on_field: str
    publishing: str
    in_radians: bool = False


@dataclass(frozen=True)
class GamepadOrder:
    """The numbers that the driver station gives the controls of a gamepad.

    :param axes:    the names of its axes, in their order
    :param buttons: the names of its buttons, in their order
    """

    axes: tuple[str, ...]
    buttons: tuple[str, ...]


@dataclass(frozen=True)
class Season:
    """What one season fixes.

    :param year:         the season's year, as in WPILib's version numbers
    :param kickoff:      when it begins; robot code's `time.time()` starts there
    :param cli_plugins:  group of the entry points by which the command `robotpy` finds commands
    :param opmodes:      whether robots can have opmodes
    :param first_button: the number that robot code gives the first button of a joystick
    :param window_drives: whether WPILib's own simulator window drives a robot whose time pyfrc steps
    :param test_mode:    what drivers read for the mode ``test``
    """

    year: int
    kickoff: datetime
    match: MatchLengths
    field: SeasonField
    controller: ControllerSoftware
    packages: Packages
    downloads: RobotDownloads
    dashboards: Dashboards
    gamepad: GamepadOrder
    cli_plugins: str
    opmodes: bool = False
    first_button: int = 1
    window_drives: bool = True
    test_mode: str = "Test"

    @property
    def requirement(self) -> str:
        """The requirement for its WPILib, as pip takes it. It names a preview where there is nothing else yet.

        pip installs a preview that is named, without ``--pre``, and then takes no previews of other packages.
        """
        return f"wpilib>={self.packages.wpilib},<{self.year + 1}"

    def requirement_of(self, package: str) -> str:
        """Return a package of WPILib's for the command line of pip.

        While there are only previews, pip would otherwise take last year's, and WPILib of last year with it.
        """
        if self.packages.wpilib.replace(".", "").isdecimal():
            return package
        return f'"{package}>={self.year}.0.0a1,<{self.year + 1}"'
