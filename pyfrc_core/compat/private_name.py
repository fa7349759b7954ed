"""A name that a library does not promise to keep, and what depends on it."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

from ..errors import PyfrcError


class IncompatibleLibraryError(PyfrcError):
    """An installed version of a library lacks something that pyfrc depends on."""


@dataclass(frozen=True)
class PrivateName:
    """A name that a library does not promise to keep.

    :param path: ``module:name``, or ``module:Class.name``
    :param used_for: what depends on it, as a sentence
    """

    path: str
    used_for: str

    @property
    def name(self) -> str:
        """The name itself, without its module and class."""
        return self.path.replace(":", ".").rpartition(".")[2]

    def find(self) -> Any:
        """Import the module and return what the name stands for.

        :raises IncompatibleLibraryError: when the installed version has no such name
        """
        return self.of(self._owner())

    def of(self, owner: object) -> Any:
        """Return what the name stands for in this object, such as an instance of the class.

        :raises IncompatibleLibraryError: when the object has no such attribute
        """
        try:
            return getattr(owner, self.name)
        except AttributeError:
            raise self.missing() from None

    @property
    def place(self) -> tuple[Any, str]:
        """The module or class, and the name in it: where another value can be set.

        :raises IncompatibleLibraryError: when the installed version has no such name
        """
        owner = self._owner()
        self.of(owner)
        return owner, self.name

    def missing(self) -> IncompatibleLibraryError:
        """Return the error that says that the installed version has no such name."""
        return IncompatibleLibraryError(self.gone, remedy=_version_of(self.path))

    @property
    def gone(self) -> str:
        """What to say when there is no such name."""
        return f"{self.path.replace(':', '.')} is gone: {self.used_for}"

    def _owner(self) -> Any:
        module, _, names = self.path.partition(":")
        try:
            owner: Any = import_module(module)
            for name in names.split(".")[:-1]:
                owner = getattr(owner, name)
        except (ImportError, AttributeError):
            raise self.missing() from None
        return owner


def _version_of(path: str) -> str:
    """Return which version of the library is installed, and what to do about it."""
    from importlib import metadata
    from platform import python_version

    top = path.partition(":")[0].partition(".")[0]
    distribution = _DISTRIBUTIONS.get(top)
    try:
        installed = f"{distribution} {metadata.version(distribution)}" if distribution else f"Python {python_version()}"
    except metadata.PackageNotFoundError:
        installed = f"{distribution} of an unknown version"
    return f"This pyfrc does not know {installed}. Install an earlier version of that, or a later one of pyfrc."


_DISTRIBUTIONS = {
    "_pytest": "pytest",
    "commands2": "robotpy-commands-v2",
    "magicbot": "robotpy-wpilib-utilities",
    "pip": "pip",
    "pytest": "pytest",
    "wpilib": "wpilib",
    "wpiutil": "robotpy-wpiutil",
}
