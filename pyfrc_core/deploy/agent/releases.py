"""The releases on the robot, and how one of them becomes what the robot starts.

``~/py`` is a link to ``~/.pyfrc/releases/<number>``; beside each release is ``<number>.json``, its record. A release is
complete before it has that name, and never has it any more once its removal has begun.
"""

from __future__ import annotations

import filecmp
import json
import os
import re
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import Any

from .activity import Activity
from .disk import everything_below, link_or_copy, remove, remove_if_possible, text_of, write_whole
from .places import CODE, COMMAND, DEBUG_COMMAND, HOME, Places, Refusal
from .system import REPLACES_LINKS, exchange, flush, linked_directory, make_link, replace_link

Record = dict[str, Any]

_KEPT = 3
_TRASH = "trash-"
_DIRECT = HOME + "/.pyfrc/releases"
#: Bytes of a file's name that leave room for an ending; of a longer one so many characters are kept.
_LONGEST_NAME, _SHORTENED = 220, 50
_OTHER_TOOLS_CODE = (".py", ".pyi", ".pyc")


def start_commands(main: str) -> dict[str, str | None]:
    """What is in the files that name the robot's start command, for the program with this main file."""
    if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_./-]*", main):
        raise Refusal(
            "main",
            f"the main file cannot be called {main!r}: its name is part of the robot's start command",
            "Give it a name of letters, digits, '_', '-' and '.'.",
        )
    python = "env LD_LIBRARY_PATH=/usr/local/frc/lib/ /usr/local/bin/python3 -u"
    return {
        COMMAND: f"{python} -O -m robotpy --main {CODE}/{main} run\n",
        DEBUG_COMMAND: f"{python} -m robotpy --main {CODE}/{main} -v run\n",
    }


