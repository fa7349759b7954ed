"""``pyfrc sim --watch``: continue a simulation with new code when a file of the project is saved."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from .program_files import program_files
from .simulation import Simulation

#: How often to look, in wall seconds.
_LOOK_SECONDS = 0.2


class Watch:
    """The files that make up a robot program: its Python files and ``sim/config.json``.

    :param root: the directory of the robot's code
    """

    def __init__(self, root: Path) -> None:
        self._root = root
        self._seen = program_files(self._root)

    def changed(self) -> list[str]:
        """Return the files that were saved, made or removed since the last call, relative to the root."""
        before, self._seen = self._seen, program_files(self._root)
        changed = sorted({file for file, _ in before.items() ^ self._seen.items()})
        return [Path(file).relative_to(self._root).as_posix() for file in changed]


@contextmanager
def watching(simulation: Simulation, saved: Callable[[list[str]], object]) -> Iterator[None]:
    """Within this context, continue the simulation with the project's new code whenever a file is saved.

    :param saved: called with the changed files, before the simulation continues
    """
    over = threading.Event()
    watch = Watch(simulation.project.root)

    def look() -> None:
        while not over.wait(_LOOK_SECONDS):
            if files := watch.changed():
                saved(files)
                simulation.reload()

    thread = threading.Thread(target=look, name="pyfrc sim: watch", daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()
