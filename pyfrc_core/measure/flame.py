"""The flame view: pyinstrument's web page, of the samples that were taken here.

pyinstrument draws it because a page in which one can fold, search and zoom is much work, and its is the one that people
know. It is an optional extra, since nothing else here needs it.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

from .._version import requirement
from ..errors import UsageError
from ..text_files import write_whole
from .figures import Figures

#: What joins the parts of a frame, and what stands before the number of the line, in pyinstrument's session files.
_PART, _LINE = "\x00", "\x01l"


def flame_is_to_be_had() -> None:
    """Ask before the measuring begins.

    :raises UsageError: when pyinstrument is missing
    """
    if importlib.util.find_spec("pyinstrument") is None:
        raise UsageError(
            "the flame view is drawn by pyinstrument, which is not installed",
            remedy=f'Install it with: pip install "{requirement("profile")}"',
        )


def write_flame(figures: Figures, file: Path, title: str) -> None:
    """Write the samples as a web page.

    :param title: what was measured
    """
    from pyinstrument.renderers import HTMLRenderer
    from pyinstrument.session import Session

    whole = f"the robot{_PART}{_PART}0"
    records = [
        [[whole, *(f"{name}{_PART}{place}{_PART}{0}{_LINE}{line}" for name, place, line in stack)], spent / 1e9]
        for stack, spent in figures.stacks.items()
    ]
    seconds = sum(figures.stacks.values()) / 1e9
    session = Session.from_json(
        {
            "frame_records": records,
            "start_time": 0.0,
            "duration": seconds,
            "sample_count": figures.samples,
            "start_call_stack": [whole],
            "target_description": title,
            "cpu_time": seconds,
            "sys_path": sys.path,
            "sys_prefixes": Session.current_sys_prefixes(),
        }
    )
    write_whole(file, [HTMLRenderer(show_all=True).render(session)])
