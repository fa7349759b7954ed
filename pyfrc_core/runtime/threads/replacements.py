"""What makes a replacement behave as the name that it replaces.

Robot code and libraries use names of the standard library for more than calling them: in annotations, as class
attributes, with `isinstance`, `copy` and `pickle`, as specifications of mocks. wrapt's proxies forward each
use to one object; these are functions and classes themselves.
"""

from __future__ import annotations

import copyreg
import functools
import types
from abc import ABCMeta
from collections.abc import Callable
from typing import Any, cast

_IDENTITY = ("__name__", "__qualname__", "__module__", "__doc__", "__self__")


class BuiltinReplacement(staticmethod):  # type: ignore[type-arg]
    """A Python function in the place of a built-in one.

    As the built-in function it is not bound when it is a class attribute, it is copied as itself, and pickled by name.

    :param function: what it calls
    :param original: the built-in function that it replaces
    :param place: where the replacement is found: ``module:name``
    """

    def __init__(self, function: Callable[..., object], original: Callable[..., object], place: str) -> None:
        _take_identity(function, original)
        function.__annotations__ = {}  # a built-in function has none
        super().__init__(function)
        _take_identity(self, original)
        self._place = place
        self._repr = repr(original)

    @property  # type: ignore[misc]
    def __class__(self) -> Any:
        return types.BuiltinFunctionType

    def __get__(self, instance: object, owner: type | None = None) -> Any:
        return self

    def __copy__(self) -> BuiltinReplacement:
        return self

    def __deepcopy__(self, memo: object) -> BuiltinReplacement:
        return self

    def __reduce__(self) -> tuple[Callable[[str], Any], tuple[str]]:
        return _by_name(self._place)

    def __repr__(self) -> str:
        return self._repr


class ReplacementType(ABCMeta):
    """The type of a class that replaces a built-in one: instances of the built-in class count as its instances.

    It is an `ABCMeta`, so that classes derived from the replacement can have abstract base classes beside it.
    """


class BuiltinClassReplacement(metaclass=ReplacementType):
    """Base of a class that replaces a built-in one; `replaces` decorates it."""

    __slots__ = ()

    @property  # type: ignore[misc]
    def __class__(self) -> Any:
        # Code that has the built-in class from before takes an instance for one of it; a derived class stays itself.
        return _originals.get(type(self), type(self))

    def __reduce__(self) -> Any:
        raise TypeError(f"cannot pickle {type(self).__module__ + '.' + type(self).__qualname__!r} object")


def replaces(original: type, place: str) -> Callable[[ReplacementType], Any]:
    """Decorate a class that replaces the built-in class `original`, which is found at ``module:name``."""

    def decorate(cls: ReplacementType) -> ReplacementType:
        cls.__name__, cls.__qualname__, cls.__module__ = original.__name__, original.__qualname__, original.__module__
        cls.__doc__ = original.__doc__
        if "__new__" in vars(cls):  # its annotations would be the class's signature, of which a built-in one has none
            cast(Any, cls.__new__).__annotations__ = {}
        cls.register(original)
        _originals[cls], _places[cls] = original, place
        return cls

    return decorate


def as_original(owner: Any, name: str, original: Any, replacement: Any) -> Any:
    """Give a replacement the identity of what it replaces in a module or class, and a function the same kind.

    :param owner: the module or class
    :param original: what the name stands for there, as `vars` shows it
    """
    if isinstance(replacement, type) and not isinstance(replacement, ReplacementType):
        replacement.__module__ = original.__module__
    if original is None or not isinstance(replacement, types.FunctionType):
        return replacement
    if isinstance(original, types.FunctionType):
        return functools.update_wrapper(replacement, original)
    static = isinstance(original, staticmethod)
    called = original.__func__ if static else original
    if isinstance(called, types.BuiltinFunctionType):
        place = f"{owner.__name__}:{name}" if isinstance(owner, types.ModuleType) else _place_of(owner, name)
        replacement = BuiltinReplacement(replacement, called, place)
    else:
        _take_identity(replacement, called)
    return staticmethod(replacement) if static else replacement


def _place_of(owner: type, name: str) -> str:
    return f"{owner.__module__}:{owner.__qualname__}.{name}"


def _take_identity(replacement: object, original: object) -> None:
    for name in _IDENTITY:
        value = getattr(original, name, None)
        if value is not None and not (name == "__self__" and isinstance(replacement, types.FunctionType)):
            setattr(replacement, name, value)


# -- pickling by name --------------------------------------------------------------------------------------------------

_originals: dict[type, type] = {}
_places: dict[type, str] = {}


def _by_name(place: str) -> tuple[Callable[[str], Any], tuple[str]]:
    import pkgutil

    return pkgutil.resolve_name, (place,)


def _reduce_class(cls: ReplacementType) -> Any:
    # A class derived from the replacement is found by its own name, as every class is.
    return _by_name(_places[cls]) if cls in _places else cls.__qualname__


copyreg.pickle(ReplacementType, _reduce_class)
