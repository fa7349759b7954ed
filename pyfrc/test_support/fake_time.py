"""Control over robot time in a test."""

from pyfrc_core.test_support.fake_time import FakeTime, TestEnded, TestFroze, TestRanTooLong

__all__ = ["FakeTime", "TestEnded", "TestFroze", "TestRanTooLong"]
