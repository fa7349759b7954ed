"""Parts of the rewriting of `pyfrc migrate`: ports, imports of what is gone, statements that are left out."""

from __future__ import annotations

import platform
from pathlib import Path

import pytest

pytest.importorskip("libcst")

from pyfrc_core.migrate import project
from pyfrc_core.migrate.migration import migrate
from pyfrc_core.migrate.report import Report
from pyfrc_core.migrate.rewrite.ports import Ports
from pyfrc_core.season.names.table import table

_ALL = "SystemCore's ports 0 to 5 are for PWM, digital, analog and LEDs together"


def remarks_of(report: Report) -> list[tuple[int, str, str, bool]]:
    """Line, sentence, remedy and whether it runs, by line."""
    remarks = [*report.by_hand(), *report.to_check()]
    return sorted((place.line, each.what, each.remedy, each.done) for each in remarks for place in each.places)


def reported(*devices: tuple[str, int]) -> list[tuple[int, str, str, bool]]:
    """Line, sentence, remedy and whether it runs, of devices with these channels, one in each line."""
    ports, report = Ports(table()), Report()
    for line, (name, channel) in enumerate(devices, 1):
        ports.use("robot.py", line, f"wpilib.{name}", channel)
    ports.report(report)
    return remarks_of(report)


def test_kinds_of_channels() -> None:
    ports = Ports(table())
    names = ("PWMSparkMax", "Servo", "DigitalInput", "AnalogInput", "AddressableLED", "Joystick")
    assert [ports.kind(f"wpilib.{name}") for name in names] == ["PWM", "PWM", "digital", "analog", "LED", ""]
    assert ports.kind("rev.PWMSparkMax") == ""


def test_devices_with_ports_of_their_own_are_not_reported() -> None:
    assert reported(("PWMSparkMax", 0), ("Encoder", 1), ("AnalogInput", 5)) == []
    # Two of one kind on one channel were an error on the roboRIO, too.
    assert reported(("PWMSparkMax", 0), ("PWMSparkMax", 0)) == []


def test_devices_that_share_a_port_name_the_first_and_the_free_ports() -> None:
    assert reported(("PWMSparkMax", 0), ("DigitalInput", 0), ("AnalogInput", 2)) == [
        (
            2,
            "DigitalInput has channel 0, as the PWMSparkMax in robot.py:1.",
            f"{_ALL}. Give each its own; free: 1, 3, 4, 5.",
            True,
        )
    ]
    # A strip and a switch on one port stop the program, in the simulation, too.
    ((line, what, _, done),) = reported(("AddressableLED", 3), ("DigitalOutput", 3))
    assert (line, what, done) == (2, "DigitalOutput has channel 3, as the AddressableLED in robot.py:1.", False)
    ((*_, done),) = reported(("AddressableLED", 3), ("AnalogInput", 3))
    assert done


def test_the_last_channel_is_the_one_before_the_number_of_channels(tmp_path: Path) -> None:
    _, said = migrated(tmp_path, "import wpilib\nwpilib.AddressableLED(5)\nwpilib.AddressableLED(6)\n")
    assert [each for each in said if "does not exist" in each] == ["3 Channel 6 does not exist on SystemCore."]


def test_a_channel_that_systemcore_lacks() -> None:
    remedy = f"{_ALL}. Write yours; free: 0, 1, 2, 3, 4, 5."
    assert reported(("DigitalInput", 9), ("Servo", 6)) == [
        (1, "DigitalInput has channel 9.", remedy, True),
        (2, "Servo has channel 6.", remedy, True),
    ]
    assert reported(("AddressableLED", 9)) == []  # reported where it is made: the program stops there


def test_too_many_devices() -> None:
    six = [("PWMSparkMax", number) for number in range(6)]
    assert reported(*six) == []
    ((_, what, remedy, _),) = reported(*six, ("AnalogInput", 0))
    assert what == "AnalogInput has channel 0, as the PWMSparkMax in robot.py:1."
    assert remedy.startswith(f"{_ALL}, but this project needs 7. Replace some by CAN devices")


