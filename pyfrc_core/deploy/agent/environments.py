"""Python environments on the robot: each has a Python and packages, and is never changed once it is complete.

Each release's record names its environment. The one that programs start with is a link, as the code is, and a switch to
a release replaces both links (`releases`). Where the system has a Python, the start command names the environment
instead. An environment is complete when it has its record, which is written last. Its files are never changed, so
environments share those of the same wheel.
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
from typing import Any, NamedTuple

from .activity import Activity
from .compiling import CompiledForms
from .disk import free_bytes, remove, text_of, write_whole
from .robot_paths import Refusal, RobotPaths
from .system import exchange, flush, linked_directory, make_link
from .wheels import link_wheel, unpack_wheel

#: An environment's record: the name of its Python (None: the system's), and its files, by the SHA-256 of their wheel.
RECORD = "environment.json"
_NAME, _TAKEN = re.compile(r"[0-9a-f]{16}"), re.compile(r"taken-\d+")
_SHA256 = re.compile(r"[0-9a-f]{64}")
#: Memory for compiling packages, in kB. A robot with 256 MB runs its program meanwhile.
_COMPILING_KILOBYTES = 40_000
#: Bytes of disk space that stay free.
_RESERVE = 8 << 20


class Wheel(NamedTuple):
    """A wheel for an environment; `unpacked` are the bytes that its files take on the disk."""

    file: str
    size: int
    sha256: str
    unpacked: int


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
        """Make an environment, unless it is there.

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
        interpreter = self._paths.of(self._paths.layout.python)
        if python is not None:
            interpreter = self._pythons / python / "bin/python3"
        if not os.path.lexists(interpreter):
            what = "the Python that was sent is no longer there: another computer has deployed meanwhile"
            raise Refusal("environment", what, "Run the command again.")
        complete = self.is_usable(name)
        there = {} if complete else self._unpacked(python, {each.sha256 for each in wheels})
        missing = [] if complete else [each for each in wheels if each.sha256 not in there]
        if not complete:
            self._check_disk_space(sum(each.size + each.unpacked for each in missing))
        self._wheels.mkdir(parents=True, exist_ok=True)
        receive(missing, [self._wheels / each.sha256 for each in missing])
        if complete:
            return
        record = {"python": python, "wheels": self._make(self.directory(name), interpreter, wheels, there)}
        self._flush()
        write_whole(self.directory(name) / RECORD, json.dumps(record))
        self._flush()
        remove(self._wheels)

    def _flush(self) -> None:
        self._activity.begin("sync")
        self._activity.wait_for(flush, self._paths.own)

    def _unpacked(self, python: str | None, wanted: set[str]) -> dict[str, tuple[str, list[str]]]:
        """Return where wanted wheels are unpacked already: the environment, and their files there."""
        found = {}
        for place in self._directory.iterdir() if self._directory.is_dir() else ():
            record = self._record(place.name) if self.is_usable(place.name) else {}
            wheels = record.get("wheels")
            if record.get("python") == python and isinstance(wheels, dict):
                for sha256 in wanted & wheels.keys():
                    if all((place / file).is_file() for file in wheels[sha256]):
                        found[sha256] = place.name, wheels[sha256]
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

    def _make(
        self, place: Path, python: Path, wheels: list[Wheel], there: dict[str, tuple[str, list[str]]]
    ) -> dict[str, list[str]]:
        """Make an environment, and return its files by their wheel.

        :param there: the wheels that another environment has
        """
        remove(place)
        place.parent.mkdir(parents=True, exist_ok=True)
        self._activity.begin("environment")
        self._run([str(python), "-m", "venv", *self.without_pip(python), str(place)])
        packages = next(iter(place.glob("lib/python3*/site-packages")), None)
        if packages is None:
            raise Refusal("environment", f"{python} has made no environment")
        files, forms = {}, CompiledForms()
        self._activity.begin("unpack", len(wheels))
        for each in wheels:
            if each.sha256 in there:
                name, files[each.sha256] = there[each.sha256]
                link_wheel(files[each.sha256], self.directory(name), place, forms, self._activity)
            else:
                wheel = self._wheels / each.sha256
                files[each.sha256] = unpack_wheel(wheel, each.file, place, packages, self._activity)
                remove(wheel)
        self._activity.begin("environment")
        # As programs are started. A package may have files for another version of Python, which do not count, and files
        # that need too much memory: the program compiles them when it imports them.
        limited = ["sh", "-c", f'ulimit -d {_COMPILING_KILOBYTES}; exec "$@"', "sh"]
        compiling = [str(place / "bin/python3"), "-O", "-m", "compileall", "-q", str(packages)]
        self._run([*limited, *compiling], check=False)
        return files

    def without_pip(self, python: Path) -> list[str]:
        """Return the option of `venv` for a Python that cannot install pip, as Debian's, or that has it already."""
        with_pip = self.link is not None and list(python.parent.parent.glob("lib/python3*/ensurepip"))
        return [] if with_pip else ["--without-pip"]

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

    def remove_remains(self) -> None:
        """Remove what interrupted installations have left."""
        for name in ("venv", "python"):
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

    def _record(self, name: str) -> dict[str, Any]:
        try:
            record = json.loads(text_of(self.directory(name) / RECORD) or "{}")
        except ValueError:
            return {}
        return record if isinstance(record, dict) else {}
