"""`pyfrc logs`: the logs on the robot, listed, fetched and removed.

A log is fetched piece by piece into ``.NAME.part``, which a later command continues if the robot's log begins with it.
It gets its name when the robot has the same hash.
"""

from __future__ import annotations

import errno
import os
import re
import shutil
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import UsageError
from ..file_hash import hash_file
from ..log_formats import FOREIGN_LOGS
from ..project import Project
from ..shell import quoted
from ..text_files import keep_out_of_version_control
from ..wording import counted, from_here, size_text, table
from .errors import ConnectionFailedError, DeployError, RefusedError
from .manifest import ascii_path
from .progress import DeployProgress, UserInterface
from .target_connection import connected_agent
from .team import RobotChoice, choose_target

if TYPE_CHECKING:
    from .agent_client import AgentClient
    from .facts import RobotLog

#: Where logs are written, in the project or the current directory.
LOGS = "logs"
_PIECE_BYTES = 1 << 19
_HOW_TO_LOG = "Robots write them after wpilib.DataLogManager.start()."
_GOES_ON = "Run the command again: it goes on where this one has ended."


@dataclass(frozen=True)
class LogRequest:
    """The options of the command.

    :param wanted: names of logs, or words in them; without any, the logs are listed
    :param into: the directory to write them in; None: ``logs``, in the project or the current directory
    :param delete: whether to remove them from the robot afterwards
    :param confirmed: without a question
    """

    wanted: Sequence[str] = ()
    into: Path | None = None
    delete: bool = False
    confirmed: bool = False


def fetch_logs(project: Project | None, choice: RobotChoice, request: LogRequest, talk: UserInterface) -> None:
    """List the robot's logs, or fetch some of them.

    :raises UsageError: if the options contradict each other
    :raises DeployError: if a log cannot be fetched; what has been fetched of it stays
    """
    if request.delete and not request.wanted:
        raise UsageError("--delete needs the names of logs, which are fetched first", remedy="List them: pyfrc logs")
    if request.delete and not request.confirmed and talk.ask is None:
        raise UsageError("confirmation needed: the logs will be removed from the robot", remedy="Confirm with --yes.")
    own = (Path.cwd() if project is None else project.root) / LOGS
    into = request.into or own
    target, progress = choose_target(project, choice, talk.ask), talk.progress
    with connected_agent(target, choice, progress) as (connection, robot):
        with progress.phase("logs") as phase:
            there, older = robot.logs()
            phase.detail = counted(len(there), "log") + f", and {older} older ones that are not listed" * bool(older)
        wanted = request.wanted
        if not wanted:
            listed = {"host": connection.host, "logs": [{**asdict(each), "match": each.match} for each in there]}
            *usb, in_home = connection.controller.layout.logs
            none = f"There are no logs in {', '.join(usb)} (a USB stick) and {in_home}. {_HOW_TO_LOG}"
            progress.result(listed, "\n".join(_lines(there)) or none, requested=True)
            if there and talk.ask is not None:
                answer = talk.ask.text("Fetch which ones? Numbers, or words in their names; 0: none")
                wanted = [word for word in answer.split() if word != "0"]
        if not wanted:
            return
        chosen = _chosen(there, wanted, by_number=not request.wanted)
        if into == own:
            keep_out_of_version_control(own)
        fetched = _fetch_all(robot, chosen, into, progress)
        removed = _removed(robot, chosen, request, talk) if request.delete else []
        files = [str(file) for file in fetched]
        file = min(fetched, key=lambda each: each.suffix.lower() in FOREIGN_LOGS)
        view = f"To look at it: pyfrc view {quoted(from_here(file))}"
        text = FOREIGN_LOGS.get(file.suffix.lower(), view)
        progress.result({"host": connection.host, "fetched": files, "removed": removed}, text)


def _lines(logs: Sequence[RobotLog]) -> list[str]:
    """Return the list of logs for people; times are those of this computer."""
    rows = [
        (
            str(number),
            ascii_path(log.name),
            log.match or "-",
            size_text(log.size),
            datetime.fromtimestamp(min(log.modified, 4e9)).strftime("%Y-%m-%d %H:%M"),
            "USB stick" if log.usb else "robot",
            "just written" if log.written else "",
        )
        for number, log in enumerate(logs, 1)
    ]
    return list(table(rows, 3, 3)) if rows else []


def _chosen(logs: Sequence[RobotLog], wanted: Sequence[str], by_number: bool) -> list[RobotLog]:
    """Return the logs that are named, the newest first.

    :param by_number: whether a small number is that of the list, which has just been shown
    :raises UsageError: if there is none for a name
    """
    chosen = set()
    for word in wanted:
        pattern = re.compile(rf"(?<![A-Za-z0-9]){re.escape(word)}(?![A-Za-z0-9])", re.IGNORECASE)
        found = {number for number, log in enumerate(logs) if word == "all" or pattern.search(log.name)}
        if by_number and word.isdecimal() and 0 < int(word) <= len(logs):
            found = {int(word) - 1}
        if not found:
            newest = ", ".join(ascii_path(log.name) for log in logs[:3])
            raise UsageError(
                f"no log on the robot has {word!r} in its name", remedy=f"The newest: {newest or 'there are none'}."
            )
        chosen |= found
    return [logs[number] for number in sorted(chosen)]


