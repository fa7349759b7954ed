"""Fuzzing: run matches with random inputs until the robot fails, then find the shortest script of the failure.

In: a project, and a seed or a limit of time. Out: one saved script for each failure, in tests/fuzz, which `pyfrc
replay` and the project's tests play. The wings build on each other, from below:

- `inputs`: what is varied. The writes of one match, from random numbers only.
- `oracle`: what is a failure. Exceptions, hangs, ended processes, and checks that each have a setting.
- `guidance`: what is new. Lines, branches and states that no match has reached before, and the matches to continue.
- `match`: one run, in a process of its own.
- `shrink`: the shortest script that fails in the same way.
- `campaign`: many matches, on this computer or a cluster, and what is saved of them.

A match is defined by its seeds, and from when each holds (`guidance.seed_schedule`): the same robot with the same
inputs does the same. So a campaign continues a match differently from some moment on with one new seed, and keeps no
state of a robot.
"""
