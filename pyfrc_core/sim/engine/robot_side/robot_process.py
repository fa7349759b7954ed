"""The process that a simulated robot lives in: from importing its code to telling how it ended."""

from __future__ import annotations

import gc
import math
import os
import sys
import threading
import traceback
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from types import ModuleType
from typing import Any

from ....compat.unrepeatable import explain_unrepeatable
from ....config.sim import SimConfig
from ....errors import PyfrcError
from ....physics.engine import load_physics
from ....physics.pose import METRES_PER_FOOT
from ....processes.channel import Connection
from ....processes.crash_report import CrashLog
from ....processes.exit import before_sudden_exit
from ....project import Project
from ....project.robot_files import past_pyfrc
from ....runtime.checks.code_checks import find_code_warnings
from ....runtime.checks.crash_moment import CrashMoment
from ....runtime.checks.failures import as_robot_code_error, leave_out_libraries
from ....runtime.checks.hang_detector import HangDetector
from ....runtime.loading import load_robot
from ....runtime.patches.data_logs import LogPlace
from ....runtime.patches.install import patches
from ....runtime.robot import RobotRun
from ....runtime.seeds import seed_generators
from ....season import CURRENT
from ....wpi import fields, robots
from ..extensions import LOADABLE, WINDOW
from ..messages import Failed, Job, Ready, WindowClosed
from ..program_files import keep_no_bytecode_of_new_code
from ..scene import Tag
from ..snapshot import Failure
from .console import PrintedOutput
from .session import Ended, Session
from .wpilog import WpiLog

#: Code in these directories counts as a library.
_INSTALLED = ("site-packages", "dist-packages")
#: AprilTags are drawn where the field's size differs from theirs by less than this, in feet.
_SAME_SIZE = 1.0


def run_robot(job: Job, connection: Connection, log: CrashLog, stamp: str) -> None:
    """Run a robot until the other end of `connection` is closed, or the robot fails; the failure is sent there.

    :param log: written to when the process ends by itself
    :param stamp: see `PrintedOutput`
    """
    for name in job.options.extensions:
        robots.load_extension(LOADABLE[name].module)
    if WINDOW not in job.options.extensions:
        _run(job, connection, log, stamp)
        return
    robot = threading.Thread(target=_run, name="robot", args=(job, connection, log, stamp), daemon=True)
    robot.start()
    robots.show_window()
    with suppress(OSError):
        connection.send(WindowClosed())


def _run(job: Job, connection: Connection, log: CrashLog, stamp: str) -> None:
    project, files = job.project, job.project.files
    run = RobotRun(LogPlace.of_run(project.root))
    loaded = False
    console = PrintedOutput(run.clock, stamp, keeps=job.options.wpilog is not None)
    try:
        keep_no_bytecode_of_new_code(project.root)
        patches.install(files)
        robot_class = load_robot(project)
        physics = load_physics(project) if project.physics_file.is_file() else None
        loaded = True
        hang_detector = HangDetector(files, project.settings.test.hang_seconds, log)
        with hang_detector.watching(), ExitStack() as closing:
            run.open()
            closing.callback(run.data_logs.close)
            seed_generators(job.script.seed)
            session = Session(run, job, connection)
            CrashMoment(log, run)

            def construct() -> None:
                if physics is not None:
                    physics.attach(run)
                if job.options.wpilog is not None:
                    closing.enter_context(_logged(run, project, job.options.wpilog, console))
                gc.freeze()  # or a collection of all modules would hold up the loop
                run.construct(robot_class)  # not frozen: libraries such as PyKit find its objects by the collector

            def ready() -> Ready:
                tags = tags_of(project.sim_config) if job.tags is None else job.tags
                notes = tuple(map(str, find_code_warnings(project)))
                if devices := run.hal_data["CAN"].unrepeatable_devices():
                    notes += (explain_unrepeatable(devices),)
                return Ready(tags, tuple(_libraries(project)), session.network_address, notes)

            try:
                session.go(construct, ready)
            except (BrokenPipeError, ConnectionResetError):
                pass  # the simulation has ended
            except BaseException:
                with suppress(Exception):  # the original error matters more
                    session.send_update()
                raise
    except BaseException as error:
        # A robot that could not be imported fails at the moment that it was to go on from.
        now = run.clock.now if loaded else job.forward_to_us / 1_000_000
        connection.send(Failed(_failure(error, project, now)))


def _failure(error: BaseException, project: Project, now: float) -> Failure:
    if isinstance(error, Ended):
        headline = f"{project.main_file.name}: the robot program ended by itself"
        return Failure(headline, "startCompetition() returned.", now)
    if isinstance(error, PyfrcError):
        return Failure(str(error), "", now, error.exit_code)
    failure = as_robot_code_error(error, project.files)
    leave_out_libraries(error, project.files)
    text = "".join(traceback.format_exception(type(error), error, past_pyfrc(error.__traceback__)))
    for root in {str(project.root), str(project.root.resolve())}:
        text = text.replace(f'  File "{root}{os.sep}', '  File "')  # windows have little space
    return Failure(str(failure), text, now)


@contextmanager
def _logged(run: RobotRun, project: Project, file: Path, console: PrintedOutput) -> Iterator[None]:
    log = WpiLog(file)

    def close() -> None:
        console.end()
        log.close()

    before_sudden_exit["--wpilog"] = close
    console.begin(log.print)
    changes = run.hal_data.changes()
    written: dict[str, Any] = {}
    run.when_network_written.append(written.__setitem__)

    def look(now: float) -> None:
        changed, gone = changes.look_at_values()
        controller = getattr(run.physics, "controller", None)
        log.write(run.clock.now_us, changed, gone, written, None if controller is None else controller.get_pose())
        written.clear()

    run.observe(look)
    try:
        yield
    except BaseException as error:
        failure = _failure(error, project, run.clock.now)
        for line in (failure.details or failure.headline).splitlines():
            log.print(run.clock.now_us, line)
        raise
    finally:
        del before_sudden_exit["--wpilog"]
        close()


def _libraries(project: Project) -> Iterator[str]:
    for name, module in sys.modules.copy().items():
        file = getattr(module, "__file__", None) if isinstance(module, ModuleType) else None
        if file is not None and any(part in file for part in _INSTALLED) and not project.files.is_project_file(file):
            yield name


def tags_of(config: SimConfig) -> tuple[Tag, ...]:
    """Return the AprilTags, where WPILib's library of them is installed."""
    field = config.field
    for known in fields.tagged_fields(str(field.season or CURRENT.year)):
        length, width = known.length / METRES_PER_FOOT, known.width / METRES_PER_FOOT
        if math.dist((length, width), (field.w, field.h)) < _SAME_SIZE:
            return tuple(
                Tag(tag.number, tag.x / METRES_PER_FOOT, field.h - tag.y / METRES_PER_FOOT, -tag.angle)
                for tag in known.tags
            )
    return ()
