"""What the user wants of a simulation holds, however its robot processes come and go meanwhile."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from sim_robots import FILES

from pyfrc_core.project import Project
from pyfrc_core.runtime.clock import PACKET_US
from pyfrc_core.runtime.scripts.script import Step
from pyfrc_core.sim import SimOptions, Simulation
from pyfrc_core.sim.engine import simulation
from pyfrc_core.sim.engine.commands import Command, Write
from pyfrc_core.sim.engine.messages import Failed, Job, Message, Ready, StationState, Update
from pyfrc_core.sim.engine.snapshot import Failure


@dataclass
class FakeRobot:
    """A robot process without a process: it goes by its job and its commands, one at a time."""

    number: int
    job: Job
    inbox: deque[Command] = field(default_factory=deque)
    outbox: deque[Message] = field(default_factory=deque)

    def __post_init__(self) -> None:
        self.now_us, self.time = self.job.forward_to_us, self.job.time_state
        self.carried_out = self.recorded = 0
        self.steps: list[Step] = []
        self.inputs: dict[str, object] = {}
        self.waiting: dict[str, object] = {}
        for step in self.job.script.steps:
            self.inputs.update(step.writes)
        for command in self.job.commands:
            self._carry_out(command)
        self.outbox.append(Ready((), (), None))
        self._tell()

    def work(self) -> None:
        """Carry out a command, or let a packet's time pass."""
        if self.inbox:
            self._carry_out(self.inbox.popleft())
        elif self.time.until_us is not None and not self.time.paused and self.time.until_us <= self.now_us:
            self.time = self.time.stopped()
        elif not self.time.paused:
            if self.waiting:
                self.steps.append(Step(self.now_us + 1, dict(self.waiting)))
                self.waiting.clear()
            self.recorded = self.carried_out
            self.now_us += PACKET_US
        else:
            return
        self._tell()

    def _carry_out(self, command: Command) -> None:
        self.carried_out += 1
        self.time = self.time.after(command, self.now_us + PACKET_US)
        if isinstance(command, Write):
            self.inputs.update(command.writes)
            self.waiting.update(command.writes)

    def _tell(self) -> None:
        nothing: dict[str, object] = dict.fromkeys(("drawings", "targets", "choosers", "opmodes", "robot"))
        times = dict.fromkeys(
            ("reached", "average", "packet_seconds", "worst_packet_seconds", "worst_loop_seconds", "distance"), 0.0
        )
        nothing["base"], nothing["changes"] = dict(self.inputs), ()
        nothing["network_base"], nothing["network_changes"] = {}, ()
        self.outbox.append(
            Update(
                time_us=self.now_us, mode="disabled", station=StationState(), time_state=self.time,
                carried_out=self.carried_out, recorded=self.recorded, overruns=0, late_packets=0,
                trail=(), mode_seconds={}, steps_from=0, steps=tuple(self.steps), notes=(),
                **nothing, **times,
            )  # type: ignore[arg-type]
        )  # fmt: skip


class FakeProcesses:
    """Stands for `RobotProcesses`; messages and work happen when a test lets them happen."""

    def __init__(self, on_message: Callable[[int, Message], object], *others: object) -> None:
        self._on_message = on_message
        self.robot: FakeRobot | None = None
        self.number = 0

    def launch(self, job: Job) -> int:
        self.number += 1
        self.robot = FakeRobot(self.number, job)
        return self.number

    def send(self, command: Command) -> None:
        assert self.robot is not None
        self.robot.inbox.append(command)

    def preload(self, modules: tuple[str, ...]) -> None:
        pass

    def close(self) -> None:
        pass

    def work(self) -> None:
        """Let the robot do one thing."""
        assert self.robot is not None
        self.robot.work()

    def hear(self) -> None:
        """Let one message of the robot's arrive."""
        assert self.robot is not None
        if self.robot.outbox:
            self._on_message(self.robot.number, self.robot.outbox.popleft())

    def fail(self) -> None:
        """The robot fails, with commands in its inbox."""
        assert self.robot is not None
        self.robot.inbox.clear()
        self.robot.outbox.append(Failed(Failure("a failure", "", 0.0)))
        while self.robot.outbox:
            self.hear()

    def settle(self) -> None:
        """Let everything happen that is on its way."""
        assert self.robot is not None
        while self.robot.outbox or self.robot.inbox:
            self.hear()
            if self.robot.inbox:
                self.robot.work()


@pytest.fixture(scope="module")
def project(make_shared_project) -> Project:
    return Project(make_shared_project(FILES).path / "robot.py")


