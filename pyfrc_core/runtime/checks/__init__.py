"""What is wrong with a robot's code that runs without an exception, and what to tell its author.

In: the project's source before the run, and the run itself. Out: a warning or a failure with the user's line: misspelt
methods, paths that exist on one computer only, loops that wait, code that makes no progress.
"""
