"""`pyfrc migrate`: what it writes, reports and refuses."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
from conftest import MakeProject, RobotProject
from skips import missing_programs, require

pytest.importorskip("libcst")

from pyfrc_core.migrate.migration import migrate
from pyfrc_core.migrate.report import Place

ROBOT = """
    # The robot of team 1234.
    import wpilib
    from wpilib import SmartDashboard
    from subsystems.drive import Drive


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.drive = Drive()
            self.stick = wpilib.XboxController(0)
            self.relay = wpilib.Relay(1)

        def teleopPeriodic(self):
            self.drive.goFast(-self.stick.getLeftY())  # as the driver wants
            SmartDashboard.putNumber("speed", self.drive.getSpeed())
            if self.stick.getRawButton(1):
                self.drive.stop()

        def testPeriodic(self):
            self.teleopPeriodic()
"""

DRIVE = """
    import wpilib
    import wpilib.drive


    class Drive:
        def __init__(self):
            self.encoder = wpilib.Encoder(0, 1)
            self.left, self.right = wpilib.PWMSparkMax(0), wpilib.PWMSparkMax(1)
            self.drive = wpilib.drive.DifferentialDrive(self.left, self.right)

        def goFast(self, forward):
            self.drive.arcadeDrive(xSpeed=forward, zRotation=0)

        def getSpeed(self):
            return {"speed": self.encoder.getRate()}.get("speed")

        def stop(self):
            self.left.set(0)
"""

NEW_ROBOT = """\
# The robot of team 1234.
import wpilib
import telemetry
from subsystems.drive import Drive


class MyRobot(wpilib.TimedRobot):
    def __init__(self):
        super().__init__()
        self.drive = Drive()
        self.stick = wpilib.XboxController(0)
        self.relay = wpilib.Relay(1)

    def teleop_periodic(self):
        self.drive.goFast(-self.stick.get_left_y())  # as the driver wants
        telemetry.log("speed", self.drive.getSpeed())
        if self.stick.get_hid().get_raw_button(0):
            self.drive.stop()

    def utility_periodic(self):
        self.teleop_periodic()
"""

NEW_DRIVE = """\
import wpilib
import wpilib_drivers


class Drive:
    def __init__(self):
        self.encoder = wpilib.Encoder(0, 1)
        self.left, self.right = wpilib_drivers.PWMSparkMax(0), wpilib_drivers.PWMSparkMax(1)
        self.drive = wpilib.DifferentialDrive(self.left, self.right)

    def goFast(self, forward):
        self.drive.arcade_drive(x_velocity=forward, z_rotation=0)

    def getSpeed(self):
        return {"speed": self.encoder.get_rate()}.get("speed")

    def stop(self):
        self.left.set_throttle(0)
