"""Load a project's ``physics.py``, detect its generation by its signatures, and call it during a run."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from ..config.document import document_of
from ..project import Project
from ..runtime.clock import PACKET_US, PHYSICS, to_us
from ..runtime.loading import import_file
from ..runtime.robot import RobotRun
from ..wpi import dashboards, geometry, robots, station
from .core import PhysicsEngine, PhysicsField, PhysicsInitException, PhysicsInterface

#: The shortest period of `update_sim`, for robots with faster loops (100 Hz).
_SHORTEST_PERIOD_US = 10_000

_WHAT_IT_MUST_HAVE = (
    "It must have a class PhysicsEngine with __init__(self, physics_controller) or __init__(self, physics_controller, "
    "robot),\n  and with update_sim(self, hal_data, now, tm_diff) or update_sim(self, now, tm_diff)."
)


def load_physics(project: Project) -> PhysicsModule:
    """Import the project's ``physics.py``. The robot's modules must be imported before.

    :raises RobotCodeError: when it fails, with the user's line
    """
    return PhysicsModule(import_file(project, project.physics_file), project)


class PhysicsModule:
    """A project's ``physics.py``. Its generation is detected by its signatures.

    The documented `update_sim` takes ``(hal_data, now, tm_diff)``, the current one ``(now, tm_diff)``; in both
    generations the constructor may also take the robot.

    :raises PhysicsInitException: with the line of a method that cannot be called
    """

    def __init__(self, module: ModuleType, project: Project) -> None:
        self._project = project
        self.engine_class = _engine_class(module)
        self.takes_hal_data = self._takes_hal_data()
        self.takes_robot = self._takes_robot()
        initialize = getattr(self.engine_class, "initialize", None)
        if initialize is not None and not _accepts(initialize, "self", "hal_data"):
            raise _wrong_signature(self.engine_class, "initialize")

    def attach(self, run: RobotRun, fake_time: object = None) -> Physics:
        """Create the physics of one run; call it before the robot is constructed.

        :param fake_time: the value of `physics_controller.fake_time`
        """
        loaded = self._project.loaded_sim_config
        config = loaded.config
        controller = PhysicsInterface(self._project.root, fake_time, config, run.hal_data)
        controller.config_obj = document_of(config, loaded.text.value if loaded.text is not None else None)
        if not self.takes_hal_data and not config.says_start:
            dashboards.place_robot(controller.field, geometry.pose())  # where robots of the current generation start
        return Physics(self, controller, run)

    def _takes_robot(self) -> bool:
        constructor = self.engine_class.__init__
        if constructor is not object.__init__:
            names = list(inspect.signature(constructor).parameters)[1:]
            with_robot = _accepts(constructor, "self", "physics_controller", "robot")
            if names[:1] == ["robot"] or not (with_robot or _accepts(constructor, "self", "physics_controller")):
                raise _wrong_signature(self.engine_class, "__init__")
            if not with_robot or not _accepts(constructor, "self", "physics_controller"):
                return with_robot
            # A second parameter with a default: since 2020 it receives the robot; in 2019 it was the user's own.
            return names[1:2] == ["robot"] or not self.takes_hal_data
        raise _wrong_signature(self.engine_class, "__init__")

    def _takes_hal_data(self) -> bool:
        engine = self.engine_class
        update = getattr(engine, "update_sim", None)
        if not callable(update):
            raise PhysicsInitException(
                "PhysicsEngine has no method update_sim", where=_place(engine), remedy=_WHAT_IT_MUST_HAVE
            )
        bound = ["self"] if inspect.isfunction(inspect.getattr_static(engine, "update_sim")) else []
        names = list(inspect.signature(update).parameters)[len(bound) :]
        documented = _accepts(update, *bound, "hal_data", "now", "tm_diff")
        current = _accepts(update, *bound, "now", "tm_diff") and names[:2] != ["tm_diff", "now"]
        if names[:1] == ["hal_data"]:
            current = False  # another parameter is missing
        if documented == current and not documented:
            raise _wrong_signature(engine, "update_sim")
        return documented and not current


class Physics:
    """The physics of one run, which creates and calls the engine at the right times.

    :param controller: the engine moves the robot with it
    """

    def __init__(self, module: PhysicsModule, controller: PhysicsInterface, run: RobotRun) -> None:
        self.controller = controller
        self.engine: Any = None
        #: The name of the field on dashboards.
        self.field_name = "Field"
        #: Where the robot was placed on the field by an earlier run in this process.
        self._placed_before = dashboards.placed("Field")
        self._module = module
        self._run = run
        self._updating = False
        self._period_us = PACKET_US
        self._last_us = 0
        run.physics = self
        if module.takes_hal_data and not module.takes_robot:
            run.do(self._make_engine)  # as documented: `initialize` sets inputs before the robot is created
            run.when_initialized.append(self._leave_name_to_robot)
        else:
            run.when_initialized.append(self._make_engine)
        run.when_constructed.append(self._begin)

    def _begin(self) -> None:
        if not robots.is_magic(self._run.robot):
            period_us = to_us(robots.period(self._run.robot, PACKET_US / 1_000_000))
            self._period_us = min(PACKET_US, max(_SHORTEST_PERIOD_US, period_us))
        self._run.clock.every(self._period_us, PHYSICS, self._update)

    def _make_engine(self) -> None:
        __tracebackhide__ = True
        module, run = self._module, self._run
        if dashboards.WITHOUT_ROBOT or run.robot is not None:
            self._show_field(_free_name())
        self.engine = module.engine_class(self.controller, *([run.robot] if module.takes_robot else []))
        initialize = getattr(self.engine, "initialize", None)
        if initialize is not None:
            initialize(run.hal_data)

    def _leave_name_to_robot(self) -> None:
        """Show the field, if it is not shown, or under another name, if robot code shows one of its own as "Field"."""
        if not isinstance(dashboards.shown("Field"), PhysicsField):
            self._show_field(_free_name())

    def _show_field(self, name: str) -> None:
        field, pose, placed = self.controller.field, self.controller.get_pose(), dashboards.placed(name)
        if name == "Field" and placed not in (None, self._placed_before):  # by the script that plays
            pose = placed
        self.field_name = name
        dashboards.show_field(name, field)
        dashboards.place_robot(field, pose)

    def _update(self) -> None:
        __tracebackhide__ = True
        run = self._run
        now_us, last_us = run.clock.now_us, self._last_us
        if self._updating:  # an update that waits in robot time is not interrupted by the next one
            return
        self._last_us = now_us
        if not run.started:
            return
        if self.engine is None:
            if run.initializes:
                return
            self._make_engine()
        if last_us >= now_us:  # a test has set the time back
            last_us = now_us - self._period_us
        now, tm_diff = now_us / 1_000_000, (now_us - last_us) / 1_000_000
        arguments = (run.hal_data, now, tm_diff) if self._module.takes_hal_data else (now, tm_diff)
        self._updating = True
        try:
            if station.is_enabled():
                self.engine.update_sim(*arguments)
            else:
                with run.output_gate.closed_while_disabled():
                    self.engine.update_sim(*arguments)
        finally:
            self._updating = False
        self.controller.update_rates(tm_diff)


def _engine_class(module: ModuleType) -> type[Any]:
    engine = getattr(module, "PhysicsEngine", None)
    if isinstance(engine, type) and engine is not PhysicsEngine:
        return engine
    classes = [
        value for value in vars(module).values() if isinstance(value, type) and value.__module__ == module.__name__
    ]
    similar = next((each for each in classes if hasattr(each, "update_sim")), None)
    raise PhysicsInitException(
        "there is no class PhysicsEngine in this file"
        + (f", but a class {similar.__name__}: rename it" if similar else ""),
        where=Path(str(module.__file__)).name if similar is None else _place(similar),
        remedy=_WHAT_IT_MUST_HAVE,
    )


def _accepts(function: Callable[..., object], *arguments: str) -> bool:
    try:
        inspect.signature(function).bind(*arguments)
    except TypeError:
        return False
    return True


def _wrong_signature(engine: type[object], name: str) -> PhysicsInitException:
    method = getattr(engine, name)
    if method is object.__init__:
        message = "PhysicsEngine has no constructor"
        similar = next((each for each in vars(engine) if each != name and each.strip("_") == "init"), None)
        return PhysicsInitException(
            message + (f", but a method {similar}: it needs two underscores on both sides" if similar else ""),
            where=_place(engine),
            remedy=_WHAT_IT_MUST_HAVE,
        )
    message = f"PhysicsEngine.{name}{inspect.signature(method)} cannot be called"
    if next(iter(inspect.signature(method).parameters), "") in ("hal_data", "now", "physics_controller"):
        message += ": self is missing"
    return PhysicsInitException(message, where=_place(method), remedy=_WHAT_IT_MUST_HAVE)


def _place(thing: Any) -> str:
    """Return the start of a class or function, such as ``physics.py:12``."""
    file, (_, line) = inspect.getsourcefile(thing) or "physics.py", inspect.getsourcelines(thing)
    return f"{Path(file).name}:{line}"


def _free_name() -> str:
    """Return the dashboard's name for the field: another one than "Field" if robot code shows a field of its own there.

    Two fields of one name share one pose: the robot's odometry would move the simulated robot.
    """
    shown = dashboards.shown("Field")
    return "Field" if shown is None or isinstance(shown, PhysicsField) else "Field (physics)"
