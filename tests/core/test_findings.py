"""Mistakes in files of settings: their place, the path of a key, and the sentence."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pydantic
import pytest

from pyfrc_core.config.findings import Finding, dotted, in_order, mistakes, settings_error, shortened
from pyfrc_core.errors import SettingsError


def test_the_place_of_a_finding() -> None:
    one, two = Finding("a.json", 7, "wrong", "Correct it."), Finding("a.json", None, "odd")
    assert [each.where for each in (one, two)] == ["a.json:7", "a.json"]
    assert [str(each) for each in in_order([one, two])] == ["a.json: odd", "a.json:7: wrong\n  Correct it."]
    single, both = settings_error([one]), settings_error([one, two])
    assert isinstance(both, SettingsError)
    assert (single.where, single.message, single.remedy) == ("a.json:7", "wrong", "Correct it.")
    assert (both.where, both.message) == ("a.json:7", "wrong\n  Correct it.\na.json: odd")


def test_the_path_of_a_key() -> None:
    paths: dict[str, tuple[Any, ...]] = {
        "pyfrc.robot[0].x": ("pyfrc", "robot", 0, "x"),
        "['a b'].c": ("a b", "c"),
        "a['\\xe4.']": ("a", "ä."),
        "": (),
    }
    assert {dotted(path): path for path in paths.values()} == paths
    assert shortened("a\n\x00b") == "a \\x00b"
    assert shortened("x" * 61) == "x" * 60 + "... (61 characters)"
    assert shortened("x" * 60) == "x" * 60


def test_each_mistake_is_a_sentence_with_its_place() -> None:
    class Part(pydantic.BaseModel, extra="forbid", strict=True):
        size: int
        name: str = ""

    class Whole(pydantic.BaseModel, extra="forbid", strict=True):
        part: Part
        pair: tuple[int, int] = (0, 0)

    def found(data: Any) -> list[str]:
        document: Any = SimpleNamespace(name="a.toml", line_of=len, excerpt=lambda path, value: repr(value))
        with pytest.raises(pydantic.ValidationError) as invalid:
            Whole.model_validate(data)
        known = {("part",): ["size", "name"]}
        return [str(each) for each in mistakes(invalid.value, data, document, ("tool",), known)]

    (unknown,) = found({"part": {"size": 1, "nane": ""}})
    assert unknown.startswith("a.toml:3: unknown key 'tool.part.nane'\n  ")
    assert "name" in unknown.partition("\n")[2]
    assert found({"part": {}}) == ["a.toml:3: tool.part: the key 'size' is missing"]
    assert found({"part": {"size": 1}, "pair": (1,)}) == ["a.toml:3: tool.pair: item 2 is missing"]
    (wrong,) = found({"part": {"size": "x"}})
    assert wrong.startswith("a.toml:3: tool.part.size = 'x': ")
