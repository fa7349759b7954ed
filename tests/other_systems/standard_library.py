"""Modules of the standard library that are other ones there for all code, once they are imported.

Each function gets the module when anyone has imported it, and returns whether it was imported to its end.
"""

from __future__ import annotations

import selectors
from collections.abc import Callable
from typing import Any


def prepare_multiprocessing(module: Any) -> bool:
    """Have it start new interpreters, on Windows and macOS. Return False when it is not imported to its end."""
    if not hasattr(module, "set_start_method"):
        return False
    module.set_start_method("spawn")
    return True


def prepare_connection(module: Any) -> bool:
    """Windows has pipes with a class and names of their own. Here, none has any of these names."""
    if not hasattr(module, "Connection"):
        return False
    real = module.Client

    def client(address: Any, *arguments: Any, **options: Any) -> Any:
        if str(address).startswith("\\\\"):
            raise FileNotFoundError(2, "The system cannot find the file specified", address)
        return real(address, *arguments, **options)

    module.PipeConnection, module.Client = module.Connection, client
    return True


def prepare_asyncio(module: Any) -> bool:
    """Have what its event loops wait in by Windows' name, too. Return False when it is not imported to its end."""
    if not hasattr(module, "DefaultEventLoopPolicy"):
        return False
    module.IocpProactor = selectors.DefaultSelector
    return True


def prepare_tempfile(module: Any) -> bool:
    """On Windows, each temporary file has a name, and is an object of `tempfile`'s own."""
    if not hasattr(module, "NamedTemporaryFile"):
        return False
    real = module.TemporaryFile
    module.TemporaryFile = lambda *args, **options: module._TemporaryFileWrapper(
        real(*args, **options), "", delete=False
    )
    return True


#: What is done with which module, on each system.
Preparations = dict[str, Callable[[Any], bool]]
MACOS: Preparations = {"multiprocessing": prepare_multiprocessing}
WINDOWS: Preparations = MACOS | {
    "asyncio": prepare_asyncio,
    "multiprocessing.connection": prepare_connection,
    "tempfile": prepare_tempfile,
}
