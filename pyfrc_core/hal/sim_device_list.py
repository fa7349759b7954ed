"""The SimDevices that exist, with their handles and values, listed again only after the HAL has reported a change."""

from __future__ import annotations

from hal import simulation as hs
from wpilib.simulation import SimDeviceSim

from ..compat.hal_callbacks import HalNotes, forget_registered

Signature = tuple[tuple[str, int, tuple[str, ...]], ...]

#: The prefix of device names that no device has. It is disabled in the HAL, until `resetSimDeviceData` removes that
#: together with all devices and callbacks: so a reset is seen.
_CANARY = "pyfrc: until the SimDevices are reset"


class SimDeviceList:
    """The SimDevices of this process, in the HAL's order."""

    def __init__(self) -> None:
        self._notes: HalNotes | None = None
        self._watched: set[int] = set()
        self._signature: Signature = ()

    def signature(self) -> Signature:
        """Return the name, handle and names of values of each device: the same object until one is created or freed."""
        notes = self._notes
        if notes is not None and not notes and not hs.isSimDeviceEnabled(_CANARY):
            return self._signature
        if notes is None:
            notes = self._notes = HalNotes()
        if hs.isSimDeviceEnabled(_CANARY):
            self._begin(notes)
        for _ in notes.take():  # first, since a thread may create more devices meanwhile
            pass
        # Always a new object: a device that was freed and created again has the same handles, and not its callbacks.
        self._signature = tuple([self._entry(name, notes) for name in SimDeviceSim.enumerateDevices("")])
        return self._signature

    def _begin(self, notes: HalNotes) -> None:
        """Register for devices that are created and freed; after a reset, once more."""
        forget_registered()
        self._watched.clear()
        self._signature = ()
        hs.setSimDeviceEnabled(_CANARY, False)
        notes.note_devices(1)

    def _entry(self, name: str, notes: HalNotes) -> tuple[str, int, tuple[str, ...]]:
        handle = hs.getSimDeviceHandle(name)
        if handle not in self._watched:
            self._watched.add(handle)
            notes.note_new_values(handle, 1)
        values = tuple([value for value, _readonly in SimDeviceSim(name).enumerateValues()])
        return name, handle, values


#: There is one list, as there is one HAL in a process.
sim_device_list = SimDeviceList()