@pytest.fixture(scope="module", autouse=True)
def fake() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(simulation, "RobotProcesses", FakeProcesses)
        yield


def started(project: Project, options: SimOptions) -> tuple[Simulation, FakeProcesses]:
    simulation = Simulation(project, options)
    simulation.start()
    assert isinstance(simulation._processes, FakeProcesses)
    return simulation, simulation._processes


def do(simulation: Simulation, processes: FakeProcesses, what: str) -> None:
    {
        "resume": simulation.resume,
        "pause": simulation.pause,
        "step": simulation.step,
        "fast": lambda: simulation.set_speed(4),
        "slow": lambda: simulation.set_speed(0.5),
        "until": lambda: simulation.run_until(5 * 0.02),
        "write": lambda: simulation.write({"dio[0].value": True}),
        "unwrite": lambda: simulation.write({"dio[0].value": False}),
        "reload": simulation.reload,
        "restart": simulation.restart,
        "back": lambda: simulation.rewind(0.04),
        "fail": processes.fail,
        "hear": processes.hear,
        "work": processes.work,
    }[what]()


COMMANDS = ["resume", "pause", "step", "fast", "slow", "until", "write", "unwrite"]
GOINGS = ["reload", "restart", "back", "fail"]
HAPPENINGS = ["hear", "work", "work", "hear"]


def paused_after(commands: list[str], paused: bool) -> bool:
    """What the user wants, by what the user has done alone, when there was time enough for it."""
    stepping = False
    for command in commands:
        if command in ("resume", "until"):
            paused, stepping = False, False
        elif command == "pause":
            paused, stepping = True, False
        elif command == "step":
            paused, stepping = False, True
        elif command in ("back", "restart") and stepping:
            paused, stepping = True, False
    return paused


@given(words=st.lists(st.sampled_from([*COMMANDS, *GOINGS, *HAPPENINGS]), max_size=14), paused=st.booleans())
@example(words=["reload", "fail", "reload"], paused=False)
@example(words=["restart", "back", "reload"], paused=False)
@example(words=["reload", "hear", "reload", "hear", "back"], paused=False)
def test_every_sequence_of_commands_ends_as_the_user_wants(project: Project, words: list[str], paused: bool) -> None:
    simulation, processes = started(project, SimOptions(paused=paused))
    wanted: list[str] = []
    for word in words:
        do(simulation, processes, word)
        if word not in HAPPENINGS:
            wanted.append(word)
    if simulation.status.state == "failed":
        simulation.reload()
    processes.settle()
    for _ in range(40):  # to the end of steps
        processes.work()
        processes.settle()
    has_an_end = any(word in ("step", "until") for word in wanted)
    if not has_an_end:
        assert simulation.status.state == ("paused" if paused_after(wanted, paused) else "running")
        assert simulation.wants_to_run == (simulation.status.state == "running")
    elif paused_after(wanted, paused):
        assert simulation.status.state == "paused"
    speeds = {"fast": 4.0, "slow": 0.5}
    assert simulation.status.speed == next((speeds[word] for word in reversed(wanted) if word in speeds), 1.0)


@settings(max_examples=60)
@given(
    words=st.lists(st.sampled_from(["step", "write", "unwrite", "reload", "fail", "fast", *HAPPENINGS]), max_size=12)
)
def test_new_code_loses_no_step_and_no_input(project: Project, words: list[str]) -> None:
    """However late messages are, and however often the code is saved, even with a mistake in it."""
    simulation, processes = started(project, SimOptions(paused=True))
    for word in words:
        do(simulation, processes, word)
    if simulation.status.state == "failed":
        simulation.reload()
    processes.settle()
    for _ in range(20):
        processes.work()
        processes.settle()
    assert simulation.status.state == "paused"
    assert processes.robot is not None
    assert processes.robot.now_us == words.count("step") * PACKET_US
    written = [word == "write" for word in words if word in ("write", "unwrite")]
    assert processes.robot.inputs.get("dio[0].value") == (written[-1] if written else None)


def test_two_steps_are_two_packets(project: Project) -> None:
    simulation, processes = started(project, SimOptions(paused=True))
    simulation.step()
    simulation.step(2)
    for _ in range(10):
        processes.work()
    processes.settle()
    assert (simulation.snapshot.time, simulation.status.state) == (0.06, "paused")


def test_code_saved_while_the_robot_is_brought_to_its_first_moment(project: Project) -> None:
    simulation, processes = started(project, SimOptions(paused=True, start_at=2.0))
    simulation.reload()
    processes.settle()
    assert simulation.snapshot.time == 2.0
