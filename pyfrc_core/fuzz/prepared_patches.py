"""Patches that are made once, before matches are forked: each fork finds them made."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from itertools import starmap
from typing import Any, Generic, TypeVar

from ..runtime.patch_table import Patch, PatchTable, patched

Watch = TypeVar("Watch")


class PreparedPatches(Generic[Watch]):
    """The patches that watch some kind of calls.

    :param replacements: returns what is replaced, to report to a watch: each with its owner and its name
    """

    def __init__(self, replacements: Callable[[Watch], Iterable[tuple[Any, str, Any]]]) -> None:
        self._replacements = replacements
        self._table = PatchTable()
        #: The watch to which the prepared patches report.
        self._prepared: Watch | None = None

    def prepare(self, watch: Watch) -> None:
        """Make the patches, for the forks of this process. Calling it again changes nothing until `undo`."""
        if not self._table:
            self._prepared = watch
            for patch in list(self._replacements(watch)):  # all are made from the original values
                self._table.patch(*patch)

    def undo(self) -> None:
        """Undo what was prepared, if anything was."""
        self._prepared = None
        self._table.undo()

    @contextmanager
    def watching(self, make: Callable[[], Watch]) -> Iterator[Watch]:
        """Watch until the context ends, or, where the patches are prepared, until the process does.

        :param make: returns the watch where nothing is prepared
        """
        if self._prepared is not None:
            watch, self._prepared = self._prepared, None  # the next one gets its own
            yield watch
            return
        watch = make()
        with patched(starmap(Patch, self._replacements(watch))):
            yield watch
