"""What pyfrc uses of WPILib, pytest and CPython without their promise to keep it.

One module for each library: `wpilib_private` (with `wpilib_threads`), `pytest_private`, `cpython_private`. No other
module uses a private name of theirs (`tests/test_compat_boundary.py`), and each name has a test whose failure says what
depends on it (`tests/test_compat_*.py`). To support a new version of a library, mend these modules until they pass.
"""
