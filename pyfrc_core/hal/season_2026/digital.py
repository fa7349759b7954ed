"""Digital inputs that keep what is written before the robot creates them: the HAL sets each to True then."""

from __future__ import annotations

from weakref import WeakMethod

from wpilib.simulation import DIOSim


class DigitalSim(DIOSim):
    """A digital channel, created by the robot or not yet."""

    def __init__(self, channel: int) -> None:
        super().__init__(channel)
        #: Whether False was written for an input that the robot will create.
        self._stays_false = False
        self._callback: object = None

    def setValue(self, value: bool) -> None:
        if self._callback is None and not value and not self.getInitialized():
            self._stays_false = True
            # Weak: the HAL keeps the callback, which would keep this object.
            changed = WeakMethod(self._changed)
            self._callback = self.registerValueCallback(lambda *_: (call := changed()) and call(), False)
        super().setValue(value)

    def _changed(self) -> None:
        if not self.getInitialized():  # before the robot creates it, or between two runs
            self._stays_false = not self.getValue()
        elif self._stays_false:
            self._stays_false = False
            if self.getIsInput():
                super().setValue(False)