# -- imports -----------------------------------------------------------------------------------------------------------


def migrated(tmp_path: Path, code: str) -> tuple[str, list[str]]:
    """The code after a migration, and what is said."""
    file = tmp_path / "robot.py"
    file.write_text(code, "utf-8")
    done = migrate(tmp_path)
    done.write()
    said = [f"{line} {what}" for line, what, _, _ in remarks_of(done.report)]
    return file.read_text("utf-8"), said


@pytest.mark.parametrize(
    ("code", "new", "said"),
    [
        # Not used: it goes.
        (
            "from wpilib import DigitalInput, Relay\nswitch = DigitalInput(0)\n",
            "from wpilib import DigitalInput\nswitch = DigitalInput(0)\n",
            ["1 wpilib.Relay is gone, and its import, which is not used, is removed."],
        ),
        # Used: it stays, with what to do.
        (
            "from wpilib import Relay\nlight = Relay(1)\n",
            "from wpilib import Relay\nlight = Relay(1)\n",
            ["1 wpilib.Relay is gone.", "2 wpilib.Relay is gone."],
        ),
        # All its uses are rewritten: nothing is to say.
        (
            "from wpilib import SmartDashboard\nSmartDashboard.putNumber('speed', 1)\n",
            "import telemetry\ntelemetry.log('speed', 1)\n",
            [],
        ),
    ],
)
def test_imports_of_what_is_gone(tmp_path: Path, code: str, new: str, said: list[str]) -> None:
    text, remarks = migrated(tmp_path, code)
    assert text == new
    assert [each for each in remarks if "is gone" in each] == said


def test_a_new_import_comes_after_docstring_and_future(tmp_path: Path) -> None:
    head = '"""A robot."""\n"more"\nfrom __future__ import annotations\n'
    body = "x = 1\ndef show():\n    import wpilib\n    wpilib.SmartDashboard.putNumber('speed', x)\n"
    text, _ = migrated(tmp_path, head + body)
    body = body.replace("wpilib.SmartDashboard.putNumber", "telemetry.log")
    assert text == f"{head}import telemetry\n{body}"


def test_a_name_that_another_file_imports_for_this_one_is_renamed_in_both(tmp_path: Path) -> None:
    (tmp_path / "parts.py").write_text("from wpilib import PS4Controller, PS4Controller as Pad, Timer\n", "utf-8")
    text, _ = migrated(
        tmp_path, "from parts import PS4Controller, Pad, Timer\npads = PS4Controller(0), Pad(1), Timer()\n"
    )
    assert (
        text == "from parts import DualShock4Controller, Pad, Timer\npads = DualShock4Controller(0), Pad(1), Timer()\n"
    )
    assert "DualShock4Controller, DualShock4Controller as Pad, Timer" in (tmp_path / "parts.py").read_text("utf-8")


def test_an_old_name_of_a_base_class_is_renamed_wherever_a_file_has_it_from(tmp_path: Path) -> None:
    files = {
        "base": ("from commands2 import SubsystemBase\n", "from commands2 import Subsystem\n"),
        "other": ("from base import SubsystemBase as S\nclass C(S): pass\n", None),
        "third": ("import base\nclass D(base.SubsystemBase): pass\n", "import base\nclass D(base.Subsystem): pass\n"),
    }
    for name, (before, _) in files.items():
        (tmp_path / f"{name}.py").write_text(before, "utf-8")
    text, said = migrated(tmp_path, "from base import SubsystemBase\nclass B(SubsystemBase): pass\n")
    assert (text, said) == ("from base import Subsystem\nclass B(Subsystem): pass\n", [])
    new = {name: (tmp_path / f"{name}.py").read_text("utf-8") for name in files}
    assert new["other"] == "from base import Subsystem as S\nclass C(S): pass\n"
    assert (new["base"], new["third"]) == (files["base"][1], files["third"][1])


