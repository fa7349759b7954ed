"""``pyfrc sim --watch``: when a file of the project is saved, the simulation goes on with the new code."""

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
        """The files that have been saved, made or removed since this was last asked, relative to the root."""
        before, self._seen = self._seen, program_files(self._root)
        changed = sorted({file for file, _ in before.items() ^ self._seen.items()})
        return [Path(file).relative_to(self._root).as_posix() for file in changed]


@contextmanager
def watching(simulation: Simulation, saved: Callable[[list[str]], object]) -> Iterator[None]:
    """While this lasts, have the simulation go on with the project's code as it is on the disk.

    :param saved: is told which files have changed, before that
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
