"""`test_docstrings`: all of the robot's code has docstrings, as the documentation of 2019 promises."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import dedent

import pytest

from pyfrc.tests.docstring_test import test_docstrings as check_docstrings

Found = Callable[[str], list[str]]


@pytest.fixture
def found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Found]:
    """Return what the test finds in a module of the robot, one line each."""
    monkeypatch.syspath_prepend(tmp_path)

    def look_at(source: str) -> list[str]:
        (tmp_path / "arm_of_docstrings.py").write_text(dedent(source), "utf-8")
        importlib.import_module("arm_of_docstrings")
        try:
            check_docstrings(None, str(tmp_path))
        except AssertionError as error:
            return str(error).splitlines()[1:]
        return []

    yield look_at
    sys.modules.pop("arm_of_docstrings", None)


def test_every_kind_of_code_is_looked_at(found: Found) -> None:
    assert found(
        '''
        import functools

        class Arm:
            """Arm."""

            class Inner:
                class Innermost:
                    """Innermost."""
                    def undocumented(self):
                        pass

            @staticmethod
            def s():
                pass

            @classmethod
            def c(cls):
                pass

            @property
            def p(self):
                return 1

            @functools.cached_property
            def cached(self):
                return 1

            @functools.lru_cache
            def remembered(self):
                return 1

            def _private(self):
                pass

            def __enter__(self):
                pass

        def _helper():
            pass

        def decorate(function):
            """Decorate."""
            @functools.wraps(function)
            def wrapper(*args):
                return function(*args)
            return wrapper

        @decorate
        def decorated():
            pass

        alias = _helper
        Alias = Arm.Inner
        '''
    ) == [
        "arm_of_docstrings.py:1: arm_of_docstrings has no docstring",
        "arm_of_docstrings.py:7: Arm.Inner has no docstring",
        "arm_of_docstrings.py:10: Arm.Inner.Innermost.undocumented has no docstring",
        "arm_of_docstrings.py:13: Arm.s has no docstring",
        "arm_of_docstrings.py:17: Arm.c has no docstring",
        "arm_of_docstrings.py:21: Arm.p has no docstring",
        "arm_of_docstrings.py:25: Arm.cached has no docstring",
        "arm_of_docstrings.py:29: Arm.remembered has no docstring",
        "arm_of_docstrings.py:33: Arm._private has no docstring",
        "arm_of_docstrings.py:36: Arm.__enter__ has no docstring",
        "arm_of_docstrings.py:39: _helper has no docstring",
        "arm_of_docstrings.py:49: decorated has no docstring",
    ]


def test_what_has_no_docstring_of_its_own(found: Found) -> None:
    """Inherited documentation counts, and code that Python has generated is not the team's."""
    assert not found(
        '''
        """Module."""
        import enum, functools, typing
        from dataclasses import dataclass

        class Base:
            """Base."""

            def __init__(self):
                self.itself = self

            def move(self):
                """Move."""

            @property
            def height(self):
                """Height."""

        class Arm(Base):
            """Arm."""

            key = lambda self: 1
            itself = Base

            def move(self):
                pass

            @property
            def height(self):
                return 1

        Arm.me = Arm

        @dataclass
        class Point:
            """Point."""
            x: int = 0

        class Pair(typing.NamedTuple):
            """Pair."""
            x: int

        class State(enum.Enum):
            """State."""
            UP = 1

        half = functools.partial(Arm.move)
        double = lambda x: 2 * x
        '''
    )


def test_documented_parameters_are_those_of_the_function(found: Found) -> None:
    assert found(
        '''
        """Module."""

        class Arm:
            """Arm."""

            def right(self, feet, *args, speed=1, **kwargs):
                """Move.

                :param feet: how far
                :param args: more
                :param float speed: how fast
                :param \\\\*\\\\*kwargs: even more
                """

            def short(self, feet):
                """Move so many feet."""

            def wrong(self, feet, speed):
                """Move.

                :param foot: how far
                :param speed: how fast
                :param speed: how fast
                """

            @staticmethod
            def static(feet):
                """Move.

                :param feet: how far
                """

            @classmethod
            def of_class(cls, feet, speed):
                """Move.

                :param cls: the class
                :param speed: how fast
                """

        class Lift(Arm):
            """Lift."""

            def right(self, metres):
                pass
        '''
    ) == [
        "arm_of_docstrings.py:19: Arm.wrong documents foot, which is no parameter",
        "arm_of_docstrings.py:19: Arm.wrong documents speed twice",
        "arm_of_docstrings.py:19: Arm.wrong does not document feet",
        "arm_of_docstrings.py:34: Arm.of_class does not document feet",
    ]
