"""The deploy transaction on the robot: assemble the next release beside the current one, then switch to it."""

from __future__ import annotations

import hashlib
import json
import zlib
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from .activity import Activity
from .carrying import Carried
from .compiling import CompiledForms, Compiler, compile_below, compiled_hashes
from .content_index import DEPLOY_JSON, ContentIndex, WantedFile, parse_manifest
from .disk import BLOCK, files_below, free_bytes, link_or_copy, sha256_of, sync, write_whole
from .integrity import compiled_files, mend_releases
from .release_record import Record
from .releases import Releases
from .robot_paths import Refusal, start_commands
from .wire import Message, Wire

#: Bytes of disk space that stay free for the program's own files after a deploy.
RESERVE = 256 * 1024


class ContentReader:
    """Reads file contents that the laptop sends in one compressed stream."""

    def __init__(self, wire: Wire, activity: Activity) -> None:
        self._wire = wire
        self._activity = activity
        self._unpacking = zlib.decompressobj()
        self._ready = b""

    def write(self, wanted: WantedFile, file: Path) -> None:
        """Write the next content to `file`.

        :raises Refusal: if it does not have the expected hash
        """
        digest, left = hashlib.sha256(), wanted.size
        with file.open("wb") as stream:
            while left:
                chunk = self._take(left)
                digest.update(chunk)
                stream.write(chunk)
                left -= len(chunk)
                self._activity.step(len(chunk))
        if digest.hexdigest() != wanted.sha256:
            raise Refusal("changed", f"{wanted.path} was changed while it was sent", "Deploy again.")

    def end(self) -> None:
        """Read the end of the stream.

        :raises Refusal: if it has more contents
        """
        while self._ready or not self._unpacking.eof:
            if self._ready or self._unpack():
                raise Refusal("protocol", "received more contents than requested")

    def _take(self, most: int) -> bytes:
        while not self._ready:
            if self._unpacking.eof:
                raise Refusal("protocol", "received fewer contents than requested")
            self._ready = self._unpack()
        chunk, self._ready = self._ready[:most], self._ready[most:]
        return chunk

    def _unpack(self) -> bytes:
        packed = self._unpacking.unconsumed_tail or self._wire.receive_contents()
        try:
            return self._unpacking.decompress(packed, BLOCK)
        except zlib.error as error:
            raise Refusal("protocol", f"the contents cannot be decompressed: {error}") from error


