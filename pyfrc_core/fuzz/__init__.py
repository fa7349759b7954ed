"""Fuzzing: run matches with random inputs until the robot fails, then find the shortest script of the failure.

In: a project, and a seed or a limit of time. Out: one saved script for each failure, in tests/fuzz, which `pyfrc
replay` and the project's tests play (`corpus`). `campaign` is on top.

- Inputs. `input_generator` draws the writes of one match, packet by packet, from random numbers only. It draws what
  this robot can notice: the controls that its code asks for (`asked_controls`), its sensors, its entries of
  NetworkTables.
- A match is defined by its seeds, and from when each holds (`seed_schedule`): the same robot with the same inputs does
  the same. So a campaign continues a match differently from some moment on with one new seed, and keeps no state of a
  robot.
- Guidance. It continues matches that were the first to reach a goal (`goals`): a line, a branch (from Python
  3.12), or a state. How near a comparison was is not measured: Python does not show its operands in a public way.
- What is a failure: exceptions, hangs, ended processes, and the checks of `oracle`, each with a setting. Most checks
  let the match go on, so that one match can show several. Motor calls are observed in Python: WPILib changes NaN and
  values beyond 1 before the HAL sees them.
- Each match has a process of its own (`match_executor`), forked where that is possible. A restart of the robot program
  in a match is one more process (`boots`): modules and WPILib keep what they have.
- With a number of matches, the result depends on the seed alone, not on the number of processes or computers: matches
  are in streams that do not guide each other (`stream`), and results are used in the order of the matches (`playing`).
- `shrink` is delta debugging on recorded scripts. hypothesis' shrinker does not fit: it makes a generator's choices
  fewer, but here the generator reads the robot's state while it chooses, and each choice less is another match.
"""
