"""Check a project's rules while its robot runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from types import TracebackType

from ..errors import text_of
from ..project.robot_files import RobotFiles, innermost_entry
from ..runtime.checks.failures import NamesItsPlace
from ..runtime.clock import CHECK, PACKET_US
from ..runtime.robot import RobotRun
from ..runtime.time.timed_loop import Periodic
from ..wpi import station
from .load import PARAMETERS, Invariant
from .values import Moment, moment_of_return, values_at


class BrokenInvariantError(NamesItsPlace):
    """A rule is broken, or its code raises something else than `AssertionError`.

    :param kind: ``invariant``, or the type of what it raises
    :param place: the line of the rule, such as ``tests/rules.py:7``
    :param function: the name of the function with that line
    """

    def __init__(self, what: str, kind: str, place: str, function: str) -> None:
        super().__init__(f"{place}: {what}")
        self.kind, self.place, self.function = kind, place, function


#: The kind of a failure that is a broken rule.
BROKEN = "invariant"


def watch_invariants(
    run: RobotRun,
    files: RobotFiles,
    rules: Sequence[Invariant],
    report: Callable[[BrokenInvariantError], object] | None = None,
) -> None:
    """Check the rules after the robot's loop of each packet, from its first loop to the end of the run.

    :param run: a run that has not started
    :param report: called once for each rule that is broken; by default, that ends the run as an exception does
    """
    if rules:
        _RuleWatch(run, files, list(rules), report or run.threads.fail).begin()


class _RuleWatch:
    def __init__(
        self,
        run: RobotRun,
        files: RobotFiles,
        rules: list[Invariant],
        report: Callable[[BrokenInvariantError], object],
    ) -> None:
        self._run = run
        self._files = files
        self._rules = rules
        self._report = report
        self._calls: list[tuple[Callable[[], object], Invariant]] | None = None
        #: The packet in which the rules were checked last.
        self._packet_us = -1

    def begin(self) -> None:
        self._run.timed_loop.after_calls.append(self._after_call)
        self._run.clock.every(PACKET_US, CHECK, self._after_packet)

    def _after_call(self, callback: Periodic) -> None:
        """Check the rules as soon as all that is due now has been called.

        The robot has then reacted to what the packet brought, and physics has not yet moved on.
        """
        run = self._run
        if callback is run.timed_loop.main:
            packet_us = run.clock.next_packet_us
            if packet_us != self._packet_us:
                self._packet_us = packet_us
                run.clock.at(run.clock.now_us, CHECK, self._check)

    def _after_packet(self) -> None:
        """Check the rules of a robot whose loop is not WPILib's."""
        run = self._run
        if run.own_loop is None or run.timed_loop.main is not None:
            return
        if not run.initializes or station.program_state() is not None:
            self._check()

    def _check(self) -> None:
        run = self._run
        if run.turn_began() is not None or run.threads.ending or not run.alive:
            return  # the loop waits: half of what it does in this packet is done
        if self._calls is None:
            self._calls = [(self._bound(rule), rule) for rule in self._rules]
        broken = []
        for call, rule in self._calls:
            try:
                result = call()
            except AssertionError as error:
                broken.append((call, rule, self._failed(rule, error)))
            except Exception as error:
                broken.append((call, rule, self._wrong(rule, error)))
            else:
                if result is not None and result is not True:
                    error_of_result = self._judge(rule, call, result)
                    if error_of_result is not None:
                        broken.append((call, rule, error_of_result))
        for call, rule, failure in broken:
            self._calls.remove((call, rule))
            self._report(failure)

    def _bound(self, rule: Invariant) -> Callable[[], object]:
        run = self._run
        values = {name: run.robot if name == "robot" else run.hal_data for name in rule.parameters}
        return partial(rule.function, **values)

    # -- what is wrong -------------------------------------------------------------------------------------------

    def _judge(self, rule: Invariant, call: Callable[[], object], result: object) -> BrokenInvariantError | None:
        """Return the failure of a rule that has returned neither None nor True, if it is one."""
        if type(result).__name__ not in ("bool", "bool_"):  # numpy's, too
            what = f"the rule {rule.name}() returned {result!r}: return True or False, or use assert"
            return BrokenInvariantError(what, "InvariantError", rule.place, rule.name)
        if result:
            return None
        moment = moment_of_return(rule.code, call)
        return self._broken(rule, "", moment, rule.place, rule.name)

    def _failed(self, rule: Invariant, error: AssertionError) -> BrokenInvariantError:
        moment = _innermost(error.__traceback__, self._files)
        # In a test file, pytest has added what it says of the values.
        said = "" if str(error).startswith("assert ") else str(error).partition("\nassert ")[0]
        if moment is None:
            return self._broken(rule, said, None, rule.place, rule.name)
        place = f"{self._files.relative(moment.code.co_filename)}:{moment.line}"
        return self._broken(rule, said, moment, place, moment.code.co_name)

    def _broken(
        self, rule: Invariant, said: str, moment: Moment | None, place: str, function: str
    ) -> BrokenInvariantError:
        values = ", ".join(values_at(moment, hidden=PARAMETERS)) if moment is not None else ""
        why = f"{said} ({values})" if said and values else said or values
        what = f"the rule {rule.name}() is broken" + (f": {why}" if why else "")
        return BrokenInvariantError(f"{what}\n  {self._when()}", BROKEN, place, function)

    def _wrong(self, rule: Invariant, error: Exception) -> BrokenInvariantError:
        moment = _innermost(error.__traceback__, self._files)
        place = rule.place if moment is None else f"{self._files.relative(moment.code.co_filename)}:{moment.line}"
        what = f"the rule {rule.name}() raised {text_of(error)}"
        robot_line = self._files.innermost_line(error.__traceback__)
        if robot_line is not None and robot_line != place:
            what += f" (at {robot_line})"
        function = rule.name if moment is None else moment.code.co_name
        return BrokenInvariantError(f"{what}\n  {self._when()}", type(error).__name__, place, function)

    def _when(self) -> str:
        return f"at {self._run.clock.now:.2f} s of robot time, in {station.mode_name()} mode"


def _innermost(traceback: TracebackType | None, files: RobotFiles) -> Moment | None:
    """Return the innermost moment in a file of the project's tests."""
    entry = innermost_entry(traceback, lambda file: files.is_project_file(file) and not files.is_robot_code(file))
    if entry is None:
        return None
    frame = entry.tb_frame
    return Moment(frame.f_code, entry.tb_lineno, {**frame.f_globals, **frame.f_locals})
