"""A robot on the network as a `Source`: follows its NetworkTables and its console, on a thread of its own."""

from __future__ import annotations

import socket
import threading
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from functools import partial
from time import monotonic
from types import MappingProxyType

from ...deploy.console import ConnectionReports, lines_of_one_connection
from ...deploy.discovery import Address
from ...deploy.errors import NoConsoleError
from ...deploy.targets import controller_of
from ...project import Project
from ...season import CURRENT
from ...wpi import network_client
from ...wpi.network_news import Connected, Gone, Lost, Received
from ..engine.changes import ChangeCursor, ChangeFeed, ReportSignal
from ..engine.choosers import choosers_in
from ..engine.field import field_of
from ..engine.messages import NO_CONNECTION
from ..engine.output_log import OWN, OutputCursor, OutputLog
from ..engine.past_run import PastRun
from ..engine.scene import Scene
from ..engine.snapshot import Snapshot, Status
from ..engine.source import Abilities
from .addresses import RobotAddresses
from .runs import RobotRuns
from .tuning import Tuner, checked_write

#: How often to look at what was received, and how often at least to report that time has passed, in wall seconds.
_LOOK_SECONDS, _TIME_SECONDS = 0.02, 0.1
#: How long a robot may take to respond before the reasons are looked for, in wall seconds.
_PATIENCE_SECONDS = 2.0
#: How long to wait for names and connections of a search, in wall seconds.
_SEARCH_SECONDS = 4.0
#: How late values may be before that is said, in seconds.
_LATE_SECONDS = 3.0
#: How long to wait before the next connection to a console, in wall seconds.
_BETWEEN_SECONDS = 2.0


def console_of(host: str) -> Address | None:
    """Return where a robot's console is; None: it needs a login."""
    return None if controller_of(CURRENT).layout.output else Address(host)


