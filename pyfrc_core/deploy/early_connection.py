"""Connecting to the robot in the background, while this computer reads the project."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from types import TracebackType
from typing import TYPE_CHECKING, Generic, TypeVar

if TYPE_CHECKING:
    from .agent_client import AgentClient
    from .connection import Connection
    from .discovery import FoundRobot

T = TypeVar("T")

#: Seconds after which a computing thread lets others run, meanwhile. With Python's 5 ms, each message of the robot
#: would wait so long while this computer imports modules and hashes files.
_SWITCH_INTERVAL = 0.0005


class _Step(Generic[T]):
    """A result that another thread provides, or an error."""

    def __init__(self) -> None:
        self._done = threading.Event()
        self._results: list[T] = []
        self._error: BaseException | None = None

    def run(self, call: Callable[[], T]) -> T:
        try:
            result = call()
        except BaseException as error:
            self._error = error
            raise
        else:
            self._results.append(result)
            return result
        finally:
            self._done.set()

    def result(self) -> T:
        while not self._done.wait(1.0):  # without a limit, Ctrl-C would not end it on Windows
            pass
        if self._error is not None:
            raise self._error
        return self._results[0]


class EarlyConnection:
    """Finds the robot, logs in and starts the agent, in a background thread.

    Each method waits for its step, and raises the errors of the step. The ``with`` block ends with a closed connection.

    :param find: finds the robot
    :param log_in: logs in to the robot that was found
    """

    def __init__(self, find: Callable[[], FoundRobot], log_in: Callable[[FoundRobot], Connection]) -> None:
        self._find = find
        self._log_in = log_in
        self._found = _Step["FoundRobot"]()
        self._connection = _Step["Connection"]()
        self._agent = _Step["AgentClient"]()
        self._lock = threading.Lock()
        self._over = False
        self._to_close: list[Callable[[], object]] = []
        self._switch_interval = sys.getswitchinterval()
        sys.setswitchinterval(_SWITCH_INTERVAL)
        # A daemon thread: after an error in the project, the command does not wait for a robot that is not there.
        threading.Thread(target=self._run, daemon=True).start()

    def found(self) -> FoundRobot:
        """Return the robot that was found."""
        return self._found.result()

    def connection(self) -> Connection:
        """Return the connection, logged in."""
        return self._connection.result()

    def agent(self) -> AgentClient:
        """Return the agent, which waits for `AgentClient.begin`."""
        return self._agent.result()

    def _run(self) -> None:
        with suppress(BaseException):  # `result` raises it
            found = self._found.run(self._find)
            self._close_at_end(found.connected.close)
            connection = self._connection.run(lambda: self._log_in(found))
            self._close_at_end(connection.close)
            from .agent_client import AgentClient  # not before: the login does not need it

            self._agent.run(lambda: AgentClient.open(connection))

    def _close_at_end(self, close: Callable[[], object]) -> None:
        with self._lock:
            if not self._over:
                self._to_close.append(close)
                return
        close()

    def __enter__(self) -> EarlyConnection:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        sys.setswitchinterval(self._switch_interval)
        with self._lock:
            self._over = True
        for close in reversed(self._to_close):
            close()
