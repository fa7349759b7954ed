"""A log as what the page shows: a source whose time is over."""

from __future__ import annotations

from collections.abc import Callable

from ...project import Project
from ..engine.changes import ChangeCursor, ChangeFeed, ReportSignal
from ..engine.choosers import choosers_in
from ..engine.field import field_of
from ..engine.messages import MODE, POSE
from ..engine.output_log import OutputCursor, OutputLog
from ..engine.past_run import PastRun
from ..engine.scene import Point, Pose, Scene
from ..engine.snapshot import Snapshot, Status
from ..engine.source import Abilities
from ..engine.value_history import MISSING
from .align import moment_of
from .open import OpenedLog

#: The most points of the robot's path.
_MOST_POINTS = 4000
#: How long after the enabling code may set its place, in seconds.
_SETTLED = 0.1


class LogSource:
    """A log, with others as its branches.

    :param project: whose layout, field and names are used
    :param what_if: starts a simulation of the project's robot that this log drives, and returns its page's address, as
        `WhatIf.start` does
    :raises SettingsError: when ``sim/config.json`` is invalid
    """

    wants_to_run = False

    def __init__(
        self,
        project: Project,
        log: OpenedLog,
        branches: tuple[PastRun, ...] = (),
        what_if: Callable[[], str] | None = None,
    ) -> None:
        self.log = log
        self.abilities, self.what_if = Abilities("log", over=True, replays=what_if is not None), what_if
        self.project, self.recorded, self.branches = project, log.run, branches
        self.title, self.when = log.run.name, log.when
        self.field = field_of(project, "blue")  # as robot code has written them
        self.reports = ReportSignal()
        self.status = Status(state="paused", length=log.run.end, starts=1)
        self.snapshot: Snapshot | None = self._snapshot(log.run)

    def _snapshot(self, run: PastRun) -> Snapshot:
        network = run.histories["network"]
        pose = network.now.get(POSE, MISSING)
        return Snapshot(
            time=run.end,
            mode=str(network.now.get(MODE, "disabled")),
            scene=Scene(self.field, None if pose is MISSING else Pose(*pose), _trail(run)),
            values=run.histories["hal"].now,
            choosers=tuple(choosers_in(network.now)),
        )

    def output_cursor(self) -> OutputCursor:
        """Return a reader of nothing: what was printed is in `recorded`."""
        return OutputLog().cursor()

    def change_cursor(self) -> ChangeCursor:
        """Return a reader of nothing: all changes are in `recorded`."""
        return ChangeFeed().cursor()

    def network_cursor(self) -> ChangeCursor:
        """Return a reader of nothing, likewise."""
        return ChangeFeed().cursor()

    def attach(self) -> None:
        """Nothing can be done to a log."""

    def start(self) -> None:
        """Do nothing, but say so."""
        with self.reports:
            self.reports.notify_all()

    def close(self) -> None:
        """Do nothing."""


def _trail(run: PastRun) -> tuple[Point, ...]:
    """Return the robot's path from its first enabling on: before that, code sets the place where it stands."""
    network = run.histories["network"]
    _, poses = network.changes(POSE, (moment_of(network, "enabled") or 0.0) + _SETTLED)
    every = max(len(poses) // _MOST_POINTS, 1)
    return tuple((pose[0], pose[1]) for pose in poses[::every] if pose is not MISSING)
