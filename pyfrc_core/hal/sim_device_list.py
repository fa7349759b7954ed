"""The SimDevices that exist, with their handles and values.

WPILib's Python interface does not report that one is created or freed, so they are listed at each look.
"""

from __future__ import annotations

from operator import ne

from ..wpi import sim_devices

Signature = tuple[tuple[str, int, tuple[str, ...]], ...]


class SimDeviceList:
    """The SimDevices of this process, in the HAL's order."""

    def __init__(self) -> None:
        self._names: list[str] = []
        #: WPILib's object for each, which keeps the handle: to find that takes as long as to list the values.
        self._devices: list[sim_devices.Device] = []
        self._values: list[list[tuple[str, bool]]] = []
        self._signature: Signature = ()

    def signature(self) -> Signature:
        """Return the name, handle and names of values of each device: the same object until one of them changes.

        A device that is freed and created again at once has the same signature if it has the same handle and values.
        """
        names = sim_devices.names()
        # A handle that is no longer in use has no values, so devices of the same names with other handles are noticed.
        # One device after the other: what is listed for one is freed before the next.
        if names == self._names and not any(map(ne, map(sim_devices.values_of, self._devices), self._values)):
            return self._signature
        self._names, self._devices = names, [sim_devices.open_device(name) for name in names]
        self._values = [sim_devices.values_of(device) for device in self._devices]
        self._signature = tuple(
            [
                (name, sim_devices.handle_of(name), tuple([value for value, _readonly in values]))
                for name, values in zip(names, self._values, strict=True)
            ]
        )
        return self._signature


#: There is one list, as there is one HAL in a process.
sim_device_list = SimDeviceList()
