"""Files with the inputs of a run: input scripts, and WPILib's data logs."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path

from ...log_formats import FOREIGN_LOGS
from ...season import CURRENT
from ...wording import from_here
from .file_kinds import described, is_ds_log, read_head
from .file_kinds import is_data_log as begins_as_data_log
from .script import InputScript, ScriptError, load_script, script_beside

_SCRIPT, _DATA_LOG = ".jsonl", ".wpilog"
_NEEDED = "an input script or a data log"
_KINDS = (
    "Input scripts (.jsonl) are written by pyfrc sim --record, pyfrc test --record and pyfrc fuzz; data logs (.wpilog) "
    "by robots and pyfrc sim --wpilog."
)


def is_data_log(file: Path) -> bool:
    """Return whether a file, which exists, is a data log."""
    return begins_as_data_log(read_head(file, _NEEDED, ScriptError), file.name)


def load_inputs(file: Path, given: Collection[str] = ()) -> InputScript:
    """Read an input script, or the inputs in a data log.

    :param given: of a data log, the entries of NetworkTables that a person has set
    :raises UsageError: saying what the file is instead, or naming the line and what is wrong with it
    """
    head = read_head(file, _NEEDED, ScriptError)
    if begins_as_data_log(head, file.name):
        from .data_log import script_from_log  # imports WPILib

        return script_from_log(file, given)
    suffix, where = file.suffix.lower(), from_here(file)
    if suffix in (".dslog", ".dsevents") or is_ds_log(head):
        raise ScriptError(
            "the driver station's log does not have the joysticks",
            where=where,
            remedy="Take the data log of the robot of the same match (.wpilog).",
        )
    if remedy := FOREIGN_LOGS.get(suffix):
        raise ScriptError("this log cannot be read directly", where=where, remedy=remedy)
    first_line, (what, remedy) = head.partition(b"\n")[0], described(head, file.name)
    if what == "JSON" and b'"pyfrc-trace' in first_line:
        script = script_beside(file)
        raise ScriptError(
            "a trace has no inputs", where=where, remedy=f"Its input script is {script.name}." if script else _KINDS
        )
    if suffix == _DATA_LOG and what == "JSON":
        raise ScriptError("this is JSON, not a data log", where=where, remedy="Input scripts have the ending .jsonl.")
    if (suffix == _SCRIPT and what in ("JSON", "text", "")) or (what == "JSON" and b'"format"' in first_line):
        return load_script(file)
    if not head:
        raise ScriptError("this file is empty", where=where, remedy=_KINDS)
    raise ScriptError(f"this is {what}, neither an input script nor a data log", where=where, remedy=remedy or _KINDS)


def remarks(script: InputScript) -> Iterator[str]:
    """Yield what users should know about a script's file: that it is damaged, is of another season, or lacks inputs."""
    if script.problem:
        yield f"{script.file}: {script.problem}."
    if script.year not in (None, CURRENT.year):
        yield (
            f"{script.file} is of {script.year}, and WPILib {CURRENT.year} is installed here: the field, devices and "
            "the numbers of buttons may differ."
        )
    for _, lack in script.lacks:
        yield f"{script.file} has {lack}."
