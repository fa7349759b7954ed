"""Find subsystems whose ``__init__`` does not call ``super().__init__()``: `periodic` is never called."""

from __future__ import annotations

from collections.abc import Iterator
from types import FunctionType
from typing import TYPE_CHECKING

from ...wpi import names
from .code_warning import CodeWarning
from .misspelled_methods import robot_classes

if TYPE_CHECKING:
    from ...project import Project


def find_missing_super(project: Project) -> Iterator[CodeWarning]:
    """Yield the subsystems in the project's imported modules that are not registered with the scheduler."""
    for cls in robot_classes(project):
        init = vars(cls).get("__init__")
        bases = [f"{base.__module__}.{base.__name__}" for base in cls.__mro__]
        if names.SUBSYSTEM not in bases or not isinstance(init, FunctionType):
            continue
        if not names.REGISTERING.intersection(init.__code__.co_names):
            yield CodeWarning(
                f"{project.files.relative(init.__code__.co_filename)}:{init.__code__.co_firstlineno}",
                f"{cls.__name__}.__init__ does not call super().__init__(): commands2 never calls its periodic()",
                "Write super().__init__() as its first line.",
            )
