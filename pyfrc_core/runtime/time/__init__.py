"""WPILib's own ways to wait and to be called later, in robot time.

In: the clock, and what robot code sets: notifiers, watchdogs, periodic functions. Out: calls when these are due, on the
thread that moves the time. WPILib's C++ threads, which follow the wall clock, are taken out.
"""
