"""What is a failure, and what may be a mistake.

In: a run, with the calls that set its motors. Out: a `FuzzFailure` for each misbehavior and exception. Two are the
same if their kind and the user's innermost line are equal (`failure`). `checks` has the checks that need no exception,
each with a setting; most let the match go on, so that one match can show several (`misbehavior_notes`). `hints` has
what is no failure.

Motor calls are intercepted in Python (`motor_calls`): WPILib changes NaN and values beyond 1 before the HAL sees them.
"""