"""


@pytest.fixture
def project(make_project: MakeProject) -> RobotProject:
    return make_project({"robot.py": ROBOT, "subsystems/drive.py": DRIVE})


def text(project: RobotProject, name: str) -> str:
    return (project.path / name).read_text("utf-8")


def test_a_project_is_rewritten_and_what_is_left_is_said_at_its_line(project: RobotProject) -> None:
    line = project.place("robot.py", "Relay(1)")
    result = project.run("migrate")
    assert result.code == 1, result.output
    assert text(project, "robot.py") == NEW_ROBOT
    assert text(project, "subsystems/drive.py") == NEW_DRIVE
    assert text(project, "pyproject.toml").startswith('[tool.robotpy]\nrobotpy_version = "2027.')
    assert f"{line}: wpilib.Relay is gone. SystemCore has no relay ports" in result.stdout
    assert "To do by hand (1;" in result.stdout


def test_a_second_run_changes_nothing(project: RobotProject) -> None:
    project.run_here("migrate")
    before = {file: file.read_bytes() for file in project.path.rglob("*") if file.is_file()}
    result = project.run_here("migrate")
    assert "Rewrote 0 files" in result.stdout, result.output
    assert {file: file.read_bytes() for file in project.path.rglob("*") if file.is_file()} == before


def test_nothing_is_written_on_wish(project: RobotProject) -> None:
    (project.path / "robot.py").write_text(text(project, "robot.py"), "utf-8", newline="\r\n")
    before = text(project, "robot.py")
    result = project.run_here("migrate", "--check")
    assert result.code == 1, result.output
    assert text(project, "robot.py") == before
    assert not (project.path / "pyproject.toml").exists()
    assert "Would rewrite 3 files (Python files: 2)" in result.stdout


def test_tools_get_the_report_as_json(project: RobotProject) -> None:
    report = json.loads(project.run_here("migrate", "--check", "--json").stdout)
    assert report["files"] == ["pyproject.toml", "robot.py", "subsystems/drive.py"]
    (remark,) = report["by_hand"]
    assert remark["places"] == [{"file": "robot.py", "line": project.line("robot.py", "Relay(1)")}]
    assert report["lines"]["by_hand"] == 1
    assert remark["what"] == "wpilib.Relay is gone."


def test_changes_that_are_in_no_commit_are_refused(project: RobotProject) -> None:
    require("changes that are in no commit", missing_programs("git"))
    for command in (["init", "-q"], ["add", "."]):
        subprocess.run(["git", *command], cwd=project.path, check=True)
    result = project.run_here("migrate")
    assert result.code == 2
    assert "changed, and in no commit" in result.stderr
    assert "--uncommitted" in result.stderr
    assert "robotInit" in text(project, "robot.py")
    assert project.run_here("migrate", "--uncommitted").code == 1
    assert text(project, "robot.py") == NEW_ROBOT
    assert project.run_here("migrate").code == 2, "a second run, without a commit in between"


def test_a_file_that_is_no_python_stays_and_is_named(project: RobotProject) -> None:
    project.write({"broken.py": "def broken(:\n    pass\n"})
    result = project.run_here("migrate")
    assert "broken.py:2: This is no valid Python" in result.stdout
    assert text(project, "broken.py") == "def broken(:\n    pass\n"
    assert text(project, "robot.py") == NEW_ROBOT


def test_line_ends_tabs_and_encoding_stay(make_project: MakeProject) -> None:
    project = make_project({})
    lines = ["import wpilib", "class MyRobot(wpilib.TimedRobot):", "\tdef teleopPeriodic(self):", "\t\tpass  # é", ""]
    (project.path / "robot.py").write_bytes("\r\n".join(lines).encode())
    project.run_here("migrate")
    assert (project.path / "robot.py").read_bytes() == "\r\n".join(lines).replace("P", "_p", 1).encode()


@pytest.mark.slow
def test_links_out_of_the_project_are_named(project: RobotProject) -> None:
    """Their code is not read, so it cannot be said that nothing is left to do."""
    beside = project.temporary / "lib"
    beside.mkdir()
    (beside / "arm.py").write_text("import wpilib.drive\n")
    (project.temporary / "pictures").mkdir()
    for name, target in (
        ("lib", beside),
        ("pictures", project.temporary / "pictures"),
        ("again", project.path / "subsystems"),
        ("subsystems/arm.py", beside / "arm.py"),
        (".hidden", beside),
    ):
        (project.path / name).symlink_to(target)
    project.write({"robot.py": ROBOT.replace("wpilib.Relay(1)", "1")})
    report = migrate(project.path).report
    assert [each.places for each in report.by_hand()] == [(Place("lib", 0),), (Place("subsystems/arm.py", 0),)]
    assert str(report.by_hand()[0]) == (
        f"lib: This is a link to {beside.as_posix()}, which is not followed, so the code there stays as it is. "
        "Replace the link by what it leads to, and migrate."
    )
    for _ in range(2):
        result = project.run_here("migrate")
        assert result.code == 1
        assert "Nothing is left to do" not in result.stdout
    assert (beside / "arm.py").read_text() == "import wpilib.drive\n"


@pytest.mark.slow
def test_other_environments_and_hidden_directories_are_left_alone(project: RobotProject) -> None:
    old = "import wpilib.drive\n"
    project.write(
        {"venv/pyvenv.cfg": "", "venv/lib/a.py": old, "mine/pyvenv.cfg": "", "mine/lib/b.py": old, ".hidden/c.py": old}
    )
    project.run_here("migrate")
    for name in ("venv/lib/a.py", "mine/lib/b.py", ".hidden/c.py"):
        assert text(project, name) == old


@pytest.mark.slow
def test_code_in_a_directory_of_its_own(make_project: MakeProject) -> None:
    project = make_project(
        {
            "pyproject.toml": '[tool.pyfrc]\nmain = "src/robot.py"\n',
            "src/robot.py": ROBOT,
            "src/subsystems/drive.py": DRIVE,
            "tests/a_test.py": "def test_it(robot):\n    assert robot.drive.encoder.getRate() == 0\n",
        }
    )
    project.run_here("migrate")
    assert text(project, "src/robot.py") == NEW_ROBOT
    assert "robot.drive.encoder.get_rate()" in text(project, "tests/a_test.py")
    assert 'robotpy_version = "2027.' in text(project, "pyproject.toml")


SETTINGS = {
    "pyproject.toml": """
        # What the robot needs.
        [tool.robotpy]
        robotpy_version = "2026.2.2"  # of WPILib
        components = ["commands2"]
        requires = ["robotpy-rev==2026.0.4", "numpy>=1.26", "photonlibpy==2026.3.4"]

        [tool.ruff]
        line-length = 120
    """,
    "requirements.txt": """
        robotpy[all]~=2026.2
        numpy>=1.26
    """,
    "sim/config.json": """
        {"joysticks": {"0": {"axes": {"4": "turn"}, "buttons": {"1": "shoot", "5": "slowly"}},
                       "1": {"axes": {"4": "lift"}, "buttons": {"1": "lift", "5": "climb"}}}}
    """,
    ".github/workflows/test.yml": """
        steps:
          - uses: actions/setup-python@v5
            with:
              python-version: "3.10"
          - run: pip install wpilib==2026.2.2
    """,
}

NEW_SETTINGS = {
    "pyproject.toml": """\
