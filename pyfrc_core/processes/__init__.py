"""Child processes: how they start, what they send, how they end, and what is known when they crash.

Imports nothing of what runs in them: no WPILib, no pytest.
"""
