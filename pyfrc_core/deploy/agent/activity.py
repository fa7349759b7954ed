"""Keep-alive messages: they let the laptop distinguish a busy agent from a lost connection."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

#: Seconds after which a blocking system call no longer counts as progress.
_MAX_CALL_SECONDS = 600.0


class Activity:
    """Report the agent's progress to the laptop about once a second.

    A keep-alive message is sent only if work was done since the previous one, or during a blocking system call. An
    agent that hangs sends none.

    :param send:  sends a message
    :param clock: a monotonic clock, in seconds
    :param pause: seconds between two messages
    """

    def __init__(
        self, send: Callable[..., None], clock: Callable[[], float] = time.monotonic, pause: float = 1.0
    ) -> None:
        self._send = send
        self._clock = clock
        self._pause = pause
        self._last = clock()
        self._phase = ""
        self._count = self._of = 0

    def reset(self) -> None:
        """Start a new request: its first keep-alive message is due after `pause` seconds."""
        self._last = self._clock()

    def begin(self, phase: str, of: int = 0) -> None:
        """Start a phase.

        :param phase: its name in the protocol
        :param of:    its number of steps; 0 if unknown
        """
        self._phase, self._count, self._of = phase, 0, of

    def step(self, count: int = 1) -> None:
        """Add completed steps. Zero means that part of the next step is done."""
        self._count += count
        now = self._clock()
        if now - self._last >= self._pause:
            self._last = now
            self._send(alive={"phase": self._phase, "count": self._count, "of": self._of})

    def wait_for(self, call: Callable[..., Any], *args: Any) -> Any:
        """Run a call that may block for long, such as ``syncfs``, and return its result.

        The call runs in a separate thread; messages are sent from the current one.
        """
        self.step(0)
        outcome: list[Any] = []
        failure: list[BaseException] = []

        def run() -> None:
            try:
                outcome.append(call(*args))
            except BaseException as error:
                failure.append(error)

        thread = threading.Thread(target=run, daemon=True)
        began = self._clock()
        thread.start()
        try:
            while thread.is_alive():
                thread.join(self._pause)
                if self._clock() - began < _MAX_CALL_SECONDS:
                    self.step(0)
        finally:
            thread.join()  # even after a lost connection: the deploy lock must not be released before the call ends
        if failure:
            raise failure[0]
        return outcome[0]
