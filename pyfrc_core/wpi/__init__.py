"""WPILib, in our own few verbs: the one room that is written again for each season.

In: what other rooms want of a robot's library, in robot terms (seconds, microseconds from 0, metres, radians). Out: a
topic, such as `robots` or `geometry`, of the season whose WPILib is installed::

    from ..wpi import robots

    if robots.is_timed(robot): ...

`season_2026` has a module for each topic, in that season's spelling. Another season is a package beside it, with
modules and functions of the same names; nothing else changes. So a function says what pyfrc wants, and is not WPILib's
name in another spelling: where a caller would need ten of WPILib's calls in a row, the whole step is the function.
What needs no WPILib, and is the same in each season, stands once beside the packages, such as `motor_calls`.

Only this room, `hal` (the table of devices) and `runtime.patches` (the names that are replaced) import WPILib. A topic
is imported when it is asked for: importing this package imports no WPILib.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import TYPE_CHECKING

from ..season import CURRENT

if TYPE_CHECKING:
    from .season_2026 import callbacks as callbacks
    from .season_2026 import commands as commands
    from .season_2026 import connection as connection
    from .season_2026 import dashboards as dashboards
    from .season_2026 import devices as devices
    from .season_2026 import encoders as encoders
    from .season_2026 import fields as fields
    from .season_2026 import geometry as geometry
    from .season_2026 import joysticks as joysticks
    from .season_2026 import logs as logs
    from .season_2026 import motor_controllers as motor_controllers
    from .season_2026 import motors as motors
    from .season_2026 import names as names
    from .season_2026 import network as network
    from .season_2026 import network_client as network_client
    from .season_2026 import network_reads as network_reads
    from .season_2026 import network_writes as network_writes
    from .season_2026 import reports as reports
    from .season_2026 import robots as robots
    from .season_2026 import sim_devices as sim_devices
    from .season_2026 import source as source
    from .season_2026 import sparks as sparks
    from .season_2026 import station as station
    from .season_2026 import timing as timing
    from .season_2026 import watchdogs as watchdogs
else:

    def __getattr__(name: str) -> ModuleType:
        topic = f"{__name__}.season_{CURRENT.year}.{name}"
        if name.startswith("_") or find_spec(topic) is None:
            raise AttributeError(f"module {__name__!r} has no topic {name!r}")
        return import_module(topic)
