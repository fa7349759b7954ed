"""Compare releases with what was deployed. A disk may damage a file, and releases share files."""

from __future__ import annotations

from .disk import different_files, remove, replace_by_link
from .releases import Releases

#: Files that a program does not change itself.
_CODE = (".py", ".pyc", ".so")


def compiled_files(releases: Releases) -> dict[str, str]:
    """Return the hashes of all releases' compiled files, as they were made, by their paths."""
    return {
        f"{directory}/{path}": sha256
        for number in releases.numbers()
        for directory in [releases.directory(number).resolve()]
        for path, sha256 in releases.record(number).get("compiled", {}).items()
    }


def different_in_release(releases: Releases, number: int) -> list[str]:
    """Return the deployed and compiled files of a release that are missing, or differ from what was deployed."""
    record, directory = releases.record(number), releases.directory(number)
    deployed = record.get("files", {})
    files = {**record.get("compiled", {}), **deployed}
    releases.activity.begin("check", len(files))
    different = different_files(directory, files, releases.activity, {})
    return [path for path in different if path in deployed or (directory / path).exists()]


def different_code(releases: Releases) -> list[str]:
    """Return the code that differs from what was deployed or installed: of the current release, and of packages."""
    current, installed = releases.current(), releases.environments.damaged()
    found = [] if current is None else different_in_release(releases, current)
    packages = {path for paths in installed.values() for path in paths}
    return [*(path for path in found if path.endswith(_CODE)), *sorted(packages)]


def mend_releases(releases: Releases, number: int) -> None:
    """Replace files that differ from what was deployed, in all other releases, as far as this one has them.

    Compiled files that differ are removed: the program compiles them when it imports them.
    """
    good, directory = releases.record(number)["files"], releases.directory(number)
    for other in releases.numbers():
        files = releases.record(other).get("files", {})
        for path in different_in_release(releases, other) if other != number else ():
            if path not in files:
                remove(releases.directory(other) / path)
            elif files[path] == good.get(path):
                replace_by_link(directory / path, releases.directory(other) / path)
