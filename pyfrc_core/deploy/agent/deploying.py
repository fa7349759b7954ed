"""A deploy as the robot does it: put the next release together beside the current one, and only then switch."""

from __future__ import annotations

import hashlib
import json
import os
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from .compiling import compile_below, compiled_forms, link_compiled
from .disk import BLOCK, files_below, flush, free_bytes, link_or_copy, remove, sha256_of, write_whole
from .places import COMMAND, DEBUG_COMMAND, Refusal
from .releases import Record, Releases, start_commands
from .wire import Said, Wire

#: Bytes to be left free on the robot's disk after a deploy, for the program's own files.
_RESERVE = 256 * 1024
_DEPLOY_JSON = "deploy.json"


class Wanted(NamedTuple):
    """A file as it is to be on the robot."""

    path: str
    size: int
    sha256: str
    executable: bool


def wanted_of(files: Iterable[Any]) -> list[Wanted]:
    """The manifest that the laptop has sent; every path stays in the code's directory."""
    wanted = [Wanted(str(path), int(size), str(sha256), bool(executable)) for path, size, sha256, executable in files]
    for each in wanted:
        if "\0" in each.path or any(part in ("", ".", "..") for part in each.path.split("/")):
            raise Refusal("path", f"{each.path!r} is no path within the program's directory")
    if len({each.path for each in wanted}) != len(wanted):
        raise Refusal("path", "the manifest has the same path twice")
    return [each for each in wanted if each.path != _DEPLOY_JSON]


class AtHand:
    """Which of the wanted contents are on the robot already: looked for in all releases, known by their hashes."""

    def __init__(self, releases: Releases, wanted: list[Wanted]) -> None:
        sizes, hashes = {each.size for each in wanted}, {each.sha256 for each in wanted}
        self._copies: dict[str, Path] = {}
        self._same: dict[tuple[str, str, bool], Path] = {}
        code = releases.code()
        places = [] if code is None else [code]
        places += [releases.directory(number).resolve() for number in reversed(releases.numbers())]
        known: dict[tuple[int, int], str] = {}
        for directory in dict.fromkeys(places):
            listed = releases.listed(directory)
            for name, file in files_below(directory):
                try:
                    state = file.stat()
                    if state.st_size not in sizes:
                        continue
                    identity = (state.st_dev, state.st_ino)
                    if identity not in known:
                        known[identity] = sha256_of(file)
                except OSError:
                    continue  # the program that runs may remove and replace its files
                sha256 = known[identity]
                if sha256 in hashes:
                    self._copies.setdefault(sha256, file)
                    if listed is None or name in listed:
                        self._same.setdefault((name, sha256, bool(state.st_mode & 0o100)), file)

    def same_file(self, wanted: Wanted) -> Path | None:
        """The file of this very name and content, in a release: it can be linked. Others might be the program's own."""
        return self._same.get((wanted.path, wanted.sha256, wanted.executable))

    def copy(self, wanted: Wanted) -> Path | None:
        """A file with this content."""
        return self._copies.get(wanted.sha256)

    def missing(self, wanted: Iterable[Wanted]) -> list[Wanted]:
        """The files whose contents the laptop has to send, each content once."""
        first: dict[str, Wanted] = {}
        for each in wanted:
            if self.copy(each) is None:
                first.setdefault(each.sha256, each)
        return list(first.values())


class Contents:
    """The contents that come over the wire: one compressed stream of them all, one after the other."""

    def __init__(self, wire: Wire) -> None:
        self._wire = wire
        self._unpacking = zlib.decompressobj()
        self._ready = b""

    def write(self, wanted: Wanted, file: Path) -> None:
        """Write the next one to `file`."""
        digest, left = hashlib.sha256(), wanted.size
        with file.open("wb") as stream:
            while left:
                piece = self._take(left)
                digest.update(piece)
                stream.write(piece)
                left -= len(piece)
        if digest.hexdigest() != wanted.sha256:
            raise Refusal("changed", f"{wanted.path} was changed while it was sent", "Deploy again.")

    def end(self) -> None:
        """Hear the end of the stream."""
        while not self._unpacking.eof:
            if self._ready or self._unpack():
                raise Refusal("protocol", "more contents have come than were asked for")

    def _take(self, most: int) -> bytes:
        while not self._ready:
            if self._unpacking.eof:
                raise Refusal("protocol", "fewer contents have come than were asked for")
            self._ready = self._unpack()
        piece, self._ready = self._ready[:most], self._ready[most:]
        return piece

    def _unpack(self) -> bytes:
        packed = self._unpacking.unconsumed_tail or self._wire.content()
        try:
            return self._unpacking.decompress(packed, BLOCK)
        except zlib.error as error:
            raise Refusal("protocol", f"the contents cannot be unpacked: {error}") from error


