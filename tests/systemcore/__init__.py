"""A SystemCore look-alike: a real OpenSSH server and a real sudo in a root of its own, with the robot's user and paths.

It was never compared with a real one. It is made from what is known in public: see docs/reference/systemcore.md.
"""

from .machine import Systemcore, require_systemcore

__all__ = ["Systemcore", "require_systemcore"]
