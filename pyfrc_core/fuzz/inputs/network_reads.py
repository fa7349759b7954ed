"""Watch which entries of NetworkTables robot code reads, of which type, and with which default.

An entry that only the robot reads is in no list of NetworkTables: a camera's table is empty as long as there is no
camera. So the functions that read are intercepted in Python. Subscribing is reading, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from types import FrameType
from typing import Any

import ntcore
import wpilib

from ...compat.cpython_private import get_frame
from ...project.robot_files import RobotFiles
from ...runtime.patch_table import Patch
from ...wpi import names
from ..prepared_patches import PreparedPatches
from .network_values import STRUCTS, NetworkRead

#: The names that NetworkTables gives to types, by the names in its functions.
_TYPES = {
    "Boolean": "boolean",
    "Integer": "int",
    "Float": "float",
    "Double": "double",
    "String": "string",
    "BooleanArray": "boolean[]",
    "IntegerArray": "int[]",
    "FloatArray": "float[]",
    "DoubleArray": "double[]",
    "StringArray": "string[]",
}
#: The names of types that differ in the tables' and the preferences' functions.
_TABLE_TYPES = {**_TYPES, "Number": "double", "NumberArray": "double[]"}
_PREFERENCE_TYPES = {**_TYPES, "Int": "int", "Long": "int"}


#: The library file that reads on behalf of robot code: MagicBot's tunables.
_TUNABLES = "magic_tunable.py"
#: The file that runs in simulations only.
_PHYSICS = "physics.py"


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
        if not self._files.is_robot_code(file) and not file.endswith(_TUNABLES):
            return
        if _is_of_simulation(frame):  # the robot may read it later
            return
        default = values[-1] if values else next(iter(named.values()), None)
        read = self.found[name] = NetworkRead(name, type_name, default)
        self.on_first(read)


def _is_of_simulation(frame: FrameType | None) -> bool:
    """Return whether simulation code calls: what it alone reads is no input of a robot."""
    while frame is not None:
        code = frame.f_code
        if code.co_name in names.OF_SIMULATION or code.co_filename.endswith(_PHYSICS):
            return True
        frame = frame.f_back
    return False


def watch_network_reads(files: RobotFiles) -> AbstractContextManager[NetworkReads]:
    """Watch until the context ends."""
    return _watches.watching(lambda: NetworkReads(files))


def prepare_network_watch(files: RobotFiles, prepare: bool = True) -> None:
    """Prepare `watch_network_reads` for the forks of this process, or undo that."""
    if prepare:
        _watches.prepare(NetworkReads(files))
    else:
        _watches.undo()


def _patches(reads: NetworkReads) -> Iterator[Patch]:
    for owner in (ntcore.NetworkTableEntry, ntcore.GenericSubscriber):
        for name, type_name in _TYPES.items():
            yield Patch(owner, f"get{name}", _of_entry(vars(owner)[f"get{name}"], type_name, reads))
    for name, type_name in _TABLE_TYPES.items():
        if f"get{name}" in vars(ntcore.NetworkTable):
            real = vars(ntcore.NetworkTable)[f"get{name}"]
            yield Patch(ntcore.NetworkTable, f"get{name}", _of_table(real, type_name, reads))
    for name, type_name in _TABLE_TYPES.items():
        if f"get{name}" in vars(wpilib.SmartDashboard):
            yield _static(wpilib.SmartDashboard, f"get{name}", "/SmartDashboard/", type_name, reads)
    for name, type_name in _PREFERENCE_TYPES.items():
        for verb in ("get", "init"):
            if f"{verb}{name}" in vars(wpilib.Preferences):
                yield _static(wpilib.Preferences, f"{verb}{name}", "/Preferences/", type_name, reads)
    for name, type_name in _TYPES.items():
        owner = getattr(ntcore, f"{name}Topic")
        for verb in ("subscribe", "getEntry"):
            yield Patch(owner, verb, _of_topic(vars(owner)[verb], lambda *_, known=type_name: known, reads))
    for struct_owner, ending in ((ntcore.StructTopic, ""), (ntcore.StructArrayTopic, "[]")):

        def struct_type(default: object, ending: str = ending) -> str:
            return _struct_type(default, ending)

        for verb in ("subscribe", "getEntry"):
            yield Patch(struct_owner, verb, _of_topic(vars(struct_owner)[verb], struct_type, reads))


_watches = PreparedPatches(_patches)


def _of_entry(real: Any, type_name: str, reads: NetworkReads) -> Callable[..., Any]:
    call = _unbound(real)

    def get(self: Any, *args: Any, **kwargs: Any) -> Any:
        name = self.getName() if isinstance(self, ntcore.NetworkTableEntry) else self.getTopic().getName()
        if name not in reads.found:
            reads.note(name, type_name, args, kwargs)
        return call(self, *args, **kwargs)

    return get


def _of_table(real: Any, type_name: str, reads: NetworkReads) -> Callable[..., Any]:
    call = _unbound(real)

    def get(self: Any, key: str, *args: Any, **kwargs: Any) -> Any:
        name = f"{self.getPath()}/{key}"
        if name not in reads.found:
            reads.note(name, type_name, args, kwargs)
        return call(self, key, *args, **kwargs)

    return get


def _static(owner: object, name: str, table: str, type_name: str, reads: NetworkReads) -> Patch:
    call = getattr(owner, name)

    def get(key: str, *args: object, **kwargs: object) -> Any:
        if table + key not in reads.found:
            reads.note(table + key, type_name, args, kwargs)
        return call(key, *args, **kwargs)

    return Patch(owner, name, staticmethod(get))


def _of_topic(real: Any, type_of: Callable[[Any], str], reads: NetworkReads) -> Callable[..., Any]:
    call = _unbound(real)

    def subscribe(self: Any, *args: Any, **kwargs: Any) -> Any:
        name, default = self.getName(), args[0] if args else kwargs.get("defaultValue")
        if name not in reads.found and (type_name := type_of(default)):
            reads.note(name, type_name, (default,), {})
        return call(self, *args, **kwargs)

    return subscribe


def _unbound(real: Any) -> Callable[..., Any]:
    """Return the function of a method: the bindings' methods cannot be called as their class has them."""
    function: Callable[..., Any] = getattr(real, "__func__", real)
    return function


def _struct_type(default: Any, ending: str) -> str:
    """Return the name of a struct's type; empty when it cannot be written as numbers."""
    from wpiutil import wpistruct

    if ending:
        default = default[0] if default else None
    if default is None:
        return ""
    try:
        name, schema = wpistruct.getTypeName(type(default)), wpistruct.getSize(type(default))
    except TypeError:
        return ""
    return f"struct:{name}{ending}" if name in STRUCTS and schema == 8 * len(STRUCTS[name]) else ""
