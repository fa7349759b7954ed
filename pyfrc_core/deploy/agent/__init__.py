"""The robot's side of a deploy: plain Python 3.9, standard library only.

`robot` sends these modules to the robot, in the order of their dependence, over the standard input of one exec; nothing
of them is installed there. Here they are imported for the frames, and by tests.
"""
