"""Watch which entries of NetworkTables robot code reads, of which type, and with which default.

An entry that only the robot reads is in no list of NetworkTables: a camera's table is empty as long as there is no
camera. So the functions that read are intercepted in Python. Subscribing is reading, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import starmap

from ...compat.cpython_private import get_frame
from ...patch_table import Patch, patched
from ...project.robot_files import RobotFiles
from ...runtime.simulation_code import is_of_simulation
from ...wpi import names, network_reads
from .network_values import STRUCTS, NetworkRead


class NetworkReads:
    """The entries that robot code has read, by name, in the order of their first reading."""

    def __init__(self, files: RobotFiles) -> None:
        self.found: dict[str, NetworkRead] = {}
        self._files = files
        #: Called before the first reading of an entry.
        self.on_first: Callable[[NetworkRead], None] = lambda read: None

    def note(self, name: str, type_name: str, values: tuple[object, ...], named: dict[str, object]) -> None:
        """Note a reading, if robot code reads and not a library: cameras' libraries check what they receive.

        :param values: the arguments of the call; the last one is the default
        :param named: the arguments that have names
        """
        frame = get_frame(2)
        file = frame.f_code.co_filename
        if not self._files.is_robot_code(file) and not file.endswith(names.TUNABLES_FILE):
            return
        if is_of_simulation(frame):  # the robot may read it later
            return
        default = values[-1] if values else next(iter(named.values()), None)
        read = self.found[name] = NetworkRead(name, type_name, default)
        self.on_first(read)


@contextmanager
def watch_network_reads(files: RobotFiles) -> Iterator[NetworkReads]:
    """Watch until the context ends."""
    reads = NetworkReads(files)
    numbers = {name: len(spans) for name, spans in STRUCTS.items()}
    with patched(starmap(Patch, network_reads.replacements(reads, numbers))):
        yield reads
