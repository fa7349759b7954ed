"""Interpreters that are used again while they are as good as new: where processes cannot be forked.

One is started for each piece of work that runs at the same time. While each is as good as new after its work, there
are no more than these. From the first on that is not, others are started ahead, so that the next work finds one ready.
An interpreter that crashes, or is ended because it hangs, is replaced in the same way.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from ..processors import usable_processors
from .interpreter import Interpreter, Prepare, SpawnedWorker
from .worker import Work


class Interpreters:
    """The interpreters of one command.

    :param prepare: called in each before its first work
    :param ahead: how many to start now, for the first work
    :param keeps_output: whether their workers return what was printed
    """

    def __init__(self, prepare: Prepare, ahead: int = 0, *, keeps_output: bool = False) -> None:
        self._prepare, self._keeps_output = prepare, keeps_output
        #: What the first piece of work has left after which an interpreter was not used again, as far as it is known.
        self.reason = ""
        #: Those that were started ahead, and those that have done their work, which may have left something.
        self._unused: list[Interpreter] = []
        self._used: list[Interpreter] = []
        self._working: dict[SpawnedWorker, Interpreter] = {}
        self._rehearsal: SpawnedWorker | None = None
        #: Files of their work that could not be removed: `close` does it.
        self.left: list[Path] = []
        self._start_ahead(ahead)

    def begin(self, work: Work, more: int = 0) -> SpawnedWorker:
        """Begin a piece of work. Give its worker to `end` afterwards.

        :param more: how many are known to follow
        """
        worker = self._begin(work)
        if self.reason:
            self._start_ahead(min(more, usable_processors()))
        return worker

    def rehearse(self, work: Work) -> None:
        """Do work before all other, whose result is not needed: the libraries that it imports stay."""
        self._rehearsal = self._begin(work)

    def end(self, worker: SpawnedWorker) -> None:
        """Take back the interpreter of a worker, whose result is not needed any more."""
        worker.close()
        self._take_back()
        if (interpreter := self._working.pop(worker, None)) is not None:
            interpreter.close()

    def why_not_again(self) -> str:
        """Return what the first piece of work has left of which that is true; empty if each left nothing."""
        for interpreter in self._used:
            if not self.reason:
                self._note(interpreter.left_over())
        return self.reason

    def close(self) -> None:
        """End all interpreters."""
        for interpreter in (*self._unused, *self._used, *self._working.values()):
            interpreter.close()
        self._unused, self._used, self._working = [], [], {}
        for file in self.left:
            with suppress(OSError):
                file.unlink()

    def _begin(self, work: Work) -> SpawnedWorker:
        interpreter = self._take()
        worker = interpreter.begin(work)
        self._working[worker] = interpreter
        return worker

    def _take_back(self) -> None:
        """Take back interpreters that have done their work, although its result may not have been needed yet."""
        for worker in [worker for worker in self._working if worker.goes_on]:
            self._used.append(self._working.pop(worker))

    def _take(self) -> Interpreter:
        """Return an interpreter that is as good as new, started now if there is none."""
        if self._rehearsal is not None:
            self._rehearsal.interpreter.left_over()  # waits until it is over
            self._rehearsal.poll()
            self.end(self._rehearsal)
            self._rehearsal = None
        self._take_back()
        self._used.sort(key=lambda each: not each.is_restored)
        while self._used and (self._used[0].is_restored or not self._unused):
            interpreter = self._used.pop(0)
            left = interpreter.left_over()
            if left is not None and not left:
                return interpreter
            self._note(left)
            interpreter.close()
        return self._unused.pop(0) if self._unused else self._start()

    def _note(self, left: Sequence[str] | None) -> None:
        self.reason = self.reason or "; ".join(left or ())

    def _start_ahead(self, number: int) -> None:
        while len(self._unused) < number:
            self._unused.append(self._start())

    def _start(self) -> Interpreter:
        return Interpreter(self._prepare, keeps_output=self._keeps_output)
