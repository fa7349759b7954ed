"""What each run of pytest would find out again, found out once, in the process that commands are forked from.

It is the same each time: the plugins that are installed, and what is in them.
"""

from __future__ import annotations

import contextlib
import functools
import importlib.metadata
import io
import os
import sys
import tempfile
from collections.abc import Iterable, Iterator
from importlib.metadata import Distribution
from pathlib import Path


def prepare_pytest() -> None:
    """Have the runs of pytest in forks of this process begin with what is known here."""
    _keep_metadata()
    _import_plugins()
    _keep_what_has_no_fixtures()
    _keep_what_is_rewritten()


def _import_plugins() -> None:
    """Import the plugins that each run of pytest imports, in the way it does: the module of a plugin that was
    imported in another way would make it warn.
    """
    import pytest

    with tempfile.TemporaryDirectory() as empty, contextlib.redirect_stdout(io.StringIO()):
        here = Path.cwd()
        os.chdir(empty)
        try:
            pytest.main(["-VV"])
        finally:
            os.chdir(here)


def _keep_metadata() -> None:
    """Keep the installed packages of each directory, with what was read of them, as long as it does not change.

    Each run of pytest reads the entry points of all of them twice, and the lists of all files of its plugins.
    """
    distributions = importlib.metadata.distributions

    @functools.cache
    def installed(directory: str, changed: int) -> list[Distribution]:
        return list(distributions(path=[directory]))

    def keeping(**context: object) -> Iterable[Distribution]:
        if context:
            return distributions(**context)
        return _all_in(sys.path)

    def _all_in(path: list[str]) -> Iterator[Distribution]:
        for directory in path:
            try:
                changed = Path(directory).stat().st_mtime_ns
            except OSError:
                continue
            yield from installed(str(Path(directory).absolute()), changed)

    for name in ("entry_points", "files", "metadata"):
        read = functools.cached_property(getattr(Distribution, name).fget)
        read.__set_name__(Distribution, name)
        setattr(Distribution, name, read)
    importlib.metadata.distributions = keeping  # type: ignore[assignment]


def _keep_what_has_no_fixtures() -> None:
    """Keep which plugins and classes of plugins have no fixtures: each run of pytest searches all their attributes."""
    from _pytest import fixtures, nodes

    if not hasattr(fixtures, "FixtureFunctionDefinition"):  # pytest before 8.4
        return

    def has_fixtures(holder: object) -> bool:
        return any(isinstance(getattr(holder, name, None), fixtures.FixtureFunctionDefinition) for name in dir(holder))

    def is_pytests(name: str) -> bool:
        return name.partition(".")[0] in ("_pytest", "xdist")

    modules = [module for name, module in sys.modules.items() if is_pytests(name)]
    values = [value for module in modules for value in vars(module).values()]
    # Nodes are not searched themselves: they stand for users' modules and classes.
    classes = {each for each in values if isinstance(each, type) and is_pytests(each.__module__)}
    holders = [*modules, *(each for each in classes if not issubclass(each, nodes.Node))]
    without = {holder for holder in holders if not has_fixtures(holder)}
    search = fixtures.FixtureManager.parsefactories

    def parsefactories(self: fixtures.FixtureManager, *args: object, **kwargs: object) -> None:
        holder = kwargs["holder"] if "holder" in kwargs else args[0]
        if holder.__hash__ is None or (holder not in without and type(holder) not in without):
            search(self, *args, **kwargs)  # type: ignore[call-overload]

    fixtures.FixtureManager.parsefactories = parsefactories  # type: ignore[assignment]


def _keep_what_is_rewritten() -> None:
    """Look for a plugin among the modules that are imported, and not for each of these among the plugins.

    What is looked for is a plugin that was imported without its assertions rewritten, to warn of it.
    """
    from _pytest.assertion.rewrite import AssertionRewritingHook

    mark = AssertionRewritingHook.mark_rewrite

    def mark_rewrite(self: AssertionRewritingHook, *names: str) -> None:
        imported = [sys.modules[name] for name in names if name in sys.modules]
        if all(isinstance(module.__loader__, AssertionRewritingHook) for module in imported):
            self._must_rewrite.update(names)
            self._marked_for_rewrite_cache.clear()
        else:
            mark(self, *names)

    AssertionRewritingHook.mark_rewrite = mark_rewrite  # type: ignore[method-assign]
