"""The engine of a simulation: the session, its recording and what it shows. Knows no front end.

Everything here runs in the front end's process, except `host` and `robot_side`.
"""
