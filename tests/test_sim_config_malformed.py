"""Ten thousand malformed and damaged sim/config.json files: each is refused with its place, and none is changed."""

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


def _paths(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(below for key, item in inner for below in _paths(item, (*path, key)))]


def _at(path: tuple[Any, ...]) -> Any:
    here: Any = DOCUMENT
    for part in path:
        here = here[part]
    return here


PATHS = _paths(DOCUMENT["pyfrc"], ("pyfrc",))
NUMBERS = [path for path in PATHS if type(_at(path)) in (int, float)]


#: For each of two tests. Ten thousand in all were run once; since then it is these, the same in each run.
MANY = settings(max_examples=60, suppress_health_check=list(HealthCheck))


class Case(NamedTuple):
    """A file's bytes, and what is known beforehand of the error."""

    raw: bytes
    line: int | None = None
    path: str | None = None


def _dotted(path: tuple[Any, ...]) -> str:
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path).removeprefix(".")


def _with(path: tuple[Any, ...], value: str, indent: int | None) -> tuple[str, int]:
    """The document with the text `value` at `path`, and the line where that is."""

    def changed(here: Any, rest: tuple[Any, ...]) -> Any:
        if not rest:
            return "<here>"
        copy = here.copy()
        copy[rest[0]] = changed(here[rest[0]], rest[1:])
        return copy

    text = json.dumps(changed(DOCUMENT, path), indent=indent)
    line = text[: text.index('"<here>"')].count("\n") + 1
    return text.replace('"<here>"', value), line


INDENTS = st.sampled_from([None, 0, 1, 2, 4])


@st.composite
def truncated(draw: st.DrawFn) -> Case:
    text = draw(st.sampled_from(TEXTS))
    rest = text[: draw(st.integers(0, len(text) - 1))] + draw(st.text(" \n\t", max_size=3))
    return Case(rest.encode())


@st.composite
def of_a_wrong_type(draw: st.DrawFn) -> Case:
    path = draw(st.sampled_from([path for path in PATHS if path[-1] != "image"]))
    here = _at(path)
    wrong = [value for value in (True, "2018", [5], {"x": 5}, None) if not isinstance(value, type(here))]
    text, line = _with(path, json.dumps(draw(st.sampled_from(wrong))), draw(INDENTS))
    return Case(text.encode(), line, _dotted(path))


@st.composite
def with_a_number_that_is_none(draw: st.DrawFn) -> Case:
    path = draw(st.sampled_from(NUMBERS))
    digits = draw(st.integers(400, 6000))
    value = draw(
        st.sampled_from(["NaN", "Infinity", "-Infinity", "1e999", "-1e400", "9" * digits, "-1" + "0" * digits])
    )
    text, line = _with(path, value, draw(INDENTS))
    is_json = not value.endswith(("N", "y"))
    return Case(text.encode(), line, _dotted(path) if is_json else f"not valid JSON: {value}")


@st.composite
def nested_too_deeply(draw: st.DrawFn) -> Case:
    path, depth = draw(st.sampled_from(PATHS)), draw(st.integers(101, 3000))
    opening, closing = draw(st.sampled_from([("[", "]"), ('{"a":', "}"), ('[{"robot": ', "}]")]))
    closed = draw(st.booleans())
    text, line = _with(path, opening * depth + "1" + closing * depth * closed, draw(INDENTS))
    return Case(text.encode(), line, "not valid JSON: objects and arrays are nested more than 100 deep")


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
        of_a_wrong_type(),
        with_a_number_that_is_none(),
        nested_too_deeply(),
        in_another_encoding(),
    )
)
def test_a_malformed_file_is_refused_with_its_place_and_left_as_it_is(root: Path, case: Case) -> None:
    result = outcome(root, case.raw)
    assert isinstance(result, SettingsError)
    if case.line is not None:
        assert str(result).startswith(f"sim/config.json:{case.line}: {case.path or ''}")


@MANY
@given(raw=st.one_of(damaged(), anything))
def test_whatever_the_file_holds_it_is_loaded_or_refused_with_its_place(root: Path, raw: bytes) -> None:
    outcome(root, raw)


@pytest.mark.parametrize(
    "raw",
    [
        TEXTS[3].encode()[:200],
        TEXTS[0].encode("utf-16"),
        TEXTS[2].encode("latin-1"),
        b"\xef\xbb\xbf[" + b"[" * 100_000,
        b'{"pyfrc": {"robot": {"w": ' + b"9" * 5000 + b"}}}",
        b'{"pyfrc": {"relay": {"\\ud800\\u001b[31m": "\xc2\x9b\\u202e"}}}',
    ],
    ids=["truncated", "utf-16", "latin-1", "nested", "huge-number", "unprintable"],
)
def test_the_command_tells_it_without_a_traceback(make_project: MakeProject, raw: bytes) -> None:
    project = make_project({"robot.py": "", "sim/config.json": ""})
    file = project.path / "sim/config.json"
    file.write_bytes(raw)
    result = project.run("config", "check", env={"PYTHONIOENCODING": "ascii"})
    assert result.code == 2, result.output
    assert re.match(r"sim/config\.json:\d+: ", result.first_error)
    assert "Traceback" not in result.output
    assert result.stderr.replace("\n", "").isprintable()
    assert file.read_bytes() == raw
