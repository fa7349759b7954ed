"""What `pyfrc sync` says of pip's output."""

from __future__ import annotations

import pytest

from pyfrc_core.season import CURRENT
from pyfrc_core.sync.addresses import INDEX_VARIABLE
from pyfrc_core.sync.pip_errors import explain


@pytest.mark.parametrize("index", [None, "", "https://mirror.example/simple"])
def test_an_index_without_wpilib_does_not_lead_to_its_placeholders(
    monkeypatch: pytest.MonkeyPatch, index: str | None
) -> None:
    monkeypatch.delenv(INDEX_VARIABLE, raising=False)
    if index is not None:
        monkeypatch.setenv(INDEX_VARIABLE, index)
    printed = (
        f"ERROR: Could not find a version that satisfies the requirement robotpy=={CURRENT.year}.2.2 "
        "(from versions: 0.0.1, 2019.0.0.dev0)\n"
    )
    error = explain(printed, CURRENT)
    assert f"WPILib's wheels of {CURRENT.year} are on {CURRENT.downloads.index}" in error.message
    assert "2019.0.0.dev0" not in str(error)
    if index is not None:
        assert error.remedy == (
            f"{INDEX_VARIABLE} is {index or 'empty'}, so that these wheels were not looked for there. Unset it, or "
            "name a mirror of that index."
        )


def test_another_version_of_the_season_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(INDEX_VARIABLE, "")
    printed = (
        f"ERROR: Could not find a version that satisfies the requirement robotpy-hal=={CURRENT.year}.9 "
        f"(from versions: {CURRENT.year}.1, {CURRENT.year}.2)\n"
    )
    assert f"there are wheels of {CURRENT.year}.1, {CURRENT.year}.2" in explain(printed, CURRENT).message
