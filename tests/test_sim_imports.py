"""The process of a front end has no robot, and imports nothing of WPILib: it would take a fifth of a second."""

from __future__ import annotations

import subprocess
import sys
from textwrap import dedent

from sim_robots import FILES

PROGRAM = """
    import importlib.util
    import sys
    from pathlib import Path

    from pyfrc_core.project import find_project
    from pyfrc_core.sim.simulate import SimRequest, simulate

    request = SimRequest(ui="none", seconds=0.5, quiet=True, page=Path("run.html"))
    assert simulate(find_project(Path.cwd()), request, print) == 0
    print("of the server:", [name for name in ("starlette", "uvicorn", "websockets") if name in sys.modules])
    import pyfrc_core.sim.ui.web.front_end
    import pyfrc_core.sim.ui.choose
    if importlib.util.find_spec("tkinter") is not None:
        import pyfrc_core.sim.ui.tk
    print("imported:", [name for name in ("hal", "ntcore", "wpilib", "wpimath", "wpiutil") if name in sys.modules])
"""


def test_the_front_ends_process_imports_nothing_of_wpilib(make_project) -> None:
    done = subprocess.run(
        [sys.executable, "-c", dedent(PROGRAM)],
        cwd=make_project(FILES).path,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "the robot is there" in done.stdout
    assert "of the server: []" in done.stdout
    assert "imported: []" in done.stdout
