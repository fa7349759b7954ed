"""The fixture `reraise`, which is that of pytest-reraise: each test of both runs in the same way."""

from __future__ import annotations

FILE = """
import threading
import pytest

def in_thread(work):
    thread = threading.Thread(target=work)
    thread.start()
    thread.join()

def broken():
    assert "thread" == 0

def test_passes(reraise):
    def work():
        with reraise(catch=True):
            assert 1 + 1 == 2
    in_thread(work)
    assert reraise() is None and reraise.exception is None

def test_fails_at_its_end(reraise):
    def work():
        with reraise:
            broken()
    in_thread(work)

def test_masks_an_error_of_the_test(reraise):
    in_thread(reraise.wrap(broken))
    assert "foo" == "bar"

def test_does_not_mask_what_was_raised_before(reraise):
    in_thread(reraise.wrap(broken))
    try:
        reraise()
    finally:
        reraise.exception = ValueError("later")

def test_keeps_the_first(reraise):
    reraise.exception = KeyError("first")
    reraise.exception = KeyError("second")
    with reraise(catch=True):
        raise KeyError("third")

@pytest.fixture
def late(reraise):
    yield
    reraise.exception = KeyError("late")

def test_fails_in_the_teardown(late):
    pass
"""
FAILURES = {
    "fails_at_its_end": "assert 'thread' == 0",
    "masks_an_error_of_the_test": "assert 'thread' == 0",
    "does_not_mask_what_was_raised_before": "assert 'thread' == 0",
    "keeps_the_first": "KeyError: 'first'",
    "fails_in_the_teardown": "KeyError: 'late'",
}


def test_it_behaves_as_the_package_does(make_project) -> None:
    robot = "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
    project = make_project({"robot.py": robot, "tests/test_threads.py": FILE})
    result = project.run("test", "--", "-W", "ignore::pytest.PytestUnhandledThreadExceptionWarning")
    assert "4 failed, 2 passed, 1 error" in result.stdout
    blocks = {
        name.removeprefix("ERROR at teardown of ").removeprefix("test_"): text for name, text in result.blocks().items()
    }
    for name, expected in FAILURES.items():
        assert expected in blocks[name], name
    assert "PluggyTeardownRaisedWarning" not in result.output