class RobotConsole:
    """Reads one robot's console service, as `pyfrc console` does, on a thread of its own, until it is closed.

    A roboRIO sends its output only while a Driver Station is connected to it. None is imitated here.

    :param add: called with each line
    :param say: called once with a sentence, if there is no console
    """

    def __init__(self, address: Address, add: Callable[[str], object], say: Callable[[str], object]) -> None:
        self._address = address
        self._add, self._say = add, say
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._follow, name="pyfrc view: robot's console", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End."""
        self._over.set()
        self._thread.join()

    def _follow(self) -> None:
        report = ConnectionReports(quiet=True)
        is_known = False
        while not self._over.is_set():
            try:
                for line in lines_of_one_connection(self._address, False, report, self._over.is_set):
                    is_known = True
                    self._add(f"{line}\n")
            except NoConsoleError:
                return
            if not is_known and "connected" not in report.made and not self._over.is_set():
                self._say(f"What the robot prints is not shown: there is no console at {self._address}.")
            is_known = True
            self._over.wait(_BETWEEN_SECONDS)


class LiveRobot:
    """See `Source`.

    :param project: whose field and layout the page has
    :param tell: prints to the terminal
    :param console: returns where the console of the robot with this address is
    :raises SettingsError: when ``sim/config.json`` is invalid
    """

    abilities = Abilities("robot", writes=True)
    when: datetime | None = None
    recorded: PastRun | None = None
    branches: tuple[PastRun, ...] = ()
    wants_to_run = True

    def __init__(
        self,
        project: Project,
        where: RobotAddresses,
        console: Callable[[str], Address | None] = console_of,
        tell: Callable[[str], object] = lambda text: None,
    ) -> None:
        self.project, self.title = project, where.whose
        self.field = field_of(project, "blue")  # as robot code has them
        self.reports = ReportSignal()
        self.status = Status(state="running")
        self._where, self._console_of, self._tell = where, console, tell
        self._hal, self._network, self._output = ChangeFeed(), ChangeFeed(), OutputLog()
        self._runs = RobotRuns(self._hal.add, self._network.add)
        self._newest = self._snapshot()
        #: A mistake of pyfrc's own, which would leave the page without news.
        self._mistake: Exception | None = None
        self._console: RobotConsole | None = None
        self._is_console_missing = False
        self._reported_at = 0.0
        #: Whether values of this connection were late.
        self._is_late = False
        #: Why there is no robot, as soon as that is known.
        self._why = ""
        #: The people who may set values now.
        self._tuners: set[Tuner] = set()
        self._over = threading.Event()
        self._client: network_client.Client | None = None
        self._thread = threading.Thread(target=self._follow, name="pyfrc view: robot", daemon=True)
        self._search = threading.Thread(target=self._explain, name="pyfrc view: search", daemon=True)

    @property
    def snapshot(self) -> Snapshot:
        """The newest state."""
        if self._mistake is not None:
            raise self._mistake
        return self._newest

    def output_cursor(self) -> OutputCursor:
        """Return a reader of what the robot prints."""
        return self._output.cursor()

    def change_cursor(self) -> ChangeCursor:
        """Return a reader of the runs; a robot does not say more of `hal_data`."""
        return self._hal.cursor()

    def network_cursor(self) -> ChangeCursor:
        """Return a reader of all changes of NetworkTables and of the mode."""
        return self._network.cursor()

    def attach(self) -> Tuner:
        """Return what one person may do: set values, after having switched that on."""
        return Tuner(self._write, self._tuners, self._stop_writing)

    def start(self) -> None:
        """Begin to look for the robot."""
        where = self._where
        self._say(
            f"Looking for the robot at {', '.join(map(_shown, where.servers))}. "
            "Is its program running, and this computer in its network?"
        )
        self._client = network_client.Client("pyfrc view", where.servers, where.asks_driver_station)
        self._thread.start()
        self._search.start()

    def close(self) -> None:
        """End."""
        self._over.set()
        if self._client is not None:
            self._thread.join()
            self._client.close()
        self._close_console()
        with self.reports:
            self.status = replace(self.status, state="closed")
            self.reports.notify_all()

    # -- what is received -----------------------------------------------------------------------------------------

    def _follow(self) -> None:
        assert self._client is not None
        try:
            while not self._over.wait(_LOOK_SECONDS):
                self._look(self._client)
        except Exception as mistake:
            self._mistake = mistake

    def _look(self, client: network_client.Client) -> None:
        news: list[Received | Gone] = []
        is_new = False
        for each in client.read():
            if isinstance(each, Connected):
                news.clear()
                self._runs.connect(monotonic(), client.now_us)
                self._connected(each)
            elif isinstance(each, Lost):
                self._take(client, news)
                news.clear()
                self._runs.lose()
                self._lost()
            else:
                news.append(each)
            is_new = True
        self._take(client, news)
        if self._why:
            why, self._why = self._why, ""
            self._tell_why(why)
        if is_new or monotonic() >= self._reported_at + _TIME_SECONDS:
            self._report()

    def _take(self, client: network_client.Client, news: list[Received | Gone]) -> None:
        if self._runs.take(news, monotonic(), client.now_us):
            self._say(f"0:00.00 is where the robot's own clock shows {self._runs.zero_us / 1e6:.2f} s.")
        if self._runs.behind > _LATE_SECONDS and not self._is_late:
            self._is_late = True
            self._warn("Values are seconds late: the robot publishes more than this computer or the network takes in.")

    def _explain(self) -> None:
        if not self._over.wait(_PATIENCE_SECONDS) and self.status.network_address is None:
            self._why = reasons(self._where.servers)

    def _tell_why(self, why: str) -> None:
        """Say why there is no robot, if there still is none."""
        if self.status.network_address is None and not self._runs.number:
            self._warn(f"No robot yet; still trying. {why}.")

    def _warn(self, text: str) -> None:
        self._tell(f"{text}\n")
        self.status = replace(self.status, note=text)
        self._report()

    def _connected(self, to: Connected) -> None:
        shown = _shown((to.host, to.port))
        self.status = replace(self.status, network_address=shown, note="")
        self._say(f"Connected to {shown}.")
        self._is_late = False
        if self._is_console_missing:
            return
        address = self._console_of(to.host)
        if address is None:
            self._console_is_missing("What the robot prints is not shown here: pyfrc console shows it.")
        else:
            self._console = RobotConsole(address, self._print, self._console_is_missing)

    def _lost(self) -> None:
        self._say(f"The connection to {self.status.network_address} was lost. Trying again...")
        self.status = replace(self.status, network_address=None)
        self._close_console()

    def _close_console(self) -> None:
        console, self._console = self._console, None
        if console is not None:
            console.close()

    def _console_is_missing(self, text: str) -> None:
        self._is_console_missing = True
        self._say(text)

    def _print(self, text: str) -> None:
        self._output.append(text)
        with self.reports:
            self.reports.notify_all()

    def _say(self, text: str) -> None:
        self._tell(f"{text}\n")
        self._print(f"{OWN}{text}\n")

    def _report(self) -> None:
        self._reported_at = monotonic()
        runs = self._runs
        with self.reports:
            self._newest = self._snapshot()
            starts = max(runs.number, 1)
            self.status = replace(self.status, length=runs.now, starts=starts, responding=True)
            self.reports.notify_all()

    def _snapshot(self) -> Snapshot:
        runs, station = self._runs, self._runs.station
        left = runs.values.get(runs.match_time_path or "")
        left = left if isinstance(left, (int, float)) and left >= 0 and station.mode != NO_CONNECTION else None
        values = {
            "alliance_station": station.alliance_station,
            "event.game_specific_message": station.game_message,
        }
        return Snapshot(
            time=runs.now,
            mode=station.mode,
            scene=Scene(self.field),
            values=MappingProxyType(values),
            choosers=tuple(choosers_in(runs.values)),
            emergency_stopped=station.emergency_stopped,
            station_attached=station.attached,
            practice_since=None if left is None else 0.0,
            match_left=0.0 if left is None else float(left),
        )

    # -- what is written ------------------------------------------------------------------------------------------

    def _write(self, writes: Mapping[str, object]) -> None:
        client = self._client
        for target, value in writes.items():
            name, type_name, converted = checked_write(target, value, self._runs.values)
            if client is not None:
                client.write(name, converted, type_name)

    def _stop_writing(self) -> None:
        if self._client is not None:
            self._client.stop_writing()


def _shown(server: tuple[str, int]) -> str:
    host, port = server
    return f"{host}:{port}"


def reasons(servers: Sequence[tuple[str, int]]) -> str:
    """Return what each address does instead of serving NetworkTables, as one sentence.

    A connection is tried to each once, while the client of NetworkTables goes on.
    """
    found = dict.fromkeys(servers, f"no response within {_SEARCH_SECONDS:g} s")
    threads = [threading.Thread(target=partial(_try, server, found), daemon=True) for server in servers]
    for thread in threads:
        thread.start()
    for thread in threads:  # all began at the same time; those whose names take longer are left alone
        thread.join(_SEARCH_SECONDS + 1)
    together = defaultdict(list)
    for (host, port), why in dict(found).items():
        together[why].append(_shown((host, port)))
    return "; ".join(f"{', '.join(shown)}: {why}" for why, shown in together.items())


def _try(server: tuple[str, int], found: dict[tuple[str, int], str]) -> None:
    try:
        with socket.create_connection(server, _SEARCH_SECONDS):
            found[server] = "a program responds, but not with NetworkTables"
    except (socket.gaierror, UnicodeError):
        found[server] = "the name is not known here"
    except TimeoutError:
        pass
    except ConnectionRefusedError:
        found[server] = "a computer is there, but no robot program runs on it"
    except OSError as error:
        found[server] = (error.strerror or str(error)).lower()
