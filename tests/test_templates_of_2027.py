"""The templates of 2027 are what `pyfrc migrate` makes of those of 2026, changed by one small patch each."""

from __future__ import annotations

import re

import pytest

pytest.importorskip("libcst")

from make_2027 import NAMES, OF_2027, PATCHES, PatchError, apply_patch, reasons, template_of_2027, texts

#: How many lines a patch may remove and add. What more templates need, `pyfrc migrate` or the template itself can do.
SMALL = 10


@pytest.mark.parametrize("name", NAMES)
def test_it_is_what_migrate_and_its_patch_make(name: str) -> None:
    made, there = template_of_2027(name), texts(OF_2027 / name)
    assert made == there, "Run `make templates-2027`, and commit the difference if it is right (CONTRIBUTING.md)."


@pytest.mark.parametrize("file", sorted(PATCHES.glob("templates/*")), ids=lambda file: file.stem)
def test_a_patch_is_small_and_gives_its_reasons(file) -> None:
    assert file.stem in NAMES
    assert reasons(f"templates/{file.stem}").strip()
    changed = re.findall(r"^[-+](?![-+])", file.read_text("utf-8"), flags=re.MULTILINE)
    assert len(changed) <= SMALL


def test_a_patch_that_does_not_fit_is_said_with_its_lines() -> None:
    with pytest.raises(PatchError, match=r"(?s)tank\.patch does not fit robot\.py any more:\n.*Selectable"):
        apply_patch("templates/tank", {"robot.py": "import wpilib\n"})
