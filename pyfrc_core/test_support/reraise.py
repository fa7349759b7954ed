"""The fixture `reraise`: an error of another thread fails the test that has started it.

It behaves as that of pytest-reraise, on which earlier versions of pyfrc depended, so that their users' tests run. That
package has had no release since 2022, and raises errors in a way about which pytest prints a warning for each.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from functools import wraps
from threading import Lock
from types import TracebackType
from typing import Any, TypeVar, cast, overload

import pytest

Function = TypeVar("Function", bound=Callable[..., Any])

#: The name under which pytest registers pytest-reraise.
THEIRS = "reraise"


class Reraise:
    """Keep the first exception that is raised in a ``with reraise:`` block of any thread, and raise it in the test.

    :param catch: whether the block ends the exception, instead of passing it on to its thread
    :param keeper: the object that keeps the exception
    """

    def __init__(self, catch: bool = False, keeper: Reraise | None = None) -> None:
        self._catch = catch
        self._keeper = keeper or self
        self._lock = Lock()
        self._exception: BaseException | None = None
        #: What the test has raised by a call.
        self.raised: BaseException | None = None

    def __enter__(self) -> None:
        return None

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> bool:
        if error is not None:
            self.exception = error
        return self._catch

    @property
    def exception(self) -> BaseException | None:
        """The exception that is kept, if there is one. Setting it does nothing if there is one already."""
        return self._keeper._exception

    @exception.setter
    def exception(self, error: BaseException) -> None:
        with self._keeper._lock:
            if self._keeper._exception is None:
                self._keeper._exception = error

    def reset(self) -> BaseException | None:
        """Return the exception that is kept, if there is one, and keep it no longer."""
        with self._keeper._lock:
            error, self._keeper._exception = self._keeper._exception, None
        return error

    @overload
    def __call__(self, catch: None = None) -> None: ...

    @overload
    def __call__(self, catch: bool) -> Reraise: ...

    def __call__(self, catch: bool | None = None) -> Reraise | None:
        """Raise the exception that is kept, if there is one; or return a context manager like this one.

        :param catch: whether its block ends exceptions
        """
        if catch is not None:
            return Reraise(catch, self._keeper)
        self._keeper.raised = self.reset()
        if self._keeper.raised is not None:
            raise self._keeper.raised
        return None

    def wrap(self, function: Function) -> Function:
        """Return a function that runs this one in a ``with reraise:`` block."""

        @wraps(function)
        def wrapped(*args: object, **kwargs: object) -> object:
            with self:
                return function(*args, **kwargs)
            return None  # the exception is kept

        return cast("Function", wrapped)


class ReraisePlugin:
    """The plugin with the fixture."""

    @pytest.fixture
    def reraise(self) -> Generator[Reraise, None, None]:
        """Keep exceptions of other threads: ``with reraise:`` in their function. They fail this test."""
        reraise = Reraise()
        yield reraise
        reraise()  # of a thread that ran on until the teardown

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Generator[None, object, object]:
        """Raise what another thread has raised, before an error of the test, which it may have caused."""
        result, error = None, None
        try:
            result = yield
        except (Exception, pytest.fail.Exception, pytest.skip.Exception) as raised:
            error = raised
        reraise = getattr(item, "funcargs", {}).get("reraise")
        if isinstance(reraise, Reraise):
            if error is None or error is not reraise.raised:
                reraise()
            reraise.reset()
        if error is not None:
            raise error
        return result
