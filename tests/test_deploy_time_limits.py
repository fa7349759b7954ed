"""Time limits for the robot's messages: until a frame begins, for a frame, and for a response."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator

import pytest
from loops import for_each

from pyfrc_core.deploy.agent import wire
from pyfrc_core.deploy.agent_stream import AgentStream, TimeLimits
from pyfrc_core.deploy.errors import ConnectionFailedError
from pyfrc_core.deploy.responses import value_of
from pyfrc_core.deploy.targets.roborio import ROBORIO

LIMITS = TimeLimits(start=20, silence=60, frame=30, response=900)
ALIVE = wire.message_frame({"alive": True})
DONE = wire.message_frame({"done": {"release": 7}})


def release(done: object) -> int:
    """Return the field that these tests expect in a response."""
    return value_of(done, "release", int)


class Clock:
    """Seconds, which only waiting lets pass."""

    now = 1000.0

    def __call__(self) -> float:
        return self.now


class SlowChannel:
    """A channel from which pieces come, each after some seconds."""

    def __init__(self, clock: Clock, pieces: Iterable[tuple[float, bytes]], ready: bytes = b"") -> None:
        self._clock = clock
        self._pieces: Iterator[tuple[float, bytes]] = iter(pieces)
        self._rest = ready
        self._patience = 0.0
        self.status_event = threading.Event()

    def settimeout(self, seconds: float | None) -> None:
        assert seconds is not None, "each wait has a limit"
        self._patience = seconds

    def recv(self, count: int) -> bytes:
        if not self._rest:
            wait, self._rest = next(self._pieces, (1e9, b""))
            if wait > self._patience:
                self._clock.now += self._patience
                raise TimeoutError
            self._clock.now += wait
        piece, self._rest = self._rest[:count], self._rest[count:]
        return piece

    def recv_ready(self) -> bool:
        return bool(self._rest)

    def sendall(self, data: bytes) -> None: ...
    def recv_stderr(self, count: int) -> bytes:
        return b""

    def recv_exit_status(self) -> int:
        return -1

    def close(self) -> None: ...


def stream_of(*pieces: tuple[float, bytes], clock: Clock | None = None) -> AgentStream:
    clock = clock or Clock()
    return AgentStream(SlowChannel(clock, pieces), "10.12.34.2", ROBORIO.python, LIMITS, clock)


def dripping(frame: bytes, seconds: float) -> list[tuple[float, bytes]]:
    return [(seconds, frame[place : place + 1]) for place in range(len(frame))]


def test_keep_alive_messages_extend_the_wait_and_are_skipped() -> None:
    stream = stream_of(*[(50.0, ALIVE)] * 10, (50.0, DONE))
    assert stream.read_response(release) == 7


@for_each(
    "pieces, seconds, why",
    [
        ([], 60, "no response"),
        ([(50, ALIVE), (61, DONE)], 50 + 60, "no response"),
        (dripping(wire.frame(wire.MESSAGE, bytes(1000)), 5.0), 5 + 30, "its response is incomplete"),
        ([(59, DONE[:3])], 59 + 30, "its response is incomplete"),
        ([(50, ALIVE)] * 1000, 900, "it works, but exceeds the time limit"),
        (
            [(10, wire.message_frame({"phase": "compile"}))] * 1000,
            900,
            "it works, but exceeds the time limit",
        ),
    ],
)
def test_each_limit_holds(pieces: list[tuple[float, bytes]], seconds: float, why: str) -> None:
    clock = Clock()
    with pytest.raises(ConnectionFailedError, match=f"the connection to the robot was lost: {why}"):
        stream_of(*pieces, clock=clock).read_response(release, lambda said: None)
    assert clock.now == pytest.approx(1000 + seconds, abs=5)


def test_keep_alive_messages_while_contents_are_sent_are_skipped_and_the_rest_is_kept() -> None:
    clock = Clock()
    for ready, news in ((ALIVE + ALIVE, False), (ALIVE + DONE, True)):
        stream = AgentStream(SlowChannel(clock, [(0, DONE)], ready), "10.12.34.2", ROBORIO.python, LIMITS, clock)
        assert stream.has_message() is news
        assert stream.read_response(release) == 7
