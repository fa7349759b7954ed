"""The deploy agent, which runs on the robot: Python 3.9 and the standard library only.

`deploy.agent_client` sends the source of these modules to the robot through the standard input of one SSH command.
Nothing is installed on the robot. On the laptop, the modules are imported for the frame format and by tests.
"""