class Deploy:
    """One deploy. The caller holds the deploy lock and has called `Releases.recover`."""

    def __init__(self, releases: Releases, wire: Wire, request: Message) -> None:
        self._releases = releases
        self._activity = releases.activity
        self._paths = releases.paths
        self._wire = wire
        self._wanted = parse_manifest(request["files"])
        self._about = request.get("deploy_json") or {}
        self._main = str(request["main"])
        self._debug = bool(request.get("debug"))
        #: Whether a restart follows, which removes old releases.
        self._restarts = bool(request.get("restart"))
        self._environment = request.get("environment")
        #: Hashes of compiled files that are links, by their paths.
        self._linked: dict[str, str] = {}
        #: Whether to compile everything again, and to replace damaged files of other releases.
        self._reinstall = bool(request.get("reinstall"))
        self._program = frozenset(request.get("program") or ())
        self._commands = start_commands(self._paths.layout, self._main, self._debug, self._environment)

    def run(self) -> Message:
        """Carry out the deploy, and return the result for the laptop."""
        if self._main not in {each.path for each in self._wanted}:
            raise Refusal("main", f"there is no {self._main} among the files")
        at_hand = ContentIndex(self._releases, self._wanted, self._activity)
        at_hand = self._check_disk_space(at_hand)
        missing = at_hand.missing(self._wanted)
        self._wire.send(need=[each.path for each in missing], bytes=sum(each.size for each in missing))
        current = self._releases.current()
        if current is not None and self._is_current(current, at_hand):
            return self._redeploy(current)
        self._fill_incoming(missing, at_hand)
        return {**self._release(), "files": len(missing), "bytes": sum(each.size for each in missing)}

    def _is_current(self, current: int, at_hand: ContentIndex) -> bool:
        files = self._releases.record(current).get("files")
        directory = self._releases.directory(current).resolve()
        same = files == {each.path: each.sha256 for each in self._wanted}
        same = same and self._releases.record(current).get("environment") == self._environment
        return same and not self._reinstall and all(at_hand.has(each, directory) for each in self._wanted)

    def _redeploy(self, current: int) -> Message:
        """Update only the record of the current release, which already has the same files."""
        directory = self._releases.directory(current)
        record = self._releases.record(current)
        record.update(deploy=self._about, main=self._main, debug=self._debug, commands=self._commands)
        compile_below(directory, self._debug, self._activity, self._paths.layout.code, self._program)
        self._linked = record.get("compiled", {})
        record["compiled"] = self._compiled(directory)
        self._write_about(directory)
        self._releases.write_record(current, record)
        self._switch(current, None)
        return {"release": current, "previous": current, "files": 0, "bytes": 0, "taken": None, "unchanged": True}

    def _check_disk_space(self, at_hand: ContentIndex) -> ContentIndex:
        """Check that there is enough disk space, and remove old releases if there is not.

        Contents and compiled files are counted; a compiled file may have twice the size of its source.

        :return: the index of contents, which is new if releases were removed
        :raises Refusal: if there is not enough disk space
        """
        needed = RESERVE
        for each in self._wanted:
            needed += 512
            if at_hand.same_file(each) is None:
                needed += (each.size + 4095) // 4096 * 4096 * (3 if each.path.endswith(".py") else 1)
        if free_bytes(self._paths.home) < needed:
            self._releases.prune(kept=1)
            at_hand = ContentIndex(self._releases, self._wanted, self._activity)
        free = free_bytes(self._paths.home)
        if free < needed:
            raise Refusal(
                "space",
                f"the robot's disk is full: {needed:,} bytes are needed, {free:,} are free",
                "Remove what the project does not need, or old logs from the robot.",
                needed=needed,
                free=free,
            )
        return at_hand

    def _fill_incoming(self, missing: list[WantedFile], at_hand: ContentIndex) -> None:
        """Write and compile the wanted files in the incoming directory.

        :param missing: files whose contents were requested
        """
        incoming, activity = self._paths.incoming, self._activity
        incoming.mkdir(parents=True)
        for directory in sorted({each.path.rpartition("/")[0] for each in self._wanted}):
            (incoming / directory).mkdir(parents=True, exist_ok=True)
        linked = self._link(at_hand)
        first = {each.sha256: each for each in missing}
        copied = [each for each in self._wanted if each.path not in linked and first.get(each.sha256) != each]
        at_once = [name for name, is_compiled in linked.items() if not is_compiled and name.endswith(".py")]
        sources = at_once + [each.path for each in (*missing, *copied) if each.path.endswith(".py")]
        with Compiler(incoming, sources, self._debug, self._program, self._paths.layout.code) as compiler:

            def complete(each: WantedFile) -> None:
                (incoming / each.path).chmod(0o755 if each.executable else 0o644)
                if each.path.endswith(".py"):
                    compiler.add_next()

            for _ in at_once:
                compiler.add_next()
            activity.begin("receive", sum(each.size for each in missing))
            if missing:
                contents = ContentReader(self._wire, activity)
                for each in missing:
                    contents.write(each, incoming / each.path)
                    complete(each)
                contents.end()
            activity.begin("copy", len(copied))
            for each in copied:
                received = first.get(each.sha256)
                source = at_hand.copy(each) if received is None else str(incoming / received.path)
                _copy(source, each, incoming / each.path, activity)
                complete(each)
                activity.step()
            compiler.finish(activity)

    def _link(self, at_hand: ContentIndex) -> dict[str, bool]:
        """Link the files that another release already has.

        :return: for each linked path, whether it has a compiled file
        """
        incoming, forms, linked = str(self._paths.incoming), CompiledForms(), {}
        recorded = {} if self._reinstall else compiled_files(self._releases)

        def is_good(form: str) -> bool:
            with suppress(OSError):
                if form in recorded and sha256_of(form, self._activity) == recorded[form]:
                    above, name = each.path.rpartition("/")[0], form.rpartition("/")[2]
                    self._linked[f"{above}/__pycache__/{name}".lstrip("/")] = recorded[form]
                    return True
            return False

        self._activity.begin("link", len(self._wanted))
        for each in self._wanted:
            same = at_hand.same_file(each)
            if same is not None:
                file = f"{incoming}/{each.path}"
                link_or_copy(same, file)
                all_linked = forms.link(same, file, is_good)
                linked[each.path] = all_linked and forms.includes(same, self._debug)
            self._activity.step()
        return linked

    def _write_about(self, directory: Path) -> None:
        write_whole(directory / DEPLOY_JSON, json.dumps(self._about, indent=2), between=self._paths.between)

    def _compiled(self, directory: Path) -> dict[str, str]:
        return compiled_hashes(directory, (each.path for each in self._wanted), self._activity, self._linked)

    def _release(self) -> Message:
        releases, paths = self._releases, self._paths
        sync(paths.own, self._activity)  # the contents, which takes long; the rest is small
        self._write_about(paths.incoming)
        previous, taken = releases.current(), None
        if releases.is_other_tools():
            taken = releases.next_number()
            releases.adopt_directory(taken)
        number = releases.next_number()
        record: Record = {
            "files": {each.path: each.sha256 for each in self._wanted},
            "compiled": self._compiled(paths.incoming),
            "main": self._main,
            "debug": self._debug,
            "commands": self._commands,
            "deploy": self._about,
            "from": previous if taken is None else taken,
        }
        if self._environment is not None:
            record["environment"] = self._environment
        code = releases.code()
        carried = Carried({}, [], [])
        self._wire.send(phase="switch")
        if code is not None:
            manifest = {*record["files"], DEPLOY_JSON}
            carried = releases.carry_over(code, paths.incoming.resolve(), None, manifest)
            record["carried"] = {"from": record["from"], "files": carried.files}
        releases.write_record(number, record)
        sync(paths.own, self._activity)
        paths.incoming.rename(releases.directory(number))
        try:
            self._switch(number, taken)
        except BaseException:
            if not releases.may_start(number):
                with suppress(OSError):
                    releases.discard(number)
            raise
        if self._reinstall:
            mend_releases(releases, number)
        if not self._restarts:
            with suppress(OSError):  # the next deploy removes the rest
                releases.prune()
        done = {"release": number, "previous": record["from"], "taken": taken, "unchanged": False}
        return {**done, "skipped": carried.skipped, "renamed": carried.renamed}

    def _switch(self, number: int, taken: int | None) -> None:
        self._releases.switch(number, self._commands, taken)
        self._releases.set_debug(self._debug)


