"""The wording of reports."""

from __future__ import annotations

from pathlib import Path

import pytest

from pyfrc_core.wording import counted, from_here, size_text, table


def test_the_columns_of_a_table_are_aligned() -> None:
    rows = [("name", "runs", "share", "where"), ("a", "1,000", "5 %", "robot.py"), ("longer", "2", "95 %", "a.py")]
    assert list(table(rows, 1, 1)) == [
        "  name     runs  share  where",
        "  a       1,000    5 %  robot.py",
        "  longer      2   95 %  a.py",
    ]


def test_numbers_have_their_nouns_and_units() -> None:
    assert [counted(1, "line"), counted(2000, "line"), counted(2, "match", "matches")] == [
        "1 line",
        "2,000 lines",
        "2 matches",
    ]
    assert [size_text(each) for each in (9_999, 10_000, 9_999_999, 10_000_000)] == [
        "9999 bytes",
        "10 kB",
        "10000 kB",
        "10.0 MB",
    ]


def test_files_in_the_current_directory_have_short_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert from_here(tmp_path / "sim" / "config.json") == str(Path("sim", "config.json"))
    assert from_here(tmp_path.parent / "other.py") == str(tmp_path.parent / "other.py")
