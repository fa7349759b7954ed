"""One page's connection: sends it what has changed, and carries out what it asks for."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

from ...engine.network_paths import TYPE
from .access import Role
from .commands import CommandError, Commands
from .json_text import json_text
from .layouts import save_layout
from .updates import UpdateBuilder

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

    from .collector import Collector

#: The shortest interval of updates, in seconds: somewhat less than a packet.
_INTERVAL = 0.014
#: The most paths that one page may ask for at once.
_MOST_PATHS = 64
_READ_ONLY = "This window only shows the simulation; it cannot drive."


class PageClient:
    """One page.

    :param hello: returns what a page gets first, without the state
    :param clients: returns the number of pages
    :param executor: carries out commands, one after the other
    """

    def __init__(
        self,
        socket: WebSocket,
        role: Role,
        collector: Collector,
        commands: Commands,
        builder: UpdateBuilder,
        hello: Callable[[], dict[str, Any]],
        clients: Callable[[], int],
        executor: Executor,
    ) -> None:
        self._socket, self._role = socket, role
        self._collector, self._commands, self._builder = collector, commands, builder
        self._hello, self._clients, self._executor = hello, clients, executor
        #: Set when there may be something new.
        self.news = asyncio.Event()
        #: Messages are sent one at a time.
        self._sending = asyncio.Lock()

    async def send_updates(self) -> None:
        """Send what has changed, as fast as the page takes it, until it has gone."""
        await self._send({**self._hello(), **self._builder.update(self._clients())})
        loop = asyncio.get_running_loop()
        began = loop.time()
        while True:
            await self.news.wait()
            if (rest := began + _INTERVAL - loop.time()) > 0:
                await asyncio.sleep(rest)
            self.news.clear()
            began = loop.time()
            if update := self._builder.update(self._clients()):
                await self._send({"type": "update", **update})

    async def receive(self, text: str) -> None:
        """Carry out one message of the page."""
        try:
            message = json.loads(text)
        except ValueError:
            message = None
        if not isinstance(message, dict):
            await self._send({"type": "error", "message": "a message is one JSON object"})
            return
        number = {"id": message["id"]} if isinstance(message.get("id"), (int, str)) else {}
        try:
            answer = await self._answer(message)
        except CommandError as wrong:
            await self._send({"type": "error", **number, "message": str(wrong)})
            return
        if number:
            await self._send({"type": "answer", **number, **answer})

    async def close(self) -> None:
        """Say that the simulation was closed."""
        await self._send({"type": "closed"})

    async def _send(self, message: dict[str, Any]) -> None:
        text = json_text(message)
        async with self._sending:
            await self._socket.send_text(text)

    async def _answer(self, message: dict[str, Any]) -> dict[str, Any]:
        match message.get("type"):
            case "command":
                return await self._in_order(lambda: self._commands.carry_out(message))
            case "layout":
                return await self._in_order(lambda: self._save_layout(message.get("layout")))
            case "values":
                return await asyncio.to_thread(self._values, message)
            case "plot":
                return await asyncio.to_thread(self._plot, message)
            case "first_difference":
                return await asyncio.to_thread(self._first_difference, message)
            case "subscribe":
                self._builder.subscribe(_paths(message))
                return {}
            case "ping":
                return {}
            case other:
                raise CommandError(f"There is no message {other!r}. Reload the page.")

    async def _in_order(self, act: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        if self._role != "drive":
            raise CommandError(_READ_ONLY)
        return await asyncio.get_running_loop().run_in_executor(self._executor, act)

    def _save_layout(self, layout: Any) -> dict[str, Any]:
        try:
            save_layout(self._collector.root, layout)
        except (OSError, ValueError) as wrong:
            raise CommandError(f"The layout was not saved: {wrong}") from None
        return {}

    def _values(self, message: dict[str, Any]) -> dict[str, Any]:
        time = _time(message, "t")
        values = self._collector.runs.values_at(time, _branch(message))
        if values is None:
            raise _no_branch()
        return {"t": time, "values": {path: value for path, value in values.items() if not path.startswith(TYPE)}}

    def _first_difference(self, message: dict[str, Any]) -> dict[str, Any]:
        paths, branch = None if message.get("paths") is None else _paths(message), _branch(message)
        found = None if branch is None else self._collector.runs.first_difference(branch, paths)
        if found is None:
            raise _no_branch()
        return {"t": found.time, "paths": found.paths}

    def _plot(self, message: dict[str, Any]) -> dict[str, Any]:
        points = message.get("points", 800)
        found = self._collector.runs.plots(
            _paths(message),
            _time(message, "from"),
            _time(message, "to"),
            points if isinstance(points, int) else 800,
            _branch(message),
        )
        if found is None:
            raise _no_branch()
        return {"series": found}


def _no_branch() -> CommandError:
    return CommandError("This branch is no longer kept.")


def _paths(message: dict[str, Any]) -> list[str]:
    paths = message.get("paths")
    if not isinstance(paths, list) or not all(isinstance(path, str) for path in paths) or len(paths) > _MOST_PATHS:
        raise CommandError(f"paths: a list of at most {_MOST_PATHS} texts is needed")
    return paths


def _time(message: dict[str, Any], key: str) -> float:
    value = message.get(key)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value != value:
        raise CommandError(f"{key}: a time in seconds is needed, not {value!r}")
    return float(value)


def _branch(message: dict[str, Any]) -> int | None:
    value = message.get("branch")
    if value is not None and not isinstance(value, int):
        raise CommandError(f"branch: a number is needed, not {value!r}")
    return value
