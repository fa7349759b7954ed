"""Which packages a robot gets: pip itself finds them, as for a computer with the robot's Python and wheels.

pip only reports what it would install (``--dry-run --report``); `download` gets the files.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
from collections.abc import Callable, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit, urlunsplit

from ..compat.pip_private import pip_command
from ..errors import PyfrcError
from ..season import Season
from ..temporary import temporary_directory
from .addresses import file_name_in, index_of
from .lock import LockedFile
from .pip_errors import explain, indexes_in
from .wanted import robot_environment

#: The oldest pip that reports what it would install, for another computer.
_OLDEST_PIP = (23, 0)
#: Settings of the user's for pip that do not fit: they are about installing here.
_NOT_HERE = {"PIP_TARGET", "PIP_PREFIX"}
_OFF = {"PIP_USER": "0", "PIP_REQUIRE_VIRTUALENV": "0", "PIP_DRY_RUN": "0"}
_COLLECTING = re.compile(r"Collecting ([^ =<>!~;\[]+)")


def find_packages(
    requirements: Sequence[str],
    season: Season,
    *,
    constraints: Sequence[str] = (),
    find_links: Sequence[str] = (),
    finding: Callable[[str], None] = lambda package: None,
) -> list[LockedFile]:
    """Return the wheels that meet the requirements on the season's robots, sorted by package.

    Their sizes are 0: unknown. The address may be of a file (``file:``), and the hash is empty if the index has none.

    :param constraints: versions that are to be taken, such as ``six==1.17.0``
    :param find_links:  further places where pip looks: directories and addresses
    :param finding:     is called with each package that pip looks at
    :raises PyfrcError: if there are none, with pip's reason
    """
    if not requirements:
        return []
    _refuse_old_pip()
    with temporary_directory("sync") as temporary:
        report = Path(temporary, "report.json")
        limits = Path(temporary, "constraints.txt")
        limits.write_text("".join(f"{each}\n" for each in constraints), "utf-8")
        arguments = [
            *("install", "--dry-run", "--ignore-installed", "--report", str(report), "--target", temporary),
            *("--disable-pip-version-check", "--no-input", "--no-color", "--progress-bar", "off", "--retries", "2"),
            *("--only-binary", ":all:", "--implementation", "cp", "--abi", season.downloads.abi),
            *("--python-version", season.downloads.python, "--constraint", str(limits)),
            *(part for tag in season.downloads.platforms for part in ("--platform", tag)),
            *(part for place in find_links for part in ("--find-links", place)),
        ]
        if index := index_of(season):
            arguments += ["--extra-index-url", index]
        printed, code = _run(pip_command(robot_environment(season), [*arguments, *requirements]), finding)
        if code != 0 or not report.is_file():
            raise explain(printed, season)
        return _found(json.loads(report.read_text("utf-8")), indexes_in(printed))


def _run(command: Sequence[str], finding: Callable[[str], None]) -> tuple[str, int]:
    kept = {name: value for name, value in os.environ.items() if name not in _NOT_HERE}
    environment = {**kept, **_OFF, "PYTHONUTF8": "1", "PYTHONUNBUFFERED": "1"}
    printed = []
    with subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment
    ) as pip:
        assert pip.stdout is not None
        for raw in pip.stdout:
            line = raw.decode("utf-8", "replace")
            printed.append(line)
            if (collecting := _COLLECTING.match(line)) is not None:
                finding(collecting[1])
    return "".join(printed), pip.returncode


def _found(report: dict[str, Any], indexes: Sequence[str]) -> list[LockedFile]:
    from packaging.utils import canonicalize_name

    found = []
    for each in report["install"]:
        archive = each["download_info"].get("archive_info", {})
        sha256 = archive.get("hashes", {}).get("sha256")
        if sha256 is None and archive.get("hash", "").startswith("sha256="):
            sha256 = archive["hash"].removeprefix("sha256=")
        about = each["metadata"]
        name, url = canonicalize_name(about["name"]), _without_user(each["download_info"]["url"])
        locked = LockedFile(name, about["version"], file_name_in(url), 0, sha256 or "", url, source_of(url, indexes))
        found.append(locked)
    return sorted(found, key=lambda each: each.name)


def source_of(url: str, indexes: Sequence[str] = ()) -> str | None:
    """Return the index with a file, or the host if it is none of these indexes'; None for a file of this computer."""
    parts = urlsplit(url)
    if parts.scheme == "file":
        return None
    bases = [_without_user(each).removesuffix("/").removesuffix("/simple") for each in indexes]
    host = urlunsplit(parts._replace(path="", query="", fragment=""))
    return max((each for each in bases if url.startswith(f"{each}/")), key=len, default=host)


def _without_user(url: str) -> str:
    """Return an address without user, password and fragment."""
    parts = urlsplit(url)
    return urlunsplit(parts._replace(netloc=parts.netloc.rpartition("@")[2], fragment=""))


def _refuse_old_pip() -> None:
    try:
        installed = metadata.version("pip")
    except metadata.PackageNotFoundError:
        remedy = "Install it: python -m ensurepip --upgrade. In an environment of uv: uv pip install pip"
        raise PyfrcError("pip is not installed in this environment, and finds the packages", remedy=remedy) from None
    numbers = tuple(int(part) for part in installed.split(".")[:2] if part.isdecimal())
    if numbers < _OLDEST_PIP:
        oldest = ".".join(map(str, _OLDEST_PIP))
        remedy = "Update it: python -m pip install --upgrade pip"
        raise PyfrcError(f"pip {installed} is too old: this needs {oldest} or newer", remedy=remedy)
