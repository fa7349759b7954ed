"""The page of `pyfrc profile --html`: pyinstrument samples the threads of the robot, and draws what it has seen.

It samples the thread that has started it, so each of the robot's threads has a profiler of its own. It is an optional
extra, since nothing else here needs it.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import reduce
from pathlib import Path
from typing import Any

from .._version import requirement
from ..errors import UsageError
from ..project.robot_files import RobotFiles, is_pyfrc
from ..text_files import write_whole


def require_pyinstrument() -> None:
    """Check that pyinstrument is installed, before the measurement begins.

    :raises UsageError: when it is not
    """
    if importlib.util.find_spec("pyinstrument") is None:
        raise UsageError(
            "the flame graph needs pyinstrument, which is not installed",
            remedy=f'Install it with: pip install "{requirement("profile")}"',
        )


class Samples:
    """The samples of this process, from all threads."""

    def __init__(self) -> None:
        self.sessions: list[Any] = []

    @contextmanager
    def sampling(self) -> Iterator[None]:
        """Sample this thread while the context lasts."""
        from pyinstrument import Profiler

        profiler = Profiler(async_mode="disabled")
        profiler.start()
        try:
            yield
        finally:
            self.sessions.append(profiler.stop())

    def save(self, file: Path) -> None:
        """Write the samples to a file, if there are any."""
        if self.sessions:
            _combined(self.sessions).save(file)


def write_flame_graph(files: Iterable[Path], robot: RobotFiles, page: Path, title: str) -> None:
    """Write the samples of all processes as a web page: from the robot's outermost function on, without pyfrc's own.

    :param files: what `Samples.save` has written
    :param title: the name of what was measured
    """
    from pyinstrument.renderers import HTMLRenderer
    from pyinstrument.session import Session

    session: Any = _combined([Session.load(file) for file in files])
    session.target_description = title
    session.start_call_stack = session.start_call_stack[:1]
    session.frame_records = [
        ([thread, *_from_the_robot_on(calls, robot)], seconds) for (thread, *calls), seconds in session.frame_records
    ]
    write_whole(page, [HTMLRenderer().render(session)])


def _from_the_robot_on(calls: Iterable[str], robot: RobotFiles) -> Iterator[str]:
    began = False
    for call in calls:
        file = call.split("\0")[1]
        began = began or robot.is_robot_code(file)
        if began and not is_pyfrc(file):
            yield call


def _combined(sessions: Iterable[Any]) -> Any:
    from pyinstrument.session import Session

    return reduce(Session.combine, sessions)
