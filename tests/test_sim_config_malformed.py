"""Malformed and damaged sim/config.json files: each is refused with its place, and none is changed."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from conftest import MakeProject
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pyfrc_core.config.sim_file import LoadedSimConfig, load_sim_config
from pyfrc_core.errors import SettingsError

DOCUMENT: dict[str, Any] = {
    "$schema": "config.schema.json",
    "halsim": {"robot": {"w": 5, "dio": {"1": "not ours"}}},
    "pyfrc": {
        "robot": {
            "w": 2,
            "h": 3.25,
            "starting_x": 2,
            "starting_y": 20,
            "starting_angle": -90,
            "start_positions": [
                {"name": "left", "x": 1, "y": 2, "angle": 0},
                {"name": "Café", "x": 1.5, "y": 20, "angle": 45},
            ],
        },
        "field": {
            "w": 30,
            "h": 27,
            "px_per_ft": 12,
            "image": None,
            "objects": [
                {"color": "red", "rect": [1, 2, 3, 4]},
                {"color": "#0000ff", "points": [[0, 0], [1.5, 0], [1, 1]]},
            ],
            "auto_joysticks": True,
        },
        "game_specific_messages": ["LLL", "RRR"],
        "dio": {"0": "limit", "9": "beam"},
        "CAN": {"12": "[left] {motor}"},
        "joysticks": {"0": {"axes": {"x": "turn", "1": 'speed \\ "fast"'}, "buttons": {"3": "shoot"}}},
    },
}
TEXTS = [json.dumps(DOCUMENT, indent=indent, ensure_ascii=indent == 2) for indent in (None, 0, 1, 2, 4)]


#: For each of two tests. Ten thousand in all were run once; since then it is these, the same in each run.
MANY = settings(max_examples=40, suppress_health_check=list(HealthCheck))


class Case(NamedTuple):
    """A file's bytes, and what is known beforehand of the error."""

    raw: bytes
    line: int | None = None


@st.composite
def truncated(draw: st.DrawFn) -> Case:
    text = draw(st.sampled_from(TEXTS))
    rest = text[: draw(st.integers(0, len(text) - 1))] + draw(st.text(" \n\t", max_size=3))
    return Case(rest.encode())


@st.composite
def in_another_encoding(draw: st.DrawFn) -> Case:
    text = draw(st.sampled_from([text for text in TEXTS if text.isascii() is False]))
    encoding = draw(
        st.sampled_from(["utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-32-le", "utf-32-be", "latin-1", "cp437"])
    )
    line = 1 if encoding.startswith("utf") else text[: text.index("é")].count("\n") + 1
    return Case(text.encode(encoding), line)


@st.composite
def damaged(draw: st.DrawFn) -> bytes:
    raw = draw(st.sampled_from(TEXTS)).encode()
    for _ in range(draw(st.integers(1, 2))):
        start = draw(st.integers(0, len(raw)))
        end = min(len(raw), start + draw(st.integers(0, 8)))
        raw = raw[:start] + draw(st.sampled_from(SCRAPS)) + raw[end:]
    return raw


SCRAPS = [
    *(bytes([byte]) for byte in b"{}[]\",:\\/#' \n\r\t\0\x1b-+.0eE"),
    *(
        b"",
        b"\xff",
        b"\xef\xbb\xbf",
        b"\xed\xa0\x80",
        b"\xc3",
        b"\\ud800",
        b"\\u12",
        b"//",
        b"null",
        b"1e5",
        b'"pyfrc": ',
    ),
]

ANY_JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.text(max_size=3) | st.sampled_from(["robot", "w", "field", "dio", "0", "x"]), inner, max_size=3
        )
    ),
    max_leaves=4,
)
anything = st.one_of(
    st.binary(max_size=40),
    ANY_JSON.map(lambda value: json.dumps(value).encode()),
    ANY_JSON.map(lambda value: json.dumps({"pyfrc": value}).encode()),
)


def outcome(root: Path, raw: bytes) -> LoadedSimConfig | SettingsError:
    """What loading these bytes comes to; whatever it is, the file stays as it is, and an error has its place."""
    file = root / "sim/config.json"
    file.write_bytes(raw)
    before = file.stat()
    result: LoadedSimConfig | SettingsError
    try:
        result = load_sim_config(root)
    except SettingsError as wrong:
        result = wrong
    after = file.stat()
    assert file.read_bytes() == raw
    assert (before.st_mtime_ns, before.st_ino) == (after.st_mtime_ns, after.st_ino)
    assert [path.name for path in file.parent.iterdir()] == ["config.json"]
    told = [str(result)] if isinstance(result, SettingsError) else map(str, result.warnings[:20])
    for text in told:
        place = re.match(r"sim/config\.json:(\d+): \S", text)
        assert place, text
        assert 1 <= int(place[1]) <= raw.count(b"\n") + raw.count(b"\r") + 1
        text.encode()  # a terminal can show it
        assert len(text) < 21 * 300
    return result


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("project")
    (directory / "sim").mkdir()
    return directory


def test_the_undamaged_file_loads(root: Path) -> None:
    for text in TEXTS:
        for mark in (b"", b"\xef\xbb\xbf"):
            loaded = outcome(root, mark + text.encode())
            assert isinstance(loaded, LoadedSimConfig)
            assert loaded.warnings == ()


@MANY
@given(
    case=st.one_of(
        truncated(),
        in_another_encoding(),
    )
)
def test_a_malformed_file_is_refused_with_its_place_and_left_as_it_is(root: Path, case: Case) -> None:
    result = outcome(root, case.raw)
    assert isinstance(result, SettingsError)
    if case.line is not None:
        assert str(result).startswith(f"sim/config.json:{case.line}: ")


@MANY
@given(raw=st.one_of(damaged(), anything))
def test_whatever_the_file_holds_it_is_loaded_or_refused_with_its_place(root: Path, raw: bytes) -> None:
    outcome(root, raw)


def test_the_command_tells_it_without_a_traceback(make_project: MakeProject) -> None:
    project = make_project({"robot.py": "", "sim/config.json": ""})
    file = project.path / "sim/config.json"
    file.write_bytes(b'{"pyfrc": {"relay": {"\\ud800\\u001b[31m": "\xc2\x9b\\u202e"}}}')
    result = project.run("config", "check", env={"PYTHONIOENCODING": "ascii"})
    assert result.code == 2, result.output
    assert re.match(r"sim/config\.json:1: ", result.first_error)
    assert "Traceback" not in result.output
    assert result.stderr.replace("\n", "").isprintable()
