"""Files with the inputs of a run: input scripts, and WPILib's data logs."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from .script import InputScript, load_script

#: The suffix of WPILib's data logs.
DATA_LOG = ".wpilog"


def load_inputs(file: Path, given: Collection[str] = ()) -> InputScript:
    """Read an input script, or the inputs in a data log.

    :param given: of a data log, the entries of NetworkTables that a person has set
    :raises ScriptError: naming the line and what is wrong with it
    """
    if file.suffix.lower() == DATA_LOG:
        from .data_log import script_from_log  # imports WPILib

        return script_from_log(file, given)
    return load_script(file)
