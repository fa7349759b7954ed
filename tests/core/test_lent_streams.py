"""Standard streams that are lent to robot code: whatever it does to them, the command prints to its own."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest

from pyfrc_core.processes.lent_streams import lent_streams, print_error


class Recorder:
    """As robots have them: in place of the stream, and with other attributes."""

    def __init__(self, stream: Any) -> None:
        self.stream = stream
        self.buffer = ""

    def write(self, text: str) -> None:
        self.stream.write(text)
        self.buffer = text

    def flush(self) -> None:
        self.stream.flush()


def record() -> None:
    sys.stdout, sys.stderr = Recorder(sys.stdout), Recorder(sys.stderr)
    print("recorded")


def record_both_names() -> None:
    sys.stdout = sys.__stdout__ = sys.stderr = sys.__stderr__ = Recorder(sys.stdout)  # type: ignore
    print("recorded")


def remove() -> None:
    sys.stdout = sys.stderr = None


def close() -> None:
    sys.stdout.close()
    sys.stderr.close()


def close_both_names() -> None:
    assert sys.__stdout__ is sys.stdout
    assert sys.__stderr__ is sys.stderr
    sys.__stdout__.close()
    sys.__stderr__.close()


def keep_in_a_handler() -> None:
    handler = logging.StreamHandler(sys.stdout)
    sys.stdout = Recorder(sys.stdout)
    handler.emit(logging.makeLogRecord({"msg": "recorded"}))


@contextmanager
def printing_to(directory: Path) -> Iterator[None]:
    """Have this process's streams be files, as they are without pytest."""
    with pytest.MonkeyPatch.context() as patch, ExitStack() as files:
        for name in ("stdout", "stderr"):
            stream = files.enter_context((directory / name).open("w", encoding="utf-8"))
            patch.setattr(sys, name, stream)
            patch.setattr(sys, f"__{name}__", stream)
        yield


@pytest.mark.parametrize(
    ("what", "recorded"),
    [
        (record, "recorded\n"),
        (record_both_names, "recorded\n"),
        (remove, ""),
        (close, ""),
        (close_both_names, ""),
        (keep_in_a_handler, "recorded\n"),
    ],
)
def test_what_robot_code_does_to_the_streams_is_undone(tmp_path: Path, what: Callable[[], None], recorded: str) -> None:
    with printing_to(tmp_path):
        before = sys.stdout, sys.stderr, sys.__stdout__, sys.__stderr__
        print("before")
        with lent_streams():
            print("in between")
            what()
            print_error("an error meanwhile")
        assert (sys.stdout, sys.stderr, sys.__stdout__, sys.__stderr__) == before
        print("afterwards")
        print_error("an error afterwards")
    assert (tmp_path / "stdout").read_text("utf-8") == f"before\nin between\n{recorded}afterwards\n"
    assert (tmp_path / "stderr").read_text("utf-8") == "an error meanwhile\nan error afterwards\n"
