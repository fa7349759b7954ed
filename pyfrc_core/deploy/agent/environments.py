"""Python environments on the robot: each has a Python and packages, and is never changed once it is complete.

Each release's record names its environment. The one that programs start with is a link, as the code is, and a switch to
a release replaces both links (`releases`). Where the system has a Python, the start command names the environment
instead. An environment is complete when it has its record, which is written last. Its files are never changed, so
environments share those of the same wheel. What a disk has damaged is replaced by new files (`mend`).
"""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Iterable
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import Any

from .activity import Activity
from .disk import different_files, free_bytes, remove, write_whole
from .environment_files import RECORD, EnvironmentFiles, Record, Wheel, files_in, read_record, wheels_in
from .robot_paths import Refusal, RobotPaths
from .system import exchange, flush, linked_directory, make_link

_NAME, _TAKEN = re.compile(r"[0-9a-f]{16}"), re.compile(r"taken-\d+")
_SHA256 = re.compile(r"[0-9a-f]{64}")
#: The directory of files that are to replace damaged ones.
_NEW = "new"
#: Bytes of disk space that stay free.
_RESERVE = 8 << 20


class Environments:
    """The environments on the robot, and the files that they are made of.

    :param paths: the robot's files; the layout must have environments
    """

    def __init__(self, paths: RobotPaths, activity: Activity) -> None:
        self._paths = paths
        self._activity = activity
        #: The link to the environment that programs start with, or a directory created by another tool; None: start
        #: commands name it.
        self.link = paths.of(paths.layout.environment) if paths.layout.environment else None
        self._directory = paths.own / "environments"
        self._pythons = paths.own / "pythons"
        self._wheels = paths.own / "wheels"
        self._files = EnvironmentFiles(self._wheels, self.link is not None, activity)

    def directory(self, name: str) -> Path:
        """Return the directory of an environment."""
        return self._directory / name

    def is_usable(self, name: str) -> bool:
        """Return whether an environment is complete."""
        place = self.directory(name)
        return (place / RECORD).is_file() if _NAME.fullmatch(name) else bool(_TAKEN.fullmatch(name) and place.is_dir())

    def of_this_process(self) -> str | None:
        """Return the environment in which this agent runs, or None: another tool's, or a Python without one."""
        place = Path(sys.prefix).resolve()
        return place.name if place.parent == self._directory.resolve() and self.is_usable(place.name) else None

    def current(self) -> str | None:
        """Return the environment that programs start with, or None: another tool's, or none."""
        if self.link is None:
            pattern = re.escape(self._paths.layout.environments) + "/([0-9a-f]{16})/"
            found = re.search(pattern, self._paths.start_command())
            return found[1] if found is not None and self.is_usable(found[1]) else None
        place = linked_directory(self.link)
        if place is None or place.parent != self._directory or not self.is_usable(place.name):
            return None
        return place.name

    def other_than_current(self, name: str | None) -> str | None:
        """Return the environment of a release if the link leads to another one now, else None.

        :raises Refusal: if it is no longer there
        """
        if name is None or name == self.current():
            return None
        if self.is_usable(name):
            return None if self.link is None else name
        if self.next_taken() is not None and _TAKEN.fullmatch(name):
            return None  # interrupted before another tool's environment was moved: it is in its place still
        raise Refusal("release", "the packages of this release are no longer on the robot", "Choose another.")

    def next_taken(self) -> str | None:
        """Return a name for another tool's environment that will be replaced, or None if there is none."""
        if self.link is not None and self.link.is_dir() and linked_directory(self.link) is None:
            names = (f"taken-{number}" for number in count(1))
            return next(name for name in names if not self.directory(name).exists())
        return None

    def replace_link(self, name: str, taken: str | None) -> None:
        """Let programs start with an environment. The start command refers to its own directory meanwhile.

        :param taken: the name for another tool's environment that is in its place
        """
        assert self.link is not None
        link = self._paths.own / "venv" if taken is None else self.directory(taken)
        remove(link)
        make_link(link, self.directory(name), self.link)
        if taken is None:
            link.replace(self.link)
        elif not exchange(link, self.link):
            link.replace(self._paths.own / "venv")
            self.link.rename(self.directory(taken))
            (self._paths.own / "venv").replace(self.link)
        self._show_python(name)

    def _show_python(self, name: str) -> None:
        """Let other tools find the environment's Python where they look for it, unless they have one there."""
        python = self._record(name).get("python")
        place = self._paths.of(self._paths.layout.shown_python)
        if python is not None and (linked_directory(place) is not None or not place.exists()):
            with suppress(OSError):
                link = self._paths.own / "python"
                remove(link)
                make_link(link, self._pythons / str(python), place)
                link.replace(place)

    def install(self, request: dict[str, Any], receive: Any) -> None:
        """Make an environment, unless it is there, and replace damaged files of all environments.

        :param request: ``environment``, its name; ``python``, that of its Python, which is on the robot (None: the
            system's); ``wheels``, each as a `Wheel`
        :param receive: called with the wheels that are not on the robot, and the file for each
        :raises Refusal: if there is not enough disk space, or it cannot be made
        """
        name, python = str(request["environment"]), request["python"]
        wheels = [Wheel(*each) for each in request["wheels"]]
        names = [name] if python is None else [name, str(python)]
        if not all(map(_NAME.fullmatch, names)) or not all(_SHA256.fullmatch(each.sha256) for each in wheels):
            raise Refusal("protocol", "an environment has a name that is not one")
        interpreter = self._python(python)
        if not os.path.lexists(interpreter):
            what = "the Python that was sent is no longer there: another computer has deployed meanwhile"
            raise Refusal("environment", what, "Run the command again.")
        complete, damaged = self.is_usable(name), self.damaged()
        there = {} if complete else self._unpacked(python, {each.sha256 for each in wheels})
        lacking = [] if complete else [each for each in wheels if each.sha256 not in there]
        missing = [each for each in wheels if each in lacking or self._is_in(each.sha256, damaged)]
        if missing or not complete:
            self._check_disk_space(sum(each.size + each.unpacked for each in missing))
        self._wheels.mkdir(parents=True, exist_ok=True)
        receive(missing, [self._wheels / each.sha256 for each in missing])
        if damaged:
            self._mend(damaged, missing)
        if not complete:
            sources = {sha256: self.directory(each) for sha256, each in there.items()}
            made = self._files.make(self.directory(name), interpreter, wheels, sources)
            self._write_record(name, {"python": python, **made})
        if damaged or not complete:
            self._flush()
        remove(self._wheels)

    def _flush(self) -> None:
        self._activity.begin("sync")
        self._activity.wait_for(flush, self._paths.own)

    def _write_record(self, name: str, record: Record) -> None:
        self._flush()  # what it is about
        write_whole(self.directory(name) / RECORD, json.dumps(record))

    def _python(self, name: str | None) -> Path:
        """Return the path of a Python; None: the system's."""
        return self._paths.of(self._paths.layout.python) if name is None else self._pythons / name / "bin/python3"

    def _mend(self, damaged: dict[str, list[str]], received: list[Wheel]) -> None:
        """Replace damaged files of environments by new ones, with the content of wheels that were received."""
        new = self._paths.own / _NEW
        remove(new)
        good = self._files.unpack_again(received, new)
        for name, paths in damaged.items():
            record = self._record(name)
            if made := [path for path in paths if path in record["made"]]:
                good |= self._files.make_again(self.directory(name), self._python(record["python"]), made, new / name)
        self._flush()
        for name, paths in damaged.items():
            self._write_record(name, self._files.mend(self.directory(name), paths, good))
        remove(new)

    def damaged(self) -> dict[str, list[str]]:
        """Return the files that differ from what was installed, by environment."""
        found: dict[str, list[str]] = {}
        known: dict[tuple[int, int], str] = {}
        for name in self._complete():
            files = files_in(self._record(name))
            self._activity.begin("check", len(files))
            found[name] = different_files(self.directory(name), files, self._activity, known)
        return {name: paths for name, paths in found.items() if paths}

    def _complete(self) -> list[str]:
        places = self._directory.iterdir() if self._directory.is_dir() else ()
        return sorted(each.name for each in places if _NAME.fullmatch(each.name) and self.is_usable(each.name))

    def _is_in(self, sha256: str, damaged: dict[str, list[str]]) -> bool:
        """Return whether a wheel has one of these files."""
        found = ((wheels_in(self._record(name)).get(sha256, {}), paths) for name, paths in damaged.items())
        return any(not files.keys().isdisjoint(paths) for files, paths in found)

    def _unpacked(self, python: str | None, wanted: set[str]) -> dict[str, str]:
        """Return the environments in which all files of wanted wheels are, undamaged, by wheel."""
        found: dict[str, str] = {}
        known: dict[tuple[int, int], str] = {}
        for name in self._complete():
            record = self._record(name)
            files, wheels = files_in(record), wheels_in(record) if record.get("python") == python else {}
            for sha256 in (wanted & wheels.keys()) - found.keys():
                hashes = wheels[sha256]
                if all(files[path] == hashes[path] for path in hashes) and not different_files(
                    self.directory(name), hashes, self._activity, known
                ):
                    found[sha256] = name
        return found

    def _check_disk_space(self, needed: int) -> None:
        self.remove_remains()
        needed, free = needed + _RESERVE, free_bytes(self._paths.home)
        if free < needed:
            raise Refusal(
                "space",
                f"the robot's disk is too full to install packages: {needed:,} bytes are needed, {free:,} are free",
                "Remove old logs from the robot. Nothing was changed.",
                needed=needed,
                free=free,
            )

    def remove_remains(self) -> None:
        """Remove what interrupted installations have left."""
        for name in ("venv", "python", _NEW):
            remove(self._paths.own / name)
        for place in self._directory.iterdir() if self._directory.is_dir() else ():
            # Of a taken environment that is not in its place yet, there is only the link for the exchange.
            if linked_directory(place) is not None or (_NAME.fullmatch(place.name) and not self.is_usable(place.name)):
                remove(place)
        remove(self._wheels)

    def remove_unused(self, used: Iterable[str | None]) -> None:
        """Remove environments and Pythons that nothing needs.

        :param used: the environments of the releases
        """
        here = {self.current(), self.of_this_process(), *used}
        for place in list(self._directory.iterdir()) if self._directory.is_dir() else ():
            if place.name not in here and (_NAME.fullmatch(place.name) or _TAKEN.fullmatch(place.name)):
                remove(place / RECORD)  # first: it is not complete from now on
                remove(place)
        records = [self._record(name) for name in here if name is not None]
        shown = linked_directory(self._paths.of(self._paths.layout.shown_python))
        pythons = {record.get("python") for record in records} | {None if shown is None else shown.name}
        for place in list(self._pythons.iterdir()) if self._pythons.is_dir() else ():
            if _NAME.fullmatch(place.name) and place.name not in pythons:
                remove(place)

    def _record(self, name: str) -> Record:
        return read_record(self.directory(name))
