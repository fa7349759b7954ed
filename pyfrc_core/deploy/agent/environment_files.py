"""The files of an environment: made from wheels, compared with their hashes, and replaced by new ones if damaged.

A file is written once and is read-only, since other environments may share it: what takes its place is another file.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Iterable
from contextlib import nullcontext
from pathlib import Path
from typing import Any, NamedTuple
from zipfile import ZipFile

from ...wheel_files import WheelFile, files_of, open_wheel, owners
from .activity import Activity
from .compiling import compiled_hashes
from .disk import BLOCK, everything_below, fingerprint, link_or_copy, remove, replace_by_link, text_of
from .robot_paths import Refusal

#: An environment's record: the name of its Python (None: the system's), and the hashes of its files by their paths:
#: what `venv` has made, what each wheel has (by the SHA-256 of the wheel, in their order), and compiled files.
RECORD = "environment.json"
#: Memory for compiling packages, in kB. A robot with 256 MB runs its program meanwhile.
_COMPILING_KILOBYTES = 40_000
_SCRIPT = b"#!python"
#: The beginning of a script, for sh and for Python: it starts with the Python beside it, so it is the same everywhere.
_START = b"#!/bin/sh\n'''exec' \"$(dirname \"$0\")/python3\" \"$0\" \"$@\"\n' '''\n"
#: The modification time of all files: compiled files stay valid when a file is replaced by the same one.
_TIME = 315_532_800

Record = dict[str, Any]


class Wheel(NamedTuple):
    """A wheel for an environment; `unpacked` are the bytes that its files take on the disk."""

    file: str
    size: int
    sha256: str
    unpacked: int


def read_record(place: Path) -> Record:
    """Return an environment's record; empty if it has none, or a damaged one."""
    try:
        record = json.loads(text_of(place / RECORD) or "{}")
    except ValueError:
        return {}
    return record if isinstance(record, dict) else {}


def wheels_in(record: Record) -> dict[str, dict[str, str]]:
    """Return the wheels of an environment, each with the hashes of its files."""
    return dict(record.get("wheels", {}))


def files_in(record: Record) -> dict[str, str]:
    """Return the hash of each file of an environment. Of several wheels with the same file, the last one's counts."""
    parts = (record.get("made", {}), *wheels_in(record).values(), record.get("compiled", {}))
    return {path: sha256 for part in parts for path, sha256 in part.items()}


