"""One page's connection: sends it what has changed, and carries out what it asks for."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from concurrent.futures import Executor
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from ...engine.messages import TYPE
from .commands import PageCommands
from .dashboards import Dashboards
from .greeting import save_layout
from .messages import CommandError, Message, json_text, read_message
from .updates import UpdateBuilder

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

    from .collector import Collector

#: The shortest interval of updates, in seconds: somewhat less than a packet; and of those that bring only a later time.
_INTERVAL, _TIME_INTERVAL = 0.014, 0.2
#: The interval of signs of life while an answer takes long, in seconds: a page whose server is silent connects again.
_SIGN_INTERVAL = 1.0
#: The longest error, in characters: it may quote what the page has sent.
_MOST_ERROR = 300
#: The most points of one curve.
_MOST_POINTS = 1_000_000
_READ_ONLY = "This window only shows the simulation; it cannot drive."


class PageClient:
    """One page.

    :param commands: None for a page that only looks
    :param hello: returns what a page gets first, without the state
    :param clients: returns the number of pages
    :param executor: carries out commands, one after the other
    """

    def __init__(
        self,
        socket: WebSocket,
        collector: Collector,
        commands: PageCommands | None,
        builder: UpdateBuilder,
        hello: Callable[[], dict[str, Any]],
        clients: Callable[[], int],
        executor: Executor,
    ) -> None:
        self._socket = socket
        self._collector, self._commands, self._builder = collector, commands, builder
        self._hello, self._clients, self._executor = hello, clients, executor
        self._dashboards = Dashboards(collector.root)
        #: Set when there may be something new.
        self.news = asyncio.Event()
        #: Messages are sent one at a time.
        self._sending = asyncio.Lock()
        #: The comparisons that are asked for: one that waits, at most.
        self._comparisons: asyncio.Queue[Message] = asyncio.Queue(1)

    async def send_updates(self) -> None:
        """Send what has changed, as fast as the page takes it, until it has gone."""
        await self._send({**self._hello(), **self._builder.update(self._clients())})
        loop = asyncio.get_running_loop()
        began = sent = loop.time()
        while True:
            with suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self.news.wait(), _TIME_INTERVAL if self._builder.is_late else None)
            if (rest := began + _INTERVAL - loop.time()) > 0:
                await asyncio.sleep(rest)
            self.news.clear()
            began = loop.time()
            if update := self._builder.update(self._clients(), began >= sent + _TIME_INTERVAL):
                sent = began
                await self._send({"type": "update", **update})

    async def receive(self, text: str) -> None:
        """Carry out one message of the page; `compare` does it for a comparison."""
        try:
            message = read_message(text)
            compares = message.text("type") == "first_difference"
        except CommandError as wrong:
            await self._send_error({}, wrong)
            return
        if compares:
            await self._comparisons.put(message)
        else:
            await self._respond(message)

    async def compare(self) -> None:
        """Compare runs until the page has gone: that takes many seconds, in which other messages have to be read.

        Else the server does not read the page's signs of life, either, and ends the connection.
        """
        while True:
            await self._respond(await self._comparisons.get())

    async def _respond(self, message: Message) -> None:
        number = {} if message.id is None else {"id": message.id}
        try:
            answer = await self._with_signs(self._answer(message))
        except CommandError as wrong:
            await self._send_error(number, wrong)
            return
        if number:
            await self._send({"type": "answer", **number, **answer})

    async def _send_error(self, number: dict[str, Any], wrong: CommandError) -> None:
        await self._send({"type": "error", **number, "message": str(wrong)[:_MOST_ERROR]})

    async def close(self) -> None:
        """Say that the simulation was closed."""
        await self._send({"type": "closed"})

    async def _with_signs(self, answering: Coroutine[Any, Any, dict[str, Any]]) -> dict[str, Any]:
        """Return an answer, and let the page know meanwhile that the server is there: it gets its answers in order."""
        task = asyncio.create_task(answering)
        try:
            while not (await asyncio.wait((task,), timeout=_SIGN_INTERVAL))[0]:
                await self._send({"type": "working"})
            return task.result()
        finally:
            task.cancel()

    async def _send(self, message: dict[str, Any]) -> None:
        text = json_text(message)
        async with self._sending:
            await self._socket.send_text(text)

    async def _answer(self, message: Message) -> dict[str, Any]:
        match message.text("type"):
            case "command":
                return await self._in_order(lambda commands: commands.carry_out(message))
            case "layout":
                return await self._in_order(lambda commands: self._save_layout(message.raw("layout")))
            case "dashboards":
                known = message.text("stamp") if "stamp" in message else ""
                return await asyncio.to_thread(self._dashboards.found, known)
            case "save_dashboard":
                return await self._in_order(lambda commands: self._dashboards.save(message))
            case "elastic_layout":
                if self._commands is None:
                    raise CommandError(_READ_ONLY)
                return await asyncio.to_thread(self._dashboards.elastic_layout, self._collector.robot)
            case "values":
                return await asyncio.to_thread(self._values, message)
            case "plot":
                return await asyncio.to_thread(self._plot, message)
            case "changes":
                time, reach = message.time("t"), float(message.number("reach", 0, 60))
                return {"changes": await asyncio.to_thread(self._collector.runs.changes_around, time, reach)}
            case "first_difference":
                return await asyncio.to_thread(self._first_difference, message)
            case "show":
                self._builder.show(message.texts("paths"), message.texts("beginnings"))
                self.news.set()
                return {}
            case "subscribe":
                self._builder.subscribe(message.paths())
                return {}
            case "ping":
                return {}
            case other:
                raise CommandError(f"There is no message {other[:80]!r}. Reload the page.")

    async def _in_order(self, act: Callable[[PageCommands], dict[str, Any]]) -> dict[str, Any]:
        if self._commands is None:
            raise CommandError(_READ_ONLY)
        return await asyncio.get_running_loop().run_in_executor(self._executor, act, self._commands)

    def _save_layout(self, layout: Any) -> dict[str, Any]:
        try:
            save_layout(self._collector.root, layout)
        except OSError as wrong:
            raise CommandError(f"The layout was not saved: .pyfrc cannot be written: {wrong.strerror}") from None
        except ValueError as wrong:
            raise CommandError(f"The layout was not saved: {wrong}") from None
        return {}

    def _values(self, message: Message) -> dict[str, Any]:
        time = message.time("t")
        values = self._collector.runs.values_at(time, message.branch())
        if values is None:
            raise _no_branch()
        is_shown = self._builder.is_shown if "shown" in message else None
        return {
            "t": time,
            "values": {
                path: value
                for path, value in values.items()
                if not path.startswith(TYPE) and (is_shown is None or is_shown(path))
            },
        }

    def _first_difference(self, message: Message) -> dict[str, Any]:
        paths, branch = message.paths() if "paths" in message else None, message.branch()
        found = None if branch is None else self._collector.runs.plain_difference(branch, paths)
        if found is None:
            raise _no_branch()
        return found

    def _plot(self, message: Message) -> dict[str, Any]:
        found = self._collector.runs.plots(
            message.paths(),
            message.time("from"),
            message.time("to"),
            int(message.number("points", 1, _MOST_POINTS, 800)),
            message.branch(),
        )
        if found is None:
            raise _no_branch()
        return {"series": found}


def _no_branch() -> CommandError:
    return CommandError("This branch is no longer kept.")
