"""A team's own rules: functions in its tests that are checked while the robot runs.

In: functions with the decorator `pyfrc.invariant`. Out: a failure with the values of the broken condition (`values`).
The clock calls the rules between the robot's loop and physics, when inputs and outputs belong together. The values come
from evaluating the parts of the condition once more: pytest's own explanation needs asserts that it has rewritten at
import, and matches of fuzz run without pytest.
"""
