"""Control over the time a robot under test is using."""

from pyfrc_core.test_support.fake_time import FakeTime, TestEnded, TestFroze, TestRanTooLong

__all__ = ["FakeTime", "TestEnded", "TestFroze", "TestRanTooLong"]
