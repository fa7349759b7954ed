"""Deploy the robot program in one transaction over one SSH connection.

In: a project, and the number of its team. Out: a robot that runs the program, or its old one, and a sentence that says
which. `session` has the commands, one line for each phase; the other modules are its steps. This room never imports
WPILib: the program is imported, and tested, in other processes (`local_checks`).

- The robot's files are changed by `agent`, which runs on the robot and is always the laptop's version: the robot needs
  nothing but its Python. A cut at any moment leaves a complete program.
- Only `targets` names a controller (roboRIO, SystemCore): users, paths, commands, addresses. The agent gets its part of
  that in the first message.
- A deploy on a field waits for round trips more than for data. So there is one connection, and one request for
  the whole deploy, which includes the restart.
- Host keys are pinned in the project (`host_keys`), not in the user's `~/.ssh/known_hosts`: at the end of a USB cable,
  every team's robot has the same address.
- Nothing that the robot sends is trusted: `agent_stream` limits its time and size, `responses` checks each field, and
  control characters are made visible before they are printed.
- The console (`agent.console`: frames and the client, on laptop and robot) is our own code: `pynetconsole` does not
  check what it receives, and ends at a wrong message.
"""
