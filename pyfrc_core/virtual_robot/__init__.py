"""A virtual robot: an SSH server on this computer that runs the deploy agent and starts the deployed program.

In: a directory for its disk (`disk`). Out: an address to deploy to, a console, and a program that runs (`supervisor`).
`deploy` uses it like any robot. Only how a program is stopped and started differs: the agent asks the supervisor
(`control`). The program runs in real time under WPILib's own loop, as on a robot, and not under the runtime of tests.

Nothing outlives it: the program and the agents end when their standard input does, also if the virtual robot is killed.
Connections of other users are refused (`peers`), because a robot without a password would run their programs.
"""
