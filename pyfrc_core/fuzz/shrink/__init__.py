"""The shortest script of a failure.

In: a script that fails, and an executor that runs shorter ones. Out: the shortest that fails in the same way: few
writes, early and with simple values (`shrinker`). `starts` has the scripts that are tried first.
"""
