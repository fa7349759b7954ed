"""The ways a test run of a robot ends before its test function returns.

`TestEnded`, `TestRanTooLong` and `TestFroze` derive from `BaseException`, so that robot code's ``except Exception``
does not swallow the end of its own run. (Importable from their documented place, `pyfrc.test_support.fake_time`.)
"""

from __future__ import annotations

from ..errors import PyfrcError


class TestEnded(BaseException):
    """This is thrown when the controller has been signaled to end the test.

    It unwinds robot code that is waiting (in `wpilib.wait`, `time.sleep`, a lock) when its run is over.
    Inherits from `BaseException`: a blanket ``except Exception`` does not catch it. Generally only pyfrc
    itself needs to.
    """

    __test__ = False  # pytest: not a test class, for all its name


class TestRanTooLong(BaseException):
    """This is thrown when the time limit has expired (see `FakeTime.set_time_limit`), in robot time.

    Inherits from `BaseException`: a blanket ``except Exception`` does not catch it.
    """

    __test__ = False


class TestFroze(BaseException):
    """The robot code stopped letting time go on: an endless loop, or a call that never returns.

    Inherits from `BaseException`: a blanket ``except Exception`` does not catch it. If code catches it all the same,
    the test fails at its end.
    """

    __test__ = False


class WrongThread(PyfrcError, RuntimeError):
    """A thread asked for what only the thread that drives the clock, or one in robot time, can do."""