class Deploy:
    """One deploy; the lock is held, and the last one's debris is gone."""

    def __init__(self, releases: Releases, wire: Wire, request: Said) -> None:
        self._releases = releases
        self._places = releases.places
        self._wire = wire
        self._wanted = wanted_of(request["files"])
        self._about = request.get("deploy_json") or {}
        self._main = str(request["main"])
        self._debug = bool(request.get("debug"))
        self._in_place = bool(request.get("in_place"))
        self._commands = start_commands(self._main)

    def run(self) -> Said:
        """Do it; what is to be told to the laptop."""
        if self._main not in {each.path for each in self._wanted}:
            raise Refusal("main", f"there is no {self._main} among the files")
        at_hand = AtHand(self._releases, self._wanted)
        code = self._releases.code()
        if self._in_place and code is not None:
            wanted = [each for each in self._wanted if not _has(at_hand, each, code)]
            _refuse_clashes(wanted, code)
        else:
            wanted = self._wanted
        at_hand = self._make_room(wanted, at_hand)
        missing = at_hand.missing(wanted)
        self._wire.say(need=[each.path for each in missing], bytes=sum(each.size for each in missing))
        current = self._releases.current()
        if not (self._in_place and code is not None) and current is not None and self._is_current(current, at_hand):
            return self._again(current)
        self._fill(wanted, missing, at_hand)
        told = {"files": len(missing), "bytes": sum(each.size for each in missing)}
        if self._in_place and code is not None:
            return {**self._overwrite(code, wanted), **told}
        return {**self._release(), **told}

    def _compiling(self) -> None:
        self._wire.say(phase="compile")

    def _is_current(self, current: int, at_hand: AtHand) -> bool:
        files = self._releases.record(current).get("files")
        directory = self._releases.directory(current).resolve()
        same = files == {each.path: each.sha256 for each in self._wanted}
        return same and all(_has(at_hand, each, directory) for each in self._wanted)

    def _again(self, current: int) -> Said:
        """The same files as they are there already: only who has deployed them is new."""
        directory = self._releases.directory(current)
        record = self._releases.record(current)
        record.update(deploy=self._about, main=self._main, debug=self._debug, commands=self._commands)
        compile_below(directory, self._debug, self._compiling)
        write_whole(directory / _DEPLOY_JSON, json.dumps(self._about, indent=2))
        self._releases.write_record(current, record)
        self._switch(current, None)
        return {"release": current, "previous": current, "files": 0, "bytes": 0, "taken": None, "unchanged": True}

    def _make_room(self, wanted: list[Wanted], at_hand: AtHand) -> AtHand:
        """Look for room for what is written: contents, and compiled files, up to twice as large as their sources.

        :return: what is at hand when there is room; old releases may have had to go
        """
        needed = _RESERVE
        for each in wanted:
            needed += 512
            if at_hand.same_file(each) is None:
                needed += (each.size + 4095) // 4096 * 4096 * (3 if each.path.endswith(".py") else 1)
        if free_bytes(self._places.home) < needed:
            self._releases.prune(kept=1)
            at_hand = AtHand(self._releases, self._wanted)
        free = free_bytes(self._places.home)
        if free < needed:
            raise Refusal(
                "space",
                f"the robot's disk is full: {needed:,} bytes are needed, {free:,} are free",
                "Remove what the project does not need, or old logs from the robot.",
                needed=needed,
                free=free,
            )
        return at_hand

    def _fill(self, wanted: list[Wanted], missing: list[Wanted], at_hand: AtHand) -> None:
        """Put the wanted files into the incoming directory."""
        incoming = self._places.incoming
        incoming.mkdir(parents=True)
        for each in wanted:
            (incoming / each.path).parent.mkdir(parents=True, exist_ok=True)
        received: dict[str, Path] = {}
        contents = Contents(self._wire)
        for each in missing:
            received[each.sha256] = incoming / each.path
            contents.write(each, received[each.sha256])
        if missing:
            contents.end()
        for each in wanted:
            file, same = incoming / each.path, at_hand.same_file(each)
            if file == received.get(each.sha256):
                pass
            elif same is not None:
                link_or_copy(same, file)
                link_compiled(same, file)
                continue
            else:
                _copy(received.get(each.sha256) or at_hand.copy(each), each, file)
            file.chmod(0o755 if each.executable else 0o644)

    def _release(self) -> Said:
        releases, places = self._releases, self._places
        compile_below(places.incoming, self._debug, self._compiling)
        write_whole(places.incoming / _DEPLOY_JSON, json.dumps(self._about, indent=2))
        previous, taken = releases.current(), None
        if releases.is_other_tools():
            taken = releases.next_number()
            releases.take_over(taken)
        number = releases.next_number()
        record: Record = {
            "files": {each.path: each.sha256 for each in self._wanted},
            "main": self._main,
            "debug": self._debug,
            "commands": self._commands,
            "deploy": self._about,
            "from": previous if taken is None else taken,
        }
        code = releases.code()
        self._wire.say(phase="switch")
        releases.write_record(number, record)
        flush(places.own)
        places.incoming.rename(releases.directory(number))
        if code is not None:
            carried = releases.carry(code, releases.directory(number).resolve(), None)
            record["carried"] = {"from": record["from"], "files": carried}
            releases.write_record(number, record)
        self._switch(number, taken)
        releases.prune()
        return {"release": number, "previous": record["from"], "taken": taken, "unchanged": False}

    def _switch(self, number: int, taken: int | None) -> None:
        self._releases.switch(number, self._commands, taken)
        self._releases.set_debug(self._debug)

    def _overwrite(self, code: Path, wanted: list[Wanted]) -> Said:
        """In place: file by file, each of them whole; nothing is deleted."""
        flush(self._places.own)
        for each in wanted:
            target = code / each.path
            target.parent.mkdir(parents=True, exist_ok=True)
            for compiled in compiled_forms(target):
                remove(compiled)
            (self._places.incoming / each.path).replace(target)
        remove(self._places.incoming)
        compile_below(code, self._debug, self._compiling)
        write_whole(code / _DEPLOY_JSON, json.dumps(self._about, indent=2))
        current = self._releases.current()
        if current is not None:
            record = self._releases.record(current)
            record["files"] = {**record.get("files", {}), **{each.path: each.sha256 for each in self._wanted}}
            record.update(deploy=self._about, main=self._main, debug=self._debug, commands=self._commands)
            self._releases.write_record(current, record)
        for name in (COMMAND, DEBUG_COMMAND):
            write_whole(self._places.home / name, self._commands[name] or "")
        flush(self._places.home)
        self._releases.set_debug(self._debug)
        return {"release": current, "previous": current, "taken": None, "unchanged": not wanted}


