"""pip for another computer: it chooses packages as if it ran there.

pip chooses wheels for another computer (``--platform``), but evaluates the markers of requirements, such as
``platform_machine == "roborio"``, for the computer that it runs on, and has no option for them. WPILib's packages need
different packages on robots. So `main` runs pip in a process of its own, with another environment of markers.
"""

from __future__ import annotations

import json
import runpy
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..patch_table import PatchTable
from .private_name import PrivateName

#: The function that returns the values of markers.
MARKERS = PrivateName(
    "pip._vendor.packaging.markers:default_environment",
    "pyfrc sync has pip evaluate the markers of requirements for the robot",
)
NAMES = (MARKERS,)

#: Python's arguments. Its first own argument is the directory of this package, in place of the current directory, where
#: a module of the user's might be in the way.
_ARGUMENTS = ("-c", f"import sys; sys.path[0] = sys.argv.pop(1); from {__name__} import main; main()")


def pip_command(environment: Mapping[str, str], arguments: Sequence[str]) -> list[str]:
    """Return the command that runs pip with other values of markers.

    :param environment: the values, by the names that markers have for them
    :param arguments:   pip's
    """
    directory = str(Path(__file__).resolve().parents[2])
    return [sys.executable, *_ARGUMENTS, directory, json.dumps(dict(environment)), *arguments]


def main() -> None:
    """Run pip with the rest of this process's arguments; the first one has the values of markers."""
    environment: dict[str, str] = json.loads(sys.argv[1])
    owner, name = MARKERS.place
    PatchTable().patch(owner, name, lambda: dict(environment))
    marker = owner.Marker(f"platform_machine == {environment['platform_machine']!r}")
    if not marker.evaluate():
        raise SystemExit(f"ERROR: {MARKERS.missing()}")
    sys.argv[:] = ["pip", *sys.argv[2:]]
    runpy.run_module("pip", run_name="__main__", alter_sys=True)
