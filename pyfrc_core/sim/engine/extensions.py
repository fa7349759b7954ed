"""WPILib's simulation extensions: libraries that are loaded beside the simulated HAL."""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from dataclasses import dataclass

from ...errors import UsageError
from ...season import CURRENT


@dataclass(frozen=True)
class Extension:
    """A known extension.

    :param module: the module that is loaded
    :param package: the package to install
    :param last_year: the last season in which it does something
    """

    module: str
    package: str
    last_year: int | None = None


EXTENSIONS = {
    "ds-socket": Extension("halsim_ds_socket", "robotpy-halsim-ds-socket", last_year=2026),
    "ws-server": Extension("halsim_ws.server", "robotpy-halsim-ws"),
    "ws-client": Extension("halsim_ws.client", "robotpy-halsim-ws"),
}


#: WPILib's simulator window, which needs the process's main thread.
WINDOW = "gui"
#: All that a simulation can load.
LOADABLE = {**EXTENSIONS, WINDOW: Extension("halsim_gui", "robotpy-halsim-gui")}


def check_installed(names: Sequence[str]) -> None:
    """Check that these extensions can be loaded.

    :raises UsageError: naming the package to install
    """
    for name in names:
        if name not in LOADABLE:
            raise UsageError(f"there is no extension {name!r}", remedy=f"There is: {', '.join(EXTENSIONS)}.")
        extension = LOADABLE[name]
        if extension.last_year is not None and CURRENT.year > extension.last_year:
            raise UsageError(
                f"the extension {name} does nothing with WPILib {CURRENT.year}",
                remedy="Drive the robot in the page of `pyfrc sim`.",
            )
        if importlib.util.find_spec(extension.module.partition(".")[0]) is None:
            raise UsageError(
                "WPILib's simulator window is not installed"
                if name == WINDOW
                else f"the extension {name} is not installed",
                remedy=f"Install it with: pip install {extension.package}",
            )