# What the robot needs.
[tool.robotpy]
robotpy_version = "2027.0.0a7"  # of WPILib
components = ["commands2"]
requires = ["wpilib-drivers==2027.0.0a7", "robotpy-rev==2027.0.0a7.post1", "numpy>=1.26", "photonlibpy==2026.3.4"]

[tool.ruff]
line-length = 120
""",
    "requirements.txt": """\
robotpy[all]==2027.0.0a7
numpy>=1.26
wpilib-drivers==2027.0.0a7
""",
    "sim/config.json": """\
{"joysticks": {"0": {"axes": {"2": "turn"}, "buttons": {"0": "shoot", "9": "slowly"}},
               "1": {"axes": {"4": "lift"}, "buttons": {"0": "lift", "4": "climb"}}}}
""",
    ".github/workflows/test.yml": """\
steps:
  - uses: actions/setup-python@v5
    with:
      python-version: "3.13"
  - run: pip install wpilib==2027.0.0a7
""",
}


def test_the_settings_name_the_packages_of_the_new_season(project: RobotProject) -> None:
    project.write(SETTINGS)
    for name in SETTINGS:
        (project.path / name).write_text(text(project, name), "utf-8", newline="\r\n")
    result = project.run_here("migrate")
    for name, new in NEW_SETTINGS.items():
        assert text(project, name) == new
    assert "pyproject.toml:5: photonlibpy==2026.3.4 is for 2026." in result.stdout
    project.run_here("migrate")
    for name, new in NEW_SETTINGS.items():
        assert text(project, name) == new


def test_without_libcst_there_is_a_sentence(project: RobotProject, tmp_path: Path) -> None:
    (tmp_path / "hidden").mkdir()
    (tmp_path / "hidden/libcst.py").write_text("raise ImportError\n")
    result = project.run("migrate", env={"PYTHONPATH": str(tmp_path / "hidden")}, cold=True)
    assert result.code == 1
    assert 'python -m pip install "pyfrc[migrate]>=' in result.stderr
