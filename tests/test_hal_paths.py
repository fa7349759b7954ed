"""The language of places."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from loops import for_each

from pyfrc_core.hal import format_path, parse_path

SEGMENTS = st.lists(st.text(st.characters(codec=None)) | st.integers(), min_size=1)


@given(SEGMENTS)
def test_what_is_formatted_is_parsed_back(segments: list[str | int]) -> None:
    assert parse_path(format_path(segments)) == tuple(segments)


@for_each(
    "path, segments",
    [
        ("alliance_station", ("alliance_station",)),
        ("joysticks[0].axes[1]", ("joysticks", 0, "axes", 1)),
        ('CAN["SPARK MAX [3]"].Velocity', ("CAN", "SPARK MAX [3]", "Velocity")),
        ("CAN['SPARK MAX [3]'].Velocity", ("CAN", "SPARK MAX [3]", "Velocity")),
        ("pcm[0][7].value", ("pcm", 0, 7, "value")),
        ('["odd key"]', ("odd key",)),
    ],
)
def test_paths(path: str, segments: tuple[str | int, ...]) -> None:
    assert parse_path(path) == segments


@for_each(
    "path, wrong",
    [
        ("", "empty"),
        ("pwm[", r"'\['"),
        ("pwm[0]value", "'value'"),
        ("pwm..value", r"'\.\.value'"),
        ("pwm[0].", r"'\.'"),
        (".pwm", r"'\.pwm'"),
        ("pwm[x]", r"'\[x\]'"),
        ("pwm 3", "' 3'"),
        (r'CAN["\q"]', "CAN"),
    ],
)
def test_a_text_that_is_no_path_says_where_it_goes_wrong(path: str, wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        parse_path(path)
