"""What a front end such as the page reads of whatever produces values: a simulation, a log, a robot on the network.

`Simulation` is a source. To make another one, write a class with the attributes and methods of `Source`:

- `abilities` says what can be done to it. The page hides the driver station, the joysticks and going back where there
  is nothing to drive, and plays what is over.
- What changes goes through two `changes.ChangeFeed`s, one for `hal_data` and one for NetworkTables:
  ``feed.add(RunBegan(1, 0.0, {}))``, then ``feed.add(Change(time, {path: value}, gone))`` in the order of time. Paths
  are as in `Snapshot.values`; those of NetworkTables begin with `messages.VALUE`, ``nt:/SmartDashboard/kP``, and
  `messages.TYPE` with the same name is the topic's type. Structs come as their parts (`structs.Structs`).
  `messages.MODE` and `messages.POSE` are the mode, which colours the timeline, and the robot's place.
- What is known at once, as all of a log is, is a `PastRun`, in `recorded`. Others, shown beside it, are in `branches`.
- `snapshot` and `status` are replaced, never changed; `reports.notify_all()`, with `reports` held, wakes front ends.
- `attach` returns who may write: an object with `write` and `leave`, or None. A `Driver` can do more.

`WebFrontEnd(...).run(source)` shows it, and `recorded_page` makes one file of it.
`tests/test_sim_source.py` has a small source.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Literal, Protocol

from ...project import Project
from .changes import ChangeCursor, ReportSignal
from .output_log import OutputCursor
from .past_run import PastRun
from .scene import Field
from .snapshot import Snapshot, Status


@dataclass(frozen=True)
class Abilities:
    """What a source is, and what can be done to it.

    :param kind: what it is, for the words of a front end
    :param drives: whether it has a driver station, joysticks and devices that can be set, and time that can be stopped
    :param rewinds: whether it can go back in time, and go on from there
    :param writes: whether values of NetworkTables can be set
    :param over: whether its time is over
    :param replays: whether a simulation can be started with its inputs
    """

    kind: Literal["simulation", "log", "robot"] = "simulation"
    drives: bool = False
    rewinds: bool = False
    writes: bool = False
    over: bool = False
    replays: bool = False


class Writer(Protocol):
    """What one person may do to a source."""

    def write(self, values: Mapping[str, object]) -> None:
        """Write values by target, such as ``nt:/SmartDashboard/kP``."""

    def leave(self) -> None:
        """End; what is held is released."""


class Source(Protocol):
    """See the module's docstring. All of it may be used from any thread."""

    @property
    def abilities(self) -> Abilities: ...

    @property
    def title(self) -> str:
        """What is shown, such as ``pyfrc sim``, or the name of a log's file."""

    @property
    def when(self) -> datetime | None:
        """When it happened, if that is known and it is over."""

    @property
    def project(self) -> Project:
        """The project whose layout, field and names are used; its robot need not exist."""

    @property
    def field(self) -> Field: ...

    @property
    def reports(self) -> ReportSignal:
        """Notified of everything that a front end may show."""

    @property
    def snapshot(self) -> Snapshot | None:
        """The newest state; None before the first."""

    @property
    def status(self) -> Status: ...

    @property
    def wants_to_run(self) -> bool:
        """Whether its time is to go on."""

    @property
    def recorded(self) -> PastRun | None:
        """What is known before anything is read by cursors."""

    @property
    def branches(self) -> tuple[PastRun, ...]:
        """Other runs that are shown beside it; there may be more of them later."""

    def output_cursor(self) -> OutputCursor:
        """Return a reader of what the robot prints."""

    def change_cursor(self) -> ChangeCursor:
        """Return a reader of all changes of `hal_data`."""

    def network_cursor(self) -> ChangeCursor:
        """Return a reader of all changes of NetworkTables, of the mode and of the robot's place."""

    def attach(self) -> Writer | None:
        """Return what one person may do to it, who leaves later; None: only look."""

    def start(self) -> None:
        """Begin."""

    def close(self) -> None:
        """End, whatever it is doing."""


class SimulationSource:
    """What `Simulation` says of itself as a source; the rest of it, it has anyway."""

    abilities = Abilities("simulation", drives=True, rewinds=True, writes=True)
    title = "pyfrc sim"
    when: datetime | None = None
    recorded: PastRun | None = None
    branches: tuple[PastRun, ...] = ()
