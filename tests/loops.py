"""Variants of one path through the code as one test: to collect a test takes as long as a short one runs."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable
from typing import Any


def for_each(names: str, values: Iterable[Any]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Run a test with each of these values, as `pytest.mark.parametrize` does, but as one test.

    For variants that take milliseconds and share their fixtures. The values with which a test fails are the last ones
    among what it has printed.

    :param names: the parameters, with commas between them
    :param values: a tuple for each variant, or the one value
    """
    parameters, variants = [name.strip() for name in names.split(",")], list(values)
    assert variants

    def decorate(test: Callable[..., None]) -> Callable[..., None]:
        @functools.wraps(test)
        def in_a_loop(**fixtures: Any) -> None:
            for value in variants:
                print(f"{names} = {value!r:.500}")
                test(**fixtures, **dict(zip(parameters, value if len(parameters) > 1 else [value], strict=True)))

        signature = inspect.signature(test)
        others = [each for name, each in signature.parameters.items() if name not in parameters]
        in_a_loop.__signature__ = signature.replace(parameters=others)  # type: ignore[attr-defined]
        return in_a_loop

    return decorate
