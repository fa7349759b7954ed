"""What an error means for a student: a sentence, the line of the robot's code, and what to do.

Libraries describe their errors from their own point of view: in the numbers of the HAL, in types of C++, in classes
that the user has never seen. `explain` returns the same in the user's words, for the errors that are common. Each
module has one kind as a table: adding an error is adding a row. All other errors are shown as they are.

In: an exception with its traceback. Out: an `Explanation`, or None. WPILib is not imported here: an error that it has
raised brings all that is needed.
"""

from __future__ import annotations

from .explanation import Explanation
from .kinds import explain

__all__ = ["Explanation", "explain"]
