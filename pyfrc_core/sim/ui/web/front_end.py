"""The simulator in a browser: a server of one page, on this computer unless it is shared."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from ....browser import open_in_browser, why_no_browser, write_redirection
from ....text_files import keep_out_of_version_control
from ...engine.simulation import Simulation
from ...engine.source import Source
from .. import FrontEnd
from .access import Access, allowed_origins, codespace_origins
from .app import WebApp
from .collector import Collector
from .server import Server, WebOptions

#: The interval of looks whether the simulation is to end, in seconds: on Windows, Ctrl-C does not end a wait.
_LOOK_SECONDS = 0.5

#: What is served, by its kind.
_WHAT = {"simulation": "The simulator", "log": "The log", "robot": "The robot's page"}


class WebFrontEnd(FrontEnd):
    """Serves pages that show a source, until Ctrl-C or until a page closes it.

    :param say: prints to the terminal
    :param quiet: print addresses only
    :raises UsageError: when one of the hosts that the options allow is no host
    """

    def __init__(self, say: Callable[[str], object], options: WebOptions, quiet: bool = False) -> None:
        self._say, self._options, self._quiet = say, options, quiet
        self._access = Access(options.share)
        self._allowed = allowed_origins(options.allowed_hosts)
        self._over = threading.Event()
        self.server: Server | None = None
        #: The file that leads a browser to the page.
        self._redirection: Path | None = None
        #: What keeps the whole history.
        self.collector: Collector | None = None

    def run(self, source: Source) -> int:
        self.server = server = Server(self._options, self._access)
        access = replace(self._access, origins=(*self._allowed, *codespace_origins(server.port)))
        self.collector = collector = Collector(source, server.wake)
        try:
            server.start(WebApp(source, collector, self.close, access, self._options.watching))
            collector.start()
            self._announce(server, access, source)
            source.start()
            while not self._over.wait(_LOOK_SECONDS):
                if collector.mistake is not None:
                    raise collector.mistake
        finally:
            collector.close()
            server.close()
            source.close()
            if self._redirection is not None:
                self._redirection.unlink(missing_ok=True)
        return 0

    def close(self) -> None:
        """End. May be called from any thread."""
        self._over.set()

    def saved(self, files: list[str]) -> None:
        """Show that the robot gets new code."""
        if (collector := self.collector) is not None:
            collector.announce(f"saved: {', '.join(files)}")

    def _announce(self, server: Server, access: Access, source: Source) -> None:
        kind = source.abilities.kind
        what = _WHAT[kind]
        if access.origins:
            for origin in access.origins:
                self._say(f"{what} is at {origin}/?token={access.drive}\n")
            self._say(f"To look only: {access.origins[0]}/?token={access.view}\n")
            self._say(f"On this computer: {server.address}\n")
        else:
            self._say(f"{what} is at {server.address}\n")
            self._say(f"To look only: {server.viewing_address}\n")
        if (share := self._options.share) is not None:
            can = "can drive the robot" if share == "drive" else "can only look"
            self._say(
                f"Shared with the network: who has this address {can}: {server.network_address(share == 'drive')}\n"
            )
            if share == "drive" and (port := _network_port(source)) is not None:
                self._say(f"NetworkTables are shared, too, without a key: port {port}\n")
        if not self._options.opens_browser:
            return
        if why := why_no_browser():
            self._advise(
                f"No browser is opened: {why}. Open the address in one; "
                f"on another computer, forward port {server.port} to it first."
            )
        else:
            directory = source.project.root.resolve() / ".pyfrc"
            threading.Thread(
                target=self._open, args=(server.address, directory), name="pyfrc sim: browser", daemon=True
            ).start()
        self._advise("Ctrl-C ends the simulation." if kind == "simulation" else "Ctrl-C ends this command.")

    def _open(self, address: str, directory: Path) -> None:
        with suppress(OSError):  # then it is written elsewhere
            directory.mkdir(exist_ok=True)
            keep_out_of_version_control(directory)
        self._redirection = write_redirection(address, directory)
        if not open_in_browser(address if self._redirection is None else self._redirection.as_uri()):
            self._advise("No browser was found. Open the address in one.")

    def _advise(self, text: str) -> None:
        if not self._quiet:
            self._say(f"{text}\n")


def _network_port(source: Source) -> int | None:
    """Return the port where a simulation serves NetworkTables."""
    return source.options.nt_port if isinstance(source, Simulation) else None
