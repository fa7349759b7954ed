"""Any project gives a report, and what `pyfrc migrate` writes of it is valid Python."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

pytest.importorskip("libcst")

from pyfrc_core.migrate.migration import migrate
from pyfrc_core.migrate.project import why_invalid

from .odd_projects import make_project

#: What is said of a file that is not rewritten. Python 3.12 has a limit that nothing raises.
LEFT = re.compile("LibCST cannot" if sys.version_info[:2] == (3, 12) else "LibCST cannot|nested too deeply")

#: Several tests, which processors share: twenty projects in one took more than its limit on a busy machine. Each piece
#: of code is in a dozen files of these projects, or more. Those of 15 and 16 take 40 s each, by deep nesting.
PARTS = [pytest.param(range(first, first + 5), marks=pytest.mark.slow) for first in range(1, 41, 5)]


@pytest.mark.parametrize("seeds", [range(1), *PARTS], ids=str)
def test_odd_projects(tmp_path: Path, seeds: range) -> None:
    wrong: list[str] = []
    for seed in seeds:
        root = tmp_path / str(seed)
        root.mkdir()
        make_project(root, seed)
        before = {file: file.read_bytes() for file in root.rglob("*.py") if file.is_file()}
        done = migrate(root)
        wrong += [f"{seed}: {each}" for each in done.report.by_hand() if "a mistake of pyfrc" in each.remedy]
        wrong += [f"{seed}: {each}" for each in done.report.by_hand() if LEFT.search(each.what)]
        done.write()
        valid = [file for file, text in before.items() if why_invalid(text) is None]
        wrong += [f"{seed}: {file}" for file in valid if why_invalid(file.read_bytes()) is not None]
        if migrate(root).after:
            wrong.append(f"{seed}: a second run changes {sorted(migrate(root).after)}")
    assert wrong == []
