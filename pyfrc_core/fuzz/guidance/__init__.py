"""What is new, and which match is continued because of it.

In: what each match reached, and how it ended. Out: the seeds of the next match. A match that was the first to reach a
goal (`goals`) is continued: a line or a branch (`lines`; branches from Python 3.12), or a state (`states`). How near a
comparison was is not measured: Python does not show its operands in a public way. What ends many matches is avoided
(`known_failures`).
"""
