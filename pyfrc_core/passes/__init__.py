"""What passed before: which tests need not be run again, because no file that they can have read has changed.

`contents` hashes what a run reads, and `memory` keeps the passes in the project. A test depends on its own file and on
all files of the project that are no tests. Nothing observes what a test runs: a robot's test runs most of the robot.
"""
