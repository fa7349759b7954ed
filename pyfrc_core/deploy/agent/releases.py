"""The releases on the robot, and switching between them.

``~/py`` is a link to ``~/.pyfrc/releases/<number>``. Each release has a record, ``<number>.json``, in the same
directory. A release gets its name when it is complete, and loses it before its removal begins.
"""

from __future__ import annotations

import json
import os
import re
import stat
from collections.abc import Callable
from contextlib import suppress
from itertools import count
from pathlib import Path

from .activity import Activity
from .carrying import Carried, carry_over
from .disk import allow_changes, make_links_absolute, remove, remove_if_possible, sync, text_of, write_whole
from .environments import Environments
from .release_record import Record, parse_record, record_text, standing
from .robot_paths import Refusal, RobotPaths
from .system import REPLACES_LINKS, exchange, linked_directory, make_link, replace_link

_KEPT = 3
_TRASH = "trash-"
_RECORD, _UNFINISHED_RECORD = re.compile(r"\d+\.json"), re.compile(r"\.\d+\.json\.new")


class Releases:
    """The releases on the robot, and its start command."""

    def __init__(self, paths: RobotPaths, activity: Activity) -> None:
        self.paths = paths
        self.activity = activity
        #: Cached records, each with the identity of its file: device, inode, modification time, size.
        self._records: dict[int, tuple[tuple[int, ...], Record]] = {}
        #: Releases whose cached record could not be written, as on a full disk.
        self._unwritten: set[int] = set()
        #: Environments with the packages of releases.
        self.environments = Environments(paths, activity)

    def remove(self, path: Path, *, if_possible: bool = False) -> None:
        """Remove a file or a directory tree, if it exists.

        :param if_possible: keep entries that belong to other users of the robot
        """
        self.activity.begin("remove")
        self.activity.wait_for(remove_if_possible if if_possible else remove, path)

    def directory(self, number: int) -> Path:
        """Return the directory of a release."""
        return self.paths.releases / str(number)

    def numbers(self) -> list[int]:
        """Return the numbers of the complete releases, oldest first."""
        if not self.paths.releases.is_dir():
            return []
        names = [each.name for each in self.paths.releases.iterdir() if each.name.isdecimal()]
        return sorted(int(name) for name in names if self._is_complete(int(name)))

    def _is_complete(self, number: int) -> bool:
        directory = self.directory(number)
        return directory.is_dir() and not directory.is_symlink() and self._record_file(number).exists()

    def next_number(self) -> int:
        """Return an unused number, higher than those of all known releases."""
        names = [each.name.split(".")[0] for each in self.paths.releases.glob("*")]
        return max((int(name) for name in names if name.isdecimal()), default=0) + 1

    def _record_file(self, number: int) -> Path:
        return self.paths.releases / f"{number}.json"

    def record(self, number: int) -> Record:
        """Return the record of a release (files with hashes, start commands, origin), or nothing if it is damaged."""
        file = self._record_file(number)
        try:
            state = file.stat()
        except OSError:
            return {}
        if not stat.S_ISREG(state.st_mode):
            return {}
        # The file is only ever replaced, possibly by another agent.
        identity = (state.st_dev, state.st_ino, state.st_mtime_ns, state.st_size)
        if self._records.get(number, ((), {}))[0] != identity:
            self._records[number] = identity, parse_record(text_of(file) or "")
        return dict(self._records[number][1])

    def write_record(self, number: int, record: Record) -> None:
        """Write the record of a release."""
        self.paths.releases.mkdir(parents=True, exist_ok=True)
        write_whole(self._record_file(number), record_text(record))
        self._unwritten.discard(number)

    def update_record(self, number: int, change: Callable[[Record], Record]) -> None:
        """Change the record of a release, if it still exists.

        The change is valid for this agent even if it cannot be written; see `write_again`.
        """
        record = self.record(number)
        if record and (changed := change(record)) != record:
            self._records[number] = self._records[number][0], changed
            self._unwritten.add(number)
            self.write_record(number, changed)

    def write_again(self) -> None:
        """Write the records that could not be written."""
        for number in sorted(self._unwritten):
            if record := self.record(number):
                self.write_record(number, record)

    def fallback(self, number: int | None) -> int | None:
        """Return the release that a rollback from this one selects, or None if there is none.

        This is the release that it replaced, if that is good. Otherwise it is the newest earlier good one, else the one
        that has run for longest.
        """
        numbers = self.numbers()
        earlier = [each for each in numbers if number is None or each < number]
        before = self.record(number).get("from") if number is not None else None
        if before not in earlier:
            before = max(earlier, default=None)
        keys = {each: standing(self.record(each)) for each in earlier}
        if before is None or keys[before].good:
            return before
        good = [each for each in earlier if keys[each].good]
        return max(good) if good else max(earlier, key=lambda each: (*keys[each], each == before, each))

    def current(self) -> int | None:
        """Return the release that ``~/py`` links to, or None: another tool's program, or no program."""
        release = linked_directory(self.paths.code)
        if release is not None and release.parent == self.paths.releases and release.name.isdecimal():
            return int(release.name) if release.is_dir() else None
        return None

    def code(self) -> Path | None:
        """Return the directory with the code that the robot starts, or None."""
        return self.paths.code.resolve() if self.paths.code.is_dir() else None

    def is_other_tools(self) -> bool:
        """Return whether ``~/py`` is a directory created by another tool."""
        return self.paths.code.is_dir() and linked_directory(self.paths.code) is None

    def manifest_paths(self, directory: Path) -> set[str] | None:
        """Return the deployed files of a release, or None if it is not a release. The program wrote all others."""
        if directory.parent == self.paths.releases.resolve() and directory.name.isdecimal():
            record = self.record(int(directory.name))
            if "files" in record:
                return {*record["files"], "deploy.json"}
        return None

    def switch(self, number: int, commands: dict[str, str | None], taken: int | None) -> None:
        """Make a release current. At every moment, the start command refers to the complete old or new program.

        If the start command, which names the environment, stays the same, one rename is enough. Otherwise the command
        first refers to the release's own directory, which is the moment of the switch, and to ``~/py`` again after the
        link has been replaced.

        :param taken: the release number for another tool's directory in ``~/py``, whose record is already written
        """
        commands = self.environments.in_commands(commands, self.record(number).get("environment"))
        code, direct_code = f"{self.paths.layout.code}/", f"{self.paths.releases_on_robot}/{number}/"
        direct = {name: text and text.replace(code, direct_code) for name, text in commands.items()}
        detour = not REPLACES_LINKS or any(text_of(self.paths.home / name) != text for name, text in commands.items())
        link = self.paths.own / "py" if taken is None else self.directory(taken)
        remove(link)
        make_link(link, self.directory(number), self.paths.code)
        sync(self.paths.own, self.activity)
        if detour:
            self._write_commands(direct)
        if taken is None:
            replace_link(link, self.paths.code)
        elif not exchange(link, self.paths.code):
            # Without renameat2, the directory must be moved before the link can replace it.
            if not detour:
                self._write_commands(direct)
                detour = True
            link.replace(self.paths.own / "py")
            self.paths.code.rename(self.directory(taken))
            (self.paths.own / "py").replace(self.paths.code)
        sync(self.paths.home, self.activity)
        if detour:
            self._write_commands(commands)

    def write_command(self, name: str, text: str) -> None:
        """Write a file with a start command."""
        write_whole(self.paths.home / name, text, self.paths.layout.command_mode)

    def _write_commands(self, commands: dict[str, str | None]) -> None:
        for name, text in commands.items():
            if text is not None:
                self.write_command(name, text)
        sync(self.paths.home, self.activity)
        for name, text in commands.items():
            if text is None:
                remove(self.paths.home / name)

    def set_debug(self, debug: bool) -> None:
        """Select whether the robot starts the program for debugging."""
        if not self.paths.layout.debug_flag:
            return
        flag = self.paths.of(self.paths.layout.debug_flag)
        # Another user's file may stay: both start commands refer to the same program.
        with suppress(PermissionError):
            if debug:
                flag.touch()
            else:
                remove(flag)

    def require_movable_code(self) -> None:
        """Check that another tool's directory can be moved.

        :raises Refusal: if it belongs to another user
        """
        allow_changes(self.paths.code)
        if not os.access(self.paths.code, os.W_OK):
            layout = self.paths.layout
            raise Refusal(
                "disk",
                f"{layout.code} belongs to another user of the robot, and cannot be moved",
                f"Give it to {layout.user}, {layout.by_administrator} chown -R {layout.owner} {layout.code}",
            )

    def adopt_directory(self, number: int) -> None:
        """Write the record for another tool's directory, which becomes a release.

        :raises Refusal: if the directory cannot be moved
        """
        self.require_movable_code()
        make_links_absolute(self.paths.code, self.paths.between)
        commands = {name: text_of(self.paths.home / name) for name in self.paths.layout.command_files}
        deployed = text_of(self.paths.code / "deploy.json")
        try:
            about = json.loads(deployed or "{}")
        except ValueError:
            about = {}
        record: Record = {"taken": True, "debug": self.paths.is_debug(), "commands": commands, "deploy": about}
        if (environment := self.environments.current()) is not None:
            record["environment"] = environment
        self.write_record(number, record)

    def recover(self) -> None:
        """Clean up after an interrupted deploy, and complete it if it was interrupted after the switch."""
        if not self.paths.own.is_dir():
            return
        started = re.search(re.escape(self.paths.releases_on_robot) + r"/(\d+)/", self.paths.start_command())
        if started is not None and self._is_complete(int(started[1])):
            number = int(started[1])
            taken = None
            if self.is_other_tools():
                taken = self.next_number()
                self.adopt_directory(taken)
            self.switch(number, self.record(number).get("commands") or {}, taken)
        self._remove_remains()
        self.environments.remove_remains()
        current = self.current()
        if current is not None:
            self.carry_late_writes(current)

    def _remove_remains(self) -> None:
        """Remove what interrupted deploys have left, and nothing else: a program may write to ``../`` of its code."""
        for name in self.paths.layout.command_files:
            remove(self.paths.home / f".{name}.new")
        for each in self.paths.own.iterdir():
            if re.fullmatch(rf"{_TRASH}\d+", each.name):
                self.remove(each, if_possible=True)
            elif each.name in (self.paths.incoming.name, self.paths.between.name, "py"):
                self.remove(each)
        startable = self._startable()
        for each in self.paths.releases.iterdir() if self.paths.releases.is_dir() else ():
            if _UNFINISHED_RECORD.fullmatch(each.name):
                self.remove(each)
            elif _RECORD.fullmatch(each.name):
                if not self._is_complete(int(each.stem)):
                    self.remove(each)
            elif each.name.isdecimal() and each.name not in startable and linked_directory(each) is not None:
                self.remove(each)  # an unfinished exchange; a directory gets such a name only after its record

    def remove_all(self) -> None:
        """Remove the program and all releases. Files of other users stay, and are no obstacle to the next deploy."""
        if self.is_other_tools():
            self._discard(self.paths.code)
        else:
            remove(self.paths.code)
        for number in self.numbers():
            self.discard(number)
        self._remove_remains()
        with suppress(OSError):  # the program has written to it
            self.paths.releases.rmdir()

    def discard(self, number: int) -> None:
        """Remove a release, except for files that belong to other users of the robot."""
        self._discard(self.directory(number), self._record_file(number))

    def _discard(self, directory: Path, record: Path | None = None) -> None:
        trash = self._free_name(_TRASH)
        allow_changes(directory)
        directory.rename(trash)
        if record is not None:
            remove(record)
        self.remove(trash, if_possible=True)

    def prune(self, kept: int = _KEPT, needed: int | None = None) -> None:
        """Remove old releases.

        Releases that the robot may start, the newest good one, and the one that has run for longest are always kept.

        :param kept: how many releases to keep
        :param needed: another release that is kept, if any
        """
        numbers = self.numbers()
        keep = {int(each) for each in self._startable()}
        if needed is not None:
            keep.add(needed)
        if numbers:
            keys = {each: standing(self.record(each)) for each in numbers}
            keep.add(max(numbers, key=lambda each: (keys[each].good, each)))
            keep.add(max(numbers, key=lambda each: (keys[each].lasted, each)))
        current = self.current()
        if kept > 1 and current is not None and self.record(current).get("from") in numbers:
            keep.add(self.record(current)["from"])
        if current is not None and "carried" in self.record(current):
            keep.add(self.record(current)["carried"]["from"])  # it may have files that are not carried over yet
        for number in reversed(numbers):
            if len(keep) < kept:
                keep.add(number)
        for number in numbers:
            if number not in keep:
                with suppress(PermissionError):  # another user's
                    self.discard(number)
        self.environments.remove_unused(self.record(number).get("environment") for number in self.numbers())

    def _free_name(self, prefix: str) -> Path:
        names = (self.paths.own / f"{prefix}{number}" for number in count(1))
        return next(name for name in names if not name.exists())

    def may_start(self, number: int) -> bool:
        """Return whether the robot may start this release in its current state."""
        return str(number) in self._startable()

    def _startable(self) -> set[str]:
        """Return the numbers of the releases that the robot may start in its current state."""
        texts = [text_of(self.paths.home / name) or "" for name in self.paths.layout.command_files]
        direct = re.escape(self.paths.releases_on_robot) + r"/(\d+)/"
        kept = {number for text in texts for number in re.findall(direct, text)}
        current = self.current()
        return kept if current is None else {*kept, str(current)}

    def carry_over(
        self, old: Path, new: Path, before: dict[str, int] | None, manifest: set[str] | None = None
    ) -> Carried:
        """Carry files that the program wrote in one release over into another, see `carrying.carry_over`.

        :param manifest: the deployed files of `new`, if it is not a release yet
        """
        manifests = self.manifest_paths(old), self.manifest_paths(new) or set() if manifest is None else manifest
        return carry_over(old, new, manifests, before, self.paths.between, self.activity)

    def carry_late_writes(self, number: int) -> None:
        """Link files that the previous program wrote after the switch. Call this once, after its end."""
        record = self.record(number)
        if "carried" in record:
            previous = self.directory(record["carried"]["from"])
            if previous.is_dir():
                self.carry_over(previous.resolve(), self.directory(number).resolve(), record["carried"]["files"])
            del record["carried"]
            with suppress(OSError):  # on a full disk: the next call finds nothing more to link
                self.write_record(number, record)
