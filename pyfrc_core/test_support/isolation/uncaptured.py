"""What tests print if pytest captures nothing (``-s``), without what libraries print about themselves."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

import pytest

from ...compat.pytest_private import captures_output
from ...processes.output_pipe import OutputPipe, Stamps

_STANDARD = (1, 2)


class UncapturedOutput:
    """Pipes from the tests' processes to this process's standard output and standard error."""

    def __init__(self) -> None:
        self._pipes = [OutputPipe(partial(_write, descriptor)) for descriptor in _STANDARD]

    def connect_this_process(self) -> None:
        """Let what this process, a fork, prints go through the pipes."""
        for pipe, descriptor in zip(self._pipes, _STANDARD, strict=True):
            os.dup2(pipe.writing_end, descriptor)

    def flush(self) -> None:
        """Wait until everything is printed that was written into the pipes so far."""
        for pipe in self._pipes:
            pipe.flush()

    def close(self) -> None:
        """Print the rest, and remove the pipes."""
        for pipe in self._pipes:
            pipe.close()


@contextmanager
def uncaptured_output(config: pytest.Config) -> Iterator[UncapturedOutput | None]:
    """Create the pipes; None if pytest captures the output, or if a debugger needs the terminal."""
    if captures_output(config) or config.option.usepdb:
        yield None
        return
    output = UncapturedOutput()
    try:
        yield output
    finally:
        output.close()


def _write(descriptor: int, text: str, stamps: Stamps) -> None:
    data = text.encode(errors="replace")
    while data:
        data = data[os.write(descriptor, data) :]
