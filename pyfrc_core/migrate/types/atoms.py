"""What an expression can be, as far as it matters: things of WPILib's, and the team's classes and functions."""

from __future__ import annotations

from dataclasses import dataclass

from .scopes import Module, OwnClass, OwnFunction


@dataclass(frozen=True)
class Ref:
    """A module, class, function or constant of WPILib's, by its path in the old season."""

    path: str


@dataclass(frozen=True)
class Obj:
    """An object of a class of WPILib's."""

    path: str


@dataclass(frozen=True)
class Bound:
    """A method of an object of WPILib's.

    :param owner: the class that defines it
    """

    owner: str
    name: str
    receiver: Atom


@dataclass(frozen=True)
class OwnModuleRef:
    """A module of the project's, or a package without a file (`name` then ends in no module)."""

    name: str
    module: Module | None


@dataclass(frozen=True)
class OwnRef:
    """A class of the team's."""

    own: OwnClass


@dataclass(frozen=True)
class OwnObj:
    """An object of a class of the team's.

    :param above: `super()`: lookups begin at the bases
    """

    own: OwnClass
    above: bool = False


@dataclass(frozen=True)
class OwnCallable:
    """A function of the team's."""

    function: OwnFunction


@dataclass(frozen=True)
class Many:
    """A container."""

    of: frozenset[Atom]


Atom = Ref | Obj | Bound | OwnModuleRef | OwnRef | OwnObj | OwnCallable | Many
Atoms = frozenset[Atom]
NOTHING: Atoms = frozenset()
