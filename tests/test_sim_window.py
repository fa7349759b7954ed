"""The simulator's window on a virtual display, used as its user does: with real keys and a real mouse.

By day, a user drives, and the field is looked at. What the window shows and binds is in `test_sim_window_models`.
"""

from __future__ import annotations

import gc
import math
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from textwrap import dedent
from typing import TYPE_CHECKING, Any

import pytest
from conftest import MakeProject
from skips import missing_tkinter
from virtual_display import VirtualDisplay, require_window, virtual_display

if missing_tkinter():  # some imports below need it
    require_window()

from pyfrc_core.project import Project
from pyfrc_core.sim import SimOptions, Simulation
from pyfrc_core.sim.ui.choose import FRONT_ENDS
from pyfrc_core.sim.ui.tk import theme
from pyfrc_core.sim.ui.tk.window import Window

if TYPE_CHECKING:
    import tkinter as tk
    from tkinter import ttk

    from pyfrc_core.sim import Snapshot, Status
    from pyfrc_core.sim.ui.models.devices import Row

TEMPLATE = Path(__file__).parent.parent / "templates" / "tank"

#: So often a test looks whether something has come true, waiting a little for the robot in between, before it gives up.
_LOOKS, _PAUSE = 12_000, 0.01

ROBOT = {
    "robot.py": """
        import threading
        from pathlib import Path

        import wpilib
        from pyfrc.sim import get_user_renderer


        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.driven = 0
                self.motor = wpilib.PWMSparkMax(2)
                self.switch = wpilib.DigitalInput(3)
                self.ready = wpilib.DigitalOutput(4)
                self.pot = wpilib.AnalogInput(0)
                self.encoder = wpilib.Encoder(0, 1)
                self.claw = wpilib.DoubleSolenoid(wpilib.PneumaticsModuleType.CTREPCM, 0, 1)
                self.spike = wpilib.Relay(0)
                self.stick = wpilib.Joystick(0)
                self.chooser = wpilib.SendableChooser()
                self.chooser.setDefaultOption("Nothing", 0)
                self.chooser.addOption("Everything", 1)
                wpilib.SmartDashboard.putData("Auto", self.chooser)
                self.renderer = get_user_renderer()
                print("the robot is there")

            def robotPeriodic(self):
                self.ready.set(self.switch.get())

            def teleopInit(self):
                self.gyro = wpilib.AnalogGyro(1)
                self.claw.set(wpilib.DoubleSolenoid.Value.kReverse)
                self.spike.set(wpilib.Relay.Value.kForward)
                if self.renderer is not None:
                    self.renderer.draw_line([(1, 1), (5, 5)], color="#123456")
                    self.renderer.draw_text("here", (5, 5), fontSize=9)
                    self.renderer.draw_line([(1, 1), (5, 5)], no_such_option=1)

            def teleopPeriodic(self):
                self.motor.set(-self.stick.getY())
                if self.stick.getY() < 0:
                    self.driven += 1
                    if self.driven == 50:  # until then, the window has known for long that it drives
                        Path(__file__).with_name("driven").touch()
                if self.stick.getRawButton(1):
                    raise RuntimeError("the arm has come off")
                if self.stick.getRawButton(2):
                    print("an endless loop begins", flush=True)
                    while True:
                        pass
                if self.stick.getRawButton(3):
                    threading.Thread(target=threading.Event().wait).start()
                    print("a thread that never ends", flush=True)
    """,
    "sim/config.json": """
        {"pyfrc": {"pwm": {"2": "Arm"}, "dio": {"3": "Limit"}, "game_specific_messages": ["LRL"],
                   "robot": {"starting_x": 10, "starting_y": 12,
                             "start_positions": [{"name": "left", "x": 2, "y": 3}, {"name": "right", "x": 2, "y": 20}]},
                   "field": {"objects": [{"color": "#00ff00", "rect": [20, 5, 2, 2]}]}}}
    """,
    "physics.py": """
        class PhysicsEngine:
            def __init__(self, physics_controller):
                self.physics_controller = physics_controller

            def update_sim(self, hal_data, now, tm_diff):
                self.physics_controller.drive(hal_data["pwm"][2]["value"] * 5, 0, tm_diff)
                hal_data.setdefault("custom", {})["Arm"] = "up" if hal_data["dio"][3]["value"] else "down"
    """,
    "pyproject.toml": """
        [tool.pyfrc.test]
        hang_seconds = 0.5
    """,
}


