"""The journal of a fuzzed match: its steps survive the end of the process, in the order in which they were added."""

from __future__ import annotations

import subprocess
import sys
from contextlib import closing
from pathlib import Path

from pyfrc_core.fuzz.journal import Journal, read_journal
from pyfrc_core.runtime.scripts.script import Step

STEPS = [Step(0, {"mode": "teleop"}), Step(20_000, {"joysticks[0].axes[1]": -0.5, "nt:/a": (1, "b")}), Step(40_000, {})]


def test_a_journal_has_the_steps_of_a_process_that_was_killed(tmp_path: Path) -> None:
    file = tmp_path / "journal"
    code = f"""if True:
        import os
        from pathlib import Path
        from pyfrc_core.fuzz.journal import Journal
        from pyfrc_core.runtime.scripts.script import Step
        journal = Journal(Path({str(file)!r}))
        for step in {STEPS!r}:
            journal.add(step)
        os._exit(3)
    """
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 3
    assert list(read_journal(file)) == STEPS


def test_the_next_boot_of_a_match_goes_on_with_its_journal(tmp_path: Path) -> None:
    file = tmp_path / "journal"
    with closing(Journal(file)) as journal:
        journal.add(STEPS[0])
    with closing(Journal(file)) as journal:
        journal.add(STEPS[1])
        journal.add(STEPS[2])
    assert list(read_journal(file)) == STEPS


def test_a_journal_grows(tmp_path: Path) -> None:
    file = tmp_path / "journal"
    steps = [Step(at_us, {"nt:/text": "x" * at_us}) for at_us in (10, 60_000, 70_000, 1, 300_000)]
    with closing(Journal(file)) as journal:
        for step in steps:
            journal.add(step)
        assert list(read_journal(file)) == steps


def test_a_match_that_ends_before_its_first_input_has_an_empty_journal(tmp_path: Path) -> None:
    file = tmp_path / "journal"
    assert list(read_journal(file)) == []
    with closing(Journal(file)):
        assert list(read_journal(file)) == []
