"""Whether the robot is ready for a program of ours; what is not right is told with what to do about it."""

from __future__ import annotations

import re
import threading
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING

from .connection import ADMINISTRATOR, connect
from .errors import DeployError, RefusedError
from .host_keys import HostKeys
from .progress import Progress

if TYPE_CHECKING:
    from .discovery import Address
    from .facts import RobotFacts

_NO_CHECK = "If you are sure that it works all the same: -n (--no-version-check)."

# Without it, some services of the image load libraries that robots do not use.
_MEMORY_SAVER = "sed -i -e 's/^StartupDLLs/;StartupDLLs/' /etc/natinst/share/ni-rt.ini"


def refuse_unfit_robot(facts: RobotFacts, where: str, check_versions: bool) -> None:
    """:raises RefusedError: when the program could not run there, or (`check_versions`) might not"""
    if facts.not_roborio is not None:
        raise RefusedError(
            f"this is no roboRIO: {facts.not_roborio}",
            where=where,
            remedy="Is that the right address? Name the robot with --robot HOST. A new roboRIO has to be imaged first, "
            "with the roboRIO Imaging Tool.",
        )
    ours = _our_wpilib()
    if facts.wpilib is None:
        raise RefusedError(
            "there is no wpilib for Python on the robot",
            where=where,
            remedy=f"Install it with the package robotpy: python -m robotpy installer download wpilib=={ours} on the "
            f"internet, then at the robot: python -m robotpy installer install wpilib=={ours}",
        )
    if not check_versions:
        return
    if facts.wpilib != ours:
        raise RefusedError(
            f"the robot has wpilib {facts.wpilib}, this computer has {ours}: what passes here may fail there",
            where=where,
            remedy=f"Install the same on both. {_NO_CHECK}",
        )
    year = _year(facts.image)
    if year is not None and year < int(ours.partition(".")[0]):
        raise RefusedError(
            f"the robot's image is of {year} ({facts.image}), wpilib {ours} needs that of its own year",
            where=where,
            remedy=f"Image the robot with this season's roboRIO Imaging Tool. {_NO_CHECK}",
        )


class MemorySaver:
    """Gives the program 24 MB that the image's services take for nothing.

    It needs the administrator, and so a connection of its own, meanwhile; and hinders nothing when it fails.

    :param keys: in which the robot's key is pinned
    """

    def __init__(self, facts: RobotFacts, address: Address, keys: HostKeys) -> None:
        self._address = address
        self._keys = keys
        self._problem: str | None = None
        self._thread = threading.Thread(target=self._run) if facts.startup_dlls else None
        if self._thread is not None:
            self._thread.start()

    def tell(self, progress: Progress) -> None:
        """Wait for it, and tell what came of it."""
        if self._thread is None:
            return
        self._thread.join()
        if self._problem is None:
            progress.note("  StartupDLLs was switched off: 24 MB more memory from the robot's next start on")
        else:
            progress.warning(f"StartupDLLs, which costs 24 MB of memory, could not be switched off: {self._problem}")

    def _run(self) -> None:
        try:
            with connect(self._address, self._keys, user=ADMINISTRATOR) as administrator:
                status, printed = administrator.run(_MEMORY_SAVER)
            if status != 0:
                self._problem = printed.strip() or f"exit code {status}"
        except (DeployError, OSError) as error:
            self._problem = str(error)


def _our_wpilib() -> str:
    try:
        return version("wpilib")
    except PackageNotFoundError:  # our own dependency: somebody has removed it
        raise RefusedError(
            "there is no wpilib on this computer", remedy="Install it: pip install --force-reinstall pyfrc"
        ) from None


def _year(image: str | None) -> int | None:
    """``FRC_roboRIO_2026_v2.0`` is of 2026."""
    found = re.search(r"_(20[0-9]{2})_", image or "")
    return int(found[1]) if found else None
