"""Makes the pictures in docs/images from the simulator's real window and page.

Run it with ``python docs/screenshots.py``, or ``python docs/page_screenshots.py`` for those of the page alone. It needs
Xvfb (Debian's package xvfb), Chromium and Pillow; the window's letters are those of the machine that it runs on.
"""

from __future__ import annotations

import gc
import shutil
import sys
import tempfile
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests"))

from page_screenshots import take_page_pictures  # noqa: E402
from PIL import Image, ImageGrab  # noqa: E402
from virtual_display import virtual_display  # noqa: E402

from pyfrc_core.project import Project  # noqa: E402
from pyfrc_core.sim import Simulation  # noqa: E402
from pyfrc_core.sim.ui.tk.window import Window  # noqa: E402

IMAGES = ROOT / "docs" / "images"

_LOOKS, _PAUSE = 6000, 0.01


class Photographer:
    """Works at one window, and takes pictures of it."""

    def __init__(self, project: Path, display: str) -> None:
        self.display = display
        self.simulation = Simulation(Project(project / "robot.py"))
        self.window = Window(self.simulation, display)
        self.window.root.geometry("+0+0")
        self.simulation.start()
        self.window.begin()
        self.until(lambda: self.simulation.status.state == "running" and bool(self.window.devices.items))

    def until(self, condition: Callable[[], bool]) -> None:
        """Let the window work until this is so."""
        for _ in range(_LOOKS):
            self.window.root.update()
            if condition():
                return
            self.simulation.wait_for(lambda: False, _PAUSE)
        raise SystemExit("this has not come true in time")

    def time(self) -> float:
        snapshot = self.simulation.snapshot
        return 0.0 if snapshot is None else snapshot.time

    def drive(self, left: float, right: float, seconds: float) -> None:
        """Drive the tank template for so long."""
        end = self.time() + seconds
        for stick, speed in ((0, left), (1, right)):
            self.simulation.set_axis(stick, 1, -speed)
        self.until(lambda: self.time() >= end)

    def picture(self, name: str) -> None:
        """Take a picture, when all has been drawn."""
        frames = self.window.frames
        self.until(lambda: self.window.frames > frames + 12)
        root = self.window.root
        left, top, width, height = root.winfo_rootx(), root.winfo_rooty(), root.winfo_width(), root.winfo_height()
        whole = ImageGrab.grab(xdisplay=self.display)
        window = whole.crop((left, top, left + width, top + height))
        # Few colours: a repository is no place for large files.
        picture = window.quantize(128, dither=Image.Dither.NONE).convert("RGB")
        picture.save(IMAGES / f"{name}.webp", lossless=True, quality=100, method=6)

    def close(self) -> None:
        self.window.close()
        self.simulation.close()


def take_pictures(project: Path, display: str) -> None:
    """Drive, and let the robot crash."""
    with ExitStack() as closing:
        photographer = Photographer(project, display)
        closing.callback(photographer.close)
        simulation = photographer.simulation
        simulation.set_alliance("blue2")
        simulation.enable()
        photographer.drive(0.8, 0.77, 2.0)
        photographer.drive(0.62, 0.68, 2.0)
        photographer.drive(0.8, 0.74, 1.2)
        simulation.pause()
        photographer.until(lambda: simulation.status.state == "paused")
        photographer.picture("window")
        simulation.resume()
        simulation.set_button(0, 4, True)
        photographer.until(lambda: simulation.status.state == "failed")
        photographer.picture("crash")


def make_project(directory: Path) -> Path:
    """The tank template, with a mistake for button 4, and what else a robot may have."""
    project = directory / "my-robot"
    shutil.copytree(ROOT / "templates" / "tank", project)
    robot = project / "robot.py"
    code = robot.read_text(encoding="utf-8")
    devices = (
        "        self.arm = wpilib.PWMSparkMax(4)\n"
        "        self.arm_at_top = wpilib.DigitalInput(4)\n"
        "        self.arm_angle = wpilib.AnalogInput(0)\n"
        "        self.claw = wpilib.DoubleSolenoid(wpilib.PneumaticsModuleType.CTREPCM, 0, 1)\n"
        "        self.claw.set(wpilib.DoubleSolenoid.Value.kForward)\n"
        "        self.gyro = wpilib.ADXRS450_Gyro()\n"
        "        self.chooser = wpilib.SendableChooser()\n"
        "        self.chooser.setDefaultOption('Drive forwards', 1)\n"
        "        wpilib.SmartDashboard.putData('Autonomous', self.chooser)\n"
    )
    code = code.replace("        self.timer = wpilib.Timer()\n", f"        self.timer = wpilib.Timer()\n{devices}", 1)
    head = "    def teleopPeriodic(self) -> None:\n"
    start = code.index(head) + len(head)
    end = code.index("\n", start) + 1  # its docstring
    mistake = (
        "        if self.left_stick.getRawButton(4):\n"
        "            self.arm.set(self.arm_speed)\n"
        "        self.arm.set(0.4)\n"
    )
    robot.write_text(code[:end] + mistake + code[end:], encoding="utf-8")
    return project


def main() -> None:
    IMAGES.mkdir(exist_ok=True)
    with virtual_display() as display:
        with tempfile.TemporaryDirectory() as directory:
            take_pictures(make_project(Path(directory)), display.name)
        gc.collect()  # what is Tk's can be tidied away in this thread only
    take_page_pictures()
    print(*sorted(file.name for file in IMAGES.iterdir()), sep="\n")


if __name__ == "__main__":
    main()
