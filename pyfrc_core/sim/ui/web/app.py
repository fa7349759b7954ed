"""The application: the page's files, the field's picture, and the WebSocket of each page."""

from __future__ import annotations

import asyncio
import mimetypes
import traceback
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, JSONResponse, PlainTextResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket, WebSocketDisconnect

from ....config.pictures import field_picture, picture_kind
from .access import Access, Guard, Receive, Role, Scope, Send
from .cameras import camera_page, picture_addresses, streams_path
from .commands import PageCommands
from .greeting import greeting
from .page_client import PageClient
from .sent_logs import SentLogs
from .single_file import PAGE
from .updates import UpdateBuilder

if TYPE_CHECKING:
    from ...engine.source import Source
    from .collector import Collector

#: Types that some systems have wrong, in the Windows registry for example: browsers refuse files of another type.
_TYPES = {".css": "text/css", ".svg": "image/svg+xml", ".js": "text/javascript", ".mjs": "text/javascript"}

_NO_KEY = "This address lacks its key. Open the address that pyfrc sim has printed.\n"
#: The codes that close a connection: it sent something other than text; pyfrc has a mistake.
_UNSUPPORTED, _ERROR = 1003, 1011
#: The most pages at once, so that those who only look cannot use up this computer; those who drive are not counted out.
_MOST_PAGES = 32
#: How long a page that does not read delays the end, in seconds.
_CLOSING_SECONDS = 2.0
#: What sending and receiving raise when a page has gone; RuntimeError: it was closed meanwhile.
_GONE = (WebSocketDisconnect, RuntimeError, OSError)


class _PageFiles(StaticFiles):
    """The page's files, which a browser asks for again each time: a changed file is there after a reload."""

    def file_response(self, *arguments: Any, **named: Any) -> Response:
        response = super().file_response(*arguments, **named)
        response.headers["Cache-Control"] = "no-cache"
        return response


class WebApp:
    """Serves the pages of one source.

    :param close: ends it
    :param watching: whether saved files bring new code
    """

    def __init__(
        self,
        source: Source,
        collector: Collector,
        close: Callable[[], object],
        access: Access,
        watching: bool = False,
    ) -> None:
        self._source, self._collector, self._access = source, collector, access
        self._close, self._watching = close, watching
        self._clients: dict[int, PageClient] = {}
        self._count = 0
        self._executor = ThreadPoolExecutor(1, "pyfrc sim: web commands")
        self._sent_logs = SentLogs(source, collector)
        for ending, kind in _TYPES.items():
            mimetypes.add_type(kind, ending)
        routes = [
            Route("/", self._index),
            Route("/field-image", self._image),
            Route("/camera", self._camera),
            Route("/log", self._log, methods=["POST"]),
            WebSocketRoute("/ws", self._page),
            Mount("/static", _PageFiles(directory=PAGE)),
        ]
        self._guarded = Guard(Starlette(routes=routes), access)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request, as ASGI has it."""
        await self._guarded(scope, receive, send)

    def wake(self) -> None:
        """Have every page sent what is new. Called on the event loop's thread."""
        for client in self._clients.values():
            client.news.set()

    def close(self) -> None:
        """Carry out no more commands."""
        self._executor.shutdown(wait=False, cancel_futures=True)
        self._sent_logs.close()

    async def close_pages(self) -> None:
        """Say to every page that the simulation was closed."""
        closings = [asyncio.wait_for(client.close(), _CLOSING_SECONDS) for client in self._clients.values()]
        await asyncio.gather(*closings, return_exceptions=True)

    async def _index(self, request: Request) -> Response:
        if self._access.role_of(request.scope) is None:
            return PlainTextResponse(_NO_KEY, 403)
        return FileResponse(PAGE / "index.html", headers={"Cache-Control": "no-cache"})

    async def _image(self, request: Request) -> Response:
        image = self._source.project.sim_config.field.image
        if self._access.role_of(request.scope) is None:
            return PlainTextResponse(_NO_KEY, 403)
        # Looked at again: the file may be another one since the page was made.
        file = None if image is None else field_picture(self._source.project.root, image)[0]
        if file is None:
            return PlainTextResponse("There is no picture of the field.\n", 404)
        return FileResponse(file, media_type=picture_kind(file), headers={"Cache-Control": "no-cache"})

    async def _camera(self, request: Request) -> Response:
        if self._access.role_of(request.scope) is None:
            return PlainTextResponse(_NO_KEY, 403)
        name = request.query_params.get("name", "")
        path = streams_path(name)
        text, policy = camera_page(name, picture_addresses(self._collector.runs.present_values([path]).get(path)))
        headers = {"Cache-Control": "no-cache", "Content-Security-Policy": policy, "X-Frame-Options": "SAMEORIGIN"}
        return HTMLResponse(text, headers=headers)

    async def _log(self, request: Request) -> Response:
        """Take a log from a page, and show it as a branch."""
        if self._access.role_of(request.scope) != "drive":
            return PlainTextResponse(_NO_KEY, 403)
        return JSONResponse(await self._sent_logs.take(request))

    async def _page(self, socket: WebSocket) -> None:
        role = self._access.role_of(socket.scope)
        if role is None or (role == "view" and len(self._clients) >= _MOST_PAGES):
            await socket.close(1008)
            return
        await socket.accept()
        self._count += 1
        number, token = self._count, socket.query_params.get("token", "")
        image = f"/field-image?token={token}"
        writer = self._source.attach() if role == "drive" else None
        client = PageClient(
            socket,
            self._collector,
            PageCommands(self._source, writer, self._collector, self._close) if role == "drive" else None,
            UpdateBuilder(self._collector, image),
            lambda: greeting(self._source, number, role == "view", self._watching),
            lambda: len(self._clients),
            self._executor,
        )
        self._clients[number] = client
        self.wake()
        works = (client.send_updates(), client.compare(), self._receive(socket, client))
        tasks = set(map(asyncio.create_task, works))
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._clients.pop(number, None)
            self.wake()
            for task in tasks:
                task.cancel()
            for found in await asyncio.gather(*tasks, return_exceptions=True):
                if isinstance(found, Exception) and not isinstance(found, _GONE):
                    await self._report(socket, found, role)
            if writer is not None:
                with suppress(RuntimeError):  # the simulation has ended
                    self._executor.submit(writer.leave)  # after what the page has asked for

    @staticmethod
    async def _report(socket: WebSocket, error: Exception, role: Role) -> None:
        """Print an error of pyfrc's own, and end the connection: the page connects again, and gets everything.

        Who only looks has no right to fill the driver's terminal.
        """
        if role == "drive":
            traceback.print_exception(error)
        with suppress(*_GONE):
            await socket.close(_ERROR)

    @staticmethod
    async def _receive(socket: WebSocket, client: PageClient) -> None:
        while True:
            try:
                text = await socket.receive_text()
            except KeyError:  # bytes
                await socket.close(_UNSUPPORTED)
                return
            await client.receive(text)
