"""One run of the robot, with generated inputs or those of a script.

In: a task (`work`), which can be pickled. Out: a `MatchResult`. `play` runs it in this process, which must end
afterwards: WPILib and the robot's modules keep what they have. So each match has a process of its own, and a restart
of the robot program in a match is one more (`restarts`). `preparation` does once what each fork would do again.
"""