def _fetch_all(robot: AgentClient, chosen: list[RobotLog], into: Path, progress: DeployProgress) -> list[Path]:
    into.mkdir(parents=True, exist_ok=True)
    needed, free = sum(_missing(log, into / _local_name(log.name)) for log in chosen), shutil.disk_usage(into).free
    if needed > free:
        what = f"this computer's disk has too little room: {size_text(needed)} are missing, {size_text(free)} are free"
        raise RefusedError(what, where=str(into), remedy="Fetch fewer logs, or choose another disk: --into DIRECTORY")
    fetched = []
    for log in chosen:
        file = into / _local_name(log.name)
        with progress.phase("fetch") as phase:
            try:
                has_grown = fetch_log(robot, log, file, phase.bytes)
            except ConnectionFailedError as error:
                error.remedy = f"Check the connection. {_GOES_ON}"
                raise
            phase.detail = f"{from_here(file)}, {size_text(log.size)}"
        if has_grown:
            progress.note(f"  the robot is still writing {ascii_path(log.name)}: fetch it again later for the rest")
        fetched.append(file)
    return fetched


def _missing(log: RobotLog, file: Path) -> int:
    """Return how many bytes of a log are not here."""
    here = [each.stat().st_size for each in (file, _part_of(file)) if each.exists()]
    return max(0, log.size - max(here, default=0))


def _part_of(file: Path) -> Path:
    return file.with_name(f".{file.name}.part")  # hidden: no deploy uploads it


def _local_name(name: str) -> Path:
    """Return a log's path on this computer: without letters that no file may have here, and below its directory."""
    return Path(*(re.sub(r"[^\w.+ -]", "_", part).strip(". ") or "_" for part in name.split("/")))


def fetch_log(robot: AgentClient, log: RobotLog, file: Path, on_bytes: Callable[[int, int], None]) -> bool:
    """Fetch a log as it was when it was listed, and return whether it has grown since.

    :param on_bytes: called with the number of bytes that are here, and of all
    :raises RefusedError: if there is another file of this name
    :raises DeployError: if it is not the same as on the robot, or the disk is full
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    part = _part_of(file)
    try:
        done = _begun(robot, log, file, part)
        if done == log.size and file.exists() and not part.exists():
            return False  # it is here already
        with part.open("ab") as stream:
            while done < log.size:
                on_bytes(done, log.size)
                piece = robot.read_log(log.path, done, min(_PIECE_BYTES, log.size - done))
                if not piece:
                    what = f"{ascii_path(log.path)} has become shorter on the robot"
                    raise DeployError(what, remedy="Fetch it again.")
                stream.write(piece)
                done += len(piece)
            stream.flush()
            os.fsync(stream.fileno())
    except OSError as error:
        if error.errno not in (errno.ENOSPC, errno.EDQUOT):
            raise
        remedy = f"Make room on it, or choose another one: --into DIRECTORY. {_GOES_ON}"
        raise DeployError("this computer's disk is full", where=str(part), remedy=remedy) from error
    sha256, size = robot.hash_log(log.path, log.size)
    if hash_file(part)[0] != sha256:
        part.unlink()
        what = f"{ascii_path(log.name)} was changed on the robot meanwhile, or was damaged on its way"
        raise DeployError(what, remedy="Fetch it again.")
    part.replace(file)
    return size > log.size


def _begun(robot: AgentClient, log: RobotLog, file: Path, part: Path) -> int:
    """Return how many bytes of a log are in its part, which an earlier command, or an earlier log, may have begun."""
    for kept in (part, file):
        size = kept.stat().st_size if kept.exists() else None
        if size is not None and size <= log.size and robot.hash_log(log.path, size)[0] == hash_file(kept)[0]:
            if kept is file and size < log.size:
                shutil.copyfile(file, part)
            return size
        if kept is part:
            part.unlink(missing_ok=True)
    if file.exists():
        remedy = "Rename it, or fetch into another directory: --into DIRECTORY"
        raise RefusedError("there is another file of this name, not the robot's log", where=file, remedy=remedy)
    return 0


def _removed(robot: AgentClient, chosen: list[RobotLog], request: LogRequest, talk: UserInterface) -> list[str]:
    """Remove logs that were fetched from the robot, if the user confirms it, and return their paths."""
    what = f"{counted(len(chosen), 'log')} ({size_text(sum(log.size for log in chosen))})"
    if not request.confirmed and not (talk.ask is not None and talk.ask.yes(f"Remove {what} from the robot?")):
        return []
    removed: list[str] = []
    for log in chosen:
        try:
            robot.remove_log(log.path, log.size)
        except RefusedError as error:
            talk.progress.warning(error.message)
        else:
            removed.append(log.path)
            talk.progress.note(f"  removed from the robot: {ascii_path(log.path)}")
    return removed
