"""Make `table.json` from the packages of two seasons.

Run it with the site-packages directories of environments that have each season's packages; none of them is imported.
After `--`, those of the new season:

    python -m tools.names.make_table .venv/lib/python3.11/site-packages -- .venv27/lib/.../site-packages

It was made from wpilib 2026.2.2, robotpy-rev 2026.0.4 and phoenix6 26.3.0, and from wpilib 2027.0.0a7, robotpy-rev
2027.0.0a7.post1 and phoenix6 26.70.0a2.

A correction that names what is not there is an error, so that corrections do not outlive what they correct.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from pyfrc_core.season.names.table import HERE, corrections

from .compare import compare
from .packages import Class, Packages


def main(old_sites: list[Path], new_sites: list[Path]) -> int:
    """Write the table, and return 1 if a correction is wrong."""
    old, new = Packages(*old_sites), Packages(*new_sites)
    old.read()
    new.read()
    moved = corrections()["moved"]
    wrong = [path for path in moved if not _exists(old, path)]
    wrong += [path for path in moved.values() if "." in path and not _exists(new, path)]
    for path in wrong:
        print(f"corrections.toml: there is no {path}", file=sys.stderr)
    text = json.dumps(compare(old, new, moved), indent=0, sort_keys=True)
    (HERE / "table.json").write_text(text + "\n", encoding="utf-8")
    return 1 if wrong else 0


def _exists(packages: Packages, path: str) -> bool:
    outer, _, name = path.rpartition(".")
    owner = packages.entries.get(outer)
    inside = isinstance(owner, Class) and name in owner.members
    return path in packages.entries or path in packages.aliases or inside


if __name__ == "__main__":
    cut = sys.argv.index("--")
    sys.exit(main([Path(each) for each in sys.argv[1:cut]], [Path(each) for each in sys.argv[cut + 1 :]]))
