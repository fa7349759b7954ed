"""The deploy agent, which runs on the robot: Python 3.9 and the standard library only.

In: the laptop's requests over standard input. Out: responses over standard output, and the robot's program changed as a
whole or not at all (`transaction`, `releases`). `deploy.agent_client` sends the source of these modules over the one
SSH connection. On the laptop, the modules are imported for the frame format and by tests.

A new release is built beside the running program and becomes current by one rename, so that no interruption leaves half
of a program. Whether a started program runs is judged by a state machine that reads no clock (`start_monitor`): its
inputs are times, processes and output, so tests can try each order of events. Processes decide, because a robot's
console may be silent.
"""
