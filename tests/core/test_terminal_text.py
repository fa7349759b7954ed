"""What pyfrc prints can be printed on every terminal: no letter is an error."""

from __future__ import annotations

import io
from pathlib import Path
from unittest.mock import patch

import click
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pyfrc_cli import main
from pyfrc_core.disk_space import check_disk_space
from pyfrc_core.errors import PyfrcError
from pyfrc_core.terminal_text import VisibleStream, escape_unencodable

#: The encodings of pipes and of consoles on Windows in America and Western Europe.
ENCODINGS = ["cp1252", "cp437"]


def printed(command: click.Command, encoding: str, errors: str) -> tuple[str, str]:
    """Run a command line whose streams have this encoding, and return what it has printed."""
    streams = [io.TextIOWrapper(io.BytesIO(), encoding, errors, newline="\n") for _ in range(2)]
    with (
        patch("sys.argv", ["pyfrc"]),
        patch("sys.stdout", streams[0]),
        patch("sys.stderr", streams[1]),
        patch.object(main, "cli", command),
        pytest.raises(SystemExit) as ended,
    ):
        main.run()
    assert ended.value.code == 1
    texts = []
    for stream in streams:
        stream.flush()
        assert isinstance(stream.buffer, io.BytesIO)
        texts.append(stream.buffer.getvalue().decode(encoding))
    return texts[0], texts[1]


@pytest.mark.parametrize("errors", ["strict", "surrogateescape"])
@pytest.mark.parametrize("encoding", ENCODINGS)
@given(text=st.text(st.characters(exclude_categories=["Cc"])))
def test_any_text_can_be_printed(encoding: str, errors: str, text: str) -> None:
    @click.command()
    def command() -> None:
        click.echo(f"robot: {text}!")
        print(f"plain: {text}!")
        click.echo(f"warning: {text}!", err=True)
        raise PyfrcError(f"{text}!", where=f"{text}.py:3", remedy=f"Remove {text}!")

    out, err = printed(command, encoding, errors)
    assert (out.count("!"), err.count("!")) == (2 + 2 * text.count("!"), 3 + 4 * text.count("!"))
    if text.isascii():
        assert f"robot: {text}!\nplain: {text}!\n" == out
        assert f"warning: {text}!\nerror: {text}.py:3: {text}!\n  Remove {text}!\n" == err


def test_a_stream_shows_control_characters() -> None:
    written = io.StringIO()
    stream = VisibleStream(written)
    assert stream.write("a\x07") == 5
    stream.flush()
    written.close()
    stream.flush()  # nothing is left of it
    file = io.TextIOWrapper(io.BytesIO(), "cp437")
    assert VisibleStream(file).encoding == "cp437"


@pytest.mark.parametrize(("errors", "after"), [("strict", "backslashreplace"), ("replace", "replace")])
def test_only_a_stream_that_would_raise_an_error_is_changed(errors: str, after: str) -> None:
    stream = io.TextIOWrapper(io.BytesIO(), "ascii", errors)
    escape_unencodable(stream)
    assert stream.errors == after
    escape_unencodable(io.StringIO())


def test_why_nothing_can_be_written_beside_a_file(tmp_path: Path) -> None:
    assert check_disk_space(tmp_path / "a.wpilog") == ""
    assert check_disk_space(tmp_path / "none" / "a.wpilog") == "No such file or directory"
    assert list(tmp_path.iterdir()) == []
