"""The files of a recording: ``NAME.jsonl`` is its script, ``NAME.trace.jsonl`` beside it what the robot did."""

from __future__ import annotations

import errno
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...passes.written import note_written
from ...processes.exit import before_sudden_exit
from ..robot import RobotRun
from .recorder import Recorder
from .script import trace_beside
from .trace import Trace

#: The bytes of a trace that are written at once: a robot with hundreds of values has some kilobytes in each packet.
_BUFFER = 1 << 17


@contextmanager
def traced(run: RobotRun, file: Path) -> Iterator[Trace]:
    """Write down what the robot does while this lasts. The run is open, and not started."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with _full_disk_named(file), file.open("w", buffering=_BUFFER, encoding="utf-8") as out:
        trace = Trace(run.hal_data, out)

        def write() -> None:
            trace.write_lines()
            out.flush()

        run.observe(trace.look)
        before_sudden_exit["trace"] = write
        try:
            yield trace
        finally:
            before_sudden_exit.pop("trace", None)  # robot code may have forked this process
            trace.write_lines()
        trace.finish()
        note_written(file)


@contextmanager
def _full_disk_named(file: Path) -> Iterator[None]:
    """Name the file in the error of a full disk, which names none."""
    try:
        yield
    except OSError as error:
        if error.errno == errno.ENOSPC and error.filename is None:
            error.filename = str(file)
        raise


@contextmanager
def recorded(run: RobotRun, file: Path, robot: str, seed: int) -> Iterator[None]:
    """Record a run while this lasts: its script, and its trace beside that. The run is open, and not started."""
    recorder = Recorder(run)
    with traced(run, trace_beside(file)) as trace:
        try:
            yield
        finally:
            recorder.script(robot, seed, trace.digest()).save(file)
            note_written(file)
