"""Room for code that is nested deeply: a sum of 900 terms is a tree of 900 levels, and each takes several calls."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from typing import TypeVar

Result = TypeVar("Result")

#: Bytes of the thread's stack, of which only what is used is taken from memory, and how many calls fit into it.
_STACK = 512 << 20
_CALLS = 200_000


def with_deep_stack(work: Callable[[], Result]) -> Result:
    """Return what a function returns, called in a thread with a larger stack.

    :raises BaseException: what the function raises
    """
    results: list[Result] = []
    errors: list[BaseException] = []

    def run() -> None:
        try:
            results.append(work())
        except BaseException as error:
            errors.append(error)

    limit, size = sys.getrecursionlimit(), threading.stack_size(_STACK)
    sys.setrecursionlimit(max(limit, _CALLS))
    try:
        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        thread.join()
    finally:
        threading.stack_size(size)
        sys.setrecursionlimit(limit)
    if errors:
        raise errors[0]
    return results[0]
