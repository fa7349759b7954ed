"""What an expression can be, as far as it matters: things of WPILib's, and the team's classes and functions."""

from __future__ import annotations

from collections.abc import Iterable
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
class Returns:
    """Anything that can be called, as `Callable[[], Rotation2d]`, by what it returns."""

    of: frozenset[Atom]


@dataclass(frozen=True)
class Many:
    """A container.

    :param of: what is in it; of a dictionary, its values
    :param keys: of a dictionary, its keys
    """

    of: frozenset[Atom]
    keys: frozenset[Atom] | None = None


Atom = Ref | Obj | Bound | OwnModuleRef | OwnRef | OwnObj | OwnCallable | Returns | Many
Atoms = frozenset[Atom]
NOTHING: Atoms = frozenset()
#: How deep containers are followed: `each = [each]` has no end.
_DEPTH = 5


def union(of: Iterable[Atoms]) -> Atoms:
    """Return all atoms of several sets."""
    return frozenset().union(*of)


def many(of: Iterable[Atoms]) -> Atoms:
    """Return a container of these."""
    found = frozenset(each for each in union(of) if _depth(each) < _DEPTH)
    return frozenset({Many(found)}) if found else NOTHING


def _depth(atom: Atom) -> int:
    return 1 + max(map(_depth, atom.of), default=0) if isinstance(atom, Many) else 0


def elements(of: Atoms) -> Atoms:
    """Return what iterating over containers gives."""
    return union(each.of if each.keys is None else each.keys for each in of if isinstance(each, Many))


def items(of: Atoms) -> Atoms:
    """Return what indexing containers gives."""
    return union(each.of for each in of if isinstance(each, Many))


def dictionary(keys: Atoms, values: Atoms) -> Atoms:
    """Return a dictionary."""
    shallow = frozenset(each for each in keys | values if _depth(each) < _DEPTH)
    return frozenset({Many(values & shallow, keys & shallow)}) if shallow else NOTHING


def instance(of: Ref | OwnRef) -> Atom:
    """Return an object of a class."""
    return OwnObj(of.own) if isinstance(of, OwnRef) else Obj(of.path)


def of_type(type_: str, receiver: Atom, *, values_only: bool = False) -> Atoms:
    """Return an object of a type as the table writes it: a path, `[path]`, or `self`."""
    if not type_:
        return NOTHING
    if type_ == "self":
        if isinstance(receiver, Ref):
            return frozenset({Obj(receiver.path)})
        return NOTHING if values_only else frozenset({receiver})
    if type_.startswith("["):
        return frozenset({Many(of_type(type_[1:-1], receiver))})
    return frozenset({Obj(type_)})