class EnvironmentFiles:
    """Makes and mends the files of environments.

    :param received: the directory with received wheels, by their hashes
    """

    def __init__(self, received: Path, activity: Activity) -> None:
        self._received = received
        self._activity = activity

    def make(self, place: Path, python: Path, wheels: list[Wheel], there: dict[str, Path]) -> Record:
        """Make an environment, and return the hashes of its files.

        :param python: the path of its Python
        :param there: the environments that have wheels of it, by their hashes
        :raises Refusal: if it cannot be made
        :raises WheelError: if a wheel cannot be installed
        """
        remove(place)
        place.parent.mkdir(parents=True, exist_ok=True)
        self._activity.begin("environment")
        packages = self._make_bare(python, place)
        made = {}
        for path, entry in everything_below(place):
            if not entry.is_dir(follow_symlinks=False):
                if not entry.is_symlink():
                    Path(entry.path).chmod(entry.stat().st_mode & 0o555)
                made[path] = fingerprint(entry.path, self._activity)
        names = {each.sha256: each.file for each in wheels}
        records = {source: read_record(source) for source in set(there.values())}
        hashes = {sha256: wheels_in(records[source])[sha256] for sha256, source in there.items()}
        listed = {sha256: list(paths) for sha256, paths in hashes.items()}
        for sha256 in names.keys() - there.keys():
            with open_wheel(self._received / sha256, names[sha256]) as archive:
                listed[sha256] = [each.path for each in files_of(archive, names[sha256], packages)]
        owner = owners((name, listed[sha256]) for sha256, name in names.items())
        self._activity.begin("unpack", len(wheels))
        for sha256, name in names.items():
            own = {path for path in listed[sha256] if owner[path] == name}
            if sha256 in there:
                self._link(there[sha256], records[there[sha256]]["compiled"], own, place)
            else:
                wheel = self._received / sha256
                hashes[sha256] = _unpack_wheel(wheel, name, place, packages, self._activity, own.__contains__)
                remove(wheel)
        compiled = self._compile(place, packages, owner)
        return {"made": made, "wheels": {sha256: hashes[sha256] for sha256 in names}, "compiled": compiled}

    def _make_bare(self, python: Path, place: Path) -> str:
        """Make an environment without packages. Return their directory, relative to it."""
        self._run([str(python), "-m", "venv", "--without-pip", str(place)])
        packages = next(iter(place.glob("lib/python3*/site-packages")), None)
        if packages is None:
            raise Refusal("environment", f"{python} has made no environment")
        return packages.relative_to(place).as_posix()

    def _link(self, source: Path, compiled: dict[str, str], paths: set[str], place: Path) -> None:
        """Link files of another environment, with their compiled files."""
        forms: dict[str, list[str]] = {}
        for form in compiled:
            directory, _, name = form.rpartition("__pycache__/")
            forms.setdefault(f"{directory}{name.rsplit('.cpython-', 1)[0]}.py", []).append(form)
        for path in paths:
            for each in (path, *forms.get(path, ())):
                (place / each).parent.mkdir(parents=True, exist_ok=True)
                link_or_copy(f"{source}/{each}", f"{place}/{each}")
            self._activity.step(0)
        self._activity.step()

    def _compile(self, place: Path, packages: str, paths: Iterable[str]) -> dict[str, str]:
        """Compile the packages' sources that have no compiled file. Return the hashes of compiled files.

        :param paths: the packages' files
        """
        self._activity.begin("environment")
        # As programs are started. A package may have files for another version of Python, which do not count, and files
        # that need too much memory: the program compiles them when it imports them.
        limited = ["sh", "-c", f'ulimit -d {_COMPILING_KILOBYTES}; exec "$@"', "sh"]
        compiling = [f"{place}/bin/python3", "-O", "-m", "compileall", "-q", f"{place}/{packages}"]
        self._run([*limited, *compiling], check=False)
        return compiled_hashes(place, paths, self._activity)

    def unpack_again(self, wheels: Iterable[Wheel], new: Path) -> dict[str, Path]:
        """Unpack received wheels into a new directory, and return the files by hash."""
        good = {}
        for each in wheels:
            received, place = self._received / each.sha256, new / each.sha256
            hashes = _unpack_wheel(received, each.file, place, "lib", self._activity, lambda path: True)
            good.update({sha256: place / path for path, sha256 in hashes.items()})
        return good

    def make_again(self, place: Path, python: Path, paths: Iterable[str], new: Path) -> dict[str, Path]:
        """Make files that `venv` has made in an environment again, in a new directory. Return them by hash."""
        self._make_bare(python, new)
        good = {}
        for path in paths:
            file = new / path
            if file.is_file() and not file.is_symlink():
                file.write_bytes(file.read_bytes().replace(os.fsencode(new), os.fsencode(place)))
                file.chmod(file.stat().st_mode & 0o555)
            if os.path.lexists(file):
                good[fingerprint(str(file), self._activity)] = file
        return good

    def mend(self, place: Path, damaged: list[str], good: dict[str, Path]) -> Record:
        """Replace damaged files of an environment by good ones, as far as there are any. Return its new record.

        :param good: files by hash
        """
        record = read_record(place)
        files, compiled = files_in(record), record["compiled"]
        for path in damaged:
            if path in compiled:
                remove(place / path)
            elif files[path] in good:
                replace_by_link(good[files[path]], place / path)
        (packages,) = (each.relative_to(place).as_posix() for each in place.glob("lib/python3*/site-packages"))
        return {**record, "compiled": self._compile(place, packages, files.keys() - compiled.keys())}

    def _run(self, command: list[str], check: bool = True) -> None:
        import subprocess

        run = self._activity.wait_for(
            lambda: subprocess.run(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False
            )
        )
        if check and run.returncode:
            said = run.stdout.decode(errors="replace").strip().splitlines()[-1:]
            raise Refusal("environment", f"{command[0]} cannot make an environment: {''.join(said)}")


def _unpack_wheel(
    wheel: Path, name: str, place: Path, packages: str, activity: Activity, is_wanted: Callable[[str], bool]
) -> dict[str, str]:
    """Unpack a wheel as the specification of wheels says. No file that exists is written to.

    Return the SHA-256 of each of its files by path.

    :param is_wanted: whether it is the wheel from which the file of a path comes; others are only hashed
    :raises WheelError: if it is damaged, or cannot be installed
    """
    with open_wheel(wheel, name) as archive:
        hashes = {
            each.path: _unpack(archive, each, place / each.path if is_wanted(each.path) else None, activity)
            for each in files_of(archive, name, packages)
        }
    activity.step()
    return hashes


def _unpack(archive: ZipFile, file: WheelFile, target: Path | None, activity: Activity) -> str:
    if target is not None:
        target.parent.mkdir(parents=True, exist_ok=True)
    digest = hashlib.sha256()
    with archive.open(file.member) as content, nullcontext() if target is None else target.open("xb") as stream:
        block = content.read(BLOCK)
        if block.startswith(_SCRIPT) and file.path.startswith("bin/"):
            block = _START + block.partition(b"\n")[2]
        while block:
            digest.update(block)
            if stream is not None:
                stream.write(block)
            block = content.read(BLOCK)
            activity.step(0)
    if target is not None:
        target.chmod(0o555 if file.executable else 0o444)
        os.utime(target, (_TIME, _TIME))
    return digest.hexdigest()
