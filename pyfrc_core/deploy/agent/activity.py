"""Signs of life: over a silent link, a laptop cannot know an agent that works from one that is gone."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

#: Seconds after which a call to the system is no longer taken for work.
_LONGEST_CALL = 600.0


class Activity:
    """What the agent works on, and how far it is; sent to the laptop about once a second.

    A sign is sent only where work was done since the last one, or while the system is waited for: an agent that hangs
    is silent.

    :param say:   sends a frame
    :param clock: seconds that only grow
    :param pause: seconds between two signs
    """

    def __init__(
        self, say: Callable[..., None], clock: Callable[[], float] = time.monotonic, pause: float = 1.0
    ) -> None:
        self._say = say
        self._clock = clock
        self._pause = pause
        self._last = clock()
        self._phase = ""
        self._count = self._of = 0

    def reset(self) -> None:
        """Begin to work on an answer: its first sign is due in a second."""
        self._last = self._clock()

    def begin(self, phase: str, of: int = 0) -> None:
        """Begin a phase.

        :param phase: a word that the laptop knows
        :param of:    how many steps it has; 0: not known
        """
        self._phase, self._count, self._of = phase, 0, of

    def step(self, count: int = 1) -> None:
        """Count steps that are done. With none, something of the next one is done."""
        self._count += count
        now = self._clock()
        if now - self._last >= self._pause:
            self._last = now
            self._say(alive={"phase": self._phase, "count": self._count, "of": self._of})

    def wait_for(self, call: Callable[..., Any], *args: Any) -> Any:
        """Return what a call returns in which the system may be busy for long, such as ``syncfs``.

        It is made in a thread, which no frame is sent from.
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
                if self._clock() - began < _LONGEST_CALL:
                    self.step(0)
        finally:
            thread.join()  # where the laptop is gone, too: what holds the lock then does nothing any more
        if failure:
            raise failure[0]
        return outcome[0]
