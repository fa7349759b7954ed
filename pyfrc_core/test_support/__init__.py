"""Support of robot tests: fake time, the controller of the robot's state, and the pytest plugin with its fixtures.

In: a project's tests, and options. Out: pytest's exit code. `run_tests` is `pyfrc test`; `autoload` gives a plain
`pytest` the same fixtures. `fake_time` and `controller` are a test's view of `runtime`: the clock does not know tests'
vocabulary. `isolation` runs each test that uses the robot in its own process. Failures begin with the user's own line
(`reporting`).
"""
