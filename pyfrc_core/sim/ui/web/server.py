"""The server on its own thread, and the addresses where it is found."""

from __future__ import annotations

import asyncio
import socket
import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING

import uvicorn

from ....errors import UsageError
from .access import Access, Share

if TYPE_CHECKING:
    from .app import WebApp

#: The largest message that a page may send, in bytes.
_MOST_MESSAGE = 1 << 20
#: How often pages are asked whether they are there, and how long they may take to respond, in seconds: the browser
#: responds by itself, however busy its page is.
_PING_SECONDS, _GONE_SECONDS = 1.0, 3.0
#: How long each step of the end may take, in seconds; longer than the app waits for a page.
_CLOSING_SECONDS = 3.0


@dataclass(frozen=True)
class WebOptions:
    """How to serve.

    :param share: what clients on the network may do; None: they are not served
    :param port: the port; 0: any that is free
    :param allowed_hosts: where else browsers find the page, through a forwarded port
    :param opens_browser: whether to open the page in a browser
    :param watching: whether saved files bring new code
    """

    share: Share | None = None
    port: int = 0
    allowed_hosts: tuple[str, ...] = ()
    opens_browser: bool = True
    watching: bool = False


class Server:
    """Listens from its construction on.

    :raises UsageError: when the port cannot be had
    """

    def __init__(self, options: WebOptions, access: Access) -> None:
        self._access = access
        address = "127.0.0.1" if options.share is None else "0.0.0.0"
        # With its protocol named, asyncio has what is sent leave at once; otherwise small messages wait for others.
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM, socket.IPPROTO_TCP)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            self._socket.bind((address, options.port))
            self._socket.listen(64)  # a browser that comes before the loop runs is not refused
        except OSError as wrong:
            self._socket.close()
            raise UsageError(
                f"the page cannot be served at port {options.port}: {wrong.strerror}", remedy="Choose another --port."
            ) from None
        self.port: int = self._socket.getsockname()[1]
        self._server: uvicorn.Server | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._app: WebApp | None = None
        self._thread: threading.Thread | None = None

    @property
    def address(self) -> str:
        """The page's address on this computer, with the key that drives."""
        return f"http://127.0.0.1:{self.port}/?token={self._access.drive}"

    @property
    def viewing_address(self) -> str:
        """The address of a page that only shows the simulation."""
        return f"http://127.0.0.1:{self.port}/?token={self._access.view}"

    def network_address(self, drive: bool = False) -> str:
        """Return the page's address for other computers."""
        token = self._access.drive if drive else self._access.view
        return f"http://{_own_address()}:{self.port}/?token={token}"

    def start(self, app: WebApp) -> None:
        """Begin to serve."""
        config = uvicorn.Config(
            app,
            http="h11",
            ws="websockets-sansio",
            lifespan="off",
            log_config=None,
            log_level="critical",  # the terminal is the robot's
            access_log=False,
            proxy_headers=False,  # any client can send them
            server_header=False,
            ws_max_size=_MOST_MESSAGE,
            ws_per_message_deflate=False,  # most pages are on the same computer
            # A page that does not respond has gone: what it held is released, and a robot without a driver is disabled.
            ws_ping_interval=_PING_SECONDS,
            ws_ping_timeout=_GONE_SECONDS,
            timeout_graceful_shutdown=1,
        )
        config.load()  # here, not on the thread: a program that is to end at once would wait for its imports
        self._app, self._server = app, uvicorn.Server(config)
        self._thread = threading.Thread(target=self._serve, name="pyfrc sim: web server", daemon=True)
        self._thread.start()

    def _serve(self) -> None:
        assert self._server is not None
        server = self._server

        async def serve() -> None:
            self._loop = asyncio.get_running_loop()
            await server.serve(sockets=[self._socket])

        asyncio.run(serve())

    def wake(self) -> None:
        """Have every page sent what is new. May be called from any thread."""
        loop, app = self._loop, self._app
        if loop is not None and app is not None and not loop.is_closed():
            try:
                loop.call_soon_threadsafe(app.wake)
            except RuntimeError:  # it was closed meanwhile
                return

    def close(self) -> None:
        """Stop serving; pages are shown that the simulation was closed."""
        if self._server is None or self._thread is None:
            self._socket.close()
            return
        loop, app = self._loop, self._app
        if loop is not None and app is not None and not loop.is_closed():
            closing = asyncio.run_coroutine_threadsafe(app.close_pages(), loop)
            try:
                closing.result(_CLOSING_SECONDS)
            except Exception:  # the server is too busy: the pages see that the connection is gone
                closing.cancel()
        self._server.should_exit = True
        self._thread.join(_CLOSING_SECONDS)
        if self._thread.is_alive():
            self._server.force_exit = True
            self._thread.join(_CLOSING_SECONDS)
        if app is not None:
            app.close()
        self._socket.close()


def _own_address() -> str:
    """Return this computer's address on the network."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("10.255.255.255", 1))  # sends nothing
            return str(probe.getsockname()[0])
        except OSError:
            return socket.gethostname()