class Releases:
    """The releases, the current one, and the start command."""

    def __init__(self, places: Places, activity: Activity) -> None:
        self.places = places
        self.activity = activity
        #: Records as they were read, by what shows that the file has been replaced since.
        self._records: dict[int, tuple[tuple[int, ...], Record]] = {}

    def flush(self, directory: Path) -> None:
        """Wait until all that was written in this file system is on the disk."""
        self.activity.begin("sync")
        self.activity.wait_for(flush, directory)

    def remove(self, path: Path, *, if_possible: bool = False) -> None:
        """Remove a file or a whole directory, if it is there.

        :param if_possible: leave what we may not remove: others of the robot's users may have put theirs into it
        """
        self.activity.begin("remove")
        self.activity.wait_for(remove_if_possible if if_possible else remove, path)

    def directory(self, number: int) -> Path:
        """Where a release is."""
        return self.places.releases / str(number)

    def numbers(self) -> list[int]:
        """The complete releases, oldest first."""
        if not self.places.releases.is_dir():
            return []
        names = [each.name for each in self.places.releases.iterdir() if each.name.isdigit()]
        return sorted(int(name) for name in names if self._is_complete(int(name)))

    def _is_complete(self, number: int) -> bool:
        directory = self.directory(number)
        return directory.is_dir() and not directory.is_symlink() and self._record_file(number).exists()

    def next_number(self) -> int:
        """A number that no release has had, as far as is known."""
        names = [each.name.split(".")[0] for each in self.places.releases.glob("*")]
        return max((int(name) for name in names if name.isdigit()), default=0) + 1

    def _record_file(self, number: int) -> Path:
        return self.places.releases / f"{number}.json"

    def record(self, number: int) -> Record:
        """What is known of a release: its files with their hashes, its start commands, what it was deployed from."""
        file = self._record_file(number)
        try:
            state = file.stat()
        except OSError:
            return {}
        # It is never written into, only replaced; another agent may have done so.
        identity = (state.st_dev, state.st_ino, state.st_mtime_ns, state.st_size)
        if self._records.get(number, ((), {}))[0] != identity:
            try:
                record = json.loads(text_of(file) or "{}")
            except ValueError:
                record = {}
            self._records[number] = identity, record if isinstance(record, dict) else {}
        return dict(self._records[number][1])

    def write_record(self, number: int, record: Record) -> None:
        """Keep what is known of a release."""
        self.places.releases.mkdir(parents=True, exist_ok=True)
        write_whole(self._record_file(number), json.dumps(record))

    def ran(self, number: int) -> bool:
        """Return whether a watch has seen this release run."""
        return bool(self.record(number).get("ran"))

    def record_start(self, number: int, ran: bool, ended: bool) -> None:
        """Record what is known of the starts of a release, if it is still there.

        :param ran:   whether a watch has seen it run, at any start
        :param ended: whether it ended at the last start that was watched
        """
        record = self.record(number)
        known = {**record, "ran": ran, "ended": ended}
        if record and known != record:
            self.write_record(number, known)

    def fallback(self, number: int | None) -> int | None:
        """Return the release that a rollback from this one goes back to, or None without one.

        It is the one that this one replaced, unless only others were seen to run: then it is the newest of these.
        """
        numbers = self.numbers()
        earlier = [each for each in numbers if number is None or each < number]
        before = self.record(number).get("from") if number is not None else None
        if before not in numbers:
            before = max(earlier, default=None)
        ran = [each for each in earlier if self.ran(each)]
        return before if before in ran or not ran else ran[-1]

    def current(self) -> int | None:
        """The release that ``~/py`` is; none: another tool has put something there, or nothing is."""
        release = linked_directory(self.places.code)
        if release is not None and release.parent == self.places.releases and release.name.isdigit():
            return int(release.name) if release.is_dir() else None
        return None

    def code(self) -> Path | None:
        """The directory with the code that the robot starts now."""
        return self.places.code.resolve() if self.places.code.is_dir() else None

    def is_other_tools(self) -> bool:
        """Whether ``~/py`` is another tool's directory."""
        return self.places.code.is_dir() and linked_directory(self.places.code) is None

    def listed(self, directory: Path) -> set[str] | None:
        """The files that a release came with; the program has written the others. None: it is not one of ours."""
        if directory.parent == self.places.releases.resolve() and directory.name.isdigit():
            record = self.record(int(directory.name))
            if "files" in record:
                return {*record["files"], "deploy.json"}
        return None

    def switch(self, number: int, commands: dict[str, str | None], taken: int | None) -> None:
        """Make a release current: at every moment the start command names the old program or the new one, whole.

        One rename does it when the start command stays the same. Otherwise the command first names the release's own
        directory, which is the moment of the change, and ``~/py`` only when that has followed.

        :param taken: the release as which another tool's directory is kept; its record is there already
        """
        direct = {name: text and text.replace(f"{CODE}/", f"{_DIRECT}/{number}/") for name, text in commands.items()}
        changed = any(text_of(self.places.home / name) != text for name, text in commands.items())
        detour = changed or not REPLACES_LINKS
        link = self.places.own / "py" if taken is None else self.directory(taken)
        remove(link)
        make_link(link, self.directory(number), self.places.code)
        self.flush(self.places.own)
        if detour:
            self._write_commands(direct)
        if taken is None:
            replace_link(link, self.places.code)
        elif not exchange(link, self.places.code):
            # Without renameat2 the directory has to be moved before the link can have its place.
            if not detour:
                self._write_commands(direct)
                detour = True
            link.replace(self.places.own / "py")
            self.places.code.rename(self.directory(taken))
            (self.places.own / "py").replace(self.places.code)
        self.flush(self.places.home)
        if detour:
            self._write_commands(commands)

    def _write_commands(self, commands: dict[str, str | None]) -> None:
        for name, text in commands.items():
            if text is not None:
                write_whole(self.places.home / name, text)
        self.flush(self.places.home)
        for name, text in commands.items():
            if text is None:
                remove(self.places.home / name)

    def set_debug(self, debug: bool) -> None:
        """Let the robot start the program for debugging, or the ordinary way."""
        # Of another user, it can stay: both start commands name the same program.
        with suppress(PermissionError):
            if debug:
                self.places.debug_flag.touch()
            else:
                remove(self.places.debug_flag)

    def take_over(self, number: int) -> None:
        """Write the record under which another tool's directory is going to be a release.

        :raises Refusal: when the directory cannot be moved
        """
        if not os.access(self.places.code, os.W_OK):
            raise Refusal(
                "disk",
                f"{CODE} belongs to another user of the robot, and so cannot be moved out of the way",
                f"Give it to lvuser, as admin on the robot: chown -R lvuser:ni {CODE}",
            )
        commands = {name: text_of(self.places.home / name) for name in (COMMAND, DEBUG_COMMAND)}
        deployed = text_of(self.places.code / "deploy.json")
        try:
            about = json.loads(deployed or "{}")
        except ValueError:
            about = {}
        debug = self.places.debug_flag.exists()
        self.write_record(number, {"taken": True, "debug": debug, "commands": commands, "deploy": about})

    def recover(self) -> None:
        """Clear up after a deploy that was cut, and finish one that was cut past its decisive moment."""
        if not self.places.own.is_dir():
            return
        command = text_of(self.places.home / (DEBUG_COMMAND if self.places.debug_flag.exists() else COMMAND)) or ""
        started = re.search(re.escape(_DIRECT) + r"/(\d+)/", command)
        if started is not None and self._is_complete(int(started[1])):
            number = int(started[1])
            taken = None
            if self.is_other_tools():
                taken = self.next_number()
                self.take_over(taken)
            self.switch(number, self.record(number)["commands"], taken)
        for each in self.places.own.iterdir():
            if each.name.startswith(_TRASH):
                self.remove(each, if_possible=True)
            elif each not in (self.places.lock, self.places.releases):
                self.remove(each)
        for name in (COMMAND, DEBUG_COMMAND):
            remove(self.places.home / f".{name}.new")
        if self.places.releases.is_dir():
            for each in self.places.releases.iterdir():
                number_text = each.name.split(".json")[0]
                if (
                    not (number_text.isdigit() and self._is_complete(int(number_text)))
                    and each.name not in self._kept()
                ):
                    self.remove(each)
        current = self.current()
        if current is not None:
            self.settle(current)

    def prune(self, kept: int = _KEPT) -> None:
        """Remove old releases, but so many; never one that the robot may start, nor the newest that was seen to run."""
        numbers = self.numbers()
        keep = {int(each) for each in self._kept()}
        keep.update([each for each in numbers if self.ran(each)][-1:])
        current = self.current()
        if kept > 1 and current is not None and self.record(current).get("from") in numbers:
            keep.add(self.record(current)["from"])
        for number in reversed(numbers):
            if len(keep) < kept:
                keep.add(number)
        for number in numbers:
            if number not in keep:
                trash = self._free_name(_TRASH)
                self.directory(number).rename(trash)
                remove(self._record_file(number))
                self.remove(trash, if_possible=True)

    def _free_name(self, prefix: str) -> Path:
        names = (self.places.own / f"{prefix}{number}" for number in count(1))
        return next(name for name in names if not name.exists())

    def _kept(self) -> set[str]:
        """The releases that the robot may start as things are."""
        texts = [text_of(self.places.home / name) or "" for name in (COMMAND, DEBUG_COMMAND)]
        kept = {number for text in texts for number in re.findall(re.escape(_DIRECT) + r"/(\d+)/", text)}
        current = self.current()
        return kept if current is None else {*kept, str(current)}

    def carry(self, old: Path, new: Path, before: dict[str, int] | None) -> dict[str, int]:
        """Take what the program has written beside its code along, as further names of the same files.

        What it has written in `new` under the same name is kept beside it, with another name.

        :param before: what was carried the first time, by its name; then only what the old program has written since
            is taken, and nothing that the new one has changed
        :return: the files that are the same in both, by name, with their inode numbers
        """
        listed, came_with_new = self.listed(old), self.listed(new) or set()
        # Directories that hold only code come with the code, or go with it.
        code_in: set[str] = set()
        for name in listed or ():
            above = name.rpartition("/")[0]
            while above and above not in code_in:
                code_in.add(above)
                above = above.rpartition("/")[0]
        carried: dict[str, int] = {}
        between = self.places.own / "carried"
        self.activity.begin("carry")
        for name, entry in everything_below(old):
            self.activity.step()
            is_code = name.endswith(_OTHER_TOOLS_CODE) or name == "deploy.json" if listed is None else name in listed
            if is_code or name in came_with_new:
                continue
            target = new / name
            try:
                if entry.is_dir(follow_symlinks=False):
                    if before is None and listed is not None and name not in code_in:
                        target.mkdir(parents=True, exist_ok=True)
                    continue
                inode = os.lstat(entry.path).st_ino
                there = target.lstat().st_ino if target.exists() or target.is_symlink() else None
                if there == inode:
                    carried[name] = inode
                elif before is None or before.get(name) == there:
                    target.parent.mkdir(parents=True, exist_ok=True)
                    if before is None and there is not None:
                        _keep_beside(target, Path(entry.path), new.name)
                    remove(between)
                    link_or_copy(entry.path, str(between))
                    between.replace(target)
                    carried[name] = inode
            except (FileNotFoundError, FileExistsError, NotADirectoryError, IsADirectoryError, PermissionError):
                # The program has removed it, or the new one has a file where the old had a directory; or it is
                # another user's, which the program could not read either.
                continue
        return carried

    def settle(self, number: int) -> None:
        """Take along what the previous program has still written after the switch; once, when it runs no more."""
        record = self.record(number)
        if "carried" in record:
            previous = self.directory(record["carried"]["from"])
            if previous.is_dir():
                self.carry(previous.resolve(), self.directory(number).resolve(), record["carried"]["files"])
            del record["carried"]
            self.write_record(number, record)


def _keep_beside(target: Path, replacement: Path, release: str) -> None:
    """Give a file that is about to be replaced another name, unless its replacement has the same content."""
    if target.is_dir() and not target.is_symlink():
        return  # which is not replaced
    if not (target.is_symlink() or replacement.is_symlink()) and filecmp.cmp(target, replacement, shallow=False):
        return
    name = target.name if len(os.fsencode(target.name)) <= _LONGEST_NAME else target.name[:_SHORTENED]
    for number in count(1):
        beside = target.with_name(f"{name}.release-{release}" + (f"-{number}" if number > 1 else ""))
        if not os.path.lexists(beside):
            link_or_copy(str(target), str(beside))
            return