def plan(releases: Releases, files: Iterable[Any]) -> Message:
    """Return what a deploy of these files would do, without writing anything."""
    wanted = parse_manifest(files)
    at_hand = ContentIndex(releases, wanted, releases.activity)
    code = releases.code()
    there = set() if code is None else {name for name, _ in files_below(code)}
    listed = None if code is None else releases.manifest_paths(code)
    new = {each.path for each in wanted} | {DEPLOY_JSON}
    is_code = (lambda name: name.endswith(".py")) if listed is None else listed.__contains__
    missing = at_hand.missing(wanted)
    return {
        "added": [each.path for each in wanted if each.path not in there],
        "changed": [each.path for each in wanted if each.path in there and code and not at_hand.has(each, code)],
        "removed": sorted(name for name in there if name not in new and is_code(name)),
        "files": len(missing),
        "bytes": sum(each.size for each in missing),
    }


def _copy(source: str | None, wanted: WantedFile, file: Path, activity: Activity) -> None:
    """Copy a file and check the hash of the copy, since the program may change the source at any moment."""
    if source is not None:
        with Path(source).open("rb") as reading, file.open("wb") as writing:
            while block := reading.read(BLOCK):
                writing.write(block)
    if source is None or sha256_of(str(file), activity) != wanted.sha256:
        raise Refusal("changed", f"{wanted.path} was changed by the robot program during the deploy", "Deploy again.")
