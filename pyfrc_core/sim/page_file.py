"""`--page`: a whole run as one HTML file, whatever shows the simulation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import UsageError
from ..project import Project
from ..runtime.robot_time import PACKET_US
from ..runtime.scripts.inputs_file import load_inputs
from ..text_files import write_whole
from .engine.options import SimOptions
from .engine.simulation import Simulation
from .engine.snapshot import Failure
from .engine.source import Source
from .ui.headless import Headless

if TYPE_CHECKING:
    from ..fuzz.campaign.results import FuzzFinding
    from ..replay import ReplayResult
    from ..runtime.scripts.script import InputScript
    from .ui import FrontEnd
    from .ui.web.collector import Collector
    from .ui.web.front_end import WebFrontEnd


class PageFile:
    """The page of one source; a simulation reports NetworkTables and is recorded.

    :param file: where to write it
    :param what: what was run, for the reader of the page
    """

    def __init__(self, file: Path, what: str) -> None:
        self.file, self._what = file, what
        self._collector: Collector | None = None
        self._front_end: WebFrontEnd | None = None

    def follow(self, source: Source, front_end: FrontEnd | None = None) -> None:
        """Begin to collect what the page will show.

        :param front_end: the one that collects it for itself, too
        """
        from .ui.web.collector import Collector

        if front_end is not None:
            from .ui.web.front_end import WebFrontEnd

            assert isinstance(front_end, WebFrontEnd)
            self._front_end = front_end
        else:
            self._collector = Collector(source, lambda: None)
            self._collector.start()

    def write(self, source: Source, failure: Failure | None = None) -> bool:
        """Write the page of a source that is closed, and return whether there was anything to write.

        :param failure: the failure, if it is none that the simulation knows
        :raises UsageError: when the file cannot be written
        """
        from .ui.web.recorded_page import recorded_page

        collector = self._collector if self._front_end is None else self._front_end.collector
        if collector is None or (source.snapshot is None and source.status.failure is None):
            return False
        collector.close()
        try:
            write_whole(self.file, [recorded_page(source, collector, self._what, failure)])
        except OSError as error:
            raise UsageError(f"--page {self.file} cannot be written: {error.strerror}") from None
        return True


def write_replay_page(project: Project, file: Path, page: Path, result: ReplayResult) -> None:
    """Run the robot with a script once more, up to where a replay ended, and write the page of that run.

    :raises UsageError: when the page cannot be written
    """
    failure = None if result.failure is None else Failure(str(result.failure), "", result.seconds)
    _write_page(
        project, load_inputs(file), PageFile(page, f"pyfrc replay {place_in(project, file)}"), result.seconds, failure
    )


def write_finding_page(project: Project, found: FuzzFinding, page: Path) -> None:
    """Run the robot with the script of a failure once more, and write the page of that run.

    :raises UsageError: when the page cannot be written
    """
    script = found.entry.script
    end = script.end_us / 1_000_000
    failed_at = (script.end_us - PACKET_US) / 1_000_000  # scripts of failures end with the packet after it
    what = f"pyfrc fuzz: {place_in(project, found.entry.file)}"
    _write_page(project, script, PageFile(page, what), end, Failure(found.failure.text, "", failed_at))


def _write_page(project: Project, script: InputScript, page: PageFile, end: float, failure: Failure | None) -> None:
    """Run the robot with a script, and write the page of that run.

    :param end: in seconds of robot time
    :param failure: how it fails, which the simulation may not see: a team's rules, for example, are checked elsewhere
    """
    simulation = Simulation(project, SimOptions(speed=0, paused=True, script=script, network_values=True))
    page.follow(simulation)
    Headless(lambda text: None, seconds=min(end, (script.end_us - 1) / 1_000_000)).run(simulation)
    page.write(simulation, None if simulation.status.failure is not None else failure)


def place_in(project: Project, file: Path) -> str:
    """Return a file's name for readers on other computers: relative to the project, if it is in there."""
    whole, root = file.resolve(), project.root.resolve()
    return whole.relative_to(root).as_posix() if whole.is_relative_to(root) else file.name