def test_a_circle_of_imports_that_defines_nothing_is_reported(tmp_path: Path) -> None:
    (tmp_path / "parts.py").write_text("from robot import Arm\n", "utf-8")
    _, said = migrated(tmp_path, "from parts import Arm\nclass B: pass\n")
    assert said == [
        f"1 Arm is imported in a circle: {each} and what it imports define no Arm." for each in ("parts", "robot")
    ]
    (tmp_path / "parts.py").write_text("from robot import B\nclass Arm: pass\n", "utf-8")
    assert migrated(tmp_path, "from parts import Arm\nclass B: pass\n")[1] == []


def test_a_type_of_2027_is_understood_and_asked_for(tmp_path: Path) -> None:
    code = "import wpimath.geometry\ndef go(r{}):\n    return r.rotateBy(r)\n"
    text, said = migrated(tmp_path, code.format(": wpimath.Rotation2d"))
    assert (text, said) == ("import wpimath\ndef go(r: wpimath.Rotation2d):\n    return r.rotate_by(r)\n", [])
    (tmp_path / "robot.py").write_text("def go(angle):\n    return angle.rotateBy(angle), angle.cos()\n", "utf-8")
    ((_, _, remedy, _),) = remarks_of(migrate(tmp_path).report)
    assert remedy.startswith("Write its type there: angle: wpimath.Rotation2d.")


def test_names_in_an_annotation_that_is_a_text_are_renamed(tmp_path: Path) -> None:
    for start, name in (
        ("from wpilib import PS4Controller", "PS4Controller"),
        ("import wpilib", "wpilib.PS4Controller"),
    ):
        for quote in ("", "'"):
            code = f"{start}\ndef go(a: {quote}{name}{quote}, b: {quote}list[{name}]{quote}): pass\n"
            text, _ = migrated(tmp_path, code)
            assert text == code.replace("PS4Controller", "DualShock4Controller")


def test_a_statement_that_is_left_out_after_a_colon_becomes_pass(tmp_path: Path) -> None:
    gone = "wpilib.LiveWindow.disableAllTelemetry()"
    text, _ = migrated(tmp_path, f"import wpilib\nif True: {gone}\n{gone}\n{gone}; x = 1\n")
    assert text == "import wpilib\nif True: pass\nx = 1\n"


def test_six_devices_suffice_and_the_seventh_does_not() -> None:
    shared = reported(*(("PWMSparkMax", number) for number in range(5)), ("AnalogInput", 0))
    assert [remedy for _, _, remedy, _ in shared] == [f"{_ALL}. Give each its own; free: 5."]


def test_a_file_that_cannot_be_walked_stays_and_the_others_are_rewritten(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Python 3.12 has a limit for nested code that nothing raises."""
    (tmp_path / "robot.py").write_text("import wpilib\nclass R(wpilib.TimedRobot): pass\n")
    (tmp_path / "pyproject.toml").write_text('[tool.robotpy]\nrobotpy_version = "2026.2.2"\n')
    errors = {
        "deep.py": RecursionError("maximum recursion depth exceeded"),
        "odd.py": RuntimeError("a mistake of LibCST"),
    }
    for name in errors:
        (tmp_path / name).write_text(f"# {name}\nimport wpilib\n")
    parse = project._parsed

    def parsed(text: bytes) -> object:
        for name, error in errors.items():
            if name.encode() in text:
                raise error
        return parse(text)

    monkeypatch.setattr(project, "_parsed", parsed)
    done = migrate(tmp_path)
    assert not done.after.keys() & errors.keys()
    left = {each.places[0].file: (each.what.partition(",")[0], each.remedy) for each in done.report.by_hand()}
    version = platform.python_version()
    assert left["deep.py"] == (
        f"This is nested too deeply for Python {version}",
        "Run migrate with another Python, or rewrite it by hand.",
    )
    assert left["odd.py"] == ("Python can read this", "Rewrite it by hand.")
