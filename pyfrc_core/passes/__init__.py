"""What passed before: which tests need not be run again, because no file that they can have read has changed.

In: a project and the tests that have passed. Out: whether a test, or all tests, would pass again; `pyfrc test
--changed` and `pyfrc deploy` ask. A run is isolated and deterministic, so a pass stands until something that it can
have read changes. `memory` hashes what a run reads, and keeps the passes in the project; `written` knows what pyfrc
itself wrote meanwhile. A test depends on its own file and on all files of the project that are no tests. Nothing
observes what a test runs: a robot's test runs most of the robot.
"""
