"""A simulation session: owns the robot's process, and knows no front end."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from time import monotonic
from types import TracebackType

from ...config.pictures import field_picture
from ...errors import PyfrcError, UsageError
from ...processes.crash_report import describe_exit, moment_of
from ...processes.output_pipe import Stamps
from ...project import Project
from ...runtime.robot_time import PACKET_US, to_us
from ...runtime.scripts.script import InputScript
from .changes import ChangeCursor, RecordedFeed, ReportSignal
from .commands import Command, PendingCommands, TimeState
from .controls import Controls, Driver
from .field import field_of, robot_at, start_named
from .first_script import choices_of, first_recording, releases_after
from .messages import Failed, Job, Message, Ready, Replayed, RobotReport, Update
from .options import SimOptions
from .output_log import OutputCursor, OutputLog
from .past_run import PastRun
from .processes import RobotProcesses
from .recording import Recording
from .scene import Pose, Tag
from .snapshot import Failure, Snapshot, Status
from .snapshot_builder import SnapshotBuilder, status_after, status_at_start
from .source import SimulationSource

#: A running robot does not respond when it has sent nothing for this time, in wall seconds.
_SILENCE = 1.0


class Simulation(Controls, SimulationSource):
    """A robot that a person, a script or a dashboard can drive.

    All methods may be called at any time, from any thread. A call that makes no sense at that moment does nothing, or
    explains itself in `Status.note`. Only `close` and `wait_for` block. `Snapshot` and `Status` say what there is to
    see. Several front ends can show one simulation: cursors give each of them all output and all changes.

    :param log: a run that is shown beside this one: a log that has the script's inputs
    :raises SettingsError: when ``sim/config.json`` is invalid
    :raises UsageError: when an option is impossible
    """

    def __init__(self, project: Project, options: SimOptions | None = None, log: PastRun | None = None) -> None:
        self.options = options or SimOptions()
        self.options.check()
        self.project = project
        self.field = field_of(project)
        #: Notified of everything that a front end may show.
        self.reports = ReportSignal()
        self._status = Status(speed=self.options.speed)
        self._snapshot: Snapshot | None = None
        self.branches = () if log is None else (log,)
        self._recording = self._first_recording()
        self._older: list[Recording] = []
        self._reported_at = monotonic()
        self._launch = 0
        self._tags: tuple[Tag, ...] | None = None
        self._builder = SnapshotBuilder()
        # What the user wants of time: what the robot's process has reported, and then the pending commands.
        # `Status.state` is the state of the process itself.
        until_us = None if self.options.run_until is None else to_us(self.options.run_until)
        self._time = TimeState(self.options.paused, until_us, speed=self.options.speed)
        self._pending = PendingCommands()
        self._drivers: set[Driver] = set()
        #: Held while a command is sent or a process is launched: the process gets them in the order of their calls.
        self._sending = threading.RLock()
        #: The moment that the robot's process replays to before it goes on.
        self._forward_us = 0
        self._hal, self._network = (
            RecordedFeed(changes) for changes in (self._recording.changes, self._recording.network_changes)
        )
        self._output = OutputLog()
        #: Called with all that robots print, and with their tracebacks, from this object's threads.
        self.echo: Callable[[str], object] = lambda text: None
        self._processes: RobotProcesses | None = None

    # -- what there is to see -------------------------------------------------------------------------------------

    @property
    def snapshot(self) -> Snapshot | None:
        """The robot as it last reported itself; None before the first report."""
        return self._snapshot

    @property
    def status(self) -> Status:
        """The state of the simulation."""
        status = self._status
        if status.state not in ("failed", "closed") and monotonic() - self._reported_at > _SILENCE:
            standstill = None if self._processes is None else self._processes.standstill(self.project.files)
            if standstill is not None and standstill.loading:  # nothing is wrong
                return replace(status, standstill=standstill) if status.state == "starting" else status
            silent = status.state == "running" or standstill is not None
            return replace(status, responding=not silent, standstill=standstill)
        return status

    @property
    def wants_to_run(self) -> bool:
        """Whether the commands so far want robot time to go on; also known while the robot starts or has failed."""
        with self.reports:
            return not self._time_wanted.paused

    @property
    def recordings(self) -> tuple[InputScript, ...]:
        """What was recorded before each time that the user went back in time or restarted the robot; latest first."""
        with self.reports:
            return tuple(each.script() for each in self._older)

    def output_cursor(self, from_start: bool = True) -> OutputCursor:
        """Return a reader of what the robot prints; each reader gets all of it.

        :param from_start: False begins with what is printed from now on
        """
        return self._output.cursor(from_start)

    def change_cursor(self) -> ChangeCursor:
        """Return a reader of all changes of `hal_data`, from the start of this run; each reader gets all of them.

        :raises UsageError: when this simulation is not recorded
        """
        self._check_recorded()
        with self.reports:
            return self._hal.cursor()

    def network_cursor(self) -> ChangeCursor:
        """Return a reader of all changes of NetworkTables, as `change_cursor` does of `hal_data`."""
        self._check_recorded()
        if not self.options.network_values:
            raise UsageError("this simulation does not report NetworkTables", remedy="Set SimOptions.network_values.")
        with self.reports:
            return self._network.cursor()

    def wait_for(self, condition: Callable[[], bool], timeout: float | None = None) -> bool:
        """Wait until a condition is true, and return whether it is.

        :param condition: evaluated whenever something has changed
        :param timeout: in wall seconds
        """
        with self.reports:
            return self.reports.wait_for(condition, timeout)

    def attach(self) -> Driver:
        """Return the controls of one person, which are released when that person leaves."""
        return Driver(self._send, self._drivers)

    # -- beginning and end ----------------------------------------------------------------------------------------

    def start(self) -> None:
        """Start the robot."""
        if self._processes is None:
            self._processes = RobotProcesses(self._on_message, self._on_exit, self._on_output, self.options.fork)
            options = self.options
            self._begin(self._recording, to_us(options.start_at), self._time)
            image = self.project.sim_config.field.image
            if image is not None and (why := field_picture(self.project.root, image)[1]):
                self._note(f"sim/config.json: pyfrc.field.image: {image!r}: {why}.")

    def close(self) -> None:
        """End the robot's process, whatever it is doing."""
        with self.reports:
            self._status = replace(self._status, state="closed")
            self.reports.notify_all()
        if self._processes is not None:
            self._processes.close()

    def __enter__(self) -> Simulation:
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.close()

    # -- time -----------------------------------------------------------------------------------------------------

    def rewind(self, seconds: float) -> None:
        """Go back to a moment, and go on from there. What came after it is kept in `recordings`.

        The joysticks are released: what was held at that moment is not held any more. A robot that has failed can go
        back to a moment before its failure.
        """
        if not self.options.recording:
            self._note("Going back is impossible: this simulation is not recorded.")
            return
        with self._sending, self.reports:
            to = max(0, min(to_us(seconds), self._moment_us)) // PACKET_US * PACKET_US
            part = self._recording.until(to)
            self._keep_and_begin(part, to, self._time_wanted.continued_at(to), releases_after(part))

    def restart(self) -> None:
        """Start the robot again, at time 0. What was recorded is kept in `recordings`.

        The alliance, the game data, the choosers' options and the chosen mode stay as they were chosen.
        """
        with self._sending, self.reports:
            to = to_us(self.options.start_at)
            first = self._first_recording()
            choices = choices_of(self._recording, self._pending.commands, first.past, self._snapshot)
            self._keep_and_begin(first, to, self._time_wanted.continued_at(to), choices)

    def reload(self) -> None:
        """Load the robot's code again, replay the same inputs until this moment, and go on from there."""
        if not self.options.recording:
            self.restart()
            return
        with self._sending, self.reports:
            project = replace(self.project)
            try:
                self.field = field_of(project)
            except PyfrcError as wrong:
                self._note(str(wrong))
                return
            self.project = project
            again = self._recording.again()
            to = max([self._moment_us, *(step.at_us for step in again.past.steps[-1:])])
            former = self._builder.trail
            self._keep_and_begin(again, to, self._time, self._pending.commands, keep=False)
            self._status = replace(self._status, former_trail=former)

    # -- where the robot is ---------------------------------------------------------------------------------------

    def place(self, x: float, y: float, degrees: float) -> None:
        """Put the robot at a place on the field, in feet and degrees as in ``sim/config.json``."""
        self.write(robot_at(self.field, Pose(x, y, math.radians(degrees))))

    def reset_position(self, start: str | None = None) -> None:
        """Put the robot where it started, or on one of the field's other `starts`."""
        self.write(robot_at(self.field, start_named(self.field, start or self.options.start_position)))

    # -- recording ------------------------------------------------------------------------------------------------

    def script(self) -> InputScript:
        """Return the robot's inputs from its start until now, with the hash of what it did."""
        with self.reports:
            return self._recording.script()

    def save(self, file: Path) -> None:
        """Write the recording: an input script, and a trace beside it.

        :raises UsageError: when this simulation is not recorded
        """
        self._check_recorded()
        with self.reports:
            self._recording.save(file)

    def save_all(self, file: Path) -> list[Path]:
        """Write this recording, and the older ones beside it as ``NAME-1.jsonl`` and so on, the oldest first.

        :returns: the files of the scripts
        """
        self.save(file)
        files = [file]
        with self.reports:
            for number, older in enumerate(reversed(self._older), 1):
                files.append(file.with_name(f"{file.stem}-{number}{file.suffix}"))
                older.save(files[-1])
        return files

    # -- the robot's process --------------------------------------------------------------------------------------

    def _keep_and_begin(
        self, recording: Recording, to_us: int, time: TimeState, commands: tuple[Command, ...] = (), keep: bool = True
    ) -> None:
        if self._processes is None or self._status.state == "closed":
            return
        if keep and self._recording.length_us > to_us:
            self._older.insert(0, self._recording)
        self._status = replace(self._status, former_trail=self._builder.trail if keep else ())
        self._begin(recording, to_us, time, commands)

    def _begin(
        self, recording: Recording, forward_to_us: int, time: TimeState, commands: tuple[Command, ...] = ()
    ) -> None:
        assert self._processes is not None
        options = self.options
        job = Job(
            project=replace(self.project),
            options=replace(options, script=None),
            script=recording.past,
            forward_to_us=forward_to_us,
            time_state=time,
            commands=commands,
            station=recording.station,
            tags=self._tags,
            reports_replay=recording.is_open,
        )
        with self._sending, self.reports:
            self._recording = recording
            self._forward_us = forward_to_us
            self._time, self._pending = time, PendingCommands(commands)
            self._builder = SnapshotBuilder()
            self._reported_at = monotonic()
            self._status = status_at_start(self._status, forward_to_us)
            self._hal.launch(recording.changes)
            self._network.launch(recording.network_changes)
            self._launch = self._processes.launch(job)
            self.reports.notify_all()

    def _send(self, command: Command) -> None:
        with self._sending:
            with self.reports:
                if self._processes is None or self._status.state == "closed":
                    return
                failed = self._status.state == "failed"
                self._pending.add(command, sent=not failed)
            if not failed:  # otherwise the next process gets it
                self._processes.send(command)

    @property
    def _time_wanted(self) -> TimeState:
        return self._pending.time_after(self._time, self._moment_us + PACKET_US)

    @property
    def _moment_us(self) -> int:
        """The moment that the robot is at, or is replaying to."""
        return max(self._recording.length_us, self._forward_us)

    def _on_message(self, launch: int, message: Message) -> None:
        with self.reports:
            if launch != self._launch or self._status.state == "closed":
                return
            self._reported_at = monotonic()
            if isinstance(message, Update):
                self._take_in(message)
            elif isinstance(message, Replayed):
                self._record(message)
                self._status = replace(self._status, replayed=message.time_us / 1_000_000)
            elif isinstance(message, Ready):
                self._tags = message.tags
                self.field = replace(self.field, tags=message.tags)
                note = "\n".join(message.notes) or self._status.note
                self._status = replace(self._status, network_address=message.network_address, note=note)
                if self.options.recording:  # otherwise another process of the robot is unlikely
                    assert self._processes is not None
                    self._processes.preload(message.libraries)
            elif isinstance(message, Failed):
                self._fail(message.failure)
            else:
                self._status = replace(self._status, state="closed")
            self.reports.notify_all()
        if isinstance(message, Failed):
            self._echo_failure(message.failure)

    def _on_exit(self, launch: int, status: int, report: bytes) -> None:
        with self.reports:
            if launch != self._launch or self._status.state in ("failed", "closed"):
                return
            text = describe_exit(report, status, self.project.files, "while it was simulated")
            headline, _, details = text.partition("\n\n")
            moment = moment_of(report)
            failure = Failure(headline, details, moment.seconds if moment else self._recording.length_us / 1_000_000)
            self._fail(failure)
            self.reports.notify_all()
        self._echo_failure(failure)

    def _on_output(self, text: str, stamps: Stamps) -> None:
        self._output.append(text, stamps)
        with self.reports:
            self.reports.notify_all()
        self.echo(text)

    def _fail(self, failure: Failure) -> None:
        self._status = replace(self._status, state="failed", failure=failure, reached=0.0)

    def _echo_failure(self, failure: Failure) -> None:
        details = f"{failure.details.rstrip()}\n" if failure.details else ""
        self.echo(f"{details}{failure}\n")

    def _note(self, note: str) -> None:
        with self.reports:
            self._status = replace(self._status, note=note)
            self.reports.notify_all()

    def _take_in(self, update: Update) -> None:
        if self.options.recording:
            self._record(update)
        else:
            self._recording.length_us = update.time_us
        self._time = update.time_state
        self._pending.settle(update.carried_out, update.recorded)
        self._snapshot = self._builder.snapshot_after(update, self.field)
        self._status = status_after(self._status, update, self._recording.length_us)

    def _record(self, report: RobotReport) -> None:
        """Add what the robot did to the recording, and pass it on to readers."""
        number, is_new_code = self._status.starts, self._recording.is_open
        self._recording.add(report)
        self._hal.report(number, report.time_us, report.base, report.changes, is_new_code)
        self._network.report(number, report.time_us, report.network_base, report.network_changes, is_new_code)

    def _check_recorded(self) -> None:
        if not self.options.recording:
            raise UsageError("this simulation is not recorded")

    def _first_recording(self) -> Recording:
        return first_recording(self.options, self.project.main_file.name, self.field, bool(self.branches))
