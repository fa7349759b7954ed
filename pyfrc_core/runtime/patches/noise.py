"""Notice simulations that draw random noise without a seed: what they simulate does not repeat.

REV's SPARKs draw some whenever physics calls `iterate`; without it they repeat. WPILib's mechanisms draw some if they
were made with standard deviations of their measurements that are not 0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

import wpilib.simulation

from ...compat.unrepeatable import report_noise, report_noisy_mechanism
from ...patch_table import Patch

_simulation: Any = wpilib.simulation
_MECHANISMS = (
    _simulation.DCMotorSim,
    _simulation.DifferentialDrivetrainSim,
    _simulation.ElevatorSim,
    _simulation.FlywheelSim,
    _simulation.SingleJointedArmSim,
    *(each for name, each in vars(_simulation).items() if name.startswith("LinearSystemSim_")),
)


def patches(make_kit: str) -> Iterator[Patch]:
    """Return the patches that notice mechanisms with noise.

    :param make_kit: the name of the function that makes a `DifferentialDrivetrainSim` of a kit
    """
    for kind in _MECHANISMS:
        yield Patch(kind, "__init__", _making(kind, kind.__init__))
    drivetrain = _simulation.DifferentialDrivetrainSim
    yield Patch(drivetrain, make_kit, _making(drivetrain, getattr(drivetrain, make_kit)))


def spark_patch(rev: Any) -> Patch:
    """Return the patch that notices noise of SPARKs.

    :param rev: REV's module
    """
    real = rev.SparkSim.iterate

    def iterate(*args: Any, **kwargs: Any) -> Any:
        __tracebackhide__ = True
        report_noise("rev")
        return real(*args, **kwargs)

    return Patch(rev.SparkSim, "iterate", iterate)


def _making(kind: type, real: Callable[..., Any]) -> Callable[..., Any]:
    def make(*args: Any, **kwargs: Any) -> Any:
        __tracebackhide__ = True
        made = real(*args, **kwargs)
        # Standard deviations are the only argument that is a sequence.
        if any(isinstance(each, Iterable) and any(each) for each in (*args, *kwargs.values())):
            report_noisy_mechanism(kind.__name__)
        return made

    return make
