"""The flame graph: pyinstrument's web page, drawn from our own samples.

pyinstrument draws it, because a page with folding, search and zoom is much work, and its page is widely known. It is an
optional extra, since nothing else here needs it.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

from .._version import requirement
from ..errors import UsageError
from ..text_files import write_whole
from .figures import Figures

#: The separators in pyinstrument's session files: between the parts of a frame, and before a line number.
_PART, _LINE = "\x00", "\x01l"


def require_pyinstrument() -> None:
    """Check that pyinstrument is installed, before the measurement begins.

    :raises UsageError: when it is not
    """
    if importlib.util.find_spec("pyinstrument") is None:
        raise UsageError(
            "the flame graph needs pyinstrument, which is not installed",
            remedy=f'Install it with: pip install "{requirement("profile")}"',
        )


def write_flame(figures: Figures, file: Path, title: str) -> None:
    """Write the samples as a web page.

    :param title: the name of what was measured
    """
    from pyinstrument.renderers import HTMLRenderer
    from pyinstrument.session import Session

    whole = f"the robot{_PART}{_PART}0"
    seconds = figures.stacks.total() / 1e9
    session = Session.from_json(
        {
            "frame_records": [
                [[whole, *(f"{name}{_PART}{file}{_PART}0{_LINE}{line}" for name, file, line in stack)], spent / 1e9]
                for stack, spent in figures.stacks.items()
            ],
            "start_time": 0.0,
            "duration": seconds,
            "sample_count": len(figures.stacks),
            "start_call_stack": [whole],
            "target_description": title,
            "cpu_time": seconds,
            "sys_path": sys.path,
            "sys_prefixes": Session.current_sys_prefixes(),
        }
    )
    write_whole(file, [HTMLRenderer(show_all=True).render(session)])
