"""What the robot needs, downloaded while there is internet: the season's Python, and packages as wheels.

In: a project, whose ``[tool.robotpy]`` names the packages. Out: files in the season's cache, which the season's own
tool uses too, and a lock beside pyproject.toml with their versions and hashes. A deploy reads both (`load_lock`,
`cached_file`). Nothing here connects to a robot.
"""

from .cache import cache_of, cached_file
from .lock import LOCK_FILE, Lock, LockedFile, load_lock, lock_file_of

__all__ = ["LOCK_FILE", "Lock", "LockedFile", "cache_of", "cached_file", "load_lock", "lock_file_of"]
