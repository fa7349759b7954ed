"""A TCP proxy to the look-alike: it delays, limits, counts and cuts connections."""

from __future__ import annotations

import contextlib
import selectors
import socket
import threading
import time
from collections import deque
from dataclasses import dataclass, field
from types import TracebackType

CHUNK_BYTES = 1448  # bytes: what one packet on the wire carries


@dataclass
class Way:
    """One direction of one connection."""

    source: socket.socket
    target: socket.socket
    to_robot: bool
    #: (when it is due at the other end, the bytes); nothing: the end
    under_way: deque[tuple[float, bytes]] = field(default_factory=deque)
    free_at: float = 0.0
    ended: bool = False
    delivered_end: bool = False


class Proxy:
    """Passes connections on to `target`, until the end of the ``with`` block.

    :param target:         host and port
    :param round_trip:     seconds, half of which each direction takes
    :param rate:           bytes a second, in each direction; none: no limit
    :param cut_to_robot:   cut everything when this many bytes have gone to the robot in all
    :param cut_from_robot: likewise in the other direction
    :param host:           where it listens
    """

    def __init__(
        self,
        target: tuple[str, int],
        *,
        round_trip: float = 0.0,
        rate: float | None = None,
        cut_to_robot: int | None = None,
        cut_from_robot: int | None = None,
        host: str = "127.0.0.1",
        port: int = 0,
    ) -> None:
        self._target = target
        self._delay = round_trip / 2
        self._rate = rate
        self._cut_after = {True: cut_to_robot, False: cut_from_robot}
        self._listener = socket.create_server((host, port))
        self.host, self.port = self._listener.getsockname()[:2]
        #: Bytes that went to the robot, and came from it.
        self.bytes_to_robot = 0
        self.bytes_from_robot = 0
        #: How often the robot responded to new data.
        self.round_trips = 0
        self.connections = 0
        #: Whether the proxy has cut the connection as requested.
        self.has_cut = False
        self._last_to_robot = False
        self._ways: list[Way] = []
        self._selector = selectors.DefaultSelector()
        self._wake, self._woken = socket.socketpair()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._selector.register(self._woken, selectors.EVENT_READ)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def __enter__(self) -> Proxy:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Cut what is left, and listen no more."""
        self._wake.send(b"x")
        self._thread.join()
        for each in (self._listener, self._wake, self._woken):
            each.close()
        self._selector.close()

    def _run(self) -> None:
        try:
            while True:
                now = time.monotonic()
                due = [way.under_way[0][0] for way in self._ways if way.under_way]
                for key, _ in self._selector.select(max(0.0, min(due) - now) if due else None):
                    if key.fileobj is self._woken:
                        return
                    if key.fileobj is self._listener:
                        self._accept()
                    elif key.data in self._ways:
                        self._take(key.data)
                now = time.monotonic()
                for way in list(self._ways):
                    while way in self._ways and way.under_way and way.under_way[0][0] <= now:
                        self._deliver(way, way.under_way.popleft()[1])
        finally:
            self._cut()

    def _accept(self) -> None:
        near, _ = self._listener.accept()
        try:
            far = socket.create_connection(self._target, timeout=5)
        except OSError:
            near.close()
            return
        self.connections += 1
        for each in (near, far):
            each.settimeout(None)
            each.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for way in (Way(near, far, True), Way(far, near, False)):
            self._ways.append(way)
            self._selector.register(way.source, selectors.EVENT_READ, way)

    def _take(self, way: Way) -> None:
        try:
            piece = way.source.recv(CHUNK_BYTES)
        except OSError:
            piece = b""
        if not piece:
            self._selector.unregister(way.source)
            way.ended = True
        now = time.monotonic()
        start = max(now, way.free_at)
        way.free_at = start + (len(piece) / self._rate if self._rate else 0.0)
        way.under_way.append((way.free_at + self._delay, piece))

    def _deliver(self, way: Way, piece: bytes) -> None:
        limit = self._cut_after[way.to_robot]
        so_far = self.bytes_to_robot if way.to_robot else self.bytes_from_robot
        cut = limit is not None and so_far + len(piece) >= limit
        if cut:
            piece = piece[: limit - so_far]  # type: ignore[operator]
        if piece:
            if way.to_robot:
                self.bytes_to_robot += len(piece)
            else:
                self.bytes_from_robot += len(piece)
                self.round_trips += self._last_to_robot
            self._last_to_robot = way.to_robot
        with contextlib.suppress(OSError):
            if piece:
                way.target.sendall(piece)
            else:
                way.target.shutdown(socket.SHUT_WR)
                way.delivered_end = True
        if cut:
            self.has_cut = True
            self._cut()
            return
        pair = [each for each in self._ways if each.source in (way.source, way.target)]
        if all(each.delivered_end for each in pair):
            self._close(pair)

    def _cut(self) -> None:
        self._close(list(self._ways))

    def _close(self, ways: list[Way]) -> None:
        for way in ways:
            self._ways.remove(way)
            if not way.ended:
                self._selector.unregister(way.source)
        for way in ways:
            with contextlib.suppress(OSError):
                way.source.close()
