"""Whether devices that a vendor simulates in real time need some of it: where what they do comes back to the robot.

That is so while a loop is closed in a motor's controller, and once code has asked for the simulation of a device, which
computes its motion. All else, such as a voltage that the robot's code sets, has no effect that the robot could see. The
vendor's public functions that begin either are intercepted: nothing else tells.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from typing import Any

from ...patch_table import Patch

#: The names of phoenix6's control requests for which the motor's controller reads a sensor.
_CLOSED = re.compile(r"Position|Velocity|MotionMagic|Differential(?!.*Follower)")


class RealTimeLoops:
    """What robot code has asked of such devices."""

    def __init__(self) -> None:
        #: The devices whose controllers close a loop, by their identity.
        self._closed: set[int] = set()
        self._is_simulated = False

    @property
    def needed(self) -> bool:
        """Return whether the devices need real time while the robot is enabled."""
        return self._is_simulated or bool(self._closed)

    def patches(self) -> Iterator[Patch]:
        """Return the patches that report to this."""
        hardware: Any = sys.modules.get("phoenix6.hardware")
        for owner in [each for each in vars(hardware).values() if isinstance(each, type)] if hardware else ():
            if hasattr(owner, "set_control"):
                yield Patch(owner, "set_control", self._controlled(owner.set_control))
            if isinstance(simulated := getattr(owner, "sim_state", None), property) and simulated.fget is not None:
                yield Patch(owner, "sim_state", property(self._simulated(simulated.fget)))
        swerve: Any = sys.modules.get("phoenix6.swerve")
        if swerve is not None and hasattr(swerve, "SwerveDrivetrain"):  # its loops are closed in native code
            owner = swerve.SwerveDrivetrain
            yield Patch(owner, "__init__", self._simulated(owner.__init__))

    def _controlled(self, real: Callable[..., Any]) -> Callable[..., Any]:
        def set_control(device: Any, request: Any, *args: Any, **kwargs: Any) -> Any:
            (self._closed.add if _CLOSED.search(type(request).__name__) else self._closed.discard)(id(device))
            return real(device, request, *args, **kwargs)

        return set_control

    def _simulated(self, real: Callable[..., Any]) -> Callable[..., Any]:
        def call(device: Any, *args: Any, **kwargs: Any) -> Any:
            self._is_simulated = True
            return real(device, *args, **kwargs)

        return call
