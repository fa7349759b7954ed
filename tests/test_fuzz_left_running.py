"""A motor that autonomous has set and no code stops: it runs on in teleop."""

from __future__ import annotations

from typing import Any

from pyfrc_core.runtime.scripts.script import load_script

SHORT = "[tool.pyfrc.fuzz]\nmatch_seconds = 8\n"

ROBOT = """
    import wpilib
    import wpilib.drive

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.intake = wpilib.PWMSparkMax(0)
            self.left, self.right = wpilib.PWMSparkMax(1), wpilib.PWMSparkMax(2)
            self.drive = wpilib.drive.DifferentialDrive(self.left, self.right)
            self.gamepad = wpilib.XboxController(0)

        def autonomousInit(self):
            self.intake.set(0.7)
            self.left.set(0.4)

        def teleopPeriodic(self):
            self.drive.arcadeDrive(0.4, 0.0)
            if self.gamepad.getAButton():
                self.intake.set(0.0)
    """


def test_a_motor_that_autonomous_leaves_running_is_found(make_project: Any) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": SHORT})
    result = project.run("fuzz", "--seed", "1", "--runs", "8")
    assert result.code == 1, result.output
    place = project.place("robot.py", "self.intake.set(0.7)")
    message = (
        f"{place}: the motor still runs at 0.70, as autonomous has set it here, 1 s after the beginning of teleop: "
        "no code has set it since"
    )
    assert f"{message}\n" in result.stdout
    # It is named when it is found, and once more with its script.
    assert (
        result.stdout.count("\nrobot.py:12: the motor still runs at") == result.stdout.count("found robot.py:12: ") == 1
    )
    (file,) = (project.path / "tests/fuzz").iterdir()
    assert file.name == "motors_left_running-robot-autonomousinit.jsonl"
    writes = [value for step in load_script(file).steps for target, value in step.writes.items() if target == "mode"]
    assert [each for each in writes if "disabled" not in each] == ["autonomous", "teleop"]
    assert f"then {message}" in project.run("replay", file).output
