"""Direct tests of the core: the order of events, as short lists that a person can read.

They call the classes themselves, in this process, without a command and without a robot project.
"""
