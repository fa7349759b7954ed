"""A simulation session: owns the process that the robot lives in, and knows no window."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from time import monotonic
from types import TracebackType
from typing import Any

from ...errors import PyfrcError, UsageError
from ...project import Project
from ...runtime.clock import PACKET_US, to_us
from ...runtime.own_process import explain_end, moment_of
from ...runtime.scripts.script import InputScript, Step
from .commands import Command, Pause, Run, Speed
from .controls import Controls
from .field import field_of, robot_at, start_named
from .messages import Failed, Job, Message, Ready, Update
from .options import SimOptions, check_speed
from .pending import PendingCommands
from .processes import RobotProcesses
from .recording import Recording
from .scene import Pose, Tag
from .snapshot import Failure, Snapshot, Status
from .snapshot_builder import Assembly
from .time_state import TimeState

#: So much of what a robot has printed is kept for whoever asks for it, in characters.
_MOST_OUTPUT = 200_000
#: A robot not heard of for so long does not respond, in wall seconds.
_SILENCE = 1.0


class Simulation(Controls):
    """A robot that a person, a script or a dashboard can drive.

    Everything may be called at any time, from any thread: what makes no sense then does nothing, or is answered in
    `Status.note`. Only `close` and `wait_for` wait for anything. See `Snapshot` and `Status` for what there is to see.

    :raises SettingsError: when ``sim/config.json`` is not what it may be
    :raises UsageError: when an option cannot be
    """

    def __init__(self, project: Project, options: SimOptions | None = None) -> None:
        self.options = options or SimOptions()
        self.options.check()
        self.project = project
        self.field = field_of(project)
        self._changed = threading.Condition()
        self._status = Status(speed=self.options.speed)
        self._snapshot: Snapshot | None = None
        self._recording = Recording(self._first_script())
        self._older: list[Recording] = []
        self._heard = monotonic()
        self._launch = 0
        self._tags: tuple[Tag, ...] | None = None
        self._assembly = Assembly()
        # What the user wants is what the robot's process was last known to go by, and after that the commands that are
        # pending. What is, is `Status.state`.
        until_us = None if self.options.run_until is None else to_us(self.options.run_until)
        self._time = TimeState(self.options.paused, until_us, speed=self.options.speed)
        self._pending = PendingCommands()
        #: Held while a command is sent or a process is launched, so that all threads' come in one order.
        self._sending = threading.RLock()
        #: Where the robot's process is to be brought to before it goes on.
        self._forward_us = 0
        self._output = ""
        #: Called with all that robots print, and with their tracebacks, from threads of this object's.
        self.echo: Callable[[str], object] = lambda text: None
        self._processes: RobotProcesses | None = None

    # -- what there is to see -------------------------------------------------------------------------------------

    @property
    def snapshot(self) -> Snapshot | None:
        """The robot as it was last heard of; None before the first time."""
        return self._snapshot

    @property
    def status(self) -> Status:
        """How the simulation goes."""
        status = self._status
        if status.state == "running" and monotonic() - self._heard > _SILENCE:
            return replace(status, responding=False)
        return status

    @property
    def wants_to_run(self) -> bool:
        """Whether robot time is to go on, by the commands so far: also while the robot starts, or has failed."""
        with self._changed:
            return not self._time_wanted.paused

    @property
    def recordings(self) -> tuple[InputScript, ...]:
        """What was recorded until time was turned back, or the robot restarted; the latest first."""
        with self._changed:
            return tuple(each.script() for each in self._older)

    def take_output(self) -> str:
        """What the robot has printed since this was last asked."""
        with self._changed:
            output, self._output = self._output, ""
        return output

    def wait_for(self, condition: Callable[[], bool], timeout: float | None = None) -> bool:
        """Wait until this is so; answers whether it is.

        :param condition: asked whenever something has changed
        :param timeout: in wall seconds
        """
        with self._changed:
            return self._changed.wait_for(condition, timeout)

    # -- beginning and end ----------------------------------------------------------------------------------------

    def start(self) -> None:
        """Start the robot."""
        if self._processes is None:
            self._processes = RobotProcesses(self._on_message, self._on_exit, self._on_output, self.options.fork)
            options = self.options
            self._begin(self._recording, to_us(options.start_at), self._time)
            image = self.project.sim_config.field.image
            if image is not None and self.field.image is None:
                self._note(f"sim/config.json: pyfrc.field.image: there is no file {image!r} in sim/. Correct the path.")

    def close(self) -> None:
        """End the robot's process, whatever it does."""
        with self._changed:
            self._status = replace(self._status, state="closed")
            self._changed.notify_all()
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

    def resume(self) -> None:
        """Let time go on."""
        self._send(Run())

    def pause(self) -> None:
        """Let time stand still."""
        self._send(Pause())

    def step(self, packets: int = 1) -> None:
        """Let so many packets' time pass, 0.02 s each, then pause. What is left of another step is added."""
        self._send(Run(packets=max(1, packets)))

    def run_for(self, seconds: float) -> None:
        """Let so many seconds of robot time pass, then pause."""
        self.step(round(to_us(seconds) / PACKET_US))

    def run_until(self, seconds: float) -> None:
        """Pause when robot time gets there."""
        self._send(Run(until_us=to_us(seconds)))

    def set_speed(self, factor: float) -> None:
        """Robot seconds a second: 1 is real time, 0.1 slow motion, 0 as fast as it goes."""
        check_speed(factor)
        self._send(Speed(factor))

    def rewind(self, seconds: float) -> None:
        """Go back to a moment, and go on from there. What came after it is kept among `recordings`.

        A robot that has failed can be brought back to before it did.
        """
        if not self.options.recording:
            self._note("There is no way back: this simulation is not recorded.")
            return
        with self._sending, self._changed:
            to = max(0, min(to_us(seconds), self._moment_us)) // PACKET_US * PACKET_US
            self._keep_and_begin(self._recording.until(to), to, self._time_wanted.continued_at(to))

    def restart(self) -> None:
        """Start the robot anew, at time 0. What was recorded is kept among `recordings`."""
        with self._sending, self._changed:
            to = to_us(self.options.start_at)
            self._keep_and_begin(Recording(self._first_script()), to, self._time_wanted.continued_at(to))

    def reload(self) -> None:
        """Bring the robot, with its code as it is now, to this moment through the same inputs, and go on from there."""
        if not self.options.recording:
            self.restart()
            return
        with self._sending, self._changed:
            project = replace(self.project)
            try:
                self.field = field_of(project)
            except PyfrcError as wrong:
                self._note(str(wrong))
                return
            self.project = project
            again = self._recording.again()
            to = max([self._moment_us, *(step.at_us for step in again.past.steps[-1:])])
            former = self._assembly.trail
            self._keep_and_begin(again, to, self._time, self._pending.commands, keep=False)
            self._status = replace(self._status, former_trail=former)

    # -- where the robot is ---------------------------------------------------------------------------------------

    def place(self, x: float, y: float, degrees: float) -> None:
        """Put the robot elsewhere on the field: feet and degrees, as in ``sim/config.json``."""
        self.write(robot_at(self.field, Pose(x, y, math.radians(degrees))))

    def reset_position(self, start: str | None = None) -> None:
        """Put the robot where it started, or on another of the field's `starts`."""
        self.write(self._at_start(start or self.options.start_position))

    # -- recording ------------------------------------------------------------------------------------------------

    def script(self) -> InputScript:
        """What the robot has been told from its start until now, and the hash of what it has done."""
        with self._changed:
            return self._recording.script()

    def save(self, file: Path) -> None:
        """Write the recording: an input script, and a trace beside it.

        :raises UsageError: when this simulation is not recorded
        """
        if not self.options.recording:
            raise UsageError("this simulation is not recorded")
        with self._changed:
            self._recording.save(file)

    def save_all(self, file: Path) -> list[Path]:
        """Write this recording, and the older ones beside it: ``NAME-1.jsonl`` is what time was first turned back from.

        :returns: the scripts' files
        """
        self.save(file)
        files = [file]
        with self._changed:
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
        self._status = replace(self._status, former_trail=self._assembly.trail if keep else ())
        self._begin(recording, to_us, time, commands)

    def _begin(
        self, recording: Recording, forward_to_us: int, time: TimeState, commands: tuple[Command, ...] = ()
    ) -> None:
        assert self._processes is not None
        options = self.options
        job = Job(
            project=replace(self.project),
            script=recording.past,
            forward_to_us=forward_to_us,
            time_state=time,
            commands=commands,
            recording=options.recording,
            station=recording.station,
            nt_port=options.nt_port,
            wpilog=options.wpilog,
            extensions=options.extensions,
            tags=self._tags,
        )
        with self._sending, self._changed:
            self._recording = recording
            self._forward_us = forward_to_us
            self._time, self._pending = time, PendingCommands(commands)
            self._assembly = Assembly()
            self._heard = monotonic()
            starts = self._status.starts + 1
            self._status = replace(self._status, state="starting", failure=None, note="", starts=starts)
            self._launch = self._processes.launch(job)
            self._changed.notify_all()

    def _send(self, command: Command) -> None:
        with self._sending:
            with self._changed:
                if self._processes is None or self._status.state == "closed":
                    return
                failed = self._status.state == "failed"
                self._pending.add(command, sent=not failed)
            if not failed:  # else the next process gets it
                self._processes.send(command)

    @property
    def _time_wanted(self) -> TimeState:
        return self._pending.time_after(self._time, self._moment_us + PACKET_US)

    @property
    def _moment_us(self) -> int:
        """The moment that the robot is at, or is being brought to."""
        return max(self._recording.length_us, self._forward_us)

    def _on_message(self, launch: int, message: Message) -> None:
        with self._changed:
            if launch != self._launch or self._status.state == "closed":
                return
            self._heard = monotonic()
            if isinstance(message, Update):
                self._take_in(message)
            elif isinstance(message, Ready):
                self._tags = message.tags
                self.field = replace(self.field, tags=message.tags)
                note = " ".join(message.notes) or self._status.note
                self._status = replace(self._status, network_address=message.network_address, note=note)
                if self.options.recording:  # else there is no other robot's process to come, in all likelihood
                    assert self._processes is not None
                    self._processes.preload(message.libraries)
            elif isinstance(message, Failed):
                self._fail(message.failure)
            else:
                self._status = replace(self._status, state="closed")
            self._changed.notify_all()
        if isinstance(message, Failed):
            self._echo_failure(message.failure)

    def _on_exit(self, launch: int, status: int, words: str) -> None:
        with self._changed:
            if launch != self._launch or self._status.state in ("failed", "closed"):
                return
            text = explain_end(words, status, self.project.files, "while it was simulated")
            headline, _, details = text.partition("\n\n")
            moment = moment_of(words)
            seconds = self._recording.length_us / 1_000_000 if moment is None else moment.seconds
            failure = Failure(headline, details, seconds)
            self._fail(failure)
            self._changed.notify_all()
        self._echo_failure(failure)

    def _on_output(self, text: str) -> None:
        with self._changed:
            self._output = (self._output + text)[-_MOST_OUTPUT:]
            self._changed.notify_all()
        self.echo(text)

    def _fail(self, failure: Failure) -> None:
        self._status = replace(self._status, state="failed", failure=failure, reached=0.0)

    def _echo_failure(self, failure: Failure) -> None:
        details = f"{failure.details.rstrip()}\n" if failure.details else ""
        self.echo(f"{details}failed at {failure.time:.2f} s: {failure.headline}\n")

    def _note(self, note: str) -> None:
        with self._changed:
            self._status = replace(self._status, note=note)
            self._changed.notify_all()

    def _take_in(self, update: Update) -> None:
        if self.options.recording:
            self._recording.hear(update)
        else:
            self._recording.length_us = update.time_us
        self._time = update.time_state
        self._pending.settle(update.carried_out, update.recorded)
        self._snapshot = self._assembly.snapshot_after(update, self.field)
        self._status = replace(
            self._status,
            state="paused" if update.time_state.paused else "running",
            speed=update.time_state.speed,
            reached=update.reached,
            average=update.average,
            packet_seconds=update.packet_seconds,
            worst_packet_seconds=update.worst_packet_seconds,
            late_packets=update.late_packets,
            overruns=update.overruns,
            worst_loop_seconds=update.worst_loop_seconds,
            length=self._recording.length_us / 1_000_000,
            note=" ".join(update.notes) or self._status.note,
        )

    def _first_script(self) -> InputScript:
        script = self.options.script or InputScript((), 0, robot=self.project.main_file.name)
        if self.options.start_position is not None:
            script = replace(script, steps=(Step(0, self._at_start(self.options.start_position)), *script.steps))
        return script

    def _at_start(self, name: str | None) -> dict[str, Any]:
        return robot_at(self.field, start_named(self.field, name))
