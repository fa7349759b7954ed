"""Python environments on the robot: each has a Python and packages, and is never changed once it is complete.

Each release's record names its environment, and so does its start command. An environment is complete when it has its
record, which is written last. Its files are never changed, so environments share those of the same wheel. What a disk
has damaged is replaced by new files (`mend`).
"""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from .activity import Activity
from .disk import different_files, free_bytes, remove, sync, write_whole
from .environment_files import RECORD, EnvironmentFiles, Record, Wheel, files_in, read_record, wheels_in
from .robot_paths import Refusal, RobotPaths, in_environment

_NAME = re.compile(r"[0-9a-f]{16}")
_PYTHON = re.compile(r"(/\S+)/bin/python3")
_SHA256 = re.compile(r"[0-9a-f]{64}")
#: The directory of files that are to replace damaged ones.
_NEW = "new"
#: Bytes of disk space that stay free.
_RESERVE = 8 << 20


class Environments:
    """The environments on the robot, and the files that they are made of."""

    def __init__(self, paths: RobotPaths, activity: Activity) -> None:
        self._paths = paths
        self._activity = activity
        self._directory = paths.own / "environments"
        self._pythons = paths.own / "pythons"
        self._wheels = paths.own / "wheels"
        self._files = EnvironmentFiles(self._wheels, activity)

    def directory(self, name: str) -> Path:
        """Return the directory of an environment."""
        return self._directory / name

    def is_usable(self, name: str) -> bool:
        """Return whether an environment is complete."""
        return bool(_NAME.fullmatch(name)) and (self.directory(name) / RECORD).is_file()

    def of_this_process(self) -> str | None:
        """Return the environment in which this agent runs, or None: another tool's, or a Python without one."""
        return self._at(Path(sys.prefix))

    def current(self) -> str | None:
        """Return the environment that programs start with, or None: another tool's, or none."""
        found = _PYTHON.search(self._paths.start_command())
        return None if found is None else self._at(self._paths.of(found[1]))

    def _at(self, place: Path) -> str | None:
        place = place.resolve()
        return place.name if place.parent == self._directory.resolve() and self.is_usable(place.name) else None

    def in_commands(self, commands: dict[str, str | None], name: str | None) -> dict[str, str | None]:
        """Return a release's start commands with its environment.

        :raises Refusal: if that is no longer there
        """
        if name is not None and not self.is_usable(name):
            raise Refusal("release", "the packages of this release are no longer on the robot", "Choose another.")
        return in_environment(self._paths.layout, commands, name)

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
            sync(self._paths.own, self._activity)
        remove(self._wheels)

    def _write_record(self, name: str, record: Record) -> None:
        sync(self._paths.own, self._activity)  # what it is about
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
        sync(self._paths.own, self._activity)
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
        """Return the environments that have all files of wanted wheels, by wheel. Damaged ones are replaced first."""
        found: dict[str, str] = {}
        for name in self._complete():
            record = self._record(name)
            files, wheels = files_in(record), wheels_in(record) if record.get("python") == python else {}
            found.update({each: name for each in wanted & wheels.keys() if wheels[each].items() <= files.items()})
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
        remove(self._paths.own / _NEW)
        for place in self._directory.iterdir() if self._directory.is_dir() else ():
            if _NAME.fullmatch(place.name) and not self.is_usable(place.name):
                remove(place)
        remove(self._wheels)

    def remove_unused(self, used: Iterable[str | None]) -> None:
        """Remove environments and Pythons that nothing needs.

        :param used: the environments of the releases
        """
        here = {self.current(), self.of_this_process(), *used}
        for place in list(self._directory.iterdir()) if self._directory.is_dir() else ():
            if place.name not in here and _NAME.fullmatch(place.name):
                remove(place / RECORD)  # first: it is not complete from now on
                remove(place)
        pythons = {self._record(name).get("python") for name in here if name is not None}
        for place in list(self._pythons.iterdir()) if self._pythons.is_dir() else ():
            if _NAME.fullmatch(place.name) and place.name not in pythons:
                remove(place)

    def _record(self, name: str) -> Record:
        return read_record(self.directory(name))