def _refuse_clashes(wanted: list[Wanted], code: Path) -> None:
    """:raises Refusal: when a file cannot take its place in the directory `code` without anything being deleted"""
    for each in wanted:
        *above, _ = each.path.split("/")
        places = [code.joinpath(*above[: depth + 1]) for depth in range(len(above))]
        clash = next((place for place in places if os.path.lexists(place) and not place.is_dir()), None)
        if clash is not None or (code / each.path).is_dir():
            kind = "directory" if clash is None else "file"
            raise Refusal(
                "path",
                f"{(clash or code / each.path).relative_to(code).as_posix()!r} is a {kind} on the robot",
                "Deploy without --in-place, which deletes nothing.",
            )


def plan(releases: Releases, files: Iterable[Any]) -> Said:
    """What a deploy of these files would do; nothing is written."""
    wanted = wanted_of(files)
    at_hand = AtHand(releases, wanted)
    code = releases.code()
    there: dict[str, Path] = {} if code is None else dict(files_below(code))
    listed = None if code is None else releases.listed(code)
    new = {each.path for each in wanted} | {_DEPLOY_JSON}
    is_code = (lambda name: name.endswith(".py")) if listed is None else listed.__contains__
    missing = at_hand.missing(wanted)
    return {
        "added": [each.path for each in wanted if each.path not in there],
        "changed": [each.path for each in wanted if each.path in there and code and not _has(at_hand, each, code)],
        "removed": sorted(name for name in there if name not in new and is_code(name)),
        "files": len(missing),
        "bytes": sum(each.size for each in missing),
    }


def _copy(source: Path | None, wanted: Wanted, file: Path) -> None:
    """A copy of a file that may be the program's own, and changed at any moment: what was copied is what counts."""
    if source is not None:
        with source.open("rb") as reading, file.open("wb") as writing:
            while block := reading.read(BLOCK):
                writing.write(block)
    if source is None or sha256_of(file) != wanted.sha256:
        raise Refusal("changed", f"{wanted.path} was changed by the robot program in this moment", "Deploy again.")


def _has(at_hand: AtHand, wanted: Wanted, code: Path) -> bool:
    """Whether the file of this name in the directory `code` is as wanted."""
    file, same = code / wanted.path, at_hand.same_file(wanted)
    if same is None or not file.is_file():
        return False
    return same == file or same.samefile(file)
