"""What pyfrc uses of other libraries although these may change it at any time.

One module for each: `pytest_private`, `cpython_private`, `pip_private`. What is private to WPILib is in `wpi`. No other
module uses a private name of theirs (`tests/test_compat_boundary.py`), and each name has a test whose failure says what
depends on it (`tests/test_compat_*.py`). To support a new version of a library, change these modules until the tests
pass. `CONTRIBUTING.md` lists the steps.

Two modules depend on how libraries behave: `unrepeatable` (phoenix6, REV, WPILib) and `library_output` (what they
print).
"""
