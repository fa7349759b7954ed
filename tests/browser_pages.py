"""A real browser on the page of `pyfrc sim`, and a robot that has something of everything."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from typing import TYPE_CHECKING, Any

from sim_robots import FILES, PATIENCE
from skips import missing_programs
from web_pages import Served

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

_ARGUMENTS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
)

HOSTILE = "<script>document.title = 'broken'</script><b>bold</b>"

#: The name of a chooser: a slash would begin another part of its place in NetworkTables.
CHOOSER = "Auto <img src=x onerror=alert(1)>"

ROBOT = {
    "robot.py": f"""
        import ntcore
        import wpilib
        from wpimath.controller import PIDController
        from wpimath.geometry import Pose2d, Rotation2d
        from wpimath.kinematics import SwerveModuleState

        CHOOSER = {CHOOSER!r}
        HOSTILE = {HOSTILE!r}


        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.left = wpilib.PWMSparkMax(0)
                self.right = wpilib.PWMSparkMax(1)
                self.stick = wpilib.Joystick(0)
                self.switch = wpilib.DigitalInput(3)
                self.sensor = wpilib.AnalogInput(2)
                self.chooser = wpilib.SendableChooser()
                self.chooser.setDefaultOption("Nothing", 0.0)
                self.chooser.addOption("Forward", 1.0)
                self.chooser.addOption(HOSTILE, 2.0)
                wpilib.SmartDashboard.putData(CHOOSER, self.chooser)
                wpilib.SmartDashboard.putNumber("kP", 0.5)
                wpilib.SmartDashboard.putBoolean("flag", False)
                wpilib.SmartDashboard.putString("text", HOSTILE)
                self.mechanism = wpilib.Mechanism2d(3, 3)
                self.mechanism.getRoot("pivot", 1, 1).appendLigament("arm", 2, 45)
                wpilib.SmartDashboard.putData("Arm", self.mechanism)
                self.field = wpilib.Field2d()
                wpilib.SmartDashboard.putData("Plan", self.field)
                wpilib.SmartDashboard.putData("Turn", PIDController(2, 0, 0))
                path = [Pose2d(2 + n / 2, 4 + n / 8, Rotation2d(0.2)) for n in range(12)]
                self.field.getObject("path").setPoses(path)
                self.field.getObject("tags").setPoses([Pose2d(5 * (n % 2), n, Rotation2d()) for n in range(8)])
                self.field.getObject("goal").setPose(8, 5.5, Rotation2d(0.5))
                table = ntcore.NetworkTableInstance.getDefault()
                self.modules = table.getStructArrayTopic("/SmartDashboard/Modules", SwerveModuleState).publish()
                self.alert = wpilib.Alert("the battery is low", wpilib.Alert.AlertType.kWarning)
                self.alert.set(True)
                print(HOSTILE)
                print("Warning: this is a warning")

            def robotPeriodic(self):
                kp = wpilib.SmartDashboard.getNumber("kP", 0)
                wpilib.SmartDashboard.putNumber("doubled", 2 * kp)
                self.modules.set([SwerveModuleState(2 * kp, Rotation2d(0.7)) for _ in range(4)])

            def disabledPeriodic(self):
                pass

            def autonomousPeriodic(self):
                speed = self.chooser.getSelected()
                self.left.set(speed)
                self.right.set(-speed)

            def testPeriodic(self):
                pass

            def teleopPeriodic(self):
                forward, turn = -self.stick.getY(), self.stick.getX()
                self.left.set(forward + turn)
                self.right.set(-forward + turn)
                if self.stick.getRawButton(5):
                    self.left.set(1 / 0)
                if self.stick.getRawButton(8):
                    while True:
                        pass
                if self.stick.getRawButton(9):
                    for number in range(3000):
                        print("flood", number)

            def disabledInit(self):
                self.left.set(0)
                self.right.set(0)
    """,
    "physics.py": FILES["physics.py"],
    "sim/config.json": """
        {"pyfrc": {"robot": {"starting_x": 10, "starting_y": 12, "starting_angle": 0,
                             "start_positions": [{"name": "left", "x": 20, "y": 6, "angle": 90},
                                                 {"name": "right", "x": 20, "y": 20}]},
                   "pwm": {"0": "left motor"}, "analog": {"2": "range finder"}}}
    """,
}


#: The names of the browser's program. The first one has no windows at all: a page takes half of the processor time.
_PROGRAMS = ("chromium-headless-shell", "chromium", "google-chrome")


def missing_browser() -> list[str]:
    """Return what is missing for a real browser."""
    return ["chromium"] if len(missing_programs(*_PROGRAMS)) == len(_PROGRAMS) else []


#: For scripts in the page: what one of its modules exports.
MODULE = "window.module = (name) => import(`#${name}`);"


#: Twenty frames in a second, as on a slow computer: drawing takes most of what a page costs.
FRAMES = "window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 50);"


#: Add scripts that are not the page's own, and return which of the page's rules refuse them, and what has run.
INJECTED = """async () => {
  const code = "window.hasRun = (window.hasRun ?? 0) + 1";
  const data = `data:text/javascript,${encodeURIComponent(code)}`;
  const scripts = [
    { textContent: code },
    { src: data },
    { type: "module", textContent: code },
    { type: "module", src: data },
    { src: URL.createObjectURL(new Blob([code], { type: "text/javascript" })) },
  ];
  const refused = [];
  for (const script of scripts) {
    await new Promise((resolve) => {
      document.addEventListener("securitypolicyviolation", (event) => {
        refused.push(event.effectiveDirective);
        resolve();
      }, { once: true });
      document.head.append(Object.assign(document.createElement("script"), script));
    });
  }
  return [refused, window.hasRun ?? 0];
}"""
REFUSED = [["script-src-elem"] * 5, 0]


@contextmanager
def open_browser() -> Iterator[Browser]:
    """Start Chromium without a window."""
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=PATIENCE * 1000)  # otherwise five seconds, for all that was set for a page
    program = next(filter(None, map(shutil.which, _PROGRAMS)))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=_ARGUMENTS)
        yield browser
        browser.close()


class Seen:
    """A person at the page.

    :param wrong: errors of the page's code, and what its content security policy has refused
    """

    def __init__(self, page: Page, server: Served) -> None:
        self.page, self.server, self.simulation = page, server, server.simulation
        self.wrong: list[str] = []
        page.set_default_timeout(PATIENCE * 1000)
        page.on("pageerror", lambda error: self.wrong.append(str(error)))
        page.on("console", lambda message: message.type == "error" and self.wrong.append(message.text))

    def open(self, address: str = "") -> Seen:
        """Open the page, and wait until it shows a robot."""
        self.page.goto(address or self.server.address)
        self.page.locator(".state.disabled, .state.enabled").wait_for()
        return self

    def until(self, condition: Callable[[], Any]) -> None:
        """Wait until this is so in the simulation."""
        assert self.simulation.wait_for(condition, PATIENCE), (self.simulation.status, self.simulation.snapshot)

    def value(self, path: str) -> Any:
        """Return a value in the simulation."""
        assert self.simulation.snapshot is not None
        return self.simulation.snapshot.values.get(path)

    def written(self, name: str) -> list[Any]:
        """Return what the robot has been sent for a value of SmartDashboard."""
        path = f"nt:/SmartDashboard/{name}"
        return [step.writes[path] for step in self.simulation.script().steps if path in step.writes]

    def button(self, name: str) -> Locator:
        return self.page.get_by_role("button", name=name, exact=True)

    def tab(self, name: str) -> Locator:
        return self.page.get_by_role("tab", name=name, exact=True)

    def row(self, path: str) -> Locator:
        """The row of a value, among the devices or in NetworkTables."""
        return self.page.locator(f"[data-path={path!r}]").first

    def choose(self, menu: str, item: str) -> None:
        """Choose from one of the page's menus, which is named by its tooltip."""
        self.page.get_by_title(menu, exact=True).click()
        self.page.locator(".menu-list button", has_text=item).first.click()

    def set_number(self, box: Locator, text: str) -> None:
        """Type into a box, and press Enter."""
        box.click()
        box.fill(text)
        box.press("Enter")

    def shows(self, box: Locator, text: str) -> None:
        """Wait until a box or a slider has this value."""
        from playwright.sync_api import expect

        expect(box).to_have_value(text)

    def drawn(self) -> None:
        """Wait until the page has drawn what was changed."""
        self.page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def eventually(self, script: str, argument: Any = None, accept: Callable[[Any], object] = bool) -> Any:
        """Run a script in the page until its result is accepted, and return it.

        `Page.wait_for_function` does not wait for the result of a promise, and takes the promise for true.
        """
        ends = monotonic() + PATIENCE
        while not accept(found := self.page.evaluate(script, argument)):
            assert monotonic() < ends, found
            self.drawn()
        return found

    def state(self, text: str) -> None:
        """Wait until the driver station shows this."""
        self.page.locator(".state b", has_text=text).wait_for()

    def pause(self) -> None:
        """Press the key that pauses, and wait until the simulation does, and the page shows that moment."""
        self.page.keyboard.press("F5")
        self.until(lambda: self.simulation.status.state == "paused")
        self.button("Run").first.wait_for()

    def drag(self, place: Locator, start: tuple[float, float], end: tuple[float, float], **options: Any) -> None:
        """Drag from a place in an element to another one, each as a share of its width and height."""
        box = place.bounding_box()
        assert box is not None
        points = [(box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in (start, end)]
        self.page.mouse.move(*points[0])
        self.page.mouse.down(**options)
        self.page.mouse.move(*points[1], steps=4)
        self.page.mouse.up(**options)


@contextmanager
def opened_page(browser: Browser, address: str, width: int = 1180, height: int = 820) -> Iterator[Page]:
    """Open a page that shows a log, and close it; no error may come up in it."""
    page = browser.new_page(viewport={"width": width, "height": height})
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.set_default_timeout(PATIENCE * 1000)
    page.add_init_script(MODULE)
    page.goto(address)
    yield page
    page.close()
    assert wrong == []


@contextmanager
def page_of(browser: Browser, server: Served, address: str = "", **options: Any) -> Iterator[Seen]:
    """Open the page as a new person, for whom nothing was arranged, on a robot that has just started."""
    (server.simulation.project.root / ".pyfrc" / "sim-layout.json").unlink(missing_ok=True)
    starts = server.simulation.status.starts
    server.simulation.choose_mode("teleop")  # a restart keeps what was chosen
    server.simulation.choose(f"/SmartDashboard/{CHOOSER}", "Nothing")
    server.simulation.restart()
    server.simulation.resume()
    server.simulation.set_speed(1)

    def runs() -> bool:
        status = server.simulation.status
        return status.starts > starts and status.state == "running" and server.simulation.snapshot is not None

    assert server.simulation.wait_for(runs, PATIENCE)
    context = browser.new_context(viewport={"width": 1366, "height": 768}, **options)
    try:
        seen = Seen(context.new_page(), server)
        seen.page.add_init_script(MODULE + FRAMES)
        yield seen.open(address)
        assert not seen.wrong, seen.wrong
    finally:
        context.close()