# Tk keeps a display that it has seen, and ends the process when that goes: it stays as long as the process.
@pytest.fixture(scope="session")
def display() -> Iterator[VirtualDisplay]:
    with virtual_display() as display:
        yield display


class User:
    """Somebody at the window.

    :ivar status: the one that was there at the last look, with which a condition was met
    """

    def __init__(self, simulation: Simulation, window: Window, display: VirtualDisplay) -> None:
        self.simulation, self.window, self.display = simulation, window, display
        self._look()

    def _look(self) -> None:
        self.status: Status = self.simulation.status
        self._snapshot = self.simulation.snapshot

    @property
    def snapshot(self) -> Snapshot:
        """The snapshot that was there at the last look: a newer one may not meet the condition any more."""
        assert self._snapshot is not None
        return self._snapshot

    def until(self, condition: Callable[[], Any]) -> None:
        """Let the window work until this is so."""
        if not self.sees(condition, _LOOKS):
            raise AssertionError(f"this has not come true: {self.simulation.status} {self.simulation.snapshot}")

    def sees(self, condition: Callable[[], Any], looks: int) -> bool:
        """Whether this is so after so many looks, or earlier."""
        for _ in range(looks):
            self.window.root.update()
            if self.window.failure is not None:
                raise self.window.failure
            self._look()
            if condition():
                return True
            self.simulation.wait_for(lambda: False, _PAUSE)
        return False

    def shown(self) -> None:
        """Let the window draw what there is now."""
        frames = self.window.frames
        self.until(lambda: self.window.frames > frames + 1)

    def keys(self, *words: str) -> None:
        self.display.do(*words)

    def press(self, key: str) -> None:
        self.display.do("key", key)

    def click(self, widget: tk.Misc, x: int | None = None, y: int | None = None, button: int = 1) -> None:
        """Click on a widget, in its middle or at one of its pixels."""
        self.display.do(*self._to(widget, x, y), "click", button)

    def drag(self, widget: tk.Misc, start: tuple[int, int], end: tuple[int, int], button: int = 1) -> None:
        self.display.do(*self._to(widget, *start), "mousedown", button, *self._to(widget, *end), "mouseup", button)

    def row(self, label: str) -> Row:
        """The device row with this label."""
        return next(item.row for item in self.window.devices.items if item.row.label.strip() == label)

    def click_row(self, label: str) -> None:
        self.click(self.window.devices.canvas, *self.window.devices.center_of(self.row(label)))

    def choose(self, box: ttk.Combobox, index: int) -> None:
        """Choose from a box's list; as a person would, click again where a click has come to nothing."""
        tcl = box.tk
        listbox = str(tcl.call("ttk::combobox::PopdownWindow", str(box))) + ".f.l"

        def is_open() -> int:
            return int(tcl.call("winfo", "ismapped", listbox))

        def choose() -> bool:
            if not is_open():
                self.click(box)
                return self.sees(is_open, 100) and choose()
            self.shown()  # where it is to stay
            x, y, width, height = (int(each) for each in tcl.splitlist(tcl.call(listbox, "bbox", index)))
            left, top = (int(tcl.call("winfo", f"root{axis}", listbox)) for axis in "xy")
            self.display.do("mousemove", left + x + width // 2, top + y + height // 2, "click", 1)
            return self.sees(lambda: not is_open(), 100) and box.current() == index

        assert any(choose() for _ in range(10)), box.get()

    @staticmethod
    def _to(widget: tk.Misc, x: int | None, y: int | None) -> tuple[str | int, ...]:
        widget.update_idletasks()
        x = widget.winfo_width() // 2 if x is None else x
        y = widget.winfo_height() // 2 if y is None else y
        return "mousemove", widget.winfo_rootx() + x, widget.winfo_rooty() + y


#: What belongs to Tk can be tidied away in no thread but this one; and a failed test keeps it for a while.
_KEPT: list[object] = []

Sit = Callable[..., User]


@pytest.fixture
def sit(display: VirtualDisplay) -> Iterator[Sit]:
    """Opens a window on a simulation, and somebody sits down at it."""
    opened: list[User] = []

    def sit(project: Path, options: SimOptions | None = None) -> User:
        simulation = Simulation(Project(project / "robot.py"), options)
        user = User(simulation, Window(simulation, display.name), display)
        opened.append(user)
        simulation.start()
        user.window.begin()
        user.window.root.wait_visibility()
        user.window.field.canvas.focus_force()
        user.until(lambda: user.status.state in ("running", "paused") and simulation.snapshot is not None)
        user.until(lambda: user.window.devices.items)
        return user

    yield sit
    for user in opened:
        user.window.close()
        user.simulation.close()
        _KEPT.append(user.window.root.tk)
        del user.window
    gc.collect()


@pytest.fixture
def user(sit: Sit, make_project: MakeProject) -> User:
    """Somebody at the test robot's window."""
    return sit(make_project(ROBOT).path)


@pytest.fixture
def tank(tmp_path: Path) -> Path:
    """The project that `pyfrc init` makes."""
    shutil.copytree(TEMPLATE, tmp_path / "tank")
    return tmp_path / "tank"


def test_driving_by_keys_in_all_kinds_of_time(sit: Sit, tank: Path) -> None:
    """The tank template: driven forwards, paused, stepped, slowed down, reset."""
    user = sit(tank)
    window = user.window
    start = user.snapshot.scene.robot
    assert start is not None
    assert not user.snapshot.enabled
    user.keys("keydown", "bracketleft", "keydown", "bracketright", "key", "backslash")
    user.keys("keyup", "bracketleft", "keyup", "bracketright")
    user.until(lambda: user.snapshot.mode == "teleop")
    user.keys("keydown", "w")
    user.until(lambda: user.snapshot.scene.robot.x > start.x + 2)
    robot = user.snapshot.scene.robot  # on a busy machine, much farther
    assert abs(robot.y - start.y) < (robot.x - start.x) / 10
    user.press("F5")
    user.until(lambda: user.status.state == "paused")
    user.keys("keyup", "w")
    user.until(lambda: user.snapshot.values["joysticks[0].axes"][1] == 0)

    # What is seen is where the robot is.
    user.shown()
    x0, y0, x1, y1 = window.field.canvas.bbox("bumpers")
    robot = user.snapshot.scene.robot
    assert ((x0 + x1) / 2, (y0 + y1) / 2) == pytest.approx(window.field.view.to_screen(robot.x, robot.y), abs=2)
    assert window.field.canvas.find_withtag("trail")

    before = user.snapshot.time
    user.press("F6")
    user.until(lambda: user.snapshot.time != before)
    user.until(lambda: user.status.state == "paused")
    assert round(user.snapshot.time - before, 9) == 0.02
    user.click(window.time.step)
    user.until(lambda: user.snapshot.time > before + 0.03)
    user.until(lambda: user.status.state == "paused")
    assert round(user.snapshot.time - before, 9) == 0.04

    user.choose(window.time.speed, 0)
    user.until(lambda: user.status.speed == 0.1)
    user.choose(window.time.speed, 7)
    user.until(lambda: user.status.speed == 0)
    user.press("F5")
    user.until(lambda: user.snapshot.time > before)

    user.press("Return")
    user.until(lambda: user.snapshot.mode == "disabled")
    seen: list[Snapshot] = []

    def stands() -> bool:
        seen.append(user.snapshot)
        return any(
            then.time < user.snapshot.time - 1 and then.scene.robot == user.snapshot.scene.robot for then in seen
        )

    user.until(stands)
    user.click(window.match.reset)
    user.until(lambda: user.snapshot.scene.robot[:2] == pytest.approx(start[:2], abs=1e-6))


@pytest.mark.slow
def test_modes_emergency_stop_and_restart(user: User) -> None:
    station = user.window.station
    user.click(station.mode_buttons["autonomous"])
    user.until(lambda: user.snapshot.mode == "disabled autonomous")
    user.shown()
    assert (station.mode.get(), station.state.cget("text")) == ("autonomous", "Autonomous disabled")
    user.click(station.enable)
    user.until(lambda: user.snapshot.mode == "autonomous")
    user.shown()
    assert station.enable.instate(["disabled"])
    user.press("space")
    user.until(lambda: user.snapshot.emergency_stopped)
    user.press("ctrl+e")
    user.until(lambda: "restart" in user.status.note)
    assert not user.snapshot.enabled
    user.press("F9")
    user.until(lambda: user.status.state == "running" and not user.snapshot.emergency_stopped)
    user.until(lambda: station.practice.instate(["!disabled"]))
    user.click(station.practice)
    user.until(lambda: user.snapshot.mode == "autonomous" and user.snapshot.practice_since is not None)


@pytest.mark.slow
def test_devices_are_shown_and_set(user: User) -> None:
    devices = user.window.devices
    assert [panel.title for panel in devices.rows.panels][:2] == ["PWM", "Digital I/O"]
    assert user.row("2  Arm").kind == "meter"

    def lamp() -> str:
        item = next(each for each in devices.items if each.row.paths == ("dio[4].value",))
        return str(devices.canvas.itemcget(item._lamp, "fill"))

    user.click_row("3  Limit")
    user.until(lambda: user.snapshot.values["dio[4].value"] is False)
    user.until(lambda: lamp() == theme.LAMP_OFF)
    user.until(lambda: user.snapshot.values["custom.Arm"] == "down")
    user.click_row("Encoder 0")
    user.until(lambda: user.window.root.focus_get().winfo_class() == "Entry")
    user.keys("type", "123")  # what is typed there neither drives nor presses buttons
    user.press("Return")
    user.until(lambda: user.snapshot.values["encoder[0].count"] == 123)
    assert not any(user.snapshot.values["joysticks[0].buttons"])

    # What is no number is refused with a reason, and Tab sets what was edited.
    for text, key in (("1,000", "Return"), ("45", "Tab")):
        user.click_row("Encoder 0")
        user.until(lambda: user.window.root.focus_get().winfo_class() == "Entry")
        user.keys("type", text)
        user.press(key)
        refused = key == "Return"
        user.until(lambda refused=refused: ("write thousands without a comma" in user.window._noted) is refused)
        assert devices._editor is None
    user.until(lambda: user.snapshot.values["encoder[0].count"] == 45)
    voltage = next(item for item in devices.items if item.row.paths == ("analog_in[0].voltage",))
    y = devices.center_of(voltage.row)[1]
    user.drag(devices.canvas, (voltage.place.left + 20, y), (voltage.place.left + 40, y))
    user.until(lambda: user.snapshot.values["analog_in[0].voltage"] == voltage.value_at(voltage.place.left + 40))

    # What the robot makes later is shown from then on.
    titles = [panel.title for panel in devices.rows.panels]
    user.press("ctrl+e")
    user.until(lambda: [panel.title for panel in devices.rows.panels] != titles)
    assert user.row("Analog 1").paths == ("analog_gyro[1].angle",)
    user.until(lambda: user.snapshot.values["relay[0].fwd"] is True)
    user.click_row("3  Limit")
    user.until(lambda: lamp() == theme.LAMP_ON)

    # A word of help, when the mouse rests on a row.
    user.keys(*map(str, user._to(devices.canvas, *devices.center_of(user.row("3  Limit")))))
    user.until(lambda: "DIO 3" in user.window.devices._tooltip.text)


def test_the_field_and_what_robot_code_draws(user: User) -> None:
    field = user.window.field
    canvas, start = field.canvas, user.snapshot.scene.robot
    center = user.window.center
    assert center._sash() == pytest.approx(0.72 * center.frame.winfo_height(), abs=2)
    assert start is not None
    user.press("ctrl+e")
    user.until(lambda: canvas.find_withtag("drawing"))
    user.shown()
    line, text = canvas.find_withtag("drawing")
    assert (canvas.type(line), canvas.itemcget(line, "fill"), canvas.itemcget(line, "arrow")) == (
        "line", "#123456", "last"
    )  # fmt: skip
    assert canvas.coords(line) == pytest.approx(field.view.line([(1, 1), (5, 5)]), abs=0.5)
    assert canvas.itemcget(text, "text") == "here"
    assert "no_such_option" in field.problem  # and is said where notes are
    shapes = [item for item in canvas.find_withtag("field") if canvas.type(item) == "polygon"]
    assert [canvas.itemcget(shape, "fill") for shape in shapes] == ["#00ff00"]

    whole = field.view.scale
    x, y = (round(each) for each in field.view.to_screen(20, 20))
    user.click(canvas, x, y, button=4)  # the wheel
    user.until(lambda: field.view.scale > whole)
    user.shown()
    assert field.view.to_field(x, y) == pytest.approx((20, 20), abs=0.1)
    assert canvas.coords(line) == pytest.approx(field.view.line([(1, 1), (5, 5)]), abs=0.5)
    user.drag(canvas, (x, y), (x + 40, y + 10))
    user.until(lambda: field.view.to_field(x + 40, y + 10) == pytest.approx((20, 20), abs=0.1))
    user.drag(canvas, *(tuple(round(each) for each in field.view.to_screen(*place)) for place in ((10, 12), (13, 15))))
    user.until(lambda: user.snapshot.scene.robot[:2] == pytest.approx((13, 15), abs=0.2))
    user.shown()
    robot = user.snapshot.scene.robot
    user.drag(
        canvas,
        *(tuple(round(each) for each in field.view.to_screen(*place)) for place in (robot[:2], (robot.x, robot.y + 5))),
        button=3,
    )
    user.until(lambda: user.snapshot.scene.robot.angle == pytest.approx(math.pi / 2, abs=0.1))
    user.click(user.window.match.reset)
    user.until(lambda: user.snapshot.scene.robot == pytest.approx(start, abs=1e-6))


@pytest.mark.slow
def test_a_robot_that_crashes_is_restarted(user: User) -> None:
    console = user.window.console
    user.until(lambda: "the robot is there" in console.text.get("1.0", "end"))
    user.press("ctrl+e")
    user.until(lambda: user.snapshot.mode == "teleop")
    user.keys("keydown", "1")
    user.until(lambda: user.status.state == "failed")
    user.keys("keyup", "1")
    user.until(console.restart.winfo_ismapped)
    assert "RuntimeError: the arm has come off" in console.headline.cget("text")
    assert console.headline.cget("text").startswith("robot.py:")
    text = console.text.get("1.0", "end")
    assert "in teleopPeriodic" in text
    assert "pyfrc_core" not in text  # only the user's own lines
    user.shown()
    user.click(console.restart)
    user.until(lambda: user.status.state == "running" and not console.restart.winfo_ismapped())
    assert user.snapshot.mode == "disabled"


@pytest.mark.slow
@pytest.mark.parametrize("what", ["an endless loop", "a thread that never ends"])
def test_closing_whatever_the_robot_does(what: str, sit: Sit, make_project: MakeProject) -> None:
    user = sit(make_project(ROBOT).path)
    user.press("ctrl+e")
    user.until(lambda: user.snapshot.mode == "teleop")
    key = "2" if what == "an endless loop" else "3"
    user.keys("keydown", key)
    user.until(lambda: what in user.window.console.text.get("1.0", "end"))
    user.keys("keyup", key)
    if what == "an endless loop":
        user.until(lambda: user.status.state == "failed" or not user.status.responding)
    root = user.window.root
    # What a window manager tells the window when its cross is clicked.
    root.after(1, lambda: root.tk.eval(root.tk.call("wm", "protocol", ".", "WM_DELETE_WINDOW")))
    user.window.loop()
    user.simulation.close()
    assert user.simulation.status.state == "closed"


@pytest.mark.slow
def test_the_command(make_project: MakeProject, display: VirtualDisplay) -> None:
    """`pyfrc sim --ui tk` opens the window, and ends when it is closed; what was done in it can be replayed."""
    project = make_project(ROBOT)
    words = ("sim", "--ui", "tk", "--nt-port", "0", "--record", "run.jsonl")
    with project.start(*words, env=display.variable) as running:
        window = display.do("search", "--sync", "--onlyvisible", "--name", f"{project.path.name} - pyfrc")
        display.do("windowfocus", window)
        display.do("key", "ctrl+e", "keydown", "w")
        for _ in range(_LOOKS):
            if (project.path / "driven").exists():
                break
            with suppress(subprocess.TimeoutExpired):
                running.wait(_PAUSE)
        display.do("keyup", "w", "key", "ctrl+q")
        output, _ = running.rest(120)
    assert running.wait() == 0, output
    assert '"mode": "teleop"' in (project.path / "run.jsonl").read_text(encoding="utf-8")
    replayed = project.run("replay", "run.jsonl")
    assert replayed.code == 0, replayed.output


# -- what cannot be shown ---------------------------------------------------------------------------------------------


def test_the_command_offers_each_front_end() -> None:
    from pyfrc_cli.sim import command

    (option,) = (each for each in command.params if each.name == "ui")
    assert list(option.type.choices) == list(FRONT_ENDS)


def test_no_tkinter(make_project: MakeProject, display: VirtualDisplay) -> None:
    project = make_project(ROBOT)
    program = dedent("""
        import sys
        sys.modules["tkinter"] = None
        from pyfrc_cli.start import main
        main()
    """)
    done = subprocess.run(
        [sys.executable, "-c", program, "sim", "--ui", "tk"],
        cwd=project.path, env=os.environ | display.variable, capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    assert done.returncode == 2
    assert "tkinter" in done.stderr
    assert "Traceback" not in done.stderr
