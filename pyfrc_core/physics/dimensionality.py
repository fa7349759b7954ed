"""The error for a wrong unit that is also pint's, as code of 2019 catches it. Imported when it is raised, with pint."""

from __future__ import annotations

import pint

from .parameters import WrongDimension


class WrongUnit(WrongDimension, pint.DimensionalityError):
    """A parameter has a unit of another dimension, or lacks one.

    :param units1: what was given
    :param units2: the unit that was expected
    """

    def __init__(self, units1: str, units2: str, message: str, *, where: str) -> None:
        WrongDimension.__init__(self, message, where=where)
        self.units1, self.units2 = units1, units2

    def __reduce__(self) -> tuple[object, ...]:
        return _again, (self.units1, self.units2, self.message, self.where)


def _again(units1: str, units2: str, message: str, where: str) -> WrongUnit:
    return WrongUnit(units1, units2, message, where=where)
