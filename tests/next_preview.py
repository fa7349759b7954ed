"""What another preview of 2027 changes: which names of WPILib's packages, and which tests of season 2027 fail with it.

    make next-preview                              # the newest preview, beside the one that pyfrc is written for
    make next-preview ARGS="--since 2027.0.0a6"    # beside another one; --names: without the tests

`make` installs the newest preview that the index has in a new environment, and runs this there. Of the former one, only
the packages with names for robot code are unpacked; names are read from stubs, and nothing is imported. What follows
these options is passed to pytest. The exit code is that of the tests. CONTRIBUTING.md says how to move on to the new
preview.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import sysconfig
from importlib.metadata import packages_distributions, version
from pathlib import Path
from tempfile import TemporaryDirectory

from pyfrc_core.season.season_2027 import SEASON_2027
from tools.names.packages import PACKAGES, Class, Entry, Function, Packages


def main(arguments: list[str]) -> int:
    """Run the tests, print what has changed, and return the exit code."""
    parser = argparse.ArgumentParser(prog="make next-preview")
    parser.add_argument("--since", default=SEASON_2027.packages.wpilib, help="the former preview (%(default)s)")
    parser.add_argument("--names", action="store_true", help="only compare the names")
    options, for_pytest = parser.parse_known_args(arguments)
    code = 0
    if not options.names:
        tests = [sys.executable, "-m", "pytest", "-n", "auto", "--dist", "worksteal", *for_pytest]
        code = subprocess.run(tests, check=False).returncode
    with TemporaryDirectory() as former:
        compared, missing = _unpack(options.since, Path(former))
        changes = differences(names_in(Path(former), compared), names_in(_installed(), compared))
    print(f"\n== names: {options.since} beside wpilib {version('wpilib')}: {len(changes)} changes")
    print("\n".join(changes))
    for package in missing:
        print(f"not compared, since the index has no such preview of it for this system: {package}")
    return code


def _installed() -> Path:
    return Path(sysconfig.get_path("purelib"))


def _unpack(preview: str, directory: Path) -> tuple[list[str], list[str]]:
    """Unpack a preview of the installed packages of this season.

    :returns: the importable packages that can be compared, and the distributions that cannot
    """
    distributions = packages_distributions()
    compared, missing = [], []
    for package in PACKAGES:
        for name in distributions.get(package, []):
            if not version(name).startswith(f"{SEASON_2027.year}."):
                continue
            wanted = f"{name}>={preview},<={preview}.post999"
            pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", str(directory), wanted]
            done = subprocess.run(pip, capture_output=True, check=False)
            (missing if done.returncode else compared).append(name if done.returncode else package)
    return compared, missing


def names_in(site: Path, packages: list[str]) -> dict[str, str]:
    """Return what packages in a directory have for robot code: a short description of each name by its path."""
    found = Packages(site)
    found.read()
    described: dict[str, str] = {}
    for path, entry in found.entries.items():
        if path.partition(".")[0] in packages and ".version." not in path:
            _describe(path, entry, described)
    return described | {path: f" is {of}" for path, of in found.aliases.items() if path.partition(".")[0] in packages}


def _describe(path: str, entry: Entry, described: dict[str, str]) -> None:
    if isinstance(entry, Function):
        described[path] = f"({', '.join(entry.parameters)})" + (f" -> {entry.returns}" if entry.returns else "")
    elif isinstance(entry, Class):
        described[path] = f"({', '.join(entry.bases)})" if entry.bases else ""
        for name, member in entry.members.items():
            if not name.startswith("_") or name == "__init__":
                _describe(f"{path}.{name}", member, described)
    else:
        described[path] = f": {entry.type}" if entry.type else ""


def differences(before: dict[str, str], after: dict[str, str]) -> list[str]:
    """Return a line for each name that is gone, new, or another one; not for the parts of what is gone or new."""
    lines = []
    for path in sorted(before.keys() | after.keys()):
        owner = path.rpartition(".")[0]
        if path not in after:
            if owner not in before or owner in after:
                lines.append(f"- {path}{before[path]}")
        elif path not in before:
            if owner not in after or owner in before:
                lines.append(f"+ {path}{after[path]}")
        elif before[path] != after[path]:
            lines.append(f"~ {path}{before[path]}  is now  {after[path].strip() or 'of another kind'}")
    return lines


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
