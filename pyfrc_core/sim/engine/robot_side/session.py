"""The robot's side of a simulation: lets time go on, carries out commands, reports what has changed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from functools import partial
from typing import Any

from ....errors import PyfrcError
from ....physics.core import PhysicsInterface
from ....physics.pose import walls_of
from ....processes.channel import Connection
from ....runtime.checks.loop_limit import LoopLimit
from ....runtime.checks.refresh import RefreshCheck
from ....runtime.clock import INPUT, NO_LIMIT_US, OBSERVE, PACKET_US
from ....runtime.exceptions import TestEnded
from ....runtime.robot import RobotRun
from ....runtime.scripts.player import Player
from ....runtime.scripts.recorder import Recorder
from ....runtime.scripts.targets import Targets
from ....wpi import station
from .. import commands
from ..messages import Job, Ready, Replayed, Update
from ..scene import Pose, Target
from ..snapshot import Opmode
from .driven_path import DrivenPath
from .network import Choosers, Served, written_target
from .pace import Pace, wall
from .station import Station
from .traces import NetworkTrace, Traces
from .user_renderer import UserRenderer

#: Above real time, the shortest interval of updates, in wall seconds; otherwise each packet has one. Unrecorded
#: simulations run unattended, and need fewer.
_UPDATE_SECONDS, _UNRECORDED_UPDATE_SECONDS = 0.02, 0.1
#: How often to report how far a replay has come, in wall seconds.
_REPLAY_SECONDS = 0.05
#: How long to wait for commands in a pause before reading what dashboards have written, in wall seconds.
_LOOK_SECONDS = 0.05
#: The robot's place is read at this interval, in packets.
_FOLLOW_PACKETS = 2
#: The longest run between two looks at commands at full speed, in packets and in wall seconds.
_MOST_PACKETS, _CHUNK_SECONDS = 50, 0.01
#: A `robotInit` that waits longer than this is shown while it waits.
_INITIALIZED_BY_US = 10_000_000


class Ended(Exception):
    """The robot program has ended by itself."""


class Session:
    """One interactive run of a robot. The run is open, and its robot is not constructed yet.

    :param connection: to the `Simulation`
    """

    def __init__(self, run: RobotRun, job: Job, connection: Connection) -> None:
        self._run, self._job, self._connection = run, job, connection
        self._targets = Targets(run.hal_data, run.connection.packet, run.when_network_written)
        self._choosers = Choosers()
        self._opmodes: tuple[Opmode, ...] = ()
        self._served: Served | None = None
        self._time = job.time_state
        self._carried_out = self._recorded = 0
        self._pace = Pace(self._time.speed, self._time.paused)
        if job.options.extensions:  # which have changed the initial state: that counts as an input, too
            station.reset_driver_station()
        self._recorder = Recorder(run) if job.options.recording else None
        self._traces = Traces(run.hal_data, NetworkTrace(self._robot_pose) if job.options.network_values else None)
        self._renderer = UserRenderer(self._robot_pose)
        self._drawings: tuple[Any, ...] = ()
        self._vision: tuple[Target, ...] = ()
        self._path = DrivenPath(walls_of(job.project.sim_config))
        self._mode_packets: Counter[str] = Counter()
        self._notes: list[str] = []
        self._replaying = False
        self._packet_began = wall()
        self._steps_sent = self._own_steps_from = 0
        self._sent_at = 0.0
        self._update_seconds = _UPDATE_SECONDS if job.options.recording else _UNRECORDED_UPDATE_SECONDS
        self._packets_at_once = 1
        # The next target in robot time, and the last target beyond which the robot was waiting.
        self._target_us = self._awaited_us = -1
        self._advance_began = wall(), 0  # on the wall and in robot time
        self._taken_over = self._left = False
        self._refresh = RefreshCheck(run)
        self._beyond_us = 0  # 1 in the microsecond after the target, where the robot waits beyond it
        run.threads.before_driver_waits.append(self._on_wait)
        run.renderer = self._renderer
        run.clock.limit_us = NO_LIMIT_US
        project = job.project
        self._station = Station(run, project.settings.match, project.sim_config.field, self._write, job.station)

    def go(self, construct: Callable[[], object], ready: Callable[[], Ready]) -> None:
        """Construct the robot, replay to the moment that it goes on from, and run it until the simulation ends.

        :raises Ended: when the robot program has ended
        """
        run, job = self._run, self._job
        from_the_start = job.forward_to_us <= job.script.start_us
        self._traces.is_on = job.options.recording and (from_the_start or job.reports_replay)
        self._replaying = not from_the_start
        if job.options.recording:
            run.clock.before_packet.append(self._packet_begins)
            run.observe(self._packet_is_over)
        LoopLimit(run, job.project.files, job.project.settings, lambda error: self._notes.append(error.note))
        construct()
        run.clock.every(_FOLLOW_PACKETS * PACKET_US, OBSERVE, self._follow)
        self._ready = ready
        self._target_us = max(job.forward_to_us, _INITIALIZED_BY_US)
        try:
            Player(job.script, run).start()
            if self._recorder is not None and not job.options.extensions:
                self._own_steps_from = len(self._recorder.steps_from(0))  # those before are the script's
            self._mark_position()
            if job.reports_replay:
                self._traces.look(run.clock.now)  # the values that it begins with
            if run.clock.now_us < job.forward_to_us:
                self._target_us = job.forward_to_us
                run.run_until(job.forward_to_us)
            if not self._taken_over:
                self._take_over()
            self._loop()
        except TestEnded:
            if not self._left:
                raise

    def _take_over(self) -> None:
        """Begin to carry out commands: the replay is over."""
        run, job = self._run, self._job
        self._taken_over, self._replaying = True, False
        if job.options.recording:
            self._traces.skip_hal(run.clock.now)
        self._station.connect(job.script, job.options.opmodes)
        for command in job.commands:
            self._carry_out(command)
        if job.options.nt_port is not None:
            self._served = Served(job.options.nt_port, job.options.nt_shared, self._write)
            if self._served.problem:
                self._notes.append(self._served.problem)
        self._connection.send(self._ready())
        self.send_update(dict(run.hal_data.leaves()))
        self._traces.is_on = job.options.recording
        self._pace.begin(run.clock.now_us)

    @property
    def network_address(self) -> str | None:
        """Where NetworkTables are served."""
        return None if self._served is None else self._served.address

    # -- time -----------------------------------------------------------------------------------------------------

    def _loop(self) -> None:
        while (target_us := self._next_target()) is not None:
            self._begin_advance(target_us)
            self._run.run_until(target_us)
            self._end_advance()

    def _next_target(self) -> int | None:
        """Carry out commands, pause and keep the pace until robot time may go on.

        :returns: the next target; None when the simulation has ended
        """
        pace, clock = self._pace, self._run.clock
        while self._receive_commands():
            if not pace.paused and self._stop_us() <= clock.now_us:
                self._set_time(self._time.stopped())
                self.send_update()
            if pace.paused:
                if self._connection.poll(_LOOK_SECONDS if self._served is not None else None):
                    continue
                self._exchange()
                continue
            packets = self._packets_at_once if pace.speed == 0 else 1
            target_us = min(clock.next_packet_us + (packets - 1) * PACKET_US, self._stop_us())
            wait = pace.wait_for(target_us)
            if wait > 0 and self._connection.poll(wait):
                continue
            self._exchange()
            return target_us
        return None

    def _begin_advance(self, target_us: int) -> None:
        self._target_us = target_us
        self._recorded = self._carried_out
        self._advance_began = wall(), self._run.clock.now_us

    def _end_advance(self) -> None:
        """Measure the time that the robot took to its target, and send an update if one is due."""
        pace, now_us = self._pace, self._run.clock.now_us
        began, from_us = self._advance_began
        took = wall() - began
        pace.ran(now_us)
        if not self._job.options.recording:
            packets = max(1, (now_us - from_us) // PACKET_US)
            pace.took(took / packets, packets)
        if took > _CHUNK_SECONDS:
            self._packets_at_once = max(1, self._packets_at_once // 2)
        else:
            self._packets_at_once = min(_MOST_PACKETS, self._packets_at_once * 2)
        if 0 < pace.speed <= 1 or wall() - self._sent_at >= self._update_seconds:
            self.send_update()

    # -- a loop that waits ----------------------------------------------------------------------------------------

    def _on_wait(self) -> None:
        """Note that robot code on this thread is about to wait, perhaps beyond the target."""
        if self._awaited_us != self._target_us:
            self._awaited_us = self._target_us
            # Right after everything that is due at the target.
            self._run.clock.at(self._target_us + 1, INPUT, partial(self._on_beyond, self._target_us))

    def _on_beyond(self, target_us: int) -> None:
        """Do the work between two targets within the robot's wait, since `run_until` does not return."""
        run = self._run
        if target_us != self._target_us or not run.threads.driver_waits:
            return
        recorder = run.recorder
        run.in_motion, self._beyond_us = False, 1
        if recorder is not None:
            recorder.begin_outside(stepping=True)
        try:
            if self._taken_over:
                self._end_advance()
            else:
                if not run.timed_loop.in_place:
                    line = self._job.project.files.line_of_thread(run.threads.driver)
                    self._notes.append(f"{line}: the robot still waits here, before its loop has begun.")
                self._take_over()
            next_us = self._next_target()
        finally:
            if recorder is not None:
                recorder.end_outside(stepping=True)
            run.in_motion, self._beyond_us = True, 0
        if next_us is None:
            self._left = True
            run.clock.halted = True
            raise TestEnded
        self._begin_advance(next_us)
        self._on_wait()

    def _stop_us(self) -> int:
        return 1 << 62 if self._time.until_us is None else self._time.until_us

    def _set_time(self, time: commands.TimeState) -> None:
        self._time = time
        self._pace.paused, self._pace.speed = time.paused, time.speed
        self._pace.begin(self._run.clock.now_us)

    # -- inputs ---------------------------------------------------------------------------------------------------

    def _receive_commands(self) -> bool:
        """Carry out the commands that have arrived. Returns False when the simulation has ended."""
        received = False
        try:
            while self._connection.poll():
                command = self._connection.recv()
                if isinstance(command, commands.Quit):
                    return False
                self._carry_out(command)
                received = True
        except (EOFError, ConnectionError):
            return False
        if received and self._pace.paused:
            self.send_update(dict(self._run.hal_data.leaves()))
        return True

    def _carry_out(self, command: object) -> None:
        self._carried_out += 1
        match command:
            case commands.Resume() | commands.Pause() | commands.Speed():
                self._set_time(self._time.after(command, self._run.clock.next_packet_us))
            case commands.Write():
                for target, value in command.writes.items():
                    self._put(target, value)
            case _:
                if note := self._station.carry_out(command):
                    self._notes.append(note)

    def _put(self, target: str, value: object) -> None:
        try:
            self._station.put(written_target(target), value)
        except (PyfrcError, TypeError, ValueError, LookupError) as wrong:
            self._notes.append(f"{target} = {value!r}: {wrong}")

    def _write(self, target: str, value: object) -> None:
        if target == commands.ROBOT_ON_FIELD:  # robot code may show a field of its own under that name
            target = target.replace("/Field/", f"/{getattr(self._run.physics, 'field_name', 'Field')}/")
        self._targets.write(target, value, self._run.clock.now_us)

    def _exchange(self) -> None:
        if self._served is not None:
            self._served.exchange()

    # -- updates --------------------------------------------------------------------------------------------------

    def send_update(self, base: dict[str, object] | None = None) -> None:
        """Send what has changed.

        :param base: all values, where the changes do not continue those sent before
        """
        run, pace = self._run, self._pace
        if not self._job.options.recording and base is None:
            self._traces.look_at_hal(run.clock.now)
        steps_from = max(self._own_steps_from, self._steps_sent - 2)
        steps = () if self._recorder is None else self._recorder.steps_from(steps_from)
        overruns, worst_us = run.overruns_until_now()
        drawings, vision, opmodes = self._renderer.drawings(), self._targets_seen(), self._station.opmodes()
        changes, network_changes = self._traces.take(run.clock.now)
        update = Update(
            time_us=run.clock.now_us - self._beyond_us,
            mode=station.mode_name(),
            station=self._station.state,
            time_state=self._time,
            carried_out=self._carried_out,
            recorded=self._carried_out if self._recorder is None else self._recorded,
            reached=pace.reached,
            average=pace.average,
            packet_seconds=pace.packet_seconds,
            worst_packet_seconds=pace.worst_packet_seconds,
            late_packets=pace.late_packets,
            overruns=overruns,
            worst_loop_seconds=worst_us / 1_000_000,
            robot=self._robot_pose(),
            base=base,
            changes=changes,
            network_base=None if base is None else self._traces.network_values,
            network_changes=network_changes,
            trail=tuple(self._path.points),
            distance=self._path.distance,
            mode_seconds={mode: packets * PACKET_US / 1_000_000 for mode, packets in self._mode_packets.items()},
            steps_from=steps_from,
            steps=steps,
            drawings=None if drawings == self._drawings else drawings,
            targets=None if vision == self._vision else vision,
            choosers=self._choosers.changed(),
            opmodes=None if opmodes == self._opmodes else opmodes,
            notes=tuple(self._notes),
        )
        self._connection.send(update)
        self._sent_at = wall()
        self._drawings, self._vision, self._opmodes = drawings, vision, opmodes
        self._steps_sent = update.steps_from + len(steps)
        if self._recorder is not None:
            self._recorder.forget_before(update.steps_from)
        self._path.points.clear()
        self._notes.clear()

    @property
    def _controller(self) -> PhysicsInterface | None:
        return getattr(self._run.physics, "controller", None)

    def _robot_pose(self) -> Pose | None:
        controller = self._controller
        return None if controller is None else Pose(*controller.get_position())

    def _packet_begins(self, now: float) -> None:
        self._packet_began = wall()

    def _packet_is_over(self, now: float) -> None:
        # Measured before recording, whose time does not count as the robot's.
        self._pace.took(wall() - self._packet_began)
        if self._traces.is_on:
            self._traces.look(now)

    def _follow(self) -> None:
        """Note the robot's place and mode. Called for every second packet."""
        if not self._run.alive:
            raise Ended
        self._mode_packets[station.mode_name() if station.is_attached() else "disabled"] += _FOLLOW_PACKETS
        if (note := self._refresh.look()) is not None:
            self._notes.append(note)
        self._traces.skip(self._run.clock.now)
        if self._replaying and wall() - self._sent_at >= _REPLAY_SECONDS:
            self._report_replay()
        self._mark_position()

    def _report_replay(self) -> None:
        clock = self._run.clock
        changes, network_changes = self._traces.take(clock.now)
        self._connection.send(Replayed(time_us=clock.now_us, changes=changes, network_changes=network_changes))
        self._sent_at = wall()

    def _mark_position(self) -> None:
        if (pose := self._robot_pose()) is not None and (note := self._path.add(pose)):
            self._notes.append(f"{self._run.clock.now:.2f} s: {note}")

    def _targets_seen(self) -> tuple[Target, ...]:
        controller = self._controller
        if controller is None:
            return ()
        in_view = controller.vision_targets_in_view
        return tuple(Target(each.x, each.y, each in in_view) for each in controller.vision_targets)
